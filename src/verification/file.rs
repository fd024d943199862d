//! Schema of the plan document for the checker: the required keys, in the units of the file.
//!
//! The parts that a document must state in one way only are those of the writer. The others differ:
//! a key that is missing or has another form is a violation here, or refused by its name.

use serde::Deserialize;
use serde::de::IgnoredAny;

use crate::document::{
    ForceLimitsDocument, MissionDocument, OwnShipDocument, PositionDocument, TrajectoryDocument,
};

#[derive(Debug, Deserialize)]
pub(super) struct PlanFile {
    pub format: String,
    pub scenario: String,
    pub planner: String,
    pub compliance: String,
    pub outcome: String,
    /// A document without `verdict` and `safe` is rejected.
    pub verdict: Option<String>,
    pub safe: Option<bool>,
    pub time_weight_m2_per_s2: f64,
    pub max_risk: f64,
    pub objective: String,
    pub horizon_s: f64,
    pub own_ship: OwnShipDocument,
    pub mission: MissionDocument,
    pub land: Vec<Vec<[f64; 2]>>,
    pub targets: Vec<TargetFile>,
    pub obstacles: Vec<ObstacleFile>,
    /// The first of `relaxations`.
    pub relaxation: Option<RelaxationFile>,
    pub relaxations: Vec<RelaxationFile>,
    pub cost: Option<CostFile>,
    pub trajectory: Option<TrajectoryDocument>,
    pub encounters: Vec<EncounterFile>,
    pub path_time: Option<IgnoredAny>,
    pub optimal_control: Option<ControlFile>,
}

/// A tracked ship, or explicit sets.
#[derive(Debug, Deserialize)]
pub(super) struct TargetFile {
    pub name: String,
    pub representation: String,
    pub ship: Option<ShipFile>,
    pub initial_set: Option<SetFile>,
    #[serde(default)]
    pub velocity_sets: Vec<TimedSetFile>,
}

#[derive(Debug, Deserialize)]
pub(super) struct ShipFile {
    pub position: PositionDocument,
    pub course_deg: f64,
    pub speed_mps: f64,
    pub length_m: f64,
    pub beam_m: f64,
    pub position_std_m: f64,
    pub speed_spread_mps: f64,
    pub course_spread_deg: f64,
    #[serde(default)]
    pub starboard_turn_deg: f64,
    pub turn_rate_deg_per_s: f64,
    pub kept_positions: Option<SetFile>,
    pub kept_velocities: Option<SetFile>,
}

/// Set of positions or of velocities. The two have different keys, and one of them is present.
#[derive(Debug, Deserialize)]
pub(super) struct SetFile {
    #[serde(alias = "vertices_mps")]
    pub vertices_m: Option<Vec<[f64; 2]>>,
    #[serde(alias = "center_mps")]
    pub center_m: Option<[f64; 2]>,
    #[serde(alias = "shape_m2_per_s2")]
    pub shape_m2: Option<[[f64; 2]; 2]>,
}

#[derive(Debug, Deserialize)]
pub(super) struct TimedSetFile {
    /// Null for the last.
    pub until_s: Option<f64>,
    #[serde(flatten)]
    pub set: SetFile,
}

#[derive(Debug, Deserialize)]
pub(super) struct ObstacleFile {
    pub name: String,
    pub valid_s: [f64; 2],
    pub initial_set: SetFile,
    pub velocity_set: SetFile,
}

/// A relaxed requirement; only the keys that the checks need.
#[derive(Debug, PartialEq, Deserialize)]
pub(super) struct RelaxationFile {
    pub kind: String,
    pub target: String,
    pub amount: f64,
    pub until_s: Option<f64>,
}

#[derive(Debug, Deserialize)]
pub(super) struct CostFile {
    pub objective: f64,
    pub space_time_error_m2: f64,
    pub space_time_error_arc_length_m2: Option<f64>,
    pub space_time_error_until_s: Option<f64>,
    pub arrived: bool,
    pub duration_s: f64,
    pub length_m: f64,
    pub delay_s: Option<f64>,
    /// An older document may omit it.
    #[serde(default)]
    pub waypoint_distances_m: Option<Vec<f64>>,
    pub max_risk: f64,
    pub min_clearance_m: Option<f64>,
    pub hold_clearance_m: Option<f64>,
    pub arrival_hold_s: Option<f64>,
    pub min_land_distance_m: Option<f64>,
}

#[derive(Debug, Deserialize)]
pub(super) struct EncounterFile {
    pub target: String,
    pub dcpa_m: Option<f64>,
    pub max_risk: Option<f64>,
    pub max_risk_t_s: Option<f64>,
}

#[derive(Debug, Deserialize)]
pub(super) struct ControlFile {
    pub vessel: String,
    pub force_limits: ForceLimitsDocument,
    pub state_weights: [f64; 6],
    pub control_weights: [f64; 3],
}
