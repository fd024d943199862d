//! Memory from before a scenario's time: roles, own ship's motion, and the plan that it
//! follows.

use searoom_colregs::TargetMemory;
use searoom_model::trajectory::Segment;
use searoom_planner::{Escape, PlannedManoeuvre, UnderWay, WarmStart};

/// Memory from before the scenario's time. Every time counts from the scenario's time and is
/// negative before it.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Memory {
    /// Own ship's motion up to t = 0, in order of time. Later segments need not begin exactly where
    /// earlier ones end.
    pub sailed: Vec<Segment>,
    /// The remainder of the plan that own ship follows, from t = 0 on; empty without one.
    pub remainder: Vec<Segment>,
    /// Metres from the remainder to where own ship was measured. Within its tracking margin the plan
    /// goes on from the remainder, not from there.
    pub off_plan: f64,
    /// The manoeuvres of the remainder.
    pub manoeuvres: Vec<PlannedManoeuvre>,
    /// The escape of the remainder, where own ship still holds course and speed.
    pub escape: Option<Escape>,
    /// The manoeuvre that own ship carries out.
    pub under_way: Option<UnderWay>,
    /// Names of the targets that have a velocity outside the set which the last plan assumed.
    pub outside_velocities: Vec<String>,
    /// Names of the targets at a place which they could not reach by the last plan.
    pub outside_places: Vec<String>,
    /// Names of the last plan's targets that the scenario has not; their roles are forgotten.
    pub missing: Vec<String>,
    /// One per target in the scenario's order, or none at all.
    pub targets: Vec<TargetMemory>,
    /// Own ship's state and last plan under forces; nothing else is remembered there.
    pub warm_start: Option<WarmStart>,
}

impl Memory {
    /// True for a target that is outside the sets which the last plan assumed.
    pub fn is_outside(&self, name: &str) -> bool {
        let mut outside = self.outside_velocities.iter().chain(&self.outside_places);
        outside.any(|outside| outside == name)
    }

    /// Returns the memory of a target; `None` without one.
    pub fn target(&self, index: usize) -> Option<&TargetMemory> {
        self.targets.get(index)
    }
}
