//! `searoom suite --lint`: scenario faults without planning.

use searoom::document::{LintDocument, LintScenarioDocument};
use searoom::report::lint_text;
use searoom::scenario::Scenario;
use searoom::scenario::import::Assumed;
use searoom::study::lint::{Likeness, likenesses, lint};

use super::args::SuiteArgs;
use super::input::scenes::{Scene, Unread};
use super::output::Output;
use super::output::status::ExitStatus;
use super::runner::guarded;

/// Scenario with its findings.
struct Checked {
    scenario: Scenario,
    document: LintScenarioDocument,
}

/// Checks every scene; good unless one is unreadable.
pub fn suite(
    scenes: Vec<Result<Scene, Unread>>,
    args: &SuiteArgs,
    assumed: &Assumed,
    output: &Output,
) -> ExitStatus {
    let mut status = ExitStatus::Good;
    let mut all: Vec<Result<Checked, Unread>> = Vec::new();
    for scene in scenes {
        let checked = match scene {
            Ok(scene) => guarded(|| check(&scene, assumed)).unwrap_or_else(|fault| {
                status = status.max(ExitStatus::InternalFault);
                Err(unread(&scene, fault))
            }),
            Err(unread) => Err(unread),
        };
        if let Err(failed) = &checked {
            status = status.max(ExitStatus::BadInput);
            output.error(&failed.error);
        }
        all.push(checked);
    }
    compare(&mut all);
    let documents = all.into_iter().map(|checked| match checked {
        Ok(checked) => checked.document,
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

fn check(scene: &Scene, assumed: &Assumed) -> Result<Checked, Unread> {
    let made = scene.scenario(assumed);
    let made = made.map_err(|error| unread(scene, error.to_string()))?;
    let file = scene.found.file.display().to_string();
    Ok(Checked {
        document: lint(file, &made.scenario, &scene.declared(), made.notes),
        scenario: made.scenario,
    })
}

/// Adds findings on repeated scenarios.
fn compare(all: &mut [Result<Checked, Unread>]) {
    let read: Vec<&Scenario> = all
        .iter()
        .flatten()
        .map(|checked| &checked.scenario)
        .collect();
    let names: Vec<String> = all
        .iter()
        .flatten()
        .map(|checked| format!("{} ({})", checked.scenario.title, checked.document.file))
        .collect();
    let like = likenesses(&read);
    for (checked, like) in all.iter_mut().flatten().zip(like) {
        let Some((before, how)) = like else { continue };
        let name = &names[before];
        checked.document.findings.push(match how {
            Likeness::Same => format!("the same encounter as {name}"),
            Likeness::Mirrored => format!("the mirror image of {name}"),
        });
    }
}
