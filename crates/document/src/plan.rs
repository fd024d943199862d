//! Plan document, see docs/reference/documents.md.

pub(super) mod control;
pub(super) mod departure;
pub(super) mod motions;
pub(super) mod path_time;
pub(super) mod phases;

use control::ControlDocument;
use path_time::PathTimeDocument;
use phases::PhaseDocument;

use schemars::JsonSchema;
use serde::{Deserialize, Deserializer, Serialize};

use super::encounter::EncounterDocument;
use super::memory::{MemoryDocument, PlannedManoeuvreDocument};
use super::out_of_reach::OutOfReachDocument;
use super::parts::{
    CostDocument, EscapeDocument, LowerBoundDocument, MissionDocument, ObstacleDocument,
    OwnShipDocument, PlanMethod, RelaxationDocument, SearchStatsDocument, TimingDocument,
    TrajectoryDocument, ViolationDocument,
};
use super::targets::TargetDocument;
use departure::Departure;
use searoom_evaluation::PlanOutcome;
use searoom_geometry::words;
use searoom_model::{Compliance, ObjectiveKind, PlannerKind, SearchKind};

/// Format name of the plan document.
pub const PLAN_FORMAT: &str = "searoom-plan/1";

/// Maximum size of a plan document in mebibytes; one with a hundred targets needs less than 1 MiB.
pub const PLAN_MEBIBYTES: u64 = 64;

/// Self-contained plan: everything needed to verify it again.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct PlanDocument {
    #[serde(deserialize_with = "format_name")]
    pub format: String,
    pub scenario: String,
    /// Not an enum: a user of the library may plan with a planner of another name, which `verify`
    /// rejects.
    #[serde(deserialize_with = "planner_name")]
    pub planner: String,
    pub search: SearchKind,
    /// Method that made the plan; null without a plan, and only then.
    #[serde(default)]
    pub method: Option<PlanMethod>,
    pub compliance: Compliance,
    /// Not an enum: a file may hold thresholds of another name.
    #[serde(default)]
    pub thresholds: String,
    pub objective: ObjectiveKind,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub risk_weight_m: Option<f64>,
    pub time_weight_m2_per_s2: f64,
    pub max_risk: f64,
    /// The present on the clock of the scenario file. All other times count from it.
    #[serde(default, skip_serializing_if = "super::is_zero")]
    pub time_s: f64,
    pub horizon_s: f64,
    pub own_ship: OwnShipDocument,
    pub mission: MissionDocument,
    pub land: Vec<Vec<[f64; 2]>>,
    /// Number of the map's pieces that `land` holds, where it is an outer approximation of them.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub land_outer_of: Option<usize>,
    pub outcome: PlanOutcome,
    /// The outcome for the reader, with the risk where one is taken. Empty in an old document.
    #[serde(default)]
    pub verdict: String,
    pub reason: Option<String>,
    pub relaxations: Vec<RelaxationDocument>,
    pub verified: bool,
    /// `None` in a document that does not say so, which `verify` rejects.
    #[serde(default)]
    pub safe: Option<bool>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub time_of_no_return_s: Option<Option<f64>>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub lower_bound: Option<LowerBoundDocument>,
    pub violations: Vec<ViolationDocument>,
    /// Input that the plan ignores and that bears on safety.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub cautions: Vec<String>,
    /// Other input of the scenario's files that the plan ignores.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub notes: Vec<String>,
    pub cost: Option<CostDocument>,
    pub search_stats: SearchStatsDocument,
    pub timing: TimingDocument,
    pub trajectory: Option<TrajectoryDocument>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub escape: Option<EscapeDocument>,
    #[serde(default)]
    pub departure: Option<Departure>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub manoeuvres: Vec<PlannedManoeuvreDocument>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub phases: Vec<PhaseDocument>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub memory: Option<MemoryDocument>,
    pub targets: Vec<TargetDocument>,
    pub obstacles: Vec<ObstacleDocument>,
    pub encounters: Vec<EncounterDocument>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub out_of_reach: Option<OutOfReachDocument>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub path_time: Option<PathTimeDocument>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub optimal_control: Option<ControlDocument>,
}

/// Reads the name of a format. The error for what is no text has that of a plan document.
fn format_name<'de, D: Deserializer<'de>>(from: D) -> Result<String, D::Error> {
    words::read_text(from, &[(PLAN_FORMAT, ())])
}

/// Reads the name of a planner. The error for what is no text lists those of this project.
fn planner_name<'de, D: Deserializer<'de>>(from: D) -> Result<String, D::Error> {
    words::read_text(from, PlannerKind::WORDS)
}

impl PlanDocument {
    /// The document of what makes one, such as a run of `searoom`.
    pub fn of(run: impl Into<Self>) -> Self {
        run.into()
    }

    /// True where the document says that no hard set, hull or land is entered.
    pub fn is_safe(&self) -> bool {
        self.safe == Some(true)
    }

    /// Number of the scenario's targets, with those out of reach.
    pub fn all_targets(&self) -> usize {
        let listed = self.out_of_reach.as_ref();
        self.targets.len() + listed.map_or(0, |listed| listed.rows.len())
    }
}
