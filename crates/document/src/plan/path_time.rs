//! Diagram of a path-time plan, see docs/reference/documents.md.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Path-time diagram; points are `[s_m, t_s]`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct PathTimeDocument {
    /// Not an enum: an alternative has a number.
    pub path: String,
    pub legs: Vec<PathLegDocument>,
    pub obstacles: Vec<PathObstacleDocument>,
    pub corners: Vec<PathCornerDocument>,
    pub profile: Vec<[f64; 2]>,
}

/// Leg of the planned path.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct PathLegDocument {
    pub start_m: f64,
    pub end_m: f64,
    pub path: String,
}

/// Obstacle on a leg, clipped to the leg and the horizon.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct PathObstacleDocument {
    pub target: String,
    pub leg: usize,
    pub vertices: Vec<[f64; 2]>,
}

/// Corner of the path, exempt from the turning radius. The hull covers both headings there.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct PathCornerDocument {
    pub s_m: f64,
    pub turn_deg: f64,
}
