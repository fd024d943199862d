//! `searoom suite --lint`: what is odd about scenarios, without planning.

use searoom::document::{LintDocument, LintScenarioDocument};
use searoom::report::lint_text;
use searoom::scenario::Scenario;
use searoom::scenario::import::Assumed;
use searoom::study::lint::{Likeness, Lint, likenesses, lint};

use super::args::SuiteArgs;
use super::output::Output;
use super::runner::guarded;
use super::scenes::{Scene, Unread};
use super::status::Status;

/// A scenario that was read, and what is said of it.
struct Looked {
    file: String,
    scenario: Scenario,
    lint: Lint,
    notes: Vec<String>,
}

/// Looks at every scene; good unless one cannot be read.
pub fn suite(
    scenes: Vec<Result<Scene, Unread>>,
    args: &SuiteArgs,
    assumed: &Assumed,
    output: &Output,
) -> Status {
    let mut status = Status::Good;
    let mut all: Vec<Result<Looked, Unread>> = Vec::new();
    for scene in scenes {
        let looked = match scene {
            Ok(scene) => guarded(|| look(&scene, assumed)).unwrap_or_else(|fault| {
                status = status.max(Status::InternalFault);
                Err(unread(&scene, fault))
            }),
            Err(unread) => Err(unread),
        };
        if let Err(failed) = &looked {
            status = status.max(Status::BadInput);
            output.error(&failed.error);
        }
        all.push(looked);
    }
    compare(&mut all);
    let documents = all.into_iter().map(|looked| match looked {
        Ok(looked) => LintScenarioDocument::of(
            looked.file,
            looked.scenario.title,
            &looked.lint,
            looked.notes,
        ),
        Err(failed) => {
            LintScenarioDocument::failed(failed.file.display().to_string(), failed.error)
        }
    });
    let document = LintDocument::of(documents.collect());
    let shown = if args.shared.written.json {
        output.document(&document)
    } else {
        output.result(&lint_text(&document, output.colour))
    };
    status.max(shown)
}

fn unread(scene: &Scene, error: String) -> Unread {
    Unread {
        file: scene.found.file.clone(),
        error,
    }
}

fn look(scene: &Scene, assumed: &Assumed) -> Result<Looked, Unread> {
    match scene.scenario(assumed) {
        Ok(made) => Ok(Looked {
            lint: lint(&made.scenario, &scene.declared()),
            file: scene.found.file.display().to_string(),
            scenario: made.scenario,
            notes: made.notes,
        }),
        Err(error) => Err(unread(scene, error.to_string())),
    }
}

/// Adds which are like which.
fn compare(all: &mut [Result<Looked, Unread>]) {
    let read: Vec<&Scenario> = all
        .iter()
        .flatten()
        .map(|looked| &looked.scenario)
        .collect();
    let names: Vec<String> = all
        .iter()
        .flatten()
        .map(|looked| format!("{} ({})", looked.scenario.title, looked.file))
        .collect();
    let like = likenesses(&read);
    for (looked, like) in all.iter_mut().flatten().zip(like) {
        let Some((before, how)) = like else { continue };
        let name = &names[before];
        looked.lint.findings.push(match how {
            Likeness::Same => format!("the same encounter as {name}"),
            Likeness::Mirrored => format!("the mirror image of {name}"),
        });
    }
}
