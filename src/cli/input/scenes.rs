//! Scenarios in files: one per scenario file, one or more per imported file.

use std::path::{Path, PathBuf};

use searoom::input::{Fault, InputError};
use searoom::scenario::import::{Assumed, Contents, Declared, Imported, Situation};
use searoom::scenario::{FILE_MEBIBYTES, Scenario};

use super::super::args::AssumedArgs;
use super::super::found::{Found, Refused};
use super::super::output::Output;
use super::files::{self, SEPARATOR};

const KIND: &str = "a scenario file";

/// Scenario whose text is read but not yet checked.
#[derive(Debug)]
pub struct Scene {
    pub found: Found,
    source: Source,
}

#[derive(Debug)]
enum Source {
    Text(String),
    /// Situation of an imported file, with assumptions for the values missing from it.
    Situation(Box<Situation>, Assumed),
}

impl Scene {
    /// The scenario, and the text of its scenario file.
    pub fn scenario(&self) -> Result<Imported, Refused> {
        let file = &self.found.file;
        let made = match &self.source {
            Source::Situation(situation, assumed) => situation.scenario(assumed),
            Source::Text(text) => {
                let folder = file.parent().unwrap_or(Path::new(""));
                Scenario::parse_beside(text, folder).map(|scenario| Imported {
                    notes: scenario.remarks.all(),
                    scenario,
                    text: text.clone(),
                })
            }
        };
        made.map_err(|faults| Refused::input(file, InputError::faults(file, faults)))
    }

    /// Faults with their lines in the file, where it is a scenario file.
    pub fn located(&self, faults: Vec<Fault>) -> Vec<Fault> {
        match &self.source {
            Source::Text(text) => Scenario::located(text, faults),
            Source::Situation(..) => faults,
        }
    }

    /// True for a situation of another format.
    pub fn is_imported(&self) -> bool {
        matches!(self.source, Source::Situation(..))
    }

    /// Further facts that an imported file declares about its situation.
    pub fn declared(&self) -> Declared {
        match &self.source {
            Source::Situation(situation, _) => situation.declared.clone(),
            Source::Text(_) => Declared::default(),
        }
    }

    /// Name of the situation if the file may contain several.
    pub fn name(&self) -> Option<&str> {
        match &self.source {
            Source::Situation(situation, _) if situation.id.is_some() => Some(&situation.name),
            _ => None,
        }
    }

    /// Name of the file, with that of the situation.
    pub fn label(&self) -> String {
        let file = self.found.file.display();
        match self.name() {
            Some(name) => format!("{file}: {name}"),
            None => file.to_string(),
        }
    }
}

/// Opens the files at `paths` and lists their scenes in order. Documents and maps in a folder are
/// skipped with a note.
pub fn open(
    paths: &[PathBuf],
    assumed: &AssumedArgs,
    output: &Output,
) -> Vec<Result<Scene, Refused>> {
    let assumed = assumed.assumed();
    let mut scenes = Vec::new();
    for entry in files::find(paths, &files::SCENARIOS, output) {
        match entry {
            Ok(found) => of_file(&found, &assumed, output, &mut scenes),
            Err(refused) => scenes.push(Err(refused)),
        }
    }
    scenes
}

pub fn found(scenes: &[Result<Scene, Refused>]) -> Vec<Found> {
    scenes.iter().flatten().map(|s| s.found.clone()).collect()
}

fn of_file(
    found: &Found,
    assumed: &Assumed,
    output: &Output,
    scenes: &mut Vec<Result<Scene, Refused>>,
) {
    let text = files::text(&found.file, FILE_MEBIBYTES, KIND);
    let found = &Found {
        file: files::name(&found.file),
        ..found.clone()
    };
    let file = &found.file;
    let text = match text {
        Ok(text) => text,
        Err(error) => return scenes.push(Err(Refused::input(file, error))),
    };
    let wrong = |faults| Err(Refused::input(file, InputError::faults(file, faults)));
    match Contents::parse(&text, assumed) {
        Ok(Contents::Scenario) => scenes.push(Ok(Scene {
            found: found.clone(),
            source: Source::Text(text),
        })),
        Ok(Contents::Situations(situations)) => {
            for situation in situations {
                scenes.push(situation.map_or_else(wrong, |situation| {
                    Ok(Scene {
                        found: named(found, &situation),
                        source: Source::Situation(Box::new(situation), assumed.clone()),
                    })
                }));
            }
        }
        Ok(Contents::Other(what)) if found.in_folder => {
            output.note(&format_args!("{}: {what}, left out", file.display()));
        }
        Ok(Contents::Other(what)) => {
            let error = format_args!("{}: {what}; no scenario in it", file.display());
            scenes.push(Err(Refused::unreadable(file, error)));
        }
        Err(faults) => scenes.push(wrong(faults)),
    }
}

/// Opens a file for a command that takes one scenario. The error includes the file name.
pub fn open_one(file: &Path, assumed: &AssumedArgs, output: &Output) -> Result<Scene, String> {
    let name = file.display();
    if file.is_dir() {
        return Err(format!(
            "{name}: a folder; `searoom suite` runs the scenarios in it"
        ));
    }
    let mut scenes = open(&[file.to_owned()], assumed, output);
    match (scenes.pop(), scenes.len()) {
        (Some(Ok(scene)), 0) => Ok(scene),
        (Some(Err(refused)), 0) => Err(refused.error),
        (None, _) => Err(format!("{name}: no scenario in it")),
        (_, more) => Err(format!(
            "{name}: {} situations; `searoom suite` runs them, `searoom import` makes a file of each",
            more + 1
        )),
    }
}

/// Names the outputs of one of several situations after it, in the folder of its file.
fn named(found: &Found, situation: &Situation) -> Found {
    let Some(id) = &situation.id else {
        return found.clone();
    };
    let safe = |c: char| {
        if c.is_alphanumeric() || "-_.".contains(c) {
            c
        } else {
            '_'
        }
    };
    let id: String = id.chars().map(safe).collect();
    let stem = match found.stem.rsplit_once(SEPARATOR) {
        Some((folder, _)) => format!("{folder}{SEPARATOR}{id}"),
        None => id,
    };
    Found {
        stem,
        ..found.clone()
    }
}
