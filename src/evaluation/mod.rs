//! Judges any trajectory, sharing no collision code with the planners.

use crate::frame::Side;

/// One violated requirement.
#[derive(Debug, Clone, PartialEq)]
pub struct Violation {
    /// What is violated, in words: the quantity, what was found, what is allowed.
    pub what: String,
    /// Seconds.
    pub time: f64,
}

/// A target as it was met along the plan.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Passage {
    /// Least distance between own hull and the target's nominal hull, metres.
    pub dcpa: f64,
    /// And when, seconds.
    pub tcpa: f64,
    /// Side of own ship on which the target lies then.
    pub passing_side: Side,
    /// Least distance between own hull and any hull the target may have, metres; negative in overlap.
    pub min_clearance: f64,
    /// Least signed distance to the set the plan was made against, metres, and when, seconds.
    pub min_margin: f64,
    /// Seconds.
    pub min_margin_time: f64,
}

/// The figures of a plan that do not depend on how it was found.
#[derive(Debug, Clone, PartialEq)]
pub struct Evaluation {
    /// Everything that is wrong; a plan is verified when this is empty.
    pub violations: Vec<Violation>,
    /// Formulas section 7, m².
    pub space_time_error: f64,
    /// Eq. (30) read literally, m².
    pub arc_length_error: f64,
    /// Seconds.
    pub duration: f64,
    /// Metres.
    pub length: f64,
    /// Arrival minus desired end, seconds.
    pub delay: f64,
    /// Least of the targets' clearances, metres; infinite without targets.
    pub min_clearance: f64,
    /// Per target, in the scenario's order.
    pub passages: Vec<Passage>,
}

impl Evaluation {
    /// True when the independent check found nothing wrong.
    pub fn verified(&self) -> bool {
        self.violations.is_empty()
    }
}
