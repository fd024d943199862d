//! Course alterations of a motion.

use super::Trajectory;
use crate::frame::{Side, deg_from_radians};

/// Angle in degrees below which an alteration is not visible and does not count as a turn.
const LEAST_TURN_DEG: f64 = 0.5;

/// Degrees: an alteration from which on own ship departs from its course.
pub(crate) const DEPARTURE_DEG: f64 = 5.0;

/// Alteration of course to one side.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Alteration {
    pub side: Side,
    /// Angle in degrees, positive.
    pub degrees: f64,
    /// Start time in seconds.
    pub start: f64,
}

/// First alteration of course by 5° or more, else the first visible one. Corners of a path do not
/// count.
pub(crate) fn first_alteration(trajectory: &Trajectory) -> Option<Alteration> {
    let all = turns(trajectory);
    let departs = all.iter().find(|turn| turn.degrees >= DEPARTURE_DEG);
    departs.or(all.first()).copied()
}

/// Lists all visible turns in order of time. Consecutive arcs to one side form one turn; a straight
/// segment ends it. Under forces, turns are swings of the heading.
fn turns(trajectory: &Trajectory) -> Vec<Alteration> {
    if let Some(motion) = trajectory.steered() {
        let swings = motion.swings().into_iter();
        return swings
            .filter_map(|s| visible(s.turned, s.start_time))
            .collect();
    }
    let moving = (trajectory.segments().iter()).filter(|s| s.duration > 0.0 && s.speed > 0.0);
    let changes = moving.map(|s| (s.start_time, s.turn_rate * s.duration));
    let mut turns = Vec::new();
    let mut current = (0.0, 0.0);
    for (start, change) in changes {
        if current.1 * change > 0.0 {
            current.1 += change;
        } else {
            turns.extend(visible(current.1, current.0));
            current = (start, change);
        }
    }
    turns.extend(visible(current.1, current.0));
    turns
}

/// Converts a heading change in radians to a turn; `None` if it is not visible.
fn visible(turned: f64, start: f64) -> Option<Alteration> {
    let degrees = deg_from_radians(turned.abs());
    let side = Side::of_turn(turned)?;
    (degrees >= LEAST_TURN_DEG).then_some(Alteration {
        side,
        degrees,
        start,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frame::{Pose, Vector};
    use crate::trajectory::fixtures::chain;
    use crate::trajectory::{ForceNode, Steered};

    /// Builds ten-second segments with the given turns in degrees to starboard.
    fn arcs(turns: &[f64]) -> Trajectory {
        let parts = turns.iter();
        let parts: Vec<_> = parts
            .map(|degrees| (10.0, 5.0, -degrees.to_radians() / 10.0))
            .collect();
        let start = Pose::new(Vector::zeros(), 0.2);
        Trajectory::new(chain(start, &parts)).expect("continuous")
    }

    #[test]
    fn the_first_turn_is_the_first_that_can_be_seen() {
        use Side::{Port, Starboard};
        for (turns, expected) in [
            (vec![0.0], None),
            (vec![0.2, 0.0, -0.3], None),
            (vec![0.0, 30.0, -60.0], Some((Starboard, 30.0))),
            (vec![-30.0, -15.0, 0.0, -5.0], Some((Port, 45.0))),
            (vec![0.1, -20.0], Some((Port, 20.0))),
            (vec![-1.3, 0.0, 51.0], Some((Starboard, 51.0))),
            (vec![-1.3, 0.0, 4.0], Some((Port, 1.3))),
            (vec![0.0, 40.0], Some((Starboard, 40.0))),
        ] {
            let found = first_alteration(&arcs(&turns));
            let found = found.map(|turn| (turn.side, (turn.degrees * 1e6).round() / 1e6));
            assert_eq!(found, expected, "{turns:?}");
        }
    }

    #[test]
    fn under_forces_what_swings_by_less_than_five_degrees_is_steering() {
        use Side::{Port, Starboard};
        // courses in degrees, clockwise
        let steered = |courses: &[f64]| {
            let nodes = courses.iter().enumerate().map(|(k, course)| ForceNode {
                time: k as f64,
                pose: Pose::new(Vector::zeros(), -course.to_radians()),
                velocity: Vector::new(1.0, 0.0),
                yaw_rate: 0.0,
                force: Vector::zeros(),
                moment: 0.0,
            });
            Trajectory::from(Steered::new(nodes.collect()).expect("in order"))
        };
        let found = |turn: Option<Alteration>| turn.map(|t| (t.side, t.degrees.round()));
        for (courses, first) in [
            (vec![10.0, 12.0, 9.0, 13.0, 8.5], None),
            // two degrees to port first, and again at the end
            (vec![0.0, -2.0, 10.0, 30.0, 28.0], Some((Starboard, 32.0))),
            // a swing back by four degrees does not end a turn
            (vec![0.0, -10.0, -6.0, -40.0, 20.0, 0.0], Some((Port, 40.0))),
            (vec![0.0, 5.5], Some((Starboard, 6.0))),
        ] {
            let motion = steered(&courses);
            assert_eq!(found(first_alteration(&motion)), first, "{courses:?}");
        }
    }
}
