//! Assessment of own ship's compliance with the collision regulations, from trajectories alone.
//!
//! `score` computes the scores of the literature and the rule violations; `monitor` evaluates the
//! rules as formulas of temporal logic. Both use the [`EncounterSamples`], the sectors of roles and
//! the thresholds, which differ between sources. They share no formula, so they may disagree.

mod monitor;
mod role_intervals;
mod samples;
mod score;

pub use monitor::{Measure, MonitorResult, MonitorVerdict, monitors};
pub use role_intervals::{RoleInterval, roles};
pub use samples::EncounterSamples;
pub(crate) use samples::OwnSamples;
pub use score::{Scores, scores};

use super::Thresholds;
use crate::target::ShipTrack;

/// A rule that own ship violates.
#[derive(Debug, Clone, PartialEq)]
pub struct RuleViolation {
    /// The rule: `14(a)`, `17(c)`, ...
    pub rule: &'static str,
    /// Seconds.
    pub time: f64,
    /// Description.
    pub what: String,
}

/// Scores, rule violations and monitor results of own ship toward one target.
#[derive(Debug, Clone, PartialEq)]
pub struct ComplianceReport {
    /// Roles of own ship over time; empty without risk of collision.
    pub roles: Vec<RoleInterval>,
    /// Scores in the first role.
    pub scores: Scores,
    /// Rule violations in the first role, in order of time.
    pub violations: Vec<RuleViolation>,
    /// Results of the monitors over the whole encounter.
    pub monitors: [MonitorResult; 6],
}

impl ComplianceReport {
    /// Assesses an encounter. A target in extremis, restricted visibility and lights are not
    /// considered. O(samples).
    pub fn judge(encounter: &EncounterSamples, thresholds: &Thresholds) -> Self {
        let roles = roles(encounter, thresholds);
        let (scores, violations) = match roles.first() {
            Some(first) => scores(encounter, first, thresholds),
            None => (score::safety(encounter, thresholds), Vec::new()),
        };
        Self {
            roles,
            scores,
            violations,
            monitors: monitors(encounter, thresholds),
        }
    }

    /// Assesses own ship toward one target. A target that stays too far away for any role is
    /// assessed by the nearest sample alone.
    pub(crate) fn along(track: &OwnSamples, target: &ShipTrack, thresholds: &Thresholds) -> Self {
        let (risk, monitor) = (&thresholds.risk, &thresholds.monitor);
        let length = track.hull().length.max(target.hull.length);
        let near = (risk.lengths * length).max(monitor.lengths * target.hull.length);
        let soon = risk.time.max(monitor.time).max(monitor.manoeuvre);
        let far = near + soon * track.closing(target);
        Self::judge(&track.encounter(target, far), thresholds)
    }

    /// True without a rule violation and without a violated monitor.
    pub fn complies(&self) -> bool {
        self.broken().next().is_none()
    }

    /// Names of the violated rules and monitors; a rule may appear more than once.
    pub fn broken(&self) -> impl Iterator<Item = &'static str> {
        let violated = |f: &&MonitorResult| f.verdict == MonitorVerdict::Violated;
        let monitors = self.monitors.iter().filter(violated).map(|f| f.monitor);
        self.violations.iter().map(|b| b.rule).chain(monitors)
    }
}

#[cfg(test)]
mod tests;
