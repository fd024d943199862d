//! What is wrong with a scenario file: every fault, each with its place.

use std::fmt;
use std::path::PathBuf;

use crate::map::listed;

/// One thing wrong in a file: where, what was found, what is allowed.
///
/// # Examples
///
/// ```
/// use searoom::scenario::{Fault, Scenario};
///
/// let faults: Vec<Fault> = Scenario::parse("title = \"A\"\nhorizon_s = -1.0").expect_err("faults");
/// let horizon = faults.iter().find(|fault| fault.path == "horizon_s").expect("it is negative");
/// assert_eq!((horizon.line, horizon.found.as_str()), (Some(2), "-1.0"));
/// // every fault of the text at once
/// assert!(faults.iter().any(|fault| fault.path == "own_ship"));
/// ```
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Fault {
    /// The field, as in `targets[0].speed_mps`; empty when the file as a whole is meant.
    pub path: String,
    /// What the file says there.
    pub found: String,
    /// What it may say.
    pub allowed: String,
    /// Line in the file, from 1, where one can be named.
    pub line: Option<usize>,
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(line) = self.line {
            write!(f, "line {line}: ")?;
        }
        if !self.path.is_empty() {
            write!(f, "{}: ", self.path)?;
        }
        write!(f, "found {}; allowed: {}", self.found, self.allowed)
    }
}

/// Why a file gives no scenario.
///
/// # Examples
///
/// ```
/// use searoom::scenario::{Scenario, ScenarioError};
///
/// let error = Scenario::read("scenarios/nowhere.toml".as_ref()).expect_err("no such file");
/// assert!(matches!(&error, ScenarioError::Read { .. }));
/// assert!(error.to_string().starts_with("scenarios/nowhere.toml: cannot be read"));
/// ```
#[derive(Debug, thiserror::Error)]
pub enum ScenarioError {
    /// The file cannot be read.
    #[error("{}: cannot be read: {source}", file.display())]
    Read {
        /// The file.
        file: PathBuf,
        /// The system's answer.
        source: std::io::Error,
    },
    /// The file was read and is wrong.
    #[error("{}: {}", file.display(), listed(faults))]
    Faults {
        /// The file.
        file: PathBuf,
        /// Everything wrong with it, in order of lines. Never empty.
        faults: Vec<Fault>,
    },
}
