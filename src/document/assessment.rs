//! The assessment document: docs/documents.md.

use serde::{Deserialize, Serialize};

use crate::frame::{Vector, deg_from_radians};
use crate::geometry::ConvexSet;
use crate::study::assess::{Approach, Assessment};

/// What `assess` answers.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[expect(missing_docs, reason = "docs/documents.md says what each key means")]
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

/// Where a target may be.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[expect(missing_docs, reason = "docs/documents.md says what each key means")]
pub struct TargetSectionsDocument {
    pub name: String,
    pub representation: String,
    pub sections: Vec<SectionDocument>,
}

/// The set at one time, `[east, north]`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
#[expect(missing_docs, reason = "the names are the units")]
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
#[expect(missing_docs, reason = "the names are the units")]
pub struct PointDocument {
    pub east_m: f64,
    pub north_m: f64,
    pub t_s: f64,
    pub targets: Vec<PointRiskDocument>,
}

/// One point and one target.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[expect(missing_docs, reason = "the names say it")]
pub struct PointRiskDocument {
    pub name: String,
    pub inside: bool,
    /// Null where no scaling reaches.
    pub alpha: Option<f64>,
    pub risk: f64,
}

/// Course and speed held.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[expect(missing_docs, reason = "the name says it")]
pub struct HoldCourseDocument {
    pub targets: Vec<HeldDocument>,
}

/// Course and speed held, one target.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[expect(missing_docs, reason = "the names are the units")]
pub struct HeldDocument {
    pub name: String,
    pub dcpa_m: f64,
    pub tcpa_s: f64,
    pub max_risk: f64,
}

/// The least alterations that leave every velocity obstacle; null where none does.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[expect(missing_docs, reason = "the names are the units")]
pub struct AlterationDocument {
    pub starboard_deg: Option<f64>,
    pub port_deg: Option<f64>,
    /// Change of speed; negative is slower.
    pub speed_mps: Option<f64>,
}

/// One velocity.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[expect(missing_docs, reason = "the names are the units")]
pub struct VelocityDocument {
    pub east_mps: f64,
    pub north_mps: f64,
    pub targets: Vec<ApproachDocument>,
}

/// One velocity and one target.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[expect(missing_docs, reason = "the names are the units")]
pub struct ApproachDocument {
    pub name: String,
    pub dcpa_m: f64,
    pub tcpa_s: f64,
    pub in_velocity_obstacle: bool,
}

impl AssessmentDocument {
    /// The document of an assessment; `shaped` says which sets were assessed, `horizon` is in seconds.
    pub fn of(scenario: &str, horizon: f64, shaped: bool, assessment: &Assessment) -> Self {
        let names = || assessment.targets.iter().map(|t| t.name.clone());
        let alteration = &assessment.alteration;
        let degrees = |turn: Option<f64>| turn.map(deg_from_radians);
        Self {
            scenario: scenario.to_owned(),
            horizon_s: horizon,
            sets: if shaped { "shaped" } else { "hard" }.to_owned(),
            targets: assessment
                .targets
                .iter()
                .map(|target| TargetSectionsDocument {
                    name: target.name.clone(),
                    representation: target.representation.to_owned(),
                    sections: target.sections.iter().map(section).collect(),
                })
                .collect(),
            points: assessment
                .points
                .iter()
                .map(|asked| PointDocument {
                    east_m: asked.point.position.x,
                    north_m: asked.point.position.y,
                    t_s: asked.point.time,
                    targets: names()
                        .zip(&asked.targets)
                        .map(|(name, risk)| PointRiskDocument {
                            name,
                            inside: risk.inside,
                            alpha: risk.alpha.is_finite().then_some(risk.alpha),
                            risk: risk.risk,
                        })
                        .collect(),
                })
                .collect(),
            hold_course: HoldCourseDocument {
                targets: names()
                    .zip(&assessment.hold_course)
                    .map(|(name, held)| HeldDocument {
                        name,
                        dcpa_m: held.approach.dcpa,
                        tcpa_s: held.approach.tcpa,
                        max_risk: held.max_risk,
                    })
                    .collect(),
            },
            alteration: AlterationDocument {
                starboard_deg: degrees(alteration.starboard),
                port_deg: degrees(alteration.port),
                speed_mps: alteration.speed,
            },
            velocities: assessment
                .velocities
                .iter()
                .map(|asked| VelocityDocument {
                    east_mps: asked.velocity.x,
                    north_mps: asked.velocity.y,
                    targets: names()
                        .zip(&asked.targets)
                        .map(|(name, nearest)| approach(name, nearest))
                        .collect(),
                })
                .collect(),
        }
    }
}

fn approach(name: String, nearest: &Approach) -> ApproachDocument {
    ApproachDocument {
        name,
        dcpa_m: nearest.dcpa,
        tcpa_s: nearest.tcpa,
        in_velocity_obstacle: nearest.in_velocity_obstacle,
    }
}

fn section((time, section): &(f64, ConvexSet)) -> SectionDocument {
    let pair = |p: &Vector| [p.x, p.y];
    match section {
        ConvexSet::Polygon(polygon) => SectionDocument::Polygon {
            t_s: *time,
            vertices_m: polygon.vertices().iter().map(pair).collect(),
        },
        ConvexSet::Ellipse(ellipse) => {
            let q = ellipse.shape();
            SectionDocument::Ellipse {
                t_s: *time,
                center_m: pair(&ellipse.center()),
                shape_m2: [[q[(0, 0)], q[(0, 1)]], [q[(1, 0)], q[(1, 1)]]],
            }
        }
    }
}
