//! Document of a moment of `watch`, a line each, see docs/reference/documents.md.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use searoom_model::target::Status;

/// What is around own ship at a moment, and what it should do.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct WatchDocument {
    /// Date and time, UTC.
    pub time: String,
    /// Seconds of Unix time.
    pub time_s: f64,
    /// Absent where own ship's position is not known, or too old.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub own: Option<OwnNowDocument>,
    /// Ships that may come near within the horizon, each in a set.
    pub ships: usize,
    /// How many of them the plan is clear of though it is not made for them: it enters neither their sets nor
    /// their domains.
    #[serde(default)]
    pub clear: usize,
    /// Ships too far to come near within the horizon.
    pub beyond: usize,
    /// Ships in no set, and why: not heard for too long, or heard without a place.
    pub in_no_set: Vec<String>,
    /// False where own ship is not known, or the scenario file does not fit its place: then there is no
    /// word on risk.
    pub risk_computed: bool,
    /// Ships with which there is risk of collision, the most urgent first.
    pub dangerous: Vec<DangerousShipDocument>,
    /// Where there is risk, and own ship's route is known.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub plan: Option<WatchPlanDocument>,
    /// What has happened since the last moment: connections, ships that left their sets.
    pub events: Vec<String>,
    /// How long this moment took to compute.
    pub took_s: f64,
}

/// Own ship at a moment.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct OwnNowDocument {
    pub lat_deg: f64,
    pub lon_deg: f64,
    pub course_deg: f64,
    pub speed_mps: f64,
    /// By how much it may be elsewhere.
    pub radius_m: f64,
    /// Since the last fix.
    pub age_s: f64,
}

/// A ship with which there is risk of collision.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct DangerousShipDocument {
    pub name: String,
    /// MMSI, number of a radar target, or UUID of Signal K.
    pub identity: String,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub status: Option<Status>,
    /// From own ship's middle to its middle.
    pub range_m: f64,
    /// From true north.
    pub bearing_deg: f64,
    /// Absent where the ship does not send its speed.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub course_deg: Option<f64>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub speed_mps: Option<f64>,
    /// Between the hulls when the middles are closest, and when that is, if both hold course and speed;
    /// absent where the ship does not send its speed.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub cpa_m: Option<f64>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub tcpa_s: Option<f64>,
    /// When own ship enters the ship's set if it holds course and speed; absent where it does not.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub enters_set_s: Option<f64>,
    /// Largest risk on this course, 0 outside the set.
    pub risk: f64,
    /// Own ship's role, in words.
    pub role: String,
    /// Since the last fix.
    pub age_s: f64,
    /// Why its set is wide, in words.
    pub notes: Vec<String>,
}

/// The plan of a moment, in short.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct WatchPlanDocument {
    /// In words.
    pub verdict: String,
    /// True where it is verified and safe until it ends.
    pub safe: bool,
    /// True where it leads to the end of the mission within the horizon.
    pub arrives: bool,
    /// When it ends, from now on.
    pub ends_s: f64,
    /// What the plan's own document warns of, in words.
    pub warnings: Vec<String>,
    /// Names of the targets that it is made for; it is clear of the others.
    pub planned_for: Vec<String>,
    /// True where it is what is left of the plan before.
    pub keeps_plan: bool,
    /// How old it is: it is made anew every 10 s, and at once where a ship comes near that it is not for, or
    /// leaves what it assumes.
    pub made_s_ago: f64,
    /// The next legs, from now on.
    pub legs: Vec<WatchLegDocument>,
}

/// Leg of a plan.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct WatchLegDocument {
    /// Seconds from now.
    pub from_s: f64,
    pub until_s: f64,
    pub course_deg: f64,
    pub speed_mps: f64,
    /// The target for which it alters course or speed, or `land`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub because_of: Option<String>,
    /// In order of time.
    pub events: Vec<String>,
}
