//! Document of `check`.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::input::Fault;

/// Checked files, in order.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct CheckDocument {
    pub files: Vec<CheckedDocument>,
}

/// A scenario, or a file without one. A scenario without an error is valid.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct CheckedDocument {
    pub file: String,
    pub scenario: Option<String>,
    pub error: Option<String>,
    pub faults: Vec<FaultDocument>,
    pub notes: Vec<String>,
}

/// One thing wrong in a file.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct FaultDocument {
    pub line: Option<usize>,
    pub field: Option<String>,
    pub found: String,
    pub allowed: String,
}

impl FaultDocument {
    /// Builds the entry of a fault.
    pub fn of(fault: Fault) -> Self {
        Self {
            line: fault.line,
            field: Some(fault.path).filter(|path| !path.is_empty()),
            found: fault.found,
            allowed: fault.allowed,
        }
    }
}
