//! Files that a command has found, and those that it refuses.

use std::fmt::Display;
use std::path::{Path, PathBuf};

use anyhow::bail;
use searoom::document::SuiteOutcome;
use searoom::input::{Fault, InputError};

use super::status::ExitStatus;

#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Found {
    pub file: PathBuf,
    /// Name of its outputs without extension: the path relative to the argument with "/" as "__".
    pub stem: String,
    /// True if the argument was a folder, not this file.
    pub in_folder: bool,
}

/// File, a part of it, or a folder without a result.
#[derive(Debug)]
pub struct Refused {
    pub file: PathBuf,
    /// Title of a valid scenario that is not supported as requested.
    pub title: Option<String>,
    /// Its outcome in documents.
    pub outcome: SuiteOutcome,
    /// Error that includes the file name.
    pub error: String,
    /// The faults of the file, where it could be read.
    pub faults: Vec<Fault>,
}

impl Refused {
    pub fn new(file: &Path, outcome: SuiteOutcome, error: impl Display) -> Self {
        Self {
            file: file.to_owned(),
            title: None,
            outcome,
            error: error.to_string(),
            faults: Vec::new(),
        }
    }

    pub fn unreadable(file: &Path, error: impl Display) -> Self {
        Self::new(file, SuiteOutcome::Unreadable, error)
    }

    /// A file that cannot be read, or is wrong.
    pub fn input(file: &Path, error: InputError) -> Self {
        Self {
            error: error.to_string(),
            faults: match error {
                InputError::Faults { faults, .. } => faults,
                InputError::Read { .. } => Vec::new(),
            },
            ..Self::unreadable(file, "")
        }
    }

    /// An internal fault, whose text does not include the file name.
    pub fn fault(file: &Path, fault: &str) -> Self {
        let error = format_args!("{}: {fault}", file.display());
        Self::new(file, SuiteOutcome::InternalFault, error)
    }

    pub fn status(&self) -> ExitStatus {
        match self.outcome {
            SuiteOutcome::InternalFault => ExitStatus::InternalFault,
            _ => ExitStatus::BadInput,
        }
    }
}

/// Name of a file on a page: as given, but an absolute path is shortened to the part below the
/// current folder, or to the file name.
pub fn shown(file: &Path) -> String {
    if !file.is_absolute() {
        return file.display().to_string();
    }
    let here = std::env::current_dir().ok();
    let below = here
        .as_deref()
        .and_then(|here| file.strip_prefix(here).ok());
    let name = below.or(file.file_name().map(Path::new));
    name.unwrap_or(file).display().to_string()
}

/// Fails if two scenarios would have the same output name.
pub fn refuse_clashes(found: &[Found]) -> anyhow::Result<()> {
    for (index, later) in found.iter().enumerate() {
        if let Some(earlier) = found[..index].iter().find(|f| f.stem == later.stem) {
            bail!(
                "{} and {} would both be written as '{}'; \
                 give the folder above them, or one of them",
                earlier.file.display(),
                later.file.display(),
                later.stem
            );
        }
    }
    Ok(())
}
