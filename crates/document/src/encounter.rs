//! Encounter with each target and own ship's compliance with the rules toward it.

use std::collections::{BTreeMap, BTreeSet};

use schemars::JsonSchema;
use serde::de::Error;
use serde::{Deserialize, Deserializer, Serialize};
use serde_json::{Map, Value};

use searoom_colregs::compliance::{ComplianceReport, Measure, Monitor, MonitorVerdict};
use searoom_colregs::{Paragraph, Role};
use searoom_geometry::frame::{Side, deg_from_radians};

/// Encounter with a target. Without a plan, its figures are null.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct EncounterDocument {
    pub target: String,
    pub role: Role,
    pub dcpa_m: Option<f64>,
    pub tcpa_s: Option<f64>,
    pub undisturbed_dcpa_m: Option<f64>,
    pub undisturbed_tcpa_s: Option<f64>,
    pub passing_side: Option<Side>,
    #[serde(default)]
    pub crosses_astern: Option<bool>,
    pub max_risk: Option<f64>,
    pub max_risk_t_s: Option<f64>,
    /// First time after the end of the plan, until the horizon, at which the nominal target meets
    /// own ship where it lies. Absent where it does not.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub met_at_rest_s: Option<f64>,
    #[serde(
        flatten,
        deserialize_with = "conduct",
        skip_serializing_if = "Option::is_none"
    )]
    pub conduct: Option<ConductDocument>,
}

/// Reads the conduct where a key of it is present. serde alone would take a wrong word for none.
fn conduct<'de, D: Deserializer<'de>>(from: D) -> Result<Option<ConductDocument>, D::Error> {
    let keys = Map::deserialize(from)?;
    let has_conduct = ["roles", "scores", "violations", "monitors"]
        .iter()
        .any(|key| keys.contains_key(*key));
    let conduct = || serde_path_to_error::deserialize(Value::from(keys)).map_err(D::Error::custom);
    has_conduct.then(conduct).transpose()
}

/// Role of own ship and its time interval along the plan.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct RoleDocument {
    pub role: Role,
    pub from_s: f64,
    pub until_s: f64,
}

/// Rule violation.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct RuleViolationDocument {
    pub rule: Paragraph,
    pub what: String,
    pub t_s: f64,
}

/// Verdict of a compliance monitor.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct MonitorDocument {
    pub monitor: Monitor,
    pub verdict: MonitorVerdict,
    pub robustness: Option<f64>,
    pub unit: Measure,
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
pub fn breaks(encounters: &[EncounterDocument]) -> Option<Vec<&'static str>> {
    let judged = || encounters.iter().filter_map(|e| e.conduct.as_ref());
    judged().next()?;
    let broken: BTreeSet<&str> = judged().flat_map(conduct_breaks).collect();
    Some(broken.into_iter().collect())
}

/// The rules and monitors that own ship breaks toward one target, sorted, each once.
pub fn conduct_breaks(conduct: &ConductDocument) -> Vec<&'static str> {
    let violated = conduct.monitors.iter();
    let violated = violated.filter(|m| m.verdict == MonitorVerdict::Violated);
    let rules = conduct.violations.iter().map(|v| v.rule.word());
    let broken = rules.chain(violated.map(|m| m.monitor.word()));
    let broken: BTreeSet<&str> = broken.collect();
    broken.into_iter().collect()
}

impl ConductDocument {
    /// Converts a compliance report; angles are in degrees.
    pub fn of(conduct: &ComplianceReport) -> Self {
        let roles = conduct.roles.iter().map(|interval| RoleDocument {
            role: interval.role,
            from_s: interval.from,
            until_s: interval.until,
        });
        let violations = conduct
            .violations
            .iter()
            .map(|violation| RuleViolationDocument {
                rule: violation.rule,
                what: violation.what.clone(),
                t_s: violation.time,
            });
        let monitors = conduct.monitors.iter().map(|finding| {
            let scale = match finding.measure {
                Measure::Angle => deg_from_radians,
                Measure::Distance | Measure::Time => |same: f64| same,
            };
            MonitorDocument {
                monitor: finding.monitor,
                verdict: finding.verdict,
                robustness: finding.robustness.map(scale).filter(|r| r.is_finite()),
                unit: finding.measure,
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
