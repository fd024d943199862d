//! The time of no return, in words.

use crate::pipeline::{NO_RETURN_STEP_S, NoReturn, Run};
use crate::planner::PlannerKind;

/// What a plan's text says of the time of no return.
pub fn no_return_line(found: NoReturn) -> String {
    let said = match found {
        NoReturn::Never => "none: nothing is met on the desired trajectory".to_owned(),
        NoReturn::Past => {
            "past: no plan clear of every hard set was found even from the start".to_owned()
        }
        NoReturn::At(time) => format!(
            "{time:.0} s, to {NO_RETURN_STEP_S} s: the last time that can be held on until, and still a plan is clear of \
             every hard set"
        ),
    };
    format!("  {:<13}{said}", "no return")
}

/// Why [`Run::no_return`] gives nothing.
pub fn no_return_reason(run: &Run) -> String {
    match run.scenario.planner {
        PlannerKind::SpaceTime => {
            "no time of no return: the desired trajectory cannot be followed".to_owned()
        }
        other => format!(
            "no time of no return: it is sought for plans of the space-time planner, this one is of the {} planner",
            other.word()
        ),
    }
}
