//! The assessment document: docs/documents.md.

use serde::{Deserialize, Serialize};

use crate::assessment::{Approach, Assessment};
use crate::frame::{Vector, deg_from_radians};
use crate::geometry::ConvexSet;

/// What `assess` answers.
///
/// # Examples
///
/// ```
/// use searoom::report::document::AssessmentDocument;
///
/// let text = r#"{
///     "scenario": "Give-way", "horizon_s": 400.0, "sets": "hard", "targets": [], "points": [], "velocities": [],
///     "hold_course": { "targets": [{ "name": "ferry", "dcpa_m": 0.0, "tcpa_s": 129.5, "max_risk": 1.0 }] },
///     "alteration": { "starboard_deg": 15.7, "port_deg": 20.3, "speed_mps": -1.4 }
/// }"#;
/// let read: AssessmentDocument = serde_json::from_str(text)?;
/// assert_eq!(read.hold_course.targets[0].max_risk, 1.0);
/// assert_eq!(read.alteration.starboard_deg, Some(15.7));
/// # Ok::<(), serde_json::Error>(())
/// ```
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
///
/// # Examples
///
/// ```
/// use searoom::report::document::TargetSectionsDocument;
///
/// let text = r#"{ "name": "ferry", "representation": "polytope", "sections": [
///     { "t_s": 60.0, "vertices_m": [[0.0, 0.0], [10.0, 0.0], [0.0, 10.0]] }] }"#;
/// let read: TargetSectionsDocument = serde_json::from_str(text)?;
/// assert_eq!((read.name.as_str(), read.sections.len()), ("ferry", 1));
/// # Ok::<(), serde_json::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[expect(missing_docs, reason = "docs/documents.md says what each key means")]
pub struct TargetSectionsDocument {
    pub name: String,
    pub representation: String,
    pub sections: Vec<SectionDocument>,
}

/// The set at one time, `[east, north]`.
///
/// # Examples
///
/// ```
/// use searoom::report::document::SectionDocument;
///
/// let text = r#"{ "t_s": 60.0, "center_m": [5.0, 0.0], "shape_m2": [[100.0, 0.0], [0.0, 25.0]] }"#;
/// let read: SectionDocument = serde_json::from_str(text)?;
/// assert!(matches!(read, SectionDocument::Ellipse { t_s: 60.0, .. }));
/// # Ok::<(), serde_json::Error>(())
/// ```
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
///
/// # Examples
///
/// ```
/// use searoom::report::document::PointDocument;
///
/// let text = r#"{ "east_m": 750.0, "north_m": 0.0, "t_s": 150.0, "targets": [
///     { "name": "ferry", "inside": true, "alpha": 0.0, "risk": 1.0 }] }"#;
/// let read: PointDocument = serde_json::from_str(text)?;
/// assert!(read.targets.iter().all(|target| target.inside));
/// # Ok::<(), serde_json::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[expect(missing_docs, reason = "the names are the units")]
pub struct PointDocument {
    pub east_m: f64,
    pub north_m: f64,
    pub t_s: f64,
    pub targets: Vec<PointRiskDocument>,
}

/// One point and one target.
///
/// # Examples
///
/// ```
/// use searoom::report::document::PointRiskDocument;
///
/// let text = r#"{ "name": "ferry", "inside": false, "alpha": 1.5, "risk": 0.0 }"#;
/// let read: PointRiskDocument = serde_json::from_str(text)?;
/// // the velocities would have to spread half as wide again
/// assert_eq!((read.alpha, read.risk), (Some(1.5), 0.0));
/// # Ok::<(), serde_json::Error>(())
/// ```
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
///
/// # Examples
///
/// ```
/// use searoom::report::document::HoldCourseDocument;
///
/// let text = r#"{ "targets": [{ "name": "ferry", "dcpa_m": 0.0, "tcpa_s": 129.5, "max_risk": 1.0 }] }"#;
/// let read: HoldCourseDocument = serde_json::from_str(text)?;
/// assert_eq!(read.targets.len(), 1);
/// # Ok::<(), serde_json::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[expect(missing_docs, reason = "the name says it")]
pub struct HoldCourseDocument {
    pub targets: Vec<HeldDocument>,
}

/// Course and speed held, one target.
///
/// # Examples
///
/// ```
/// use searoom::report::document::HeldDocument;
///
/// let text = r#"{ "name": "ferry", "dcpa_m": 0.0, "tcpa_s": 129.5, "max_risk": 1.0 }"#;
/// let read: HeldDocument = serde_json::from_str(text)?;
/// assert!(read.dcpa_m <= 0.0 && read.tcpa_s < 130.0);
/// # Ok::<(), serde_json::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[expect(missing_docs, reason = "the names are the units")]
pub struct HeldDocument {
    pub name: String,
    pub dcpa_m: f64,
    pub tcpa_s: f64,
    pub max_risk: f64,
}

/// The least alterations that leave every velocity obstacle; null where none does.
///
/// # Examples
///
/// ```
/// use searoom::report::document::AlterationDocument;
///
/// let text = r#"{ "starboard_deg": 15.7, "port_deg": null, "speed_mps": -1.4 }"#;
/// let read: AlterationDocument = serde_json::from_str(text)?;
/// // no turn to port leaves every velocity obstacle
/// assert!(read.port_deg.is_none());
/// # Ok::<(), serde_json::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[expect(missing_docs, reason = "the names are the units")]
pub struct AlterationDocument {
    pub starboard_deg: Option<f64>,
    pub port_deg: Option<f64>,
    /// Change of speed; negative is slower.
    pub speed_mps: Option<f64>,
}

/// One velocity.
///
/// # Examples
///
/// ```
/// use searoom::report::document::VelocityDocument;
///
/// let text = r#"{ "east_mps": 4.8, "north_mps": -1.4, "targets": [
///     { "name": "ferry", "dcpa_m": 5.8, "tcpa_s": 136.7, "in_velocity_obstacle": false }] }"#;
/// let read: VelocityDocument = serde_json::from_str(text)?;
/// assert!(read.targets.iter().all(|target| !target.in_velocity_obstacle));
/// # Ok::<(), serde_json::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[expect(missing_docs, reason = "the names are the units")]
pub struct VelocityDocument {
    pub east_mps: f64,
    pub north_mps: f64,
    pub targets: Vec<ApproachDocument>,
}

/// One velocity and one target.
///
/// # Examples
///
/// ```
/// use searoom::report::document::ApproachDocument;
///
/// let text = r#"{ "name": "ferry", "dcpa_m": 5.8, "tcpa_s": 136.7, "in_velocity_obstacle": false }"#;
/// let read: ApproachDocument = serde_json::from_str(text)?;
/// assert_eq!((read.dcpa_m, read.in_velocity_obstacle), (5.8, false));
/// # Ok::<(), serde_json::Error>(())
/// ```
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
