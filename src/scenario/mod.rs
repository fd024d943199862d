//! A scenario: read from a file, checked in full, then without invalid state.

mod check;
mod fault;
mod file;
mod limits;
mod section;
mod targets;

pub use fault::{Fault, ScenarioError};

use std::io::Read;
use std::path::Path;

use crate::planner::SearchKind;
use crate::target::Target;
use crate::trajectory::DesiredTrajectory;
use crate::vessel::OwnShip;

/// Which sets a plan keeps out of.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Compliance {
    /// The hard sets alone.
    None,
    /// The shaped sets, so that the cheapest plan follows the rules of the road.
    Shape,
}

/// A checked scenario, SI and east-north.
#[derive(Debug, Clone, PartialEq)]
pub struct Scenario {
    /// The scenario's title.
    pub title: String,
    /// Seconds.
    pub horizon: f64,
    /// Own ship.
    pub own_ship: OwnShip,
    /// Where she is meant to be, and when.
    pub desired: DesiredTrajectory,
    /// The others.
    pub targets: Vec<Target>,
    /// Which search.
    pub search: SearchKind,
    /// Which sets.
    pub compliance: Compliance,
    /// `q` of eq. (30), m²/s².
    pub time_weight: f64,
    /// Wall-clock budget of one plan, seconds.
    pub deadline: f64,
}

impl Scenario {
    /// Reads and checks a scenario file (`contract.md` section 1). Every fault of the file is in the
    /// error, not only the first.
    pub fn read(file: &Path) -> Result<Self, ScenarioError> {
        let unread = |source| ScenarioError::Read {
            file: file.to_owned(),
            source,
        };
        let whole = |found: String, allowed: &str| ScenarioError::Faults {
            file: file.to_owned(),
            faults: vec![Fault {
                path: String::new(),
                found,
                allowed: allowed.to_owned(),
                line: None,
            }],
        };
        let handle = std::fs::File::open(file).map_err(unread)?;
        let mut bytes = Vec::new();
        handle
            .take(limits::FILE_BYTES + 1)
            .read_to_end(&mut bytes)
            .map_err(unread)?;
        if bytes.len() as u64 > limits::FILE_BYTES {
            return Err(whole(
                "more than 16 MiB".to_owned(),
                "a scenario file of at most 16 MiB",
            ));
        }
        let text = std::str::from_utf8(&bytes).map_err(|error| {
            let at = error.valid_up_to();
            whole(format!("bytes that are no text at byte {at}"), "UTF-8 text")
        })?;
        Self::parse(text).map_err(|faults| ScenarioError::Faults {
            file: file.to_owned(),
            faults,
        })
    }

    /// Checks the text of a scenario file. The error holds every fault, in order of lines.
    ///
    /// Courses may be given from -360° to 360°; coordinates up to 10,000 km, speeds up to 100 m/s and
    /// times up to 1,000,000 s are accepted. A time weight that is left out is the square of the
    /// mission's mean speed.
    pub fn parse(text: &str) -> Result<Self, Vec<Fault>> {
        let source = file::Source::new(text);
        let scenario = check::text(&source, text);
        let faults = source.into_faults();
        match scenario {
            Some(scenario) if faults.is_empty() => Ok(scenario),
            _ => Err(faults),
        }
    }
}

impl Compliance {
    /// The word for it in files and on the command line.
    pub fn word(self) -> &'static str {
        match self {
            Self::None => "none",
            Self::Shape => "shape",
        }
    }
}
