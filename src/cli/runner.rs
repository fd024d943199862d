//! Runs one scenario so that a fault of the program costs that scenario alone.

use std::any::Any;
use std::cell::RefCell;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;

use searoom::pipeline::{self, Run};
use searoom::scenario::{Scenario, ScenarioError};

use super::args::Shared;

thread_local! {
    static PLACE: RefCell<Option<String>> = const { RefCell::new(None) };
}

/// What became of one file.
#[expect(
    clippy::large_enum_variant,
    reason = "one per file, and nearly always the large one"
)]
pub enum Attempt {
    /// A run, with or without a plan.
    Run(Run),
    /// No scenario in it.
    Unreadable(ScenarioError),
    /// The program failed; says where.
    Fault(String),
}

/// From here on a panic is a value of [`guarded`], not a text on standard error.
pub fn keep_panics_quiet() {
    std::panic::set_hook(Box::new(|info| {
        PLACE.set(info.location().map(ToString::to_string));
    }));
}

/// Runs `work`; a panic in it becomes a sentence.
pub fn guarded<T>(work: impl FnOnce() -> T) -> Result<T, String> {
    catch_unwind(AssertUnwindSafe(work)).map_err(|payload| {
        let place = PLACE
            .take()
            .unwrap_or_else(|| "an unknown place".to_owned());
        format!("internal fault at {place}: {}", message(payload.as_ref()))
    })
}

fn message(payload: &(dyn Any + Send)) -> &str {
    if let Some(text) = payload.downcast_ref::<&str>() {
        text
    } else if let Some(text) = payload.downcast_ref::<String>() {
        text
    } else {
        "no message"
    }
}

/// Reads, plans and judges one file.
pub fn attempt(file: &Path, shared: &Shared) -> Attempt {
    let work = || match Scenario::read(file) {
        Ok(mut scenario) => match shared.apply(&mut scenario) {
            Ok(()) => Attempt::Run(pipeline::run(scenario)),
            Err(faults) => Attempt::Unreadable(ScenarioError::Faults {
                file: file.to_owned(),
                faults,
            }),
        },
        Err(error) => Attempt::Unreadable(error),
    };
    match guarded(work) {
        Ok(attempt) => attempt,
        Err(fault) => Attempt::Fault(format!("{}: {fault}", file.display())),
    }
}
