//! `searoom check`: reads and checks scenarios without planning.

use searoom::document::{CheckDocument, CheckedDocument, FaultDocument};

use super::args::CheckArgs;
use super::input::files::Refused;
use super::input::scenes;
use super::output::Output;
use super::output::status::ExitStatus;

/// Prints one line per valid scenario with its assumptions, and every fault of the others.
pub fn check(args: &CheckArgs, output: &Output) -> ExitStatus {
    let mut status = ExitStatus::Good;
    let mut document = CheckDocument::default();
    for scene in scenes::open(&args.paths, &args.assumed, output) {
        let made = scene.and_then(|scene| Ok((scene.label(), scene.scenario()?, scene.found.file)));
        match made {
            Ok((_, made, file)) if args.json => document.files.push(CheckedDocument {
                file: file.display().to_string(),
                scenario: Some(made.scenario.title),
                notes: made.notes,
                ..CheckedDocument::default()
            }),
            Ok((label, made, _)) => {
                status = status.max(output.result(&format!("{label}: ok")));
                for note in made.notes {
                    output.note(&format_args!("{label}: {note}"));
                }
            }
            Err(refused) => {
                status = status.max(output.refused(&refused));
                document.files.push(wrong(refused));
            }
        }
    }
    match args.json {
        true => status.max(output.document(&document)),
        false => status,
    }
}

fn wrong(refused: Refused) -> CheckedDocument {
    CheckedDocument {
        file: refused.file.display().to_string(),
        error: Some(refused.error),
        faults: refused.faults.into_iter().map(FaultDocument::of).collect(),
        ..CheckedDocument::default()
    }
}
