//! How own ship behaves along the plan of a run.

use super::Run;
use crate::colregs::{
    Thresholds,
    compliance::{ComplianceReport, OwnSamples},
};

impl Run {
    /// What two judges say of own ship toward each target, in the order of the scenario's; `None` without a plan, and of a target
    /// that is no ship on a nominal track. They see the planned trajectory and that track alone. O(targets x seconds), of targets that stay far away
    /// less.
    pub fn conduct(&self, thresholds: &Thresholds) -> Vec<Option<ComplianceReport>> {
        let plan = self.planned.outcome.plan();
        let own = self.scenario.own_ship.hull;
        let track = plan.map(|plan| OwnSamples::along(&plan.trajectory, own));
        let judge = |target: &crate::target::Target| {
            Some(ComplianceReport::along(
                track.as_ref()?,
                target.ship()?,
                thresholds,
            ))
        };
        self.scenario.targets.iter().map(judge).collect()
    }

    /// [`Run::conduct`] by the thresholds of the scenario.
    pub fn judged_conduct(&self) -> Vec<Option<ComplianceReport>> {
        self.conduct(self.scenario.judged_by())
    }
}
