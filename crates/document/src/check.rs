//! Documents of what is in files: of `check`, and of `inspect`.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::{
    CostDocument, EncounterDocument, EscapeDocument, PlanMethod, ScenarioComparisonDocument,
    SearchStatsDocument, SimulationDocument,
};
use searoom_input::Fault;

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

searoom_geometry::words! {
    /// The state of a readable recording.
    pub enum Checksum {
        /// Every byte is as Searoom wrote it.
        Valid => "valid",
        /// Another program wrote the recording again, in other bytes: no checksum covers them.
        Gone => "gone",
    }
}

/// Contents of a recording. The values of its documents are as they were written.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct InspectionDocument {
    pub file: String,
    pub bytes: u64,
    pub application: &'static str,
    pub rerun_version: Option<String>,
    pub checksum: Checksum,
    /// Fields from the plan document; null without one.
    #[schemars(with = "Option<String>")]
    pub scenario: Value,
    #[schemars(with = "Option<String>")]
    pub planner: Value,
    #[schemars(with = "Option<String>")]
    pub search: Value,
    #[schemars(with = "Option<String>")]
    pub outcome: Value,
    #[schemars(with = "Option<bool>")]
    pub verified: Value,
    #[schemars(with = "Option<bool>")]
    pub safe: Value,
    #[schemars(with = "Option<CostDocument>")]
    pub cost: Value,
    #[schemars(with = "Option<PlanMethod>")]
    pub method: Value,
    #[schemars(with = "Option<SearchStatsDocument>")]
    pub search_stats: Value,
    /// Escape; null unless own ship stands on.
    #[schemars(with = "Option<EscapeDocument>")]
    pub escape: Value,
    #[schemars(with = "Vec<EncounterDocument>")]
    pub targets: Vec<Value>,
    /// Entry of `compare --json`; null for a plan.
    #[schemars(with = "Option<ScenarioComparisonDocument>")]
    pub comparison: Value,
    /// `simulate --json` without the motions and the estimates; null for a plan.
    #[schemars(with = "Option<SimulationDocument>")]
    pub simulation: Value,
    pub timelines: Vec<TimelineContents>,
    pub entities: Vec<EntityContents>,
}

/// Contents of one entity.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct EntityContents {
    /// With a leading slash.
    #[serde(rename = "entity")]
    pub path: String,
    /// Rows of all its chunks together.
    pub rows: usize,
    /// Names, sorted.
    pub components: Vec<String>,
    /// Empty for what holds at all times.
    pub timelines: Vec<TimelineContents>,
}

/// The range of a timeline that is used.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct TimelineContents {
    pub name: String,
    /// `"s"`, or empty for counts.
    pub unit: &'static str,
    pub first: f64,
    pub last: f64,
}
