//! How a run ended, and the facts of its plan.

use super::Run;
use crate::evaluation::{Safety, facts, outcome_word};
use crate::planner::Outcome;

/// How a run ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Verdict {
    /// A plan that gives up nothing.
    Solved,
    /// A plan that gives something up.
    Relaxed,
    /// No plan.
    Infeasible,
    /// The budget ran out, with a plan or without.
    Deadline,
}

impl Verdict {
    /// How this run ended.
    pub fn of(run: &Run) -> Self {
        match run.planned.outcome {
            Outcome::Infeasible(_) => Self::Infeasible,
            Outcome::Deadline(_) => Self::Deadline,
            Outcome::Solved(_) if run.relaxations.is_empty() => Self::Solved,
            Outcome::Solved(_) => Self::Relaxed,
        }
    }

    /// The word of the documents.
    pub fn word(self) -> &'static str {
        match self {
            Self::Solved => "solved",
            Self::Relaxed => "relaxed",
            Self::Infeasible => "infeasible",
            Self::Deadline => "deadline",
        }
    }
}

impl Run {
    /// What the plan enters from start to arrival; `None` without one. A plan that is not verified is unsafe.
    pub fn safety(&self) -> Option<Safety> {
        let evaluation = self.evaluation.as_ref()?;
        Some(if evaluation.verified() {
            evaluation.safety
        } else {
            evaluation.safety.max(Safety::Unsafe)
        })
    }

    /// True of a plan that enters no hard set, hull or land from start to arrival; false without one.
    pub fn safe(&self) -> bool {
        self.safety() == Some(Safety::Safe)
    }

    /// The word that people see for how it ended.
    pub fn word(&self) -> String {
        let ended = Verdict::of(self).word();
        outcome_word(ended, self.safety(), self.greatest_risk())
    }

    /// The title, how it ended, and of a plan whether it is verified and whether it is safe.
    pub fn headline(&self) -> String {
        let word = self.word();
        let facts = self.evaluation.as_ref().map_or_else(String::new, |found| {
            format!(" ({})", facts(found.verified(), self.safe()))
        });
        format!("{}: {word}{facts}", self.scenario.title)
    }

    /// The largest risk along the plan, of any target; 0 without.
    pub fn greatest_risk(&self) -> f64 {
        let risks = self.risks.iter().map(|peak| peak.risk);
        risks.max_by(f64::total_cmp).unwrap_or(0.0)
    }
}
