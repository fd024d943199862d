//! Parts shared by the documents.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::targets::sets::{InitialSetDocument, VelocitySetDocument};
use crate::frame::{Pose, Vector, heading_from_course_deg, radians_from_deg};
pub use crate::planner::PlanMethod;
use crate::planner::SearchStats;
use crate::trajectory::Segment;

/// Point in the plane.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct PositionDocument {
    pub east_m: f64,
    pub north_m: f64,
}

impl PositionDocument {
    pub(crate) fn point(&self) -> Vector {
        Vector::new(self.east_m, self.north_m)
    }
}

pub(crate) fn position(p: Vector) -> PositionDocument {
    PositionDocument {
        east_m: p.x + 0.0,
        north_m: p.y + 0.0,
    }
}

/// Own ship and its limits, with the keys of the scenario file.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct OwnShipDocument {
    pub position: PositionDocument,
    pub course_deg: f64,
    pub speed_mps: f64,
    pub length_m: f64,
    pub beam_m: f64,
    pub turning_radius_m: f64,
    pub speeds_mps: Vec<f64>,
    pub safety_margin_m: f64,
    #[serde(default, skip_serializing_if = "super::is_zero")]
    pub tracking_margin_m: f64,
    pub land_margin_m: f64,
}

/// Desired trajectory.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct MissionDocument {
    pub waypoints: Vec<PositionDocument>,
    pub leg_speeds_mps: Vec<f64>,
    pub duration_s: f64,
    pub length_m: f64,
    /// Metres that the closed loop leaves out after an intermediate end.
    #[serde(default, skip_serializing_if = "super::is_zero")]
    pub left_out_m: f64,
    /// Time until which own ship lies at the last waypoint; absent where the mission ends there.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stay_until_s: Option<f64>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub alternatives: Vec<Vec<PositionDocument>>,
}

/// Relaxation of one constraint.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct RelaxationDocument {
    pub kind: String,
    pub target: String,
    pub amount: f64,
    #[serde(default)]
    pub unit: String,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub until_s: Option<f64>,
}

/// Escape of a stand-on ship.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct EscapeDocument {
    pub policy: String,
    pub held_until_s: f64,
    pub first_segment: usize,
    pub turn_deg: f64,
    pub speed_mps: f64,
}

/// Violation found by the independent checker.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ViolationDocument {
    pub what: String,
    pub t_s: Option<f64>,
}

/// Statistics of the search that made a plan; null where no graph was searched for it.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct SearchStatsDocument {
    pub expanded: Option<usize>,
    pub generated: Option<usize>,
    pub edges_checked: Option<usize>,
    /// Absent in an old document.
    #[serde(default)]
    pub heuristic_weight: Option<f64>,
}

impl SearchStatsDocument {
    pub(crate) fn of(stats: Option<SearchStats>) -> Self {
        Self {
            expanded: stats.map(|s| s.expanded),
            generated: stats.map(|s| s.generated),
            edges_checked: stats.map(|s| s.edges_checked),
            heuristic_weight: stats.map(|s| s.heuristic_weight),
        }
    }
}

/// A space-time error that no motion can be below, and the grid on which it was found.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct LowerBoundDocument {
    pub space_time_error_m2: f64,
    pub cell_m: f64,
    pub step_s: f64,
}

/// Costs of a plan.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct CostDocument {
    pub objective: f64,
    pub space_time_error_m2: f64,
    #[serde(default)]
    pub space_time_error_until_s: f64,
    /// Null for a motion without length.
    pub space_time_error_arc_length_m2: Option<f64>,
    pub arrived: bool,
    pub duration_s: f64,
    pub length_m: f64,
    pub delay_s: Option<f64>,
    #[serde(default)]
    pub waypoint_distances_m: Vec<f64>,
    pub max_risk: f64,
    pub min_clearance_m: Option<f64>,
    #[serde(default)]
    pub hold_clearance_m: Option<f64>,
    #[serde(default)]
    pub arrival_hold_s: f64,
    pub min_land_distance_m: Option<f64>,
}

/// Planning times: they alone differ between two runs, unless a deadline ended one.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct TimingDocument {
    pub plan_s: f64,
    /// The best answers of a thorough search so far that give up as much as the plan, which is the
    /// last. Absent for other searches.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub improvements: Vec<ImprovementDocument>,
}

/// The best answer so far, from when one of the searches was complete.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ImprovementDocument {
    pub after_s: f64,
    pub cost_m2: f64,
}

/// Pose at a time.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct StartDocument {
    pub t_s: f64,
    pub east_m: f64,
    pub north_m: f64,
    pub course_deg: f64,
}

/// Line or arc; starboard turns are positive.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct SegmentDocument {
    pub start: StartDocument,
    pub duration_s: f64,
    pub speed_mps: f64,
    pub turn_rate_deg_per_s: f64,
}

impl StartDocument {
    pub(crate) fn pose(&self) -> Pose {
        let position = Vector::new(self.east_m, self.north_m);
        Pose::new(position, heading_from_course_deg(self.course_deg))
    }
}

pub(crate) fn segment(document: &SegmentDocument) -> Segment {
    Segment::new(
        document.start.pose(),
        document.start.t_s,
        document.duration_s,
        document.speed_mps,
        radians_from_deg(-document.turn_rate_deg_per_s) + 0.0,
    )
}

/// Pose at a time, with the speed from then on.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct SampleDocument {
    pub t_s: f64,
    pub east_m: f64,
    pub north_m: f64,
    pub course_deg: f64,
    pub speed_mps: f64,
    #[serde(flatten, default, skip_serializing_if = "Option::is_none")]
    pub node: Option<NodeDocument>,
}

/// State at a node and the forces held until the next one. Starboard and clockwise are positive.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct NodeDocument {
    pub heading_deg: f64,
    pub surge_mps: f64,
    pub sway_mps: f64,
    pub yaw_rate_deg_per_s: f64,
    pub surge_n: f64,
    pub sway_n: f64,
    pub yaw_nm: f64,
}

/// Trajectory, exact and sampled. Samples are one second apart, or a 20,000th of a longer
/// trajectory, and include all segment ends and nodes.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct TrajectoryDocument {
    pub segments: Option<Vec<SegmentDocument>>,
    pub samples: Vec<SampleDocument>,
}

/// Space-time obstacle.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ObstacleDocument {
    pub name: String,
    pub valid_s: [f64; 2],
    pub initial_set: InitialSetDocument,
    pub velocity_set: VelocitySetDocument,
}
