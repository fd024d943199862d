//! Runs one scenario and isolates internal faults to it.

use std::any::Any;
use std::cell::RefCell;
use std::panic::{AssertUnwindSafe, Location, catch_unwind};
use std::path::{Path, PathBuf};
use std::sync::mpsc;
use std::time::{Duration, Instant};

use searoom::document::{PLAN_MEBIBYTES, PlanDocument, SuiteOutcome};
use searoom::pipeline::{self, Run};
use searoom::replanning::{PreviousPlan, remember};
use searoom::scenario::import::Imported;
use searoom::scenario::{Fault, Scenario, ScenarioError};
use searoom::verification::{is_simulation, verified_plan};

use super::args::Shared;
use super::found::Refused;
use super::input::files;
use super::input::scenes::Scene;

thread_local! {
    static PLACE: RefCell<Option<String>> = const { RefCell::new(None) };
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

/// Runs `work` on a file; a panic is an internal fault of that file.
pub fn guarded_on<T>(file: &Path, work: impl FnOnce() -> Result<T, Refused>) -> Result<T, Refused> {
    guarded(work).unwrap_or_else(|fault| Err(Refused::fault(file, &fault)))
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

/// The command that writes a document of several plans.
fn writer(text: &str) -> Option<&'static str> {
    if is_simulation(text) {
        return Some("simulate");
    }
    let document: serde_json::Value = serde_json::from_str(text).ok()?;
    let keys = [("comparisons", "compare"), ("runs", "suite")];
    let known = keys
        .into_iter()
        .find(|(key, _)| document.get(key).is_some());
    known.map(|(_, command)| command)
}

pub struct Previous {
    pub file: PathBuf,
    pub plan: PlanDocument,
    /// Plan without it where it does not fit.
    pub ignore: bool,
}

impl Previous {
    /// Reads a plan document, which has to be one that verifies. The error includes the file.
    pub fn read(file: &Path, ignore: bool) -> Result<Self, String> {
        let text = files::text(file, PLAN_MEBIBYTES, "a plan document");
        let text = text.map_err(|error| error.to_string())?;
        let file = files::name(file);
        if let Some(command) = writer(&text) {
            let file = file.display();
            return Err(format!(
                "{file}: found the document of `{command}`; allowed: that of a plan, as `plan --json` \
                 and `simulate --plans` write it"
            ));
        }
        let plan = verified_plan(&text);
        let plan = plan.map_err(|error| format!("{}: {error}", file.display()))?;
        Ok(Self { file, plan, ignore })
    }

    /// Adds what the plan leaves to a scenario; a note where it does not fit and is ignored.
    fn remember(&self, scenario: &mut Scenario) -> Result<Option<String>, Fault> {
        let previous = PreviousPlan::try_from(&self.plan);
        match previous.and_then(|previous| remember(&previous, scenario)) {
            Ok(()) => Ok(None),
            Err(fault) if self.ignore => {
                let name = self.file.display();
                Ok(Some(format!("{name}: ignored: {fault}")))
            }
            Err(fault) => Err(fault),
        }
    }
}

/// Reads, plans and evaluates one scene; with notes on assumptions and unused parts of its file.
pub fn attempt(
    scene: &Scene,
    shared: &Shared,
    previous: Option<&Previous>,
) -> Result<(Run, Vec<String>), Refused> {
    let file = &scene.found.file;
    guarded_on(file, || {
        let Imported {
            mut scenario,
            mut notes,
            ..
        } = scene.scenario()?;
        let unfit = |scenario: &Scenario, wrong: &Path, faults| Refused {
            title: Some(scenario.title.clone()),
            ..Refused::new(
                file,
                SuiteOutcome::NotApplicable,
                ScenarioError::faults(wrong, faults),
            )
        };
        if let Err(faults) = shared.apply(&mut scenario) {
            return Err(unfit(&scenario, file, scene.located(faults)));
        }
        if let Some(previous) = previous {
            match previous.remember(&mut scenario) {
                Ok(note) => notes.extend(note),
                Err(fault) => return Err(unfit(&scenario, &previous.file, vec![fault])),
            }
        }
        scenario.set_aside_out_of_reach();
        Ok((pipeline::run(scenario), notes))
    })
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
