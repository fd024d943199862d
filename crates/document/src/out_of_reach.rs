//! Part of the plan document on targets out of reach, see docs/reference/documents.md.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Targets that the plan does not consider: none of them comes near own ship.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct OutOfReachDocument {
    /// Number of the scenario's targets: these and those in `targets` of the plan.
    pub of_targets: usize,
    /// Seconds from t = 0, not before the horizon.
    pub until_s: f64,
    /// Lower bound until then of the distance between the hulls, less own safety margin, metres.
    pub apart_m: f64,
    /// In the order of the scenario.
    pub rows: Vec<DistantRow>,
}

/// A target in one line: its name; east and north at t = 0, metres; its greatest speed, m/s; the
/// radius about that place which holds its hull at t = 0, metres.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct DistantRow(pub String, pub f64, pub f64, pub f64, pub f64);
