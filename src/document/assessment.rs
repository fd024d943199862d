//! The assessment document: docs/documents.md.

use serde::{Deserialize, Serialize};

/// The answers of `assess`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct AssessmentDocument {
    pub scenario: String,
    pub horizon_s: f64,
    /// `"hard"` or `"shaped"`.
    pub sets: String,
    pub targets: Vec<TargetSectionsDocument>,
    pub points: Vec<PointDocument>,
    pub hold_course: HoldCourseDocument,
    pub alteration: AlterationDocument,
    pub velocities: Vec<VelocityDocument>,
}

/// The sets of possible positions of a target.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct TargetSectionsDocument {
    pub name: String,
    pub representation: String,
    pub sections: Vec<SectionDocument>,
}

/// A set of possible positions at one time, `[east, north]`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum SectionDocument {
    /// Counter-clockwise.
    Polygon { t_s: f64, vertices_m: Vec<[f64; 2]> },
    /// Centre and shape matrix.
    Ellipse {
        t_s: f64,
        center_m: [f64; 2],
        shape_m2: [[f64; 2]; 2],
    },
}

/// One point.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PointDocument {
    pub east_m: f64,
    pub north_m: f64,
    pub t_s: f64,
    pub targets: Vec<PointRiskDocument>,
}

/// One point and one target.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PointRiskDocument {
    pub name: String,
    pub inside: bool,
    /// Null where no scaling reaches.
    pub alpha: Option<f64>,
    pub risk: f64,
}

/// The result of holding course and speed.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct HoldCourseDocument {
    pub targets: Vec<HeldDocument>,
}

/// The result of holding course and speed with one target.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct HeldDocument {
    pub name: String,
    pub dcpa_m: f64,
    pub tcpa_s: f64,
    pub max_risk: f64,
}

/// The least alterations that leave every velocity obstacle; null where none does.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct AlterationDocument {
    pub starboard_deg: Option<f64>,
    pub port_deg: Option<f64>,
    /// Change of speed; negative is slower.
    pub speed_mps: Option<f64>,
}

/// One velocity.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct VelocityDocument {
    pub east_mps: f64,
    pub north_mps: f64,
    pub targets: Vec<ApproachDocument>,
}

/// One velocity and one target.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ApproachDocument {
    pub name: String,
    pub dcpa_m: f64,
    pub tcpa_s: f64,
    pub in_velocity_obstacle: bool,
}
