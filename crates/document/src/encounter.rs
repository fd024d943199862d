//! Encounter with each target and own ship's compliance with the rules toward it.

use std::collections::{BTreeMap, BTreeSet};

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use searoom_colregs::compliance::{ComplianceReport, Measure, MonitorVerdict};
use searoom_geometry::frame::deg_from_radians;

/// Encounter with a target. Without a plan, its figures are null.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct EncounterDocument {
    pub target: String,
    pub role: String,
    pub dcpa_m: Option<f64>,
    pub tcpa_s: Option<f64>,
    pub undisturbed_dcpa_m: Option<f64>,
    pub undisturbed_tcpa_s: Option<f64>,
    pub passing_side: Option<String>,
    #[serde(default)]
    pub crosses_astern: Option<bool>,
    pub max_risk: Option<f64>,
    pub max_risk_t_s: Option<f64>,
    /// First time after the end of the plan, until the horizon, at which the nominal target meets
    /// own ship where it lies. Absent where it does not.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub met_at_rest_s: Option<f64>,
    #[serde(flatten, skip_serializing_if = "Option::is_none")]
    pub conduct: Option<ConductDocument>,
}

/// Role of own ship and its time interval along the plan.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct RoleDocument {
    pub role: String,
    pub from_s: f64,
    pub until_s: f64,
}

/// Rule violation.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct RuleViolationDocument {
    pub rule: String,
    pub what: String,
    pub t_s: f64,
}

/// Verdict of a compliance monitor.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct MonitorDocument {
    pub monitor: String,
    pub verdict: String,
    pub robustness: Option<f64>,
    pub unit: String,
    pub t_s: Option<f64>,
}

/// Own ship's behaviour toward one target along the plan.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ConductDocument {
    pub roles: Vec<RoleDocument>,
    pub scores: BTreeMap<String, f64>,
    pub violations: Vec<RuleViolationDocument>,
    pub monitors: Vec<MonitorDocument>,
    /// Null without a role.
    #[serde(default)]
    pub manoeuvre: Option<ManoeuvreDocument>,
}

/// Own ship's alterations in its first role toward a target, until the closest approach.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ManoeuvreDocument {
    /// Time from the first alteration to the closest approach that it changes; null without one.
    pub lead_s: Option<f64>,
    pub turns: usize,
    pub smallest_turn_deg: Option<f64>,
    pub speed_changes: usize,
}

/// The rules and monitors that a plan breaks toward any target, sorted, each once. `None` where
/// nothing is judged: without a plan, and without a target that is a ship.
pub fn breaks(encounters: &[EncounterDocument]) -> Option<Vec<&str>> {
    let judged = || encounters.iter().filter_map(|e| e.conduct.as_ref());
    judged().next()?;
    let broken: BTreeSet<&str> = judged().flat_map(conduct_breaks).collect();
    Some(broken.into_iter().collect())
}

/// The rules and monitors that own ship breaks toward one target, sorted, each once.
pub fn conduct_breaks(conduct: &ConductDocument) -> Vec<&str> {
    let violated = conduct.monitors.iter();
    let violated = violated.filter(|m| m.verdict == MonitorVerdict::Violated.word());
    let rules = conduct.violations.iter().map(|v| v.rule.as_str());
    let broken = rules.chain(violated.map(|m| m.monitor.as_str()));
    let broken: BTreeSet<&str> = broken.collect();
    broken.into_iter().collect()
}

impl ConductDocument {
    /// Converts a compliance report; angles are in degrees.
    pub fn of(conduct: &ComplianceReport) -> Self {
        let roles = conduct.roles.iter().map(|interval| RoleDocument {
            role: interval.role.word().to_owned(),
            from_s: interval.from,
            until_s: interval.until,
        });
        let violations = conduct
            .violations
            .iter()
            .map(|violation| RuleViolationDocument {
                rule: violation.rule.to_owned(),
                what: violation.what.clone(),
                t_s: violation.time,
            });
        let monitors = conduct.monitors.iter().map(|finding| {
            let (unit, scale): (_, fn(f64) -> f64) = match finding.measure {
                Measure::Distance => ("m", |metres| metres),
                Measure::Angle => ("deg", deg_from_radians),
                Measure::Time => ("s", |seconds| seconds),
            };
            MonitorDocument {
                monitor: finding.monitor.to_owned(),
                verdict: finding.verdict.word().to_owned(),
                robustness: finding.robustness.map(scale).filter(|r| r.is_finite()),
                unit: unit.to_owned(),
                t_s: finding.time,
            }
        });
        Self {
            roles: roles.collect(),
            scores: (conduct.scores.by_name().into_iter())
                .map(|(name, score)| (name.to_owned(), score))
                .collect(),
            violations: violations.collect(),
            monitors: monitors.collect(),
            manoeuvre: conduct.manoeuvre.map(|m| ManoeuvreDocument {
                lead_s: m.lead.filter(|lead| lead.is_finite()),
                turns: m.turns,
                smallest_turn_deg: m.smallest_turn.map(deg_from_radians),
                speed_changes: m.speed_changes,
            }),
        }
    }
}
