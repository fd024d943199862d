//! Parts shared by the documents.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::targets::sets::{InitialSetDocument, VelocitySetDocument};
use searoom_evaluation::Violation;
use searoom_geometry::frame::{
    Pose, Vector, clockwise_deg_per_s, course_deg_from_heading, heading_from_course_deg,
    radians_from_deg,
};
pub use searoom_model::PlanMethod;
use searoom_model::trajectory::Segment;

/// Point in the plane.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct PositionDocument {
    pub east_m: f64,
    pub north_m: f64,
}

impl PositionDocument {
    /// The document of a place.
    pub fn of(p: Vector) -> Self {
        Self {
            east_m: p.x + 0.0,
            north_m: p.y + 0.0,
        }
    }

    /// The place, metres east and north.
    pub fn point(&self) -> Vector {
        Vector::new(self.east_m, self.north_m)
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

searoom_geometry::words! {
    /// Requirement that a plan gives up.
    pub enum RelaxationKind {
        /// The rules.
        Compliance => "compliance",
        /// The ship domain of a target, reduced toward its hard set.
        Domain => "domain",
        /// The set of a target, which the plan enters.
        Risk => "risk",
        /// The arrival.
        Arrival => "arrival",
    }
}

searoom_geometry::words! {
    /// Unit of an amount.
    pub enum AmountUnit {
        /// Metres.
        Metres => "m",
        /// Fraction.
        One => "1",
    }
}

impl RelaxationKind {
    /// Unit of the amount that is given up.
    pub fn unit(self) -> AmountUnit {
        match self {
            Self::Domain | Self::Arrival => AmountUnit::Metres,
            Self::Compliance | Self::Risk => AmountUnit::One,
        }
    }
}

/// Relaxation of one constraint.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct RelaxationDocument {
    pub kind: RelaxationKind,
    pub target: String,
    pub amount: f64,
    /// That of its kind. `None` in a document that does not say so, which `verify` rejects.
    #[serde(default)]
    pub unit: Option<AmountUnit>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub until_s: Option<f64>,
}

searoom_geometry::words! {
    /// Why a plan has an escape.
    pub enum EscapePolicy {
        /// Own ship keeps course and speed, and leads out of every set from when it may act.
        StandOnHold => "stand-on-hold",
    }
}

/// Escape of a stand-on ship.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct EscapeDocument {
    pub policy: EscapePolicy,
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

impl ViolationDocument {
    /// The documents of violations, in their order.
    pub fn all(found: &[Violation]) -> Vec<Self> {
        let document = |violation: &Violation| Self {
            what: violation.what.clone(),
            t_s: finite(violation.time),
        };
        found.iter().map(document).collect()
    }
}

/// A finite number, without the sign of a zero; `None` for others, which documents write as null.
pub fn finite(value: f64) -> Option<f64> {
    // adding +0.0 converts a negative zero to zero
    value.is_finite().then_some(value + 0.0)
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
    /// The document of a pose at a time, seconds.
    pub fn of(pose: Pose, time: f64) -> Self {
        Self {
            t_s: time,
            east_m: pose.position.x + 0.0,
            north_m: pose.position.y + 0.0,
            course_deg: course_deg_from_heading(pose.heading),
        }
    }

    /// The pose.
    pub fn pose(&self) -> Pose {
        let position = Vector::new(self.east_m, self.north_m);
        Pose::new(position, heading_from_course_deg(self.course_deg))
    }
}

impl SegmentDocument {
    /// The document of a segment.
    pub fn of(segment: &Segment) -> Self {
        Self {
            start: StartDocument::of(segment.start, segment.start_time),
            duration_s: segment.duration,
            speed_mps: segment.speed,
            turn_rate_deg_per_s: clockwise_deg_per_s(segment.turn_rate),
        }
    }

    /// The segment, whose numbers are taken as they are.
    pub fn segment(&self) -> Segment {
        Segment::new(
            self.start.pose(),
            self.start.t_s,
            self.duration_s,
            self.speed_mps,
            radians_from_deg(-self.turn_rate_deg_per_s) + 0.0,
        )
    }
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
