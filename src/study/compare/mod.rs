//! Comparison of every applicable planner and two baselines on one scenario.
//!
//! ```text
//! Scenario + accepted risks ─► candidates ─► Entry, Entry, … (same targets, same figures)
//! ```

mod applies;
mod baseline;
mod line_style;
mod method;

pub use applies::{Inapplicable, Methods, methods};
pub use baseline::{Baseline, constant_velocity, hold_course};
pub(crate) use line_style::LineStyle;
pub use method::Method;

use crate::colregs::compliance::{ComplianceReport, EncounterSamples};
use crate::evaluation::{Evaluation, Safety, counted_error};
use crate::frame::Vector;
use crate::obstacle::{Obstacle, PeakRisk};
use crate::pipeline::{self, Run};
use crate::scenario::Scenario;
use crate::trajectory::Trajectory;

/// Method at one accepted risk, before it is run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Candidate {
    /// Planner or baseline.
    pub method: Method,
    /// Accepted risk of eq. (25), in `[0, 1)`.
    pub max_risk: f64,
}

/// Result of one candidate.
#[derive(Debug, Clone)]
pub struct Entry {
    /// Method and accepted risk.
    pub candidate: Candidate,
    /// Result.
    pub result: EntryResult,
}

/// Motion of a candidate, if it has one.
#[derive(Debug, Clone)]
pub enum EntryResult {
    /// Run of a planner, with or without a plan.
    Planned(Box<Run>),
    /// Baseline with a motion.
    Baseline(Box<Baseline>),
    /// Baseline without a motion; the reason.
    Nothing(&'static str),
}

/// Lists every candidate of a scenario, by method, then by risk. Holding course accepts no risk, so
/// it appears once.
pub fn candidates(methods: &[Method], risks: &[f64]) -> Vec<Candidate> {
    methods
        .iter()
        .flat_map(|&method| {
            let risks = match method {
                Method::HoldCourse => &risks[..risks.len().min(1)],
                Method::Planner { .. } | Method::ConstantVelocity => risks,
            };
            risks
                .iter()
                .map(move |&max_risk| Candidate { method, max_risk })
        })
        .collect()
}

/// Counts the space-time error of all methods alike, until the distance to the last waypoint is own
/// ship's length. For motions that stay farther away see [`Counted`](crate::evaluation::Counted).
fn count_alike(evaluation: &mut Evaluation, scenario: &Scenario, trajectory: &Trajectory) {
    let (desired, q) = (&scenario.desired, scenario.time_weight);
    let within = scenario.own_ship.hull.length;
    (evaluation.space_time_error, evaluation.counted) =
        counted_error(trajectory, desired, q, within);
}

impl Candidate {
    /// Plans and evaluates the candidate. The space-time error of all methods is counted alike.
    /// Results are deterministic except for the planning time. Candidates may run in parallel.
    pub fn run(self, scenario: &Scenario) -> Entry {
        let result = match self.method {
            Method::Planner { .. } => {
                let mut run = pipeline::run(self.scenario(scenario));
                if let (Some(plan), Some(found)) = (run.planned.outcome.plan(), &mut run.evaluation)
                {
                    count_alike(found, scenario, &plan.trajectory);
                }
                EntryResult::Planned(Box::new(run))
            }
            Method::HoldCourse => {
                EntryResult::Baseline(Box::new(hold_course(&self.scenario(scenario))))
            }
            Method::ConstantVelocity => match constant_velocity(&self.scenario(scenario)) {
                Some(found) => EntryResult::Baseline(Box::new(found)),
                None => {
                    EntryResult::Nothing("no constant velocity is out of every velocity obstacle")
                }
            },
        };
        Entry {
            candidate: self,
            result,
        }
    }

    /// Returns the scenario with the settings of this candidate.
    fn scenario(self, scenario: &Scenario) -> Scenario {
        let asked = self.method.asked(scenario);
        Scenario {
            max_risk: self.max_risk,
            ..asked
        }
    }
}

impl Entry {
    /// Motion; `None` without one.
    pub fn trajectory(&self) -> Option<&Trajectory> {
        match &self.result {
            EntryResult::Planned(run) => run.planned.outcome.plan().map(|plan| &plan.trajectory),
            EntryResult::Baseline(baseline) => Some(&baseline.trajectory),
            EntryResult::Nothing(_) => None,
        }
    }

    /// Evaluation; `None` without a motion.
    pub fn evaluation(&self) -> Option<&Evaluation> {
        match &self.result {
            EntryResult::Planned(run) => run.evaluation.as_ref(),
            EntryResult::Baseline(baseline) => Some(&baseline.evaluation),
            EntryResult::Nothing(_) => None,
        }
    }

    /// Reports whether the motion enters sets, hulls or land; `None` without a motion.
    pub fn safety(&self) -> Option<Safety> {
        match &self.result {
            EntryResult::Planned(run) => run.safety(),
            EntryResult::Baseline(baseline) => Some(baseline.evaluation.safety),
            EntryResult::Nothing(_) => None,
        }
    }

    /// Obstacles; empty without a motion.
    pub fn obstacles(&self) -> &[Obstacle] {
        match &self.result {
            EntryResult::Planned(run) => &run.obstacles,
            EntryResult::Baseline(baseline) => &baseline.obstacles,
            EntryResult::Nothing(_) => &[],
        }
    }

    /// Largest risk along the motion per target; empty without a motion.
    pub fn risks(&self) -> &[PeakRisk] {
        match &self.result {
            EntryResult::Planned(run) => &run.risks,
            EntryResult::Baseline(baseline) => &baseline.risks,
            EntryResult::Nothing(_) => &[],
        }
    }

    /// Rule violations and compliance monitors toward each target that is a ship; empty without a
    /// motion. Uses the thresholds of the scenario and the nominal motion of the targets. O(targets
    /// × seconds).
    pub fn conduct(&self, scenario: &Scenario) -> Vec<ComplianceReport> {
        let Some(trajectory) = self.trajectory() else {
            return Vec::new();
        };
        let thresholds = scenario.judged_by();
        let ships = scenario.targets.iter().filter_map(|target| target.ship());
        let samples =
            ships.map(|ship| EncounterSamples::along(trajectory, scenario.own_ship.hull, ship));
        samples
            .map(|samples| ComplianceReport::judge(&samples, thresholds))
            .collect()
    }

    /// True when the motion ends at the last waypoint.
    pub fn arrived(&self) -> bool {
        match &self.result {
            EntryResult::Planned(run) => run.arrives(),
            EntryResult::Baseline(baseline) => baseline.arrived,
            EntryResult::Nothing(_) => false,
        }
    }

    /// Position at a time in metres; after the end, the last position.
    pub fn position_at(&self, time: f64) -> Option<Vector> {
        let trajectory = self.trajectory()?;
        let within = time.clamp(trajectory.start_time(), trajectory.end_time());
        Some(trajectory.pose_at(within).position)
    }
}

/// Runs every candidate sequentially.
pub fn compare(scenario: &Scenario, risks: &[f64]) -> Vec<Entry> {
    let found = methods(scenario);
    candidates(&found.methods, risks)
        .into_iter()
        .map(|candidate| candidate.run(scenario))
        .collect()
}

#[cfg(test)]
mod tests;
