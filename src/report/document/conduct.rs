//! What the judges of own ship's behaviour say, as documents have it.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use crate::colregs::compliance::{ComplianceReport, Measure};
use crate::frame::deg_from_radians;

/// A role and when own ship has it along the plan.
///
/// # Examples
///
/// ```
/// use searoom::report::document::RoleDocument;
///
/// let text = r#"{ "role": "give-way", "from_s": 0.0, "until_s": 98.0 }"#;
/// let read: RoleDocument = serde_json::from_str(text)?;
/// assert!(read.role == "give-way" && read.from_s < read.until_s);
/// # Ok::<(), serde_json::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[expect(missing_docs, reason = "docs/documents.md says what each key means")]
pub struct RoleDocument {
    pub role: String,
    pub from_s: f64,
    pub until_s: f64,
}

/// A rule that is broken.
///
/// # Examples
///
/// ```
/// use searoom::report::document::BreachDocument;
///
/// let text = r#"{ "rule": "17(c)", "what": "heads to port of her first course before she has passed", "t_s": 89.0 }"#;
/// let read: BreachDocument = serde_json::from_str(text)?;
/// assert_eq!((read.rule.as_str(), read.t_s), ("17(c)", 89.0));
/// # Ok::<(), serde_json::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[expect(missing_docs, reason = "docs/documents.md says what each key means")]
pub struct BreachDocument {
    pub rule: String,
    pub what: String,
    pub t_s: f64,
}

/// What a monitor found.
///
/// # Examples
///
/// ```
/// use searoom::report::document::MonitorDocument;
///
/// let text = r#"{ "monitor": "S", "verdict": "satisfied", "robustness": 218.9, "unit": "m", "t_s": 136.0 }"#;
/// let read: MonitorDocument = serde_json::from_str(text)?;
/// // never nearer than that, the moment at which it was so near
/// assert_eq!((read.robustness, read.t_s), (Some(218.9), Some(136.0)));
/// # Ok::<(), serde_json::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[expect(missing_docs, reason = "docs/documents.md says what each key means")]
pub struct MonitorDocument {
    pub monitor: String,
    pub verdict: String,
    pub robustness: Option<f64>,
    pub unit: String,
    pub t_s: Option<f64>,
}

/// Own ship toward one target along the plan.
///
/// # Examples
///
/// ```
/// # use searoom::{pipeline, scenario::Scenario};
/// use searoom::report::document::{PlanDocument, ConductDocument};
///
/// let scenario = Scenario::read("scenarios/colregs/give-way.toml".as_ref())?;
/// let plan = PlanDocument::of(&pipeline::run(scenario));
/// let conduct: &ConductDocument = plan.encounters[0].conduct.as_ref().expect("a plan among ships");
/// assert!(conduct.breaches.is_empty() && conduct.scores["safety"] > 0.9);
/// # Ok::<(), searoom::scenario::ScenarioError>(())
/// ```
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[expect(missing_docs, reason = "docs/documents.md says what each key means")]
pub struct ConductDocument {
    pub roles: Vec<RoleDocument>,
    pub scores: BTreeMap<String, f64>,
    pub breaches: Vec<BreachDocument>,
    pub monitors: Vec<MonitorDocument>,
}

impl ConductDocument {
    /// Angles in degrees.
    pub(super) fn of(conduct: &ComplianceReport) -> Self {
        let scores = conduct.scores.by_name();
        Self {
            roles: conduct
                .roles
                .iter()
                .map(|spell| RoleDocument {
                    role: spell.role.name().to_owned(),
                    from_s: spell.from,
                    until_s: spell.until,
                })
                .collect(),
            scores: scores
                .into_iter()
                .map(|(name, score)| (name.to_owned(), score))
                .collect(),
            breaches: conduct
                .violations
                .iter()
                .map(|breach| BreachDocument {
                    rule: breach.rule.to_owned(),
                    what: breach.what.clone(),
                    t_s: breach.time,
                })
                .collect(),
            monitors: conduct
                .monitors
                .iter()
                .map(|finding| {
                    let (unit, scale): (_, fn(f64) -> f64) = match finding.measure {
                        Measure::Distance => ("m", |metres| metres),
                        Measure::Angle => ("deg", deg_from_radians),
                        Measure::Time => ("s", |seconds| seconds),
                    };
                    MonitorDocument {
                        monitor: finding.monitor.to_owned(),
                        verdict: finding.verdict.name().to_owned(),
                        robustness: finding.robustness.map(scale).filter(|r| r.is_finite()),
                        unit: unit.to_owned(),
                        t_s: finding.time,
                    }
                })
                .collect(),
        }
    }
}
