//! Phases of a plan by the rules: free, hold, out, parallel, back (docs/replanning.md).

use serde::{Deserialize, Serialize};

use super::legs::PlannedLeg;
use super::memory::PlannedManoeuvreDocument;
use super::parts::EscapeDocument;
use crate::colregs::ON_COURSE;
use crate::frame::{heading_from_course_deg, wrap};
use crate::tolerance;

/// What own ship does in a part of a plan by the rules.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Phase {
    /// Follows the mission.
    Free,
    /// Stands on: keeps course and speed until its escape begins.
    Hold,
    /// Has altered course or speed for a target.
    Out,
    /// Steers its first course again, beside the mission.
    Parallel,
    /// Returns to the mission; the targets are past and clear.
    Back,
}

words!(Phase {
    Free => "free",
    Hold => "hold",
    Out => "out",
    Parallel => "parallel",
    Back => "back",
});

/// A phase and its time interval, seconds.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct PhaseDocument {
    pub phase: Phase,
    pub from_s: f64,
    pub until_s: f64,
}

/// The phases from the present to the end of a plan, in order; empty without a manoeuvre.
pub(super) fn phases(
    legs: &[PlannedLeg],
    manoeuvres: &[PlannedManoeuvreDocument],
    escape: Option<&EscapeDocument>,
) -> Vec<PhaseDocument> {
    let Some(end) = legs.last().map(|leg| leg.motion.end_time()) else {
        return Vec::new();
    };
    let mut found: Vec<PhaseDocument> = Vec::new();
    let mut add = |phase: Phase, until: f64| {
        let from_s = found.last().map_or(0.0, |last| last.until_s);
        let until_s = until.min(end);
        if until_s > from_s + tolerance::TIME_S {
            found.push(PhaseDocument {
                phase,
                from_s,
                until_s,
            });
        }
    };
    for manoeuvre in manoeuvres {
        let holds = escape.is_some_and(|e| e.held_until_s >= manoeuvre.begins_s);
        add(
            if holds { Phase::Hold } else { Phase::Free },
            manoeuvre.begins_s,
        );
        add(Phase::Out, parallel_from(legs, manoeuvre));
        add(Phase::Parallel, manoeuvre.returns_s);
        add(Phase::Back, manoeuvre.joins_s);
    }
    if !manoeuvres.is_empty() {
        add(Phase::Free, end);
    }
    found
}

/// When own ship is on its first course again before it returns; else the return.
fn parallel_from(legs: &[PlannedLeg], manoeuvre: &PlannedManoeuvreDocument) -> f64 {
    let first = heading_from_course_deg(manoeuvre.first_course_deg);
    let is_off = |leg: &&PlannedLeg| wrap(leg.motion.end().heading - first).abs() > ON_COURSE;
    let during = |leg: &&PlannedLeg| {
        let middle = 0.5 * (leg.motion.start_time + leg.motion.end_time());
        middle > manoeuvre.begins_s && middle < manoeuvre.returns_s
    };
    let legs = || legs.iter().filter(during);
    // the turn away lies before the present where the manoeuvre is under way
    let turned = legs().find(is_off).map(|leg| leg.motion.start_time);
    let turned = turned.or((manoeuvre.begins_s < 0.0).then_some(0.0));
    let back = legs().find(|leg| {
        turned.is_some_and(|turned| leg.motion.start_time >= turned)
            && !leg.motion.is_arc()
            && !is_off(leg)
    });
    match back {
        // less speed alone leaves no course
        Some(leg) if manoeuvre.turn_deg != 0.0 => leg.motion.start_time.max(0.0),
        _ => manoeuvre.returns_s,
    }
}
