//! Comparison of every applicable planner and two baselines on one scenario.
//!
//! ```text
//! Scenario + accepted risks ─► candidates ─► Entry, Entry, … (same targets, same figures)
//! ```

mod applies;
mod baseline;
mod document;
mod method;
mod stroke;

pub use applies::{Inapplicable, Methods, methods};
pub use baseline::{ComparedMotion, constant_velocity, hold_course};
pub use method::Method;
use method::named;
pub use stroke::Stroke;

use crate::colregs::compliance::{ComplianceReport, EncounterSamples};
use crate::document::LowerBoundDocument;
use crate::evaluation::Safety;
use crate::frame::Vector;
use crate::pipeline::{self, Run};
use crate::planner::PlanMethod;
use crate::scenario::Scenario;
use crate::study::bound::lower_bound;
use crate::trajectory::Trajectory;

/// Method at one accepted risk, before it is run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Candidate {
    /// Planner or baseline.
    pub method: Method,
    /// Accepted risk of paper eq. (25), in `[0, 1)`.
    pub max_risk: f64,
}

/// Result of one candidate.
#[derive(Debug, Clone)]
pub struct Entry {
    /// Method and accepted risk.
    pub candidate: Candidate,
    /// Run of a planner, with or without a plan; `None` for a baseline.
    pub run: Option<Box<Run>>,
    /// Motion; `None` without one.
    pub motion: Option<ComparedMotion>,
    /// See [`Entry::with_bound`].
    pub lower_bound: Option<LowerBoundDocument>,
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

/// Leaves out plans that do not depend on the search that was asked for: that of the first search
/// stands for the same plan of the others.
pub fn without_repeats(entries: Vec<Entry>) -> Vec<Entry> {
    let mut kept: Vec<Entry> = Vec::with_capacity(entries.len());
    for entry in entries {
        let repeats = |other: &Entry| {
            other.candidate.max_risk == entry.candidate.max_risk
                && other.name() == entry.name()
                && other.trajectory() == entry.trajectory()
        };
        if !kept.iter().any(repeats) {
            kept.push(entry);
        }
    }
    kept
}

impl Candidate {
    /// Plans and evaluates the candidate, as a run of its own would. Results are deterministic except for the planning time. Candidates may run in parallel.
    pub fn run(self, scenario: &Scenario) -> Entry {
        let asked = self.scenario(scenario);
        let (run, motion) = match self.method {
            Method::Planner { .. } => {
                let run = pipeline::run(asked);
                let motion = ComparedMotion::of(&run);
                (Some(Box::new(run)), motion)
            }
            Method::HoldCourse => (None, Some(hold_course(&asked))),
            Method::ConstantVelocity => (None, constant_velocity(&asked)),
        };
        Entry {
            candidate: self,
            run,
            motion,
            lower_bound: None,
        }
    }

    fn scenario(self, scenario: &Scenario) -> Scenario {
        let asked = self.method.asked(scenario);
        Scenario {
            max_risk: self.max_risk,
            ..asked
        }
    }
}

impl Entry {
    /// With a [`lower_bound`] of J around the sets of this method, for a plan that has one. Takes
    /// some seconds.
    pub fn with_bound(mut self) -> Self {
        self.lower_bound = self.run.as_deref().and_then(lower_bound);
        self
    }

    /// Name of the row: the planner, the search if one ran, and what made the plan where that was no
    /// search of this planner; or the baseline.
    pub fn name(&self) -> String {
        match (self.candidate.method, self.run.as_deref()) {
            (
                Method::Planner {
                    planner,
                    search,
                    representation,
                },
                Some(run),
            ) => {
                let made = run.planned.method();
                let is_asked = made.is_none_or(|m| m.is_by_search() || m == PlanMethod::LeastHarm);
                let ran = run.planned.stats.is_some() && is_asked;
                named(planner, ran.then_some(search), made, representation)
            }
            (method, _) => method.to_string(),
        }
    }

    /// Trajectory; `None` without a motion.
    pub fn trajectory(&self) -> Option<&Trajectory> {
        self.motion.as_ref().map(|motion| &motion.trajectory)
    }

    /// Reports whether the motion enters sets, hulls or land; `None` without a motion.
    pub fn safety(&self) -> Option<Safety> {
        self.motion.as_ref().map(|motion| motion.safety)
    }

    /// Largest risk along the motion over all targets; 0 without a motion.
    pub fn largest_risk(&self) -> f64 {
        let risks = self.motion.iter().flat_map(|motion| &motion.risks);
        risks.map(|peak| peak.risk).fold(0.0, f64::max)
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
        let own = &scenario.own_ship;
        let samples = ships.map(|ship| EncounterSamples::along(trajectory, own, ship));
        let samples: Vec<_> = samples.collect();
        ComplianceReport::of_all(samples.iter(), thresholds)
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
    let all = candidates(&found.methods, risks).into_iter();
    without_repeats(all.map(|candidate| candidate.run(scenario)).collect())
}

#[cfg(test)]
mod tests;
