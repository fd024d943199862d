//! Simulation document, see docs/reference/documents.md. The closed loop fills it.

mod campaign;

pub use campaign::*;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::encounter::ConductDocument;
use super::memory::StateDocument;
use super::parts::{PositionDocument, RelaxationKind, SegmentDocument};
use super::plan::departure::SailedManoeuvreDocument;
use searoom_colregs::SteadyShip;
use searoom_geometry::ConvexPolygon;
use searoom_geometry::frame::{Pose, Vector, clockwise_deg, radians_from_deg};
use searoom_model::trajectory::GroundSegment;
use searoom_model::vessel::Hull;
use searoom_model::{BehaviourKind, SailedVessel, SensorType};

/// Format name of the simulation document.
pub const SIMULATION_FORMAT: &str = "searoom-simulation/1";

/// An alarm goes on where it is raised again within this many times between plans.
const GOES_ON: f64 = 1.5;

/// A scenario that was sailed in the closed loop. Times count from the scenario's present.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct SimulationDocument {
    pub format: String,
    pub build: String,
    pub scenario: String,
    pub settings: SimulationSettingsDocument,
    /// True without a contact with a hull or land, and where every plan was safe and in time.
    pub safe: bool,
    pub contact: bool,
    pub arrived: bool,
    /// True where it was ended before the arrival and before its time.
    pub interrupted: bool,
    /// True where it ended before its time, at the end of a plan, and own ship had not arrived.
    #[serde(default)]
    pub ends_short: bool,
    /// Straight from own ship's last place to the last waypoint.
    #[serde(default)]
    pub to_go_m: f64,
    pub duration_s: f64,
    pub targets: Vec<SimulatedTargetDocument>,
    /// Null without a map.
    #[serde(default)]
    pub land: Option<SailedLandDocument>,
    pub conduct: SailedDocument,
    pub alarms: Vec<AlarmDocument>,
    pub replans: Vec<ReplanDocument>,
    /// Own ship's motion over ground, without gaps. A ship that is steered has a segment per step or
    /// more.
    pub sailed: Vec<GroundSegmentDocument>,
    pub timing: CycleTimingDocument,
}

impl SimulationDocument {
    /// True where it ends as it should: safe, and at the last waypoint or when its time is over.
    pub fn is_success(&self) -> bool {
        self.safe && !self.ends_short
    }

    /// The alarms, each with how often it was raised and when last: one that is raised again within
    /// 1.5 times between plans goes on. In order of their first times.
    pub fn lasting_alarms(&self) -> Vec<LastingAlarm<'_>> {
        let goes_on = GOES_ON * self.settings.replan_s;
        let mut all: Vec<LastingAlarm> = Vec::new();
        for alarm in &self.alarms {
            let same = |a: &&mut LastingAlarm| {
                (a.first.alarm, &a.first.target) == (alarm.alarm, &alarm.target)
                    && alarm.t_s - a.until_s <= goes_on
            };
            match all.iter_mut().rev().find(same) {
                Some(last) => (last.count, last.until_s) = (last.count + 1, alarm.t_s),
                None => all.push(LastingAlarm {
                    first: alarm,
                    count: 1,
                    until_s: alarm.t_s,
                }),
            }
        }
        all
    }

    /// Pose of own hull and its velocity over ground at a time in seconds; `None` where nothing was
    /// sailed. O(log segments).
    pub fn own_at(&self, time: f64) -> Option<(Pose, Vector)> {
        let begun = self.sailed.partition_point(|s| s.track.start.t_s <= time);
        let last = self.sailed.get(begun.saturating_sub(1))?.segment();
        let time = time.clamp(last.track.start_time, last.track.end_time());
        Some((last.pose_at(time), last.velocity_at(time)))
    }
}

/// A line or an arc over ground.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct GroundSegmentDocument {
    #[serde(flatten)]
    pub track: SegmentDocument,
    /// Course less heading, to starboard positive; absent where own ship lies along its course.
    #[serde(default, skip_serializing_if = "super::is_zero")]
    pub crab_angle_deg: f64,
}

impl GroundSegmentDocument {
    /// The document of a segment over ground.
    pub fn of(sailed: &GroundSegment) -> Self {
        Self {
            track: SegmentDocument::of(&sailed.track),
            crab_angle_deg: clockwise_deg(sailed.crab),
        }
    }

    /// The segment over ground.
    pub fn segment(&self) -> GroundSegment {
        GroundSegment {
            track: self.track.segment(),
            crab: radians_from_deg(-self.crab_angle_deg),
        }
    }
}

impl ReplanDocument {
    /// Reasons that no target is named in.
    pub const START: &str = "start";
    pub const PERIOD: &str = "period";

    /// Events of a target, whose name follows after a colon.
    pub const ANOTHER_VELOCITY: &str = "another velocity";
    pub const ACQUIRED: &str = "acquired";

    /// Seconds before the end of a plan that ends short at which another one takes effect at the latest.
    pub const BEFORE_END_S: f64 = 2.0;
}

impl SimulatedTargetDocument {
    /// The target at a time in seconds; `None` without a track. O(log states).
    pub fn at(&self, time: f64) -> Option<SteadyShip> {
        let begun = self.track.partition_point(|state| state.at.t_s <= time);
        let (from, mut ship) = self.track.get(begun.saturating_sub(1))?.steady();
        ship.pose.position += ship.velocity() * (time - from);
        Some(ship)
    }

    /// What own ship may not touch, with the target at a pose: the hull, or an explicit set. `None`
    /// for a set that is no polygon.
    pub fn outline(&self, pose: &Pose) -> Option<ConvexPolygon> {
        let Some(corners) = &self.set_m else {
            return Some(self.hull().polygon(pose));
        };
        let corners = corners
            .iter()
            .map(|[x, y]| Vector::new(*x, *y) + pose.position);
        ConvexPolygon::hull(&corners.collect::<Vec<_>>()).ok()
    }

    /// Own hull as far as it counts toward the target: an explicit set already holds it.
    pub fn own_hull(&self, own: Hull) -> Hull {
        match self.set_m {
            None => own,
            Some(_) => Hull::new(0.0, 0.0),
        }
    }

    /// The hull.
    pub fn hull(&self) -> Hull {
        Hull::new(self.length_m, self.beam_m)
    }
}

/// Several simulations, and nothing else.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SimulationsDocument {
    pub simulations: Vec<SimulationDocument>,
}

/// The document of `simulate`: of one scenario, or of several.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
#[serde(untagged)]
pub enum SimulatedDocument {
    One(Box<SimulationDocument>),
    Several(SimulationsDocument),
}

/// How the scenario was sailed.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct SimulationSettingsDocument {
    pub step_s: f64,
    /// Longest time between plans, and whether events ask for one before.
    pub replan_s: f64,
    pub replan_on_events: bool,
    pub delay_s: f64,
    pub measured_delay: bool,
    pub duration_s: f64,
    pub seed: u64,
    pub vessel: SailedVessel,
    pub current_mps: [f64; 2],
    pub current_std_mps: f64,
    pub current_known: bool,
    pub sensor: SensorType,
    /// Distance of the centres beyond which no target is seen; absent without a limit.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub sensor_range_m: Option<f64>,
    pub own_length_m: f64,
    pub own_beam_m: f64,
    /// True where the scenario has a map.
    #[serde(default)]
    pub map: bool,
}

/// A target as it was.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct SimulatedTargetDocument {
    pub name: String,
    pub behaviour: BehaviourKind,
    /// Of an explicit set, its extent east and north.
    pub length_m: f64,
    pub beam_m: f64,
    /// Corners of an explicit set about its position, east and north, metres. Own ship is a point
    /// toward it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub set_m: Option<Vec<[f64; 2]>>,
    /// Least distance of the hulls, null where it is no number; negative in overlap.
    pub least_clearance_m: Option<f64>,
    pub least_clearance_t_s: f64,
    pub contact_t_s: Option<f64>,
    /// Plans at whose start the target was outside the set of positions or of velocities that they
    /// assume.
    pub outside_sets: usize,
    /// Seconds until which own ship had not seen it, so that no plan knew of it: the duration of the
    /// simulation where it never did; absent where it knew from the start.
    #[serde(default, skip_serializing_if = "super::is_zero")]
    pub unknown_until_s: f64,
    /// The true states from which it kept course and speed until the next.
    pub track: Vec<StateDocument>,
    #[serde(flatten)]
    pub conduct: ConductDocument,
}

/// Own hull and the land.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct SailedLandDocument {
    /// Least distance of own hull from land, null where it is no number; negative on land. Infinite
    /// distances, without any land in the map, are null too, and `grounded` is then false.
    pub least_m: Option<f64>,
    pub least_t_s: f64,
    /// True where own hull touched land.
    pub grounded: bool,
    /// Every convex piece of land that could be the nearest, metres.
    pub polygons_m: Vec<Vec<[f64; 2]>>,
}

/// Own ship's conduct over the whole simulation.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct SailedDocument {
    /// Space-time error of the sailed motion and of the first plan; the latter is null where that plan
    /// ends before the last waypoint.
    pub cost_m2: f64,
    pub first_plan_cost_m2: Option<f64>,
    /// Words of the rules and monitors that the sailed motion breaks toward any target, each once.
    pub breaks: Vec<String>,
    pub turns: usize,
    pub speed_changes: usize,
    /// Own ship's departures from its mission, in order of time.
    #[serde(default)]
    pub manoeuvres: Vec<SailedManoeuvreDocument>,
    /// Plans that begin another manoeuvre before the one under way is finished.
    pub replaced_manoeuvres: usize,
    /// Those of them that turn to the other side.
    pub side_switches: usize,
    /// Plans at whose time the remainder of the last plan entered a hard set.
    pub lost_remainders: usize,
    /// Cycles without a plan.
    pub without_plan: usize,
    pub unsafe_plans: usize,
    pub largest_off_plan_m: f64,
    pub largest_off_plan_t_s: f64,
    pub within_tracking_margin: bool,
}

searoom_geometry::words! {
    /// What a navigator would be called for.
    pub enum Alarm {
        /// No measurement of a target for too long.
        Stale => "stale",
        /// A target has a velocity outside the set that the last plan assumed.
        AnotherVelocity => "another velocity than assumed",
        /// A target is where it could not be by the last plan.
        AnotherPlace => "at another place than assumed",
        /// A target leaves the set of the plan that own ship begins to follow.
        OutsideSet => "outside the set of the plan",
        /// A cycle yields no plan.
        NoPlan => "no plan",
        /// A plan took longer than the delay.
        PlanTooLate => "plan too late",
        /// A plan is not safe.
        UnsafePlan => "unsafe plan",
        /// The plan of a target that plans was cut by its deadline.
        PlanCut => "plan cut by its deadline",
        /// Own ship cannot make way against the current.
        Overpowered => "current faster than own ship",
        /// Own ship is farther off its plan than its tracking margin.
        BeyondMargin => "beyond the tracking margin",
        /// Own ship is so far off that the last plan is not remembered.
        FarOff => "far off the plan",
    }
}

/// Something that a navigator would be called for.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct AlarmDocument {
    pub t_s: f64,
    pub alarm: Alarm,
    pub target: Option<String>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub reason: Option<String>,
}

impl AlarmDocument {
    /// The alarm with its target and its reason.
    pub fn words(&self) -> String {
        let part = |part: &Option<String>, before: &str| {
            (part.as_ref()).map_or(String::new(), |part| format!("{before}{part}"))
        };
        let (target, reason) = (part(&self.target, ": "), part(&self.reason, "; "));
        format!("{}{target}{reason}", self.alarm)
    }
}

/// An alarm that is raised plan after plan.
#[derive(Debug, Clone, Copy)]
pub struct LastingAlarm<'a> {
    pub first: &'a AlarmDocument,
    pub count: usize,
    pub until_s: f64,
}

/// One cycle of planning.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ReplanDocument {
    /// Time of the data, and from which the plan holds.
    pub t_s: f64,
    pub start_t_s: f64,
    /// Time at which the plan ends; null without one.
    #[serde(default)]
    pub end_s: Option<f64>,
    /// Why it was made then, with the target of an event.
    pub reason: String,
    pub verdict: String,
    pub safe: bool,
    /// False where the plan came too late or there is none: own ship keeps the plan before.
    pub followed: bool,
    pub keeps_plan: bool,
    /// Metres of the mission after the intermediate end of the plan; 0 for a plan to the last waypoint.
    #[serde(default)]
    pub left_out_m: f64,
    pub cost_m2: Option<f64>,
    pub relaxations: Vec<RelaxationKind>,
    /// First turn of the manoeuvre that is under way or planned, positive to starboard.
    pub turn_deg: Option<f64>,
    pub off_plan_m: f64,
    pub outside_velocities: Vec<String>,
    pub outside_places: Vec<String>,
    /// The targets that the plan assumes, at its start: those that own ship has seen.
    pub estimates: Vec<EstimateDocument>,
}

/// A target as a plan assumes it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct EstimateDocument {
    pub target: String,
    pub age_s: f64,
    pub stale: bool,
    /// Where it is at the time of the data.
    pub true_position: PositionDocument,
    pub position: PositionDocument,
    pub course_deg: f64,
    pub speed_mps: f64,
    /// The hull, or a larger one where heading or size are not reported.
    pub length_m: f64,
    pub beam_m: f64,
    pub position_std_m: f64,
    pub speed_spread_mps: f64,
    pub course_spread_deg: f64,
    #[serde(default)]
    pub starboard_turn_deg: f64,
}

/// Wall clock, the only values that differ between two runs.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct CycleTimingDocument {
    pub plan_s: Vec<f64>,
}

impl CycleTimingDocument {
    /// The time below which the fraction `p` of the plans took, milliseconds; 0 without a plan.
    pub fn quantile_ms(&self, p: f64) -> f64 {
        let mut sorted = self.plan_s.clone();
        sorted.sort_by(f64::total_cmp);
        let last = sorted.len().saturating_sub(1);
        let index = (p * last as f64).ceil() as usize;
        sorted.get(index).map_or(0.0, |s| s * 1e3)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use searoom_model::trajectory::Segment;

    #[test]
    fn the_crab_angle_is_the_course_less_the_heading_to_starboard() {
        // toward north, heading 10° to starboard of that
        let course = Pose::new(Vector::new(3.0, 4.0), radians_from_deg(90.0));
        let sailed = GroundSegment {
            track: Segment::straight(course, 2.0, 5.0, 3.0),
            crab: radians_from_deg(10.0),
        };
        let document = GroundSegmentDocument::of(&sailed);
        assert_eq!(document.track.start.course_deg, 0.0);
        assert!((document.crab_angle_deg + 10.0).abs() < 1e-12);
        let heading = document.segment().pose_at(4.0).heading;
        assert!((heading - radians_from_deg(80.0)).abs() < 1e-12);
    }
}
