//! What the judges of own ship's behaviour say, as documents have it.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use crate::colregs::compliance::{ComplianceReport, Measure};
use crate::frame::deg_from_radians;

/// A role and when own ship has it along the plan.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[expect(missing_docs, reason = "docs/documents.md says what each key means")]
pub struct RoleDocument {
    pub role: String,
    pub from_s: f64,
    pub until_s: f64,
}

/// A rule that is broken.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[expect(missing_docs, reason = "docs/documents.md says what each key means")]
pub struct BreachDocument {
    pub rule: String,
    pub what: String,
    pub t_s: f64,
}

/// What a monitor found.
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
