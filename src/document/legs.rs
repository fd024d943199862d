//! The legs of a plan as a navigator reads them: turns and straight runs, and what happens on each.

use super::encounter::EncounterDocument;
use super::lines::{met, passing};
use super::parts::segment;
use super::plan::PlanDocument;
use crate::frame::{clockwise_deg, course_deg_from_heading};
use crate::text::tenths;
use crate::tolerance;
use crate::trajectory::Segment;

/// A turn, a straight run or a wait at one speed.
#[derive(Debug, Clone, PartialEq)]
pub struct PlannedLeg {
    /// The whole leg; times in seconds from the present.
    pub motion: Segment,
    /// What happens on it, in order of time.
    pub events: Vec<String>,
}

impl PlannedLeg {
    /// Course at the end, degrees clockwise from north.
    pub fn course_deg(&self) -> f64 {
        course_deg_from_heading(self.motion.end().heading)
    }

    /// Change of course, degrees; positive to starboard, 0 for a straight run.
    pub fn turn_deg(&self) -> f64 {
        clockwise_deg(self.motion.turn_rate * self.motion.duration)
    }

    /// True where own ship lies still.
    pub fn waits(&self) -> bool {
        self.motion.speed == 0.0
    }
}

impl PlanDocument {
    /// The legs in order of time: the segments, where neighbours of one speed and one rate of turn
    /// are joined. Empty without a plan, and for a plan under forces.
    pub fn legs(&self) -> Vec<PlannedLeg> {
        let segments = self.trajectory.as_ref().and_then(|t| t.segments.as_ref());
        let segments: Vec<Segment> = segments.into_iter().flatten().map(segment).collect();
        let joined = segments.chunk_by(|a, b| a.speed == b.speed && a.turn_rate == b.turn_rate);
        let mut legs: Vec<PlannedLeg> = joined
            .map(|parts| PlannedLeg {
                motion: Segment {
                    duration: parts.iter().map(|s| s.duration).sum(),
                    ..parts[0]
                },
                events: Vec::new(),
            })
            .collect();
        for (time, event) in self.events() {
            let within = |leg: &&mut PlannedLeg| time < leg.motion.end_time() - tolerance::TIME_S;
            if let Some(leg) = legs.iter_mut().find(within)
                && time >= 0.0
            {
                leg.events.push(event);
            }
        }
        legs
    }

    /// What happens along the plan, by time.
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
        events.extend(met(&self.encounters).into_iter().filter_map(passes));
        events.sort_by(|a, b| a.0.total_cmp(&b.0));
        events
    }
}

/// The closest approach that the plan leaves.
fn passes(encounter: &EncounterDocument) -> Option<(f64, String)> {
    let (distance, time) = (encounter.dcpa_m?, encounter.tcpa_s?);
    let (target, side) = (&encounter.target, passing(encounter));
    let text = format!("closest to '{target}': {} m, {side}", tenths(distance));
    Some((time, text))
}
