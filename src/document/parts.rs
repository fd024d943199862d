//! Parts of documents.

use serde::{Deserialize, Serialize};

/// A point of the plane.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct PositionDocument {
    pub east_m: f64,
    pub north_m: f64,
}

/// Own ship and its limits, in the keys of the scenario file.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct OwnShipDocument {
    pub position: PositionDocument,
    pub course_deg: f64,
    pub speed_mps: f64,
    pub length_m: f64,
    pub beam_m: f64,
    pub turning_radius_m: f64,
    pub speeds_mps: Vec<f64>,
    pub safety_margin_m: f64,
    /// 0 without land.
    pub land_margin_m: f64,
}

/// The desired trajectory.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct MissionDocument {
    pub waypoints: Vec<PositionDocument>,
    pub leg_speeds_mps: Vec<f64>,
    /// Desired end.
    pub duration_s: f64,
    pub length_m: f64,
    /// Alternative paths; absent where there are none.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub alternatives: Vec<Vec<PositionDocument>>,
}

/// A relaxation.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct RelaxationDocument {
    pub kind: String,
    pub target: String,
    pub amount: f64,
    pub unit: String,
    /// For a set that is entered and left: nothing is claimed before. Absent elsewhere.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub until_s: Option<f64>,
}

/// The escape of a stand-on ship.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct EscapeDocument {
    pub policy: String,
    pub latest_s: f64,
    pub first_segment: usize,
    pub turn_deg: f64,
    pub speed_mps: f64,
}

/// A violation found by the independent checker.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ViolationDocument {
    pub what: String,
    pub t_s: Option<f64>,
}

/// The figures of a plan.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct CostDocument {
    pub objective: f64,
    pub space_time_error_m2: f64,
    /// Until when the space-time error is counted.
    pub space_time_error_until_s: f64,
    pub space_time_error_arc_length_m2: f64,
    pub arrived: bool,
    pub duration_s: f64,
    pub length_m: f64,
    /// Null for a plan that never arrives.
    pub delay_s: Option<f64>,
    /// The first alteration of course; null where there is none.
    #[serde(default)]
    pub first_turn: Option<TurnDocument>,
    /// Against the sets of which `obstacles` are the level sets.
    pub max_risk: f64,
    /// Null without targets.
    pub min_clearance_m: Option<f64>,
    /// Least clearance over `arrival_hold_s` after the end of the motion, own ship resting there.
    #[serde(default)]
    pub hold_clearance_m: Option<f64>,
    #[serde(default)]
    pub arrival_hold_s: f64,
    /// Least distance between own hull and land; null without land.
    pub min_land_distance_m: Option<f64>,
}

/// An alteration of course to one side.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct TurnDocument {
    pub side: String,
    /// Positive to either side.
    pub turn_deg: f64,
    /// When it begins.
    pub t_s: f64,
}

/// Statistics of the search.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct SearchStatsDocument {
    pub expanded: usize,
    pub generated: usize,
    pub edges_checked: usize,
}

/// The only figure that differs between two runs.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct TimingDocument {
    pub plan_s: f64,
}

/// A pose at a time.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct StartDocument {
    pub t_s: f64,
    pub east_m: f64,
    pub north_m: f64,
    pub course_deg: f64,
}

/// A line or an arc; starboard turns are positive.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct SegmentDocument {
    pub start: StartDocument,
    pub duration_s: f64,
    pub speed_mps: f64,
    pub turn_rate_deg_per_s: f64,
}

/// A pose at a time, with the speed from then on.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct SampleDocument {
    pub t_s: f64,
    pub east_m: f64,
    pub north_m: f64,
    pub course_deg: f64,
    pub speed_mps: f64,
    /// At the nodes of a motion under forces.
    #[serde(flatten, default, skip_serializing_if = "Option::is_none")]
    pub node: Option<NodeDocument>,
}

/// The state at a node, and the forces held until the next one; starboard and clockwise are
/// positive.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct NodeDocument {
    pub heading_deg: f64,
    pub surge_mps: f64,
    pub sway_mps: f64,
    pub yaw_rate_deg_per_s: f64,
    pub surge_n: f64,
    pub sway_n: f64,
    pub yaw_nm: f64,
}

/// A trajectory, exact and sampled: every second, or every 20,000th part of a longer one, and at
/// every start or end of a segment and every node.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct TrajectoryDocument {
    /// Null for a motion under forces.
    pub segments: Option<Vec<SegmentDocument>>,
    pub samples: Vec<SampleDocument>,
}

/// A convex set of positions.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum InitialSetDocument {
    /// Its vertices.
    Polygon {
        /// `[east, north]`, counter-clockwise.
        vertices_m: Vec<[f64; 2]>,
    },
    /// An ellipse.
    Ellipse {
        /// `[east, north]`.
        center_m: [f64; 2],
        /// The rows of the shape matrix.
        shape_m2: [[f64; 2]; 2],
    },
}

/// A convex set of velocities.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum VelocitySetDocument {
    /// Its vertices.
    Polygon {
        /// `[east, north]`, counter-clockwise.
        vertices_mps: Vec<[f64; 2]>,
    },
    /// An ellipse.
    Ellipse {
        /// `[east, north]`.
        center_mps: [f64; 2],
        /// The rows of the shape matrix.
        shape_m2_per_s2: [[f64; 2]; 2],
    },
}

/// A space-time obstacle.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ObstacleDocument {
    pub name: String,
    pub valid_s: [f64; 2],
    pub initial_set: InitialSetDocument,
    pub velocity_set: VelocitySetDocument,
}
