//! Runs one scenario and isolates internal faults to it.

use std::any::Any;
use std::cell::RefCell;
use std::panic::{AssertUnwindSafe, Location, catch_unwind};
use std::sync::mpsc;
use std::time::{Duration, Instant};

use searoom::pipeline::{self, Run};
use searoom::scenario::ScenarioError;
use searoom::scenario::import::Assumed;

use super::args::Shared;
use super::input::scenes::{Made, Scene};

thread_local! {
    static PLACE: RefCell<Option<String>> = const { RefCell::new(None) };
}

/// Result of one file.
#[expect(
    clippy::large_enum_variant,
    reason = "one per file, and nearly always the large one"
)]
pub enum Attempt {
    /// Run, with or without a plan, and notes on assumptions and unused parts of its file.
    Run(Run, Vec<String>),
    /// The file contains no scenario.
    Unreadable(ScenarioError),
    /// Title of a valid scenario that is not supported as requested, with the reason.
    NotApplicable(String, ScenarioError),
    /// Internal fault with its location.
    Fault(String),
}

/// Suppresses panic messages on standard error; [`guarded`] returns them instead.
pub fn keep_panics_quiet() {
    std::panic::set_hook(Box::new(|info| {
        let place = |at: &Location| format!("{}:{}", below_src(at.file()), at.line());
        PLACE.set(info.location().map(place));
    }));
}

/// Runs `work` and converts a panic to a message.
pub fn guarded<T>(work: impl FnOnce() -> T) -> Result<T, String> {
    catch_unwind(AssertUnwindSafe(work)).map_err(|payload| {
        let place = PLACE
            .take()
            .unwrap_or_else(|| "an unknown place".to_owned());
        format!("internal fault at {place}: {}", message(payload.as_ref()))
    })
}

/// Runs [`guarded`] on a separate thread; `None` if it exceeds `time`. The thread continues until
/// the program ends.
pub fn guarded_within<T: Send + 'static>(
    time: Duration,
    work: impl FnOnce() -> T + Send + 'static,
) -> Option<Result<T, String>> {
    let begun = Instant::now();
    let (done, result) = mpsc::channel();
    // the receiver no longer exists after the time limit
    std::thread::spawn(move || drop(done.send(guarded(work))));
    let found = result.recv_timeout(time).ok();
    found.filter(|_| begun.elapsed() <= time)
}

/// Path of a source file without the folders of the build machine.
fn below_src(file: &str) -> String {
    let parts: Vec<&str> = file.split(['/', '\\']).collect();
    let (name, folders) = parts.split_last().unwrap_or((&file, &[]));
    let src = folders.iter().rposition(|folder| *folder == "src");
    let below = src.map_or(&[][..], |src| &folders[src + 1..]);
    [below, &[*name]].concat().join("/")
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

/// Reads, plans and evaluates one scene.
pub fn attempt(scene: &Scene, shared: &Shared, assumed: &Assumed) -> Attempt {
    let file = &scene.found.file;
    let work = || match scene.scenario(assumed) {
        Ok(Made {
            mut scenario,
            notes,
        }) => match shared.apply(&mut scenario) {
            Ok(()) => Attempt::Run(pipeline::run(scenario), notes),
            Err(faults) => {
                let file = file.clone();
                Attempt::NotApplicable(scenario.title, ScenarioError::Faults { file, faults })
            }
        },
        Err(error) => Attempt::Unreadable(error),
    };
    match guarded(work) {
        Ok(attempt) => attempt,
        Err(fault) => Attempt::Fault(format!("{}: {fault}", file.display())),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_place_is_without_the_machine_that_it_was_built_on() {
        for (file, place) in [
            ("src/pipeline/mod.rs", "pipeline/mod.rs"),
            ("/a/registry/src/index/arrow-1.2/src/reader.rs", "reader.rs"),
            ("/rustc/0a1b/core/src/slice/index.rs", "slice/index.rs"),
            (r"C:\a\src\cli\mod.rs", "cli/mod.rs"),
            ("/a/target/build/out/made.rs", "made.rs"),
            ("", ""),
        ] {
            assert_eq!(below_src(file), place);
        }
    }
}
