//! Scenarios in files: one per scenario file, one or more per imported file.

use std::path::{Path, PathBuf};

use searoom::scenario::import::{Assumed, Contents, Declared, Imported, Situation};
use searoom::scenario::{Scenario, ScenarioError};

use super::super::output::Output;
use super::files::{self, Found, Unread};

/// Scenario that is not yet fully read.
#[derive(Debug)]
pub struct Scene {
    /// File and output name.
    pub found: Found,
    /// Situation of an imported file; `None` for a scenario file.
    situation: Option<Situation>,
}

/// Scenario with notes.
#[derive(Debug)]
pub struct Made {
    pub scenario: Scenario,
    /// Assumptions, and unused parts of the file.
    pub notes: Vec<String>,
}

impl Scene {
    /// Builds the scenario, with assumptions for values missing from an imported file.
    pub fn scenario(&self, assumed: &Assumed) -> Result<Made, ScenarioError> {
        match self.imported(assumed) {
            Some(imported) => imported.map(|imported| Made {
                scenario: imported.scenario,
                notes: imported.notes,
            }),
            None => Scenario::read(&self.found.file).map(|scenario| Made {
                scenario,
                notes: Vec::new(),
            }),
        }
    }

    /// Builds the scenario of an imported file with its text; `None` for a scenario file.
    pub fn imported(&self, assumed: &Assumed) -> Option<Result<Imported, ScenarioError>> {
        let imported = self.situation.as_ref()?.scenario(assumed);
        Some(imported.map_err(|faults| ScenarioError::faults(&self.found.file, faults)))
    }

    /// Further facts that an imported file declares about its situation.
    pub fn declared(&self) -> Declared {
        let situation = self.situation.as_ref();
        situation.map_or_else(Declared::default, |situation| situation.declared.clone())
    }

    /// Name of the file, with the situation if the file may contain several.
    pub fn label(&self) -> String {
        let file = self.found.file.display();
        match &self.situation {
            Some(situation) if situation.id.is_some() => format!("{file}: {}", situation.name),
            _ => file.to_string(),
        }
    }
}

/// Opens the files at `paths` and lists their scenes in order. Documents and maps in a folder are
/// skipped with a note.
pub fn open(paths: &[PathBuf], assumed: &Assumed, output: &Output) -> Vec<Result<Scene, Unread>> {
    let mut scenes = Vec::new();
    for entry in files::find(paths, &files::SCENARIOS, output) {
        match entry {
            Ok(found) => of_file(&found, assumed, output, &mut scenes),
            Err(unread) => scenes.push(Err(unread)),
        }
    }
    scenes
}

/// The files of the scenes.
pub fn found(scenes: &[Result<Scene, Unread>]) -> Vec<Found> {
    scenes.iter().flatten().map(|s| s.found.clone()).collect()
}

fn of_file(
    found: &Found,
    assumed: &Assumed,
    output: &Output,
    scenes: &mut Vec<Result<Scene, Unread>>,
) {
    let file = &found.file;
    let unread = |error: String| Unread {
        file: file.clone(),
        error,
    };
    match Contents::read(file, assumed) {
        Ok(Contents::Scenario) => scenes.push(Ok(Scene {
            found: found.clone(),
            situation: None,
        })),
        Ok(Contents::Situations(situations)) => {
            for situation in situations {
                scenes.push(match situation {
                    Ok(situation) => Ok(Scene {
                        found: named(found, &situation),
                        situation: Some(situation),
                    }),
                    Err(faults) => Err(unread(ScenarioError::faults(file, faults).to_string())),
                });
            }
        }
        Ok(Contents::Other(what)) if found.in_folder => {
            output.note(&format_args!("{}: {what}, left out", file.display()));
        }
        Ok(Contents::Other(what)) => {
            let error = format!("{}: {what}; no scenario in it", file.display());
            scenes.push(Err(unread(error)));
        }
        Err(error) => scenes.push(Err(unread(error.to_string()))),
    }
}

/// Opens a file for a command that takes one scenario. The error includes the file name.
pub fn open_one(file: &Path, assumed: &Assumed, output: &Output) -> Result<Scene, String> {
    let name = file.display();
    if file.is_dir() {
        return Err(format!(
            "{name}: a folder; `searoom suite` runs the scenarios in it"
        ));
    }
    let mut scenes = open(&[file.to_owned()], assumed, output);
    match (scenes.pop(), scenes.len()) {
        (Some(Ok(scene)), 0) => Ok(scene),
        (Some(Err(unread)), 0) => Err(unread.error),
        (None, _) => Err(format!("{name}: no scenario in it")),
        (_, more) => Err(format!(
            "{name}: {} situations; `searoom suite` runs them",
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

/// Replacement of "/" in output names.
const SEPARATOR: &str = "__";
