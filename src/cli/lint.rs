//! `searoom suite --lint`: scenario faults without planning.

use searoom::document::{LintDocument, LintScenarioDocument};
use searoom::report::lint_text;
use searoom::study::lint::lint;

use super::args::SuiteArgs;
use super::input::files::Unread;
use super::input::scenes::Scene;
use super::output::Output;
use super::output::status::ExitStatus;
use super::runner::guarded;

/// Checks every scene; good unless one is unreadable.
pub fn suite(scenes: Vec<Result<Scene, Unread>>, args: &SuiteArgs, output: &Output) -> ExitStatus {
    let mut status = ExitStatus::Good;
    let mut documents = Vec::new();
    for scene in scenes {
        let checked = match scene {
            Ok(scene) => guarded(|| check(&scene)).unwrap_or_else(|fault| {
                status = status.max(ExitStatus::InternalFault);
                Err(unread(&scene, fault))
            }),
            Err(unread) => Err(unread),
        };
        documents.push(checked.unwrap_or_else(|failed| {
            status = status.max(ExitStatus::BadInput);
            output.error(&failed.error);
            LintScenarioDocument::failed(failed.file.display().to_string(), failed.error)
        }));
    }
    let document = LintDocument::of(documents);
    status.max(output.show(args.shared.written.json, &document, || {
        lint_text(&document, output.colour)
    }))
}

fn unread(scene: &Scene, error: String) -> Unread {
    Unread {
        file: scene.found.file.clone(),
        error,
    }
}

fn check(scene: &Scene) -> Result<LintScenarioDocument, Unread> {
    let made = scene.scenario();
    let made = made.map_err(|error| unread(scene, error.to_string()))?;
    let file = scene.found.file.display().to_string();
    Ok(lint(file, &made.scenario, &scene.declared(), made.notes))
}
