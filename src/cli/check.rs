//! `searoom check`: reads and checks scenarios without planning.

use searoom::document::{CheckDocument, CheckedDocument, FaultDocument};
use searoom::study::lint::findings;

use super::args::CheckArgs;
use super::found::Refused;
use super::input::scenes;
use super::output::{Noted, Output};
use super::status::ExitStatus;

/// Prints one line per valid scenario, every fault of the others, and then the assumptions.
pub fn check(args: &CheckArgs, output: &Output) -> ExitStatus {
    let mut status = ExitStatus::Good;
    let mut document = CheckDocument::default();
    // by file
    let mut noted: Vec<(String, Vec<Noted>)> = Vec::new();
    for scene in scenes::open(&args.paths, &args.assumed, output) {
        let made = scene.and_then(|scene| Ok((scene.scenario()?, scene)));
        match made.map(|(mut made, scene)| {
            made.notes
                .extend(findings(&made.scenario, &scene.declared()));
            (made, scene)
        }) {
            Ok((made, scene)) if args.json => document.files.push(CheckedDocument {
                file: scene.found.file.display().to_string(),
                scenario: Some(made.scenario.title),
                notes: made.notes,
                ..CheckedDocument::default()
            }),
            Ok((made, scene)) => {
                status = status.max(output.result(&format!("{}: ok", scene.label())));
                let file = scene.found.file.display().to_string();
                let notes = (scene.name().unwrap_or_default().to_owned(), made.notes);
                match noted.last_mut().filter(|(last, _)| *last == file) {
                    Some((_, all)) => all.push(notes),
                    None => noted.push((file, vec![notes])),
                }
            }
            Err(refused) => {
                status = status.max(output.refused(&refused));
                document.files.push(wrong(refused));
            }
        }
    }
    for (file, notes) in noted {
        output.notes(Some(&file), &notes);
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
