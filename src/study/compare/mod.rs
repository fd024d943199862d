//! Every way to sail a scenario side by side: each planner that applies, and two baselines that users know.
//!
//! ```text
//! Scenario + accepted risks ─► contenders ─► Entry, Entry, … (same targets, same figures)
//! ```

mod applies;
mod baseline;
mod look;
mod method;

pub use applies::{Inapplicable, Methods, methods};
pub use baseline::{Baseline, constant_velocity, hold_course};
pub(crate) use look::Look;
pub use method::Method;

use crate::colregs::compliance::{ComplianceReport, EncounterSamples};
use crate::evaluation::{Evaluation, Safety, counted_error};
use crate::frame::Vector;
use crate::obstacle::{Obstacle, PeakRisk};
use crate::pipeline::{self, Run};
use crate::planner::PlannerKind;
use crate::scenario::Scenario;
use crate::trajectory::Trajectory;

/// One method at one accepted risk, before it is run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Contender {
    /// Who.
    pub method: Method,
    /// The risk of eq. (25) that is accepted, in `[0, 1)`.
    pub max_risk: f64,
}

/// What one contender came to.
#[derive(Debug, Clone)]
pub struct Entry {
    /// Who, and at which risk.
    pub contender: Contender,
    /// What came of it.
    pub result: Sailed,
}

/// What is sailed.
#[derive(Debug, Clone)]
pub enum Sailed {
    /// By a planner, or nothing.
    Planned(Box<Run>),
    /// By a baseline.
    Baseline(Box<Baseline>),
    /// By a baseline that found nothing, in words.
    Nothing(&'static str),
}

/// Every contender of a scenario, in the order of their rows: by method, then by risk. Holding course asks for no
/// risk, so it is there once.
pub fn contenders(methods: &[Method], risks: &[f64]) -> Vec<Contender> {
    methods
        .iter()
        .flat_map(|&method| {
            let risks = match method {
                Method::HoldCourse => &risks[..risks.len().min(1)],
                Method::Planner { .. } | Method::ConstantVelocity => risks,
            };
            risks
                .iter()
                .map(move |&max_risk| Contender { method, max_risk })
        })
        .collect()
}

/// Counts the space-time error as that of all methods: until own ship's length from the last waypoint, or where the motion does not
/// come so near, as [`Counted`](crate::evaluation::Counted) says.
fn count_alike(evaluation: &mut Evaluation, scenario: &Scenario, trajectory: &Trajectory) {
    let (desired, q) = (&scenario.desired, scenario.time_weight);
    let within = scenario.own_ship.hull.length;
    (evaluation.space_time_error, evaluation.counted) =
        counted_error(trajectory, desired, q, within);
}

impl Contender {
    /// Plans and judges. The space-time error is counted alike for all methods, not to the end of each motion. The same scenario gives the same entry, but for the time that planning took; contenders may run at
    /// the same time.
    pub fn run(self, scenario: &Scenario) -> Entry {
        let result = match self.method {
            Method::Planner { .. } => {
                let mut run = pipeline::run(self.scenario(scenario));
                if let (Some(plan), Some(found)) = (run.planned.outcome.plan(), &mut run.evaluation)
                {
                    count_alike(found, scenario, &plan.trajectory);
                }
                Sailed::Planned(Box::new(run))
            }
            Method::HoldCourse => Sailed::Baseline(Box::new(hold_course(&self.scenario(scenario)))),
            Method::ConstantVelocity => match constant_velocity(&self.scenario(scenario)) {
                Some(found) => Sailed::Baseline(Box::new(found)),
                None => Sailed::Nothing("no constant velocity is out of every velocity obstacle"),
            },
        };
        Entry {
            contender: self,
            result,
        }
    }

    /// The scenario as this contender sees it.
    fn scenario(self, scenario: &Scenario) -> Scenario {
        let asked = self.method.asked(scenario);
        Scenario {
            max_risk: self.max_risk,
            ..asked
        }
    }
}

impl Entry {
    /// The motion; `None` without one.
    pub fn trajectory(&self) -> Option<&Trajectory> {
        match &self.result {
            Sailed::Planned(run) => run.planned.outcome.plan().map(|plan| &plan.trajectory),
            Sailed::Baseline(baseline) => Some(&baseline.trajectory),
            Sailed::Nothing(_) => None,
        }
    }

    /// The judgement; `None` without a motion.
    pub fn evaluation(&self) -> Option<&Evaluation> {
        match &self.result {
            Sailed::Planned(run) => run.evaluation.as_ref(),
            Sailed::Baseline(baseline) => Some(&baseline.evaluation),
            Sailed::Nothing(_) => None,
        }
    }

    /// What the motion enters from start to arrival; `None` without one.
    pub fn safety(&self) -> Option<Safety> {
        match &self.result {
            Sailed::Planned(run) => run.safety(),
            Sailed::Baseline(baseline) => Some(baseline.evaluation.safety),
            Sailed::Nothing(_) => None,
        }
    }

    /// The sets that were kept out of; empty where nothing was found.
    pub fn obstacles(&self) -> &[Obstacle] {
        match &self.result {
            Sailed::Planned(run) => &run.obstacles,
            Sailed::Baseline(baseline) => &baseline.obstacles,
            Sailed::Nothing(_) => &[],
        }
    }

    /// The largest risk along the motion, per target; empty without a motion.
    pub fn risks(&self) -> &[PeakRisk] {
        match &self.result {
            Sailed::Planned(run) => &run.risks,
            Sailed::Baseline(baseline) => &baseline.risks,
            Sailed::Nothing(_) => &[],
        }
    }

    /// What two judges say of own ship toward each target that is a ship, by the thresholds that the scenario asks for; empty
    /// without a motion. They see the motion and the target's nominal track alone. O(targets x seconds).
    pub fn conduct(&self, scenario: &Scenario) -> Vec<ComplianceReport> {
        let Some(trajectory) = self.trajectory() else {
            return Vec::new();
        };
        let thresholds = scenario.judged_by();
        let ships = scenario.targets.iter().filter_map(|target| target.ship());
        let meetings =
            ships.map(|ship| EncounterSamples::along(trajectory, scenario.own_ship.hull, ship));
        meetings
            .map(|meeting| ComplianceReport::judge(&meeting, thresholds))
            .collect()
    }

    /// True when the motion ends at the last waypoint.
    pub fn arrived(&self) -> bool {
        match &self.result {
            Sailed::Planned(run) => {
                let plan = run.planned.outcome.plan();
                plan.is_some_and(|plan| plan.to_go == 0.0)
                    && run.scenario.planner != PlannerKind::OptimalControl
            }
            Sailed::Baseline(baseline) => baseline.arrived,
            Sailed::Nothing(_) => false,
        }
    }

    /// Where the motion is at a time, metres; where it ends after its end.
    pub fn position_at(&self, time: f64) -> Option<Vector> {
        let trajectory = self.trajectory()?;
        let within = time.clamp(trajectory.start_time(), trajectory.end_time());
        Some(trajectory.pose_at(within).position)
    }
}

/// Every contender one after another; a program may run them at the same time, the entries are the same.
pub fn compare(scenario: &Scenario, risks: &[f64]) -> Vec<Entry> {
    let found = methods(scenario);
    contenders(&found.methods, risks)
        .into_iter()
        .map(|contender| contender.run(scenario))
        .collect()
}

#[cfg(test)]
mod tests;
