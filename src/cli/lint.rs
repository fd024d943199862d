//! `searoom suite --lint`: scenario faults without planning.

use searoom::document::{LintDocument, LintScenarioDocument};
use searoom::report::lint_text;
use searoom::study::lint::lint;

use super::args::SuiteArgs;
use super::found::Refused;
use super::input::scenes::Scene;
use super::output::Output;
use super::runner::guarded_on;
use super::status::ExitStatus;

/// Checks every scene; good unless one is unreadable.
pub fn suite(scenes: Vec<Result<Scene, Refused>>, args: &SuiteArgs, output: &Output) -> ExitStatus {
    let mut status = ExitStatus::Good;
    let mut documents = Vec::new();
    for scene in scenes {
        let checked = scene.and_then(|scene| {
            let file = &scene.found.file;
            guarded_on(file, || {
                let made = scene.scenario()?;
                let (name, declared) = (file.display().to_string(), scene.declared());
                Ok(lint(name, &made.scenario, &declared, made.notes))
            })
        });
        documents.push(checked.unwrap_or_else(|refused| {
            status = status.max(output.refused(&refused));
            LintScenarioDocument::failed(refused.file.display().to_string(), refused.error)
        }));
    }
    let document = LintDocument::of(documents);
    let some = document.scenarios.iter().any(|s| s.error.is_none());
    status.max(output.show(args.shared.written.json, &document, || {
        let text = some.then(|| lint_text(&document, output.display));
        text.unwrap_or_default()
    }))
}
