//! Exit status.

use std::process::ExitCode;

use searoom::pipeline::{Relaxation, Run};

/// Exit status; the highest of a run is reported.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, PartialOrd, Ord)]
pub enum ExitStatus {
    /// All plans are found and verified.
    #[default]
    Good,
    /// A scenario has no plan that is clear of all sets and arrives.
    NoPlan,
    /// Bad input or usage, or a result that cannot be written.
    BadInput,
    /// Internal fault, including a plan that fails its own verification.
    InternalFault,
    /// Ended by Ctrl-C; what was found until then is written.
    Interrupted,
}

impl ExitStatus {
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

    pub fn code(self) -> u8 {
        match self {
            Self::Good => 0,
            Self::NoPlan => 1,
            Self::BadInput => 2,
            Self::InternalFault => 3,
            // of a process that ends by SIGINT, for shells
            Self::Interrupted => 130,
        }
    }
}

impl From<ExitStatus> for ExitCode {
    fn from(status: ExitStatus) -> Self {
        Self::from(status.code())
    }
}

#[cfg(test)]
mod tests {
    use searoom::evaluation::Violation;
    use searoom::pipeline;
    use searoom::planner::{NoPlan, Outcome};
    use searoom::scenario::Scenario;

    use super::*;

    /// Modifies a valid plan, because no planner is known to produce such a plan.
    #[test]
    fn a_plan_that_fails_its_own_verification_ends_with_status_3() {
        let file = "scenarios/colregs/head-on.toml";
        let sound = pipeline::run(Scenario::read(file.as_ref()).expect("no faults"));
        assert_eq!(ExitStatus::of(&sound).code(), 0);
        let mut spoilt = sound.clone();
        let violation = Violation::new("a gap".to_owned(), 0.0);
        let judged = spoilt.evaluation.as_mut().expect("judged");
        judged.violations.push(violation);
        assert_eq!(ExitStatus::of(&spoilt).code(), 3);
        let mut unjudged = sound.clone();
        unjudged.evaluation = None;
        assert_eq!(ExitStatus::of(&unjudged).code(), 3);
        let mut none = sound;
        none.planned.outcome = Outcome::Infeasible(NoPlan::NoRoute);
        assert_eq!(ExitStatus::of(&none).code(), 1);
        assert_eq!(ExitStatus::BadInput.code(), 2);
        // the highest of several runs is reported
        let all = [
            ExitStatus::InternalFault,
            ExitStatus::Good,
            ExitStatus::BadInput,
        ];
        assert_eq!(all.into_iter().max(), Some(ExitStatus::InternalFault));
    }
}
