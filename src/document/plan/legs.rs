//! The legs of a plan as a navigator reads them: turns and straight runs, and the events on each.

use super::PlanDocument;
use crate::document::encounter::EncounterDocument;
use crate::document::lines::{met, passing};
use crate::document::parts::segment;
use crate::frame::{clockwise_deg, course_deg_from_heading, wrap};
use crate::text::tenths;
use crate::tolerance;
use crate::trajectory::Segment;

/// Speeds that differ by this fraction are one: the rounding of a planner, half a metre in a
/// thousand kilometres.
const SAME_SPEED: f64 = 1e-6;

/// Radians. A smaller change of course at a joint is rounding.
const CORNER_RAD: f64 = 1e-6;

/// Seconds. A shorter segment is no leg: a ship covers some millimetres.
const SHORTEST_S: f64 = 1e-3;

/// m/s. A slower ship lies still.
const STILL_MPS: f64 = 1e-3;

/// A turn, a straight run or a wait at one speed.
#[derive(Debug, Clone, PartialEq)]
pub struct PlannedLeg {
    /// The whole leg; times in seconds from the present.
    pub motion: Segment,
    /// Change of course at its start, degrees, positive to starboard. Not 0 at the corners of a
    /// path, where the path-time planner turns at once.
    pub corner_deg: f64,
    /// Events on the leg, in order of time.
    pub events: Vec<String>,
}

impl PlannedLeg {
    /// Course at the end, degrees clockwise from north.
    pub fn course_deg(&self) -> f64 {
        course_deg_from_heading(self.motion.end().heading)
    }

    /// Change of course along the leg, degrees; positive to starboard, 0 for a straight run.
    pub fn turn_deg(&self) -> f64 {
        clockwise_deg(self.motion.turn_rate * self.motion.duration)
    }

    /// True where own ship lies still, or moves too slowly for any log to show it.
    pub fn waits(&self) -> bool {
        self.motion.speed < STILL_MPS
    }
}

impl PlanDocument {
    /// The legs in order of time: the segments of a millisecond or more, where those that go on in
    /// the same motion are joined. Empty without a plan, and for a plan under forces.
    pub fn legs(&self) -> Vec<PlannedLeg> {
        let segments = self.trajectory.as_ref().and_then(|t| t.segments.as_ref());
        let segments = segments.into_iter().flatten().map(segment);
        let mut legs: Vec<PlannedLeg> = Vec::new();
        for motion in segments.filter(|s| s.duration >= SHORTEST_S) {
            let mut corner_deg = 0.0;
            if let Some(last) = legs.last_mut() {
                let corner = wrap(motion.start.heading - last.motion.end().heading);
                if corner.abs() > CORNER_RAD {
                    corner_deg = clockwise_deg(corner);
                } else if are_one(&last.motion, &motion) {
                    last.motion.duration += motion.duration;
                    continue;
                }
            }
            legs.push(PlannedLeg {
                motion,
                corner_deg,
                events: Vec::new(),
            });
        }
        for (time, event) in self.events() {
            let mut until = legs
                .iter_mut()
                .filter(|leg| time >= 0.0 && leg.motion.start_time <= time);
            // the plan ends with the last leg
            if let Some(leg) = until.next_back()
                && time <= leg.motion.end_time() + tolerance::TIME_S
            {
                leg.events.push(event);
            }
        }
        legs
    }

    /// Events of the plan, by time. A manoeuvre that is under way began before.
    fn events(&self) -> Vec<(f64, String)> {
        let mut events = Vec::new();
        for manoeuvre in &self.manoeuvres {
            let parts = [
                (manoeuvre.begins_s, "begins the manoeuvre"),
                (manoeuvre.returns_s, "returns"),
                (manoeuvre.joins_s, "back on the mission"),
            ];
            events.extend(parts.map(|(time, what)| (time, what.to_owned())));
        }
        events.extend(
            met(&self.encounters)
                .into_iter()
                .filter_map(closest_approach),
        );
        events.sort_by(|a, b| a.0.total_cmp(&b.0));
        events
    }
}

/// True for two motions of one speed and one rate of turn.
fn are_one(last: &Segment, next: &Segment) -> bool {
    let turns = last.turn_rate.abs().max(next.turn_rate.abs());
    (last.speed - next.speed).abs() <= SAME_SPEED * last.speed.max(next.speed)
        && (last.turn_rate - next.turn_rate).abs() <= SAME_SPEED * turns
}

fn closest_approach(encounter: &EncounterDocument) -> Option<(f64, String)> {
    let (distance, time) = (encounter.dcpa_m?, encounter.tcpa_s?);
    let (target, distance) = (&encounter.target, tenths(distance));
    let side = match encounter.passing_side {
        Some(_) => format!(", {}", passing(encounter)),
        None => String::new(),
    };
    Some((time, format!("closest to '{target}': {distance} m{side}")))
}
