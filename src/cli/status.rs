//! The exit status of the contract, section 2.

use std::process::ExitCode;

use searoom::pipeline::{Relaxation, Run};

/// The highest of a run wins.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Status {
    /// All planned and verified.
    Good,
    /// At least one scenario without a collision-free plan to the end: none, one that enters a set, or one that does not arrive.
    NoPlan,
    /// Bad input or usage, or a result that cannot be written.
    BadInput,
    /// A fault of the program, a plan that fails its own verification included.
    InternalFault,
}

impl Status {
    /// What one run amounts to.
    pub fn of(run: &Run) -> Self {
        match (run.planned.outcome.plan(), &run.evaluation) {
            (None, _) => Self::NoPlan,
            (Some(_), Some(evaluation)) if evaluation.verified() => {
let no_way = |r: &Relaxation| {
                    matches!(r, Relaxation::Risk { .. } | Relaxation::Arrival { .. })
                };
                if run.safe() && !run.relaxations.iter().any(no_way) {
                    Self::Good
                } else {
                    Self::NoPlan
                }
            }
            (Some(_), _) => Self::InternalFault,
        }
    }
}

impl From<Status> for ExitCode {
    fn from(status: Status) -> Self {
        Self::from(match status {
            Status::Good => 0,
            Status::NoPlan => 1,
            Status::BadInput => 2,
            Status::InternalFault => 3,
        })
    }
}
