//! Memory that a plan leaves to the next one: own ship's motion so far, the targets' tracks, roles,
//! and the plan that own ship follows.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::parts::{SegmentDocument, StartDocument};
use super::plan::{segment_document, start};
use crate::colregs::{Risk, Role, SteadyShip};
use crate::frame::{
    clockwise_deg, course_deg_from_heading, heading_from_course_deg, radians_from_deg,
};
use crate::pipeline::Run;
use crate::planner::PlannedManoeuvre;

/// Memory from before the plan. Times count from the plan, and are negative.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct MemoryDocument {
    /// True where the plan is the remainder of the previous one.
    pub keeps_plan: bool,
    /// Distance of own ship from the previous plan, at most the tracking margin. The plan begins on
    /// the previous one.
    #[serde(default, skip_serializing_if = "super::is_zero")]
    pub off_plan_m: f64,
    /// Names of the targets that have a velocity outside the set which the previous plan assumed.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub outside_velocities: Vec<String>,
    /// Names of the targets at a place which they could not reach by the previous plan.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub outside_places: Vec<String>,
    /// Names of the previous plan's targets that the scenario has not.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub missing: Vec<String>,
    pub sailed: Vec<SegmentDocument>,
    pub targets: Vec<TargetMemoryDocument>,
}

/// Memory of one target from before the plan.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct TargetMemoryDocument {
    pub name: String,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub role: Option<KnownRoleDocument>,
    #[serde(default)]
    pub passed: bool,
    pub track: Vec<StateDocument>,
}

/// A role that own ship has had since before the plan, and both ships when it began.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct KnownRoleDocument {
    pub role: String,
    pub own_ship: StateDocument,
    pub target: StateDocument,
}

impl KnownRoleDocument {
    /// The role, with times that count from `elapsed` seconds later; `None` for an unknown name.
    pub(crate) fn risk(&self, elapsed: f64) -> Option<Risk> {
        let (_, role) = Role::with_rule().find(|(word, _)| *word == self.role)?;
        let (time, own) = steady(&self.own_ship, elapsed);
        Some(Risk {
            role,
            time,
            own,
            target: steady(&self.target, elapsed).1,
        })
    }
}

/// A ship at a time.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct StateDocument {
    #[serde(flatten)]
    pub at: StartDocument,
    pub speed_mps: f64,
}

/// A manoeuvre by the rules.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct PlannedManoeuvreDocument {
    pub begins_s: f64,
    pub returns_s: f64,
    pub joins_s: f64,
    pub first_course_deg: f64,
    pub turn_deg: f64,
}

impl MemoryDocument {
    /// The memory of a run; `None` where nothing was known.
    pub(super) fn of(run: &Run) -> Option<Self> {
        let memory = &run.scenario.memory;
        let known = !memory.sailed.is_empty() || !memory.targets.is_empty();
        let targets = run.scenario.targets.iter().zip(&memory.targets);
        known.then(|| Self {
            keeps_plan: run.planned.is_remainder(),
            off_plan_m: memory.off_plan,
            outside_velocities: memory.outside_velocities.clone(),
            outside_places: memory.outside_places.clone(),
            missing: memory.missing.clone(),
            sailed: memory.sailed.iter().map(segment_document).collect(),
            targets: targets
                .map(|(target, known)| TargetMemoryDocument {
                    name: target.name.clone(),
                    role: known.role.as_ref().map(|risk| KnownRoleDocument {
                        role: risk.role.word().to_owned(),
                        own_ship: state_document(risk.time, &risk.own),
                        target: state_document(risk.time, &risk.target),
                    }),
                    passed: known.passed,
                    track: (known.track.iter())
                        .map(|(time, ship)| state_document(*time, ship))
                        .collect(),
                })
                .collect(),
        })
    }
}

impl From<&PlannedManoeuvre> for PlannedManoeuvreDocument {
    fn from(manoeuvre: &PlannedManoeuvre) -> Self {
        Self {
            begins_s: manoeuvre.begins,
            returns_s: manoeuvre.returns,
            joins_s: manoeuvre.joins,
            first_course_deg: course_deg_from_heading(manoeuvre.first_heading),
            turn_deg: clockwise_deg(manoeuvre.turn),
        }
    }
}

impl From<&PlannedManoeuvreDocument> for PlannedManoeuvre {
    fn from(document: &PlannedManoeuvreDocument) -> Self {
        Self {
            begins: document.begins_s,
            returns: document.returns_s,
            joins: document.joins_s,
            first_heading: heading_from_course_deg(document.first_course_deg),
            turn: -radians_from_deg(document.turn_deg),
        }
    }
}

pub(crate) fn state_document(time: f64, ship: &SteadyShip) -> StateDocument {
    StateDocument {
        at: start(ship.pose, time),
        speed_mps: ship.speed,
    }
}

/// The state of a ship, at a time that counts from `elapsed` seconds later.
pub(crate) fn steady(state: &StateDocument, elapsed: f64) -> (f64, SteadyShip) {
    let ship = SteadyShip::new(state.at.pose(), state.speed_mps);
    (state.at.t_s - elapsed, ship)
}
