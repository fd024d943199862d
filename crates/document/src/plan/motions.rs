//! The motion of a plan as turns and straight runs.

use super::PlanDocument;
use super::departure::turn_figure;
use crate::parts::SegmentDocument;
use searoom_geometry::frame::{clockwise_deg, course_deg_from_heading, wrap};
use searoom_input::text::tenths;
use searoom_model::trajectory::Segment;

/// Speeds that differ by this fraction are one: the rounding of a planner, half a metre in a
/// thousand kilometres.
const SAME_SPEED: f64 = 1e-6;

/// Radians. A smaller change of course at a joint is rounding.
const CORNER_RAD: f64 = 1e-6;

/// Seconds. A shorter segment is no leg: a ship covers some millimetres.
const SHORTEST_S: f64 = 1e-3;

/// Degrees. A smaller turn is not told.
const LEAST_TURN_DEG: f64 = 0.05;

/// m/s. A slower ship lies still.
pub const STILL_MPS: f64 = 1e-3;

/// A turn, a straight run or a wait at one speed.
#[derive(Debug, Clone, PartialEq)]
pub struct PlannedLeg {
    /// The whole leg; times in seconds from the present.
    pub motion: Segment,
    /// Change of course at its start, degrees, positive to starboard. Not 0 at the corners of a
    /// path, where the path-time planner turns at once.
    pub corner_deg: f64,
    /// The target for which the leg alters course or speed, or `land`.
    pub because_of: Option<String>,
    /// Events on the leg, in order of time; first the alteration and its target.
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

    /// The turn in words: side and degrees, at a corner "at once"; `None` where own ship goes
    /// straight on.
    pub fn turn_words(&self) -> Option<String> {
        let sided = |turn: f64| {
            let side = if turn > 0.0 { "starboard" } else { "port" };
            let shown = turn.abs() >= LEAST_TURN_DEG;
            shown.then(|| format!("{side} {}°", turn_figure(turn.abs())))
        };
        match (sided(self.corner_deg), sided(self.turn_deg())) {
            _ if self.waits() => Some("waits".to_owned()),
            (None, turn) => turn,
            (Some(corner), None) => Some(format!("{corner} at once")),
            (Some(corner), Some(turn)) => Some(format!("{corner} at once, {turn}")),
        }
    }

    /// The course at the end as three digits, 000 to 359.
    pub fn course_figure(&self) -> String {
        // 359.9° is 000
        format!("{:03.0}", self.course_deg().round() % 360.0)
    }

    /// Length in metres, with a decimal where the `longest` leg is short.
    pub fn length_figure(&self, longest: f64) -> String {
        let length = self.motion.length();
        match longest < 100.0 {
            true => tenths(length),
            false => format!("{length:.0}"),
        }
    }

    /// True where own ship lies still, or moves too slowly for any log to show it.
    pub fn waits(&self) -> bool {
        self.motion.speed < STILL_MPS
    }
}

impl PlanDocument {
    /// The segments of a millisecond or more, where those that go on in the same motion are joined.
    pub fn motions(&self) -> Vec<PlannedLeg> {
        let segments = self.trajectory.as_ref().and_then(|t| t.segments.as_ref());
        let segments = segments.into_iter().flatten().map(SegmentDocument::segment);
        let mut legs: Vec<PlannedLeg> = Vec::new();
        for motion in segments.filter(|s| s.duration >= SHORTEST_S) {
            let mut corner_deg = 0.0;
            if let Some(last) = legs.last_mut() {
                let corner = wrap(motion.start.heading - last.motion.end().heading);
                if corner.abs() > CORNER_RAD {
                    corner_deg = clockwise_deg(corner);
                } else if is_same_motion(&last.motion, &motion) {
                    last.motion.duration += motion.duration;
                    continue;
                }
            }
            legs.push(PlannedLeg {
                motion,
                corner_deg,
                because_of: None,
                events: Vec::new(),
            });
        }
        legs
    }
}

/// True for two motions of one speed and one rate of turn.
pub fn is_same_motion(last: &Segment, next: &Segment) -> bool {
    let turns = last.turn_rate.abs().max(next.turn_rate.abs());
    (last.speed - next.speed).abs() <= SAME_SPEED * last.speed.max(next.speed)
        && (last.turn_rate - next.turn_rate).abs() <= SAME_SPEED * turns
}
