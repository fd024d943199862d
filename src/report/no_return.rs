//! The time of no return, in words.

use crate::pipeline::{NO_RETURN_STEP_S, NoReturn};

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
