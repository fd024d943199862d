//! Assessment of own ship's compliance with the collision regulations, from trajectories alone.
//!
//! `score` computes the scores of the literature and the rule violations; `monitor` evaluates the
//! rules as formulas of temporal logic. Both use the [`EncounterSamples`], the [`roles`] that last
//! until the target is past and clear, the time from which another target frees own ship, and the
//! thresholds, which differ between sources. Each has its own formulas, so they may disagree.

mod monitor;
mod role_intervals;
mod samples;
mod score;

pub use monitor::{Measure, Monitor, MonitorResult, MonitorVerdict, monitors};
pub use role_intervals::{RoleInterval, roles};
pub use samples::EncounterSamples;
pub use samples::OwnSamples;
pub use score::Scores;
use score::{around_ship_at_rest, scores};

use super::{Paragraph, TargetMemory, Thresholds};
use searoom_model::target::ShipTrack;

/// A rule that own ship violates.
#[derive(Debug, Clone, PartialEq)]
pub struct RuleViolation {
    /// The paragraph.
    pub rule: Paragraph,
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
    /// The manoeuvre in the first role; `None` without a role. After a simulation also the one
    /// around a ship at rest.
    pub manoeuvre: Option<Manoeuvre>,
}

/// Figures that a navigator looks at: own ship's alterations from the beginning of its role to the closest
/// approach of the hulls.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Manoeuvre {
    /// Seconds from the first alteration to the closest approach that it changes; `None` without
    /// an alteration.
    pub lead: Option<f64>,
    /// Number of alterations of course of more than 2°.
    pub turns: usize,
    /// The smallest of them, radians; `None` without one.
    pub smallest_turn: Option<f64>,
    /// Number of changes of speed by more than 2 % of the ordered speed.
    pub speed_changes: usize,
}

impl ComplianceReport {
    /// Assesses the encounter with the only target. A target in extremis, restricted visibility and
    /// lights are not considered. O(samples).
    pub fn judge(encounter: &EncounterSamples, thresholds: &Thresholds) -> Self {
        let roles = roles(encounter, thresholds);
        Self::within(encounter, roles, f64::INFINITY, thresholds)
    }

    /// Assesses the encounters with all targets, in their order. A ship that keeps clear of one
    /// target, or may act to avoid it, need not hold its course for another: it is excused from
    /// then on. O(targets × samples).
    pub fn of_all<'s>(
        encounters: impl Iterator<Item = &'s EncounterSamples> + Clone,
        thresholds: &Thresholds,
    ) -> Vec<Self> {
        let all: Vec<_> = (encounters.clone())
            .map(|encounter| roles(encounter, thresholds))
            .collect();
        let frees: Vec<f64> = (encounters.clone().zip(&all))
            .map(|(encounter, roles)| monitor::frees_at(encounter, roles, thresholds))
            .collect();
        let first = (0..frees.len()).min_by(|a, b| frees[*a].total_cmp(&frees[*b]));
        let others = |but: Option<usize>| {
            let others = frees.iter().enumerate();
            let others = others.filter(|(index, _)| Some(*index) != but);
            others.map(|(_, time)| *time).fold(f64::INFINITY, f64::min)
        };
        let [earliest, second] = [None, first].map(others);
        (encounters.zip(all).enumerate())
            .map(|(index, (encounter, roles))| {
                let is_first = Some(index) == first;
                let excused_from = if is_first { second } else { earliest };
                Self::within(encounter, roles, excused_from, thresholds)
            })
            .collect()
    }

    fn within(
        encounter: &EncounterSamples,
        roles: Vec<RoleInterval>,
        excused_from: f64,
        thresholds: &Thresholds,
    ) -> Self {
        let monitors = monitors(encounter, &roles, excused_from, thresholds);
        let judged = scores(encounter, roles.first(), excused_from, thresholds);
        Self {
            roles,
            scores: judged.scores,
            violations: judged.violations,
            monitors,
            manoeuvre: judged.manoeuvre,
        }
    }

    /// Samples of one target. One that stays too far away for any role has its nearest sample
    /// alone.
    pub fn samples(
        track: &OwnSamples,
        target: &ShipTrack,
        memory: Option<&TargetMemory>,
        thresholds: &Thresholds,
    ) -> EncounterSamples {
        let near = track.risk_distance(target, thresholds);
        let factor = thresholds.time_factor(track.hull().length);
        let soon = factor * thresholds.risk.time.max(thresholds.monitor.manoeuvre);
        let far = near + soon * track.closing(target);
        track.encounter(target, memory, far)
    }

    /// The report with own ship's alterations around a ship at rest, toward which it has no role.
    pub fn with_ship_at_rest(
        mut self,
        encounter: &EncounterSamples,
        thresholds: &Thresholds,
    ) -> Self {
        let around = || around_ship_at_rest(encounter, thresholds);
        self.manoeuvre = self.manoeuvre.or_else(around);
        self
    }

    /// True without a rule violation and without a violated monitor.
    pub fn complies(&self) -> bool {
        self.broken().next().is_none()
    }

    /// Names of the violated rules and monitors; a rule may appear more than once.
    pub fn broken(&self) -> impl Iterator<Item = &'static str> {
        let violated = |f: &&MonitorResult| f.verdict == MonitorVerdict::Violated;
        let monitors = self
            .monitors
            .iter()
            .filter(violated)
            .map(|f| f.monitor.word());
        let rules = self.violations.iter().map(|b| b.rule.word());
        rules.chain(monitors)
    }
}

#[cfg(test)]
mod tests;
