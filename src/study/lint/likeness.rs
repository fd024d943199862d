//! Detection of scenarios that repeat others or mirror them.

use crate::frame::{Pose, Vector, direction, heading_of, wrap};
use crate::scenario::Scenario;
use crate::target::Motion;

/// Tolerances in metres, m/s and radians (0.2°) within which two ships are equal.
const SAME_PLACE: f64 = 5.0;
const SAME_SPEED: f64 = 0.05;
const SAME_COURSE: f64 = std::f64::consts::PI / 900.0;

/// Relation of a scenario to an earlier one.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Likeness {
    /// Equal ships on equal courses, relative to own ship.
    Same,
    /// Equal after exchanging port and starboard.
    Mirrored,
}

/// Ship relative to own ship at the start: position ahead and to port in metres, relative course,
/// and speed.
#[derive(Debug, Clone, Copy)]
struct Seen {
    place: Vector,
    course: f64,
    speed: f64,
}

impl Seen {
    fn mirrored(&self) -> Self {
        Self {
            place: Vector::new(self.place.x, -self.place.y),
            course: -self.course,
            ..*self
        }
    }

    fn is(&self, other: &Self) -> bool {
        (self.place - other.place).norm() <= SAME_PLACE
            && (self.speed - other.speed).abs() <= SAME_SPEED
            && wrap(self.course - other.course).abs() <= SAME_COURSE
    }
}

/// Returns for every scenario the first earlier one that it repeats: own speed and all targets are
/// equal. Routes are not compared. A scenario without targets repeats none. O(scenarios² targets²).
pub fn likenesses(scenarios: &[&Scenario]) -> Vec<Option<(usize, Likeness)>> {
    let all: Vec<Option<Vec<Seen>>> = scenarios.iter().map(|s| seen(s)).collect();
    let run = |index: usize| {
        let desired = &scenarios[index].desired;
        desired.length() / desired.duration()
    };
    let like = |index: usize| {
        let here = all[index].as_ref()?;
        let mirrored: Vec<Seen> = here.iter().map(Seen::mirrored).collect();
        all[..index].iter().enumerate().find_map(|(before, there)| {
            let there = there.as_ref()?;
            // negated on purpose: a NaN is equal to nothing
            if !((run(before) - run(index)).abs() <= SAME_SPEED) {
                return None;
            }
            if are(here, there) {
                return Some((before, Likeness::Same));
            }
            are(&mirrored, there).then_some((before, Likeness::Mirrored))
        })
    };
    (0..scenarios.len()).map(like).collect()
}

/// Tracked ships; `None` if there are none, or other targets.
fn seen(scenario: &Scenario) -> Option<Vec<Seen>> {
    let own: Pose = scenario.own_ship.pose;
    let ships = scenario.targets.iter().map(|target| match &target.motion {
        Motion::Ship(ship) => Some(Seen {
            place: own.body_coordinates(ship.pose.position),
            course: wrap(heading_of(direction(ship.pose.heading)) - own.heading),
            speed: ship.speed,
        }),
        Motion::Sets(_) => None,
    });
    let ships: Vec<Seen> = ships.collect::<Option<_>>()?;
    (!ships.is_empty()).then_some(ships)
}

/// True if the two lists contain equal ships in any order.
fn are(some: &[Seen], others: &[Seen]) -> bool {
    let mut left: Vec<&Seen> = others.iter().collect();
    some.len() == others.len()
        && some
            .iter()
            .all(|ship| match left.iter().position(|other| ship.is(other)) {
                Some(index) => {
                    left.swap_remove(index);
                    true
                }
                None => false,
            })
}
