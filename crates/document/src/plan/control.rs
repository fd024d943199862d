//! Record of the optimal-control solution.

use schemars::JsonSchema;
use serde::{Deserialize, Deserializer, Serialize};

use searoom_geometry::frame::{Side, radians_from_deg};
use searoom_geometry::words;
use searoom_model::vessel::VesselKind;

/// Ship, weights and grid, the result of every initial guess, and the homotopy classes.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ControlDocument {
    /// Not an enum: files may name one ship model by several words.
    #[serde(deserialize_with = "vessel_name")]
    pub vessel: String,
    pub force_limits: ForceLimitsDocument,
    pub state_weights: [f64; 6],
    pub control_weights: [f64; 3],
    /// Null for a start ahead at own ship's speed.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub start: Option<StartVelocityDocument>,
    pub start_intervals: usize,
    pub intervals: usize,
    pub defect: Option<f64>,
    pub enclosed_targets: Vec<String>,
    pub starts: Vec<StartAttemptDocument>,
    pub homotopy_classes: Vec<HomotopyClassDocument>,
}

/// Reads the name of a ship model. The error for what is no text lists those of this project.
fn vessel_name<'de, D: Deserializer<'de>>(from: D) -> Result<String, D::Error> {
    words::read_text(from, &VesselKind::WORDS)
}

/// Force limits, symmetric about zero.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ForceLimitsDocument {
    pub surge_n: f64,
    pub sway_n: f64,
    pub yaw_nm: f64,
}

/// Own ship's velocity at the start; starboard and clockwise are positive.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct StartVelocityDocument {
    pub surge_mps: f64,
    pub sway_mps: f64,
    pub yaw_rate_deg_per_s: f64,
}

impl StartVelocityDocument {
    /// Surge, sway to port and yaw rate to port: m/s, m/s, rad/s.
    pub fn velocity(self) -> [f64; 3] {
        let yaw_rate = radians_from_deg(-self.yaw_rate_deg_per_s);
        [self.surge_mps, -self.sway_mps, yaw_rate]
    }
}

/// Result of one initial guess.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct StartAttemptDocument {
    /// Not an enum: the kind of guess with its number.
    pub start: String,
    /// A sentence of the solver.
    pub status: String,
    pub feasible: bool,
    pub objective: Option<f64>,
    pub iterations: usize,
}

/// Plans that pass every set on the same side.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct HomotopyClassDocument {
    pub sides: Vec<Option<Side>>,
    pub objective: f64,
    pub starts: usize,
}
