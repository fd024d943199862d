//! How a run ended, and which requirements its plan gave up.

use super::Run;
use super::sets::TargetSets;
use crate::colregs::Role;
use crate::evaluation::{PlanOutcome, Safety, outcome_word, without_rules};
use crate::obstacle::{PeakRisk, SpaceTimeObstacle};
use crate::planner::Outcome;

/// A requirement that a plan gave up.
#[derive(Debug, Clone, PartialEq)]
pub enum Relaxation {
    /// A ship domain was reduced toward its hard set.
    Domain {
        /// Name of the target.
        target: String,
        /// Largest reduction, metres.
        amount: f64,
    },
    /// The plan enters the set of a target.
    Risk {
        /// Name of the target.
        target: String,
        /// The largest risk along the plan, paper eq. (25), in `(0, 1]`.
        amount: f64,
        /// Seconds. Nothing is claimed of this target's set before; from then on the plan is clear
        /// of the whole set. `None` where the plan is always clear of the level set of the accepted
        /// risk.
        until: Option<f64>,
    },
    /// The plan does not arrive.
    Arrival {
        /// Name of the target whose set blocks the way.
        target: String,
        /// Remaining distance to the last waypoint at its end, metres.
        amount: f64,
    },
    /// The plan breaks the rules.
    Compliance {
        /// Name of a target toward which own ship has a duty.
        target: String,
        /// Own ship's role toward it.
        role: Role,
    },
}

/// Relaxations that concern sets, most important first: risks in decreasing order, then arrival,
/// then domains in decreasing order of their reduction.
pub(super) fn relaxations(
    sets: &[TargetSets],
    reductions: &[f64],
    risks: &[PeakRisk],
    released: &[Option<f64>],
    late: Option<Relaxation>,
) -> Vec<Relaxation> {
    let mut risked: Vec<(&TargetSets, f64, Option<f64>)> = (sets.iter())
        .zip(risks)
        .zip(released)
        .map(|((set, peak), until)| (set, peak.risk, *until))
        .filter(|(_, risk, until)| *risk > 0.0 || until.is_some())
        .collect();
    risked.sort_by(|a, b| b.1.total_cmp(&a.1));
    let mut reduced: Vec<(&TargetSets, f64)> = (sets.iter().zip(reductions.iter().copied()))
        .filter(|(_, reduction)| *reduction > 0.0)
        .collect();
    reduced.sort_by(|a, b| b.1.total_cmp(&a.1));
    let name = |set: &TargetSets| set.hard.name().to_owned();
    let risks = risked
        .into_iter()
        .map(|(set, amount, until)| Relaxation::Risk {
            target: name(set),
            amount,
            until,
        });
    let domains = reduced.into_iter().map(|(set, amount)| Relaxation::Domain {
        target: name(set),
        amount,
    });
    risks.chain(late).chain(domains).collect()
}

impl Run {
    /// How it ended.
    pub fn outcome(&self) -> PlanOutcome {
        match self.planned.outcome {
            Outcome::Infeasible(_) => PlanOutcome::Infeasible,
            Outcome::Deadline(_) => PlanOutcome::Deadline,
            Outcome::Solved(_) if self.relaxations.is_empty() => PlanOutcome::Solved,
            Outcome::Solved(_) => PlanOutcome::Relaxed,
        }
    }

    /// Safety of the plan from start to arrival; `None` without a plan. An unverified plan is
    /// unsafe.
    pub fn safety(&self) -> Option<Safety> {
        let evaluation = self.evaluation.as_ref()?;
        Some(if evaluation.verified() {
            evaluation.safety
        } else {
            evaluation.safety.max(Safety::Unsafe)
        })
    }

    /// True for a plan that enters no hard set, hull or land from start to arrival.
    pub fn safe(&self) -> bool {
        self.safety() == Some(Safety::Safe)
    }

    /// The outcome in words, for reports.
    pub fn word(&self) -> String {
        let word = outcome_word(self.outcome(), self.safety(), self.greatest_risk());
        without_rules(word, self.gives_up_rules())
    }

    /// The largest risk along the plan toward any target; 0 without one.
    pub fn greatest_risk(&self) -> f64 {
        let risks = self.risks().into_iter().map(|peak| peak.risk);
        risks.max_by(f64::total_cmp).unwrap_or(0.0)
    }
}
