//! Assessment document, see docs/reference/documents.md.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::targets::sets::InitialSetDocument;
use searoom_model::target::Representation;

searoom_geometry::words! {
    /// Sets that are assessed.
    pub enum AssessedSets {
        /// The hard sets.
        Hard => "hard",
        /// The sets with the ship domains.
        Domains => "domains",
    }
}

/// Results of `assess`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct AssessmentDocument {
    pub scenario: String,
    pub horizon_s: f64,
    pub sets: AssessedSets,
    pub targets: Vec<TargetSectionsDocument>,
    pub points: Vec<PointDocument>,
    pub hold_course: HoldCourseDocument,
    pub alteration: AlterationDocument,
    pub velocities: Vec<VelocityDocument>,
}

/// Sets of possible positions of a target.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct TargetSectionsDocument {
    pub name: String,
    pub representation: Representation,
    pub sections: Vec<SectionDocument>,
}

/// Set of possible positions at one time, `[east, north]`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct SectionDocument {
    pub t_s: f64,
    #[serde(flatten)]
    pub set: InitialSetDocument,
}

/// Risk at one point.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct PointDocument {
    pub east_m: f64,
    pub north_m: f64,
    pub t_s: f64,
    pub targets: Vec<PointRiskDocument>,
}

/// Risk of one target at one point.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct PointRiskDocument {
    pub name: String,
    pub inside: bool,
    pub alpha: Option<f64>,
    pub risk: f64,
}

/// Result of constant course and speed.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct HoldCourseDocument {
    pub targets: Vec<HeldDocument>,
}

/// Result of constant course and speed for one target.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct HeldDocument {
    pub name: String,
    pub dcpa_m: f64,
    pub tcpa_s: f64,
    pub max_risk: f64,
}

/// Least alterations that leave every velocity obstacle; null if none does.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct AlterationDocument {
    pub starboard_deg: Option<f64>,
    pub port_deg: Option<f64>,
    pub speed_mps: Option<f64>,
}

/// Closest approaches for one velocity.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct VelocityDocument {
    pub east_mps: f64,
    pub north_mps: f64,
    pub targets: Vec<ApproachDocument>,
}

/// Closest approach of one target for one velocity.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ApproachDocument {
    pub name: String,
    pub dcpa_m: f64,
    pub tcpa_s: f64,
    pub in_velocity_obstacle: bool,
}
