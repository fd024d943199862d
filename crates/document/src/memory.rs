//! Memory that a plan leaves to the next one: own ship's motion so far, the targets' tracks, roles,
//! and the plan that own ship follows.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::parts::{SegmentDocument, StartDocument};
use searoom_colregs::{Risk, Role, SteadyShip};

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
    pub role: Role,
    pub own_ship: StateDocument,
    pub target: StateDocument,
}

impl KnownRoleDocument {
    /// The role; `None` without a rule.
    pub fn risk(&self) -> Option<Risk> {
        self.role.rule()?;
        let (time, own) = self.own_ship.steady();
        Some(Risk {
            role: self.role,
            time,
            own,
            target: self.target.steady().1,
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

impl StateDocument {
    /// The document of a ship at a time, seconds.
    pub fn of(time: f64, ship: &SteadyShip) -> Self {
        Self {
            at: StartDocument::of(ship.pose, time),
            speed_mps: ship.speed,
        }
    }

    /// The time, seconds, and the ship.
    pub fn steady(&self) -> (f64, SteadyShip) {
        let ship = SteadyShip::new(self.at.pose(), self.speed_mps);
        (self.at.t_s, ship)
    }
}
