//! Targets of a plan, required to verify a document alone.

pub(super) mod sets;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::parts::PositionDocument;
use searoom_geometry::frame::{
    Pose, course_deg_from_heading, deg_from_radians, heading_from_course_deg, radians_from_deg,
};
use searoom_geometry::{ConvexPolygon, ConvexSet};
use searoom_input::Fault;
use searoom_model::target::{
    DomainKind, KnownLeg, Representation, ShipTrack, Status, Target, TimedVelocitySet,
};
use searoom_model::vessel::Hull;
use sets::{InitialSetDocument, VelocitySetDocument};

/// Tracked ship, or the sets of an explicit target as given by the scenario.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct TargetDocument {
    pub name: String,
    pub representation: Representation,
    /// Navigational status, where it is known. No set and no role follows from it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub status: Option<Status>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub ship: Option<ShipDocument>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub initial_set: Option<InitialSetDocument>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub velocity_sets: Vec<TimedSetDocument>,
}

/// Tracked ship, with the keys of the scenario file.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ShipDocument {
    pub position: PositionDocument,
    pub course_deg: f64,
    pub speed_mps: f64,
    pub length_m: f64,
    pub beam_m: f64,
    pub position_std_m: f64,
    #[serde(default, skip_serializing_if = "super::is_zero")]
    pub speed_std_mps: f64,
    #[serde(default, skip_serializing_if = "super::is_zero")]
    pub course_std_deg: f64,
    pub speed_spread_mps: f64,
    pub course_spread_deg: f64,
    #[serde(default)]
    pub starboard_turn_deg: f64,
    pub turn_rate_deg_per_s: f64,
    /// How far the hull may be turned from the course to either side; absent where that is as far as
    /// the course may be.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub heading_spread_deg: Option<f64>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub kept_positions: Option<InitialSetDocument>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub kept_velocities: Option<VelocitySetDocument>,
    /// The known route from the position on.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub route: Vec<KnownLegDocument>,
    /// How much earlier or later the ship may turn than its speed says.
    #[serde(default, skip_serializing_if = "super::is_zero")]
    pub time_spread_s: f64,
    /// Own ship alters for the ship though it passes beyond the limits: there is risk of collision up
    /// to this distance of the centres.
    #[serde(default, skip_serializing_if = "super::is_zero")]
    pub cpa_limit_m: f64,
}

/// Leg of a known route.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct KnownLegDocument {
    pub to: PositionDocument,
    pub speed_mps: f64,
}

/// Velocity set with the end of its time interval.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct TimedSetDocument {
    pub until_s: Option<f64>,
    #[serde(flatten)]
    pub set: VelocitySetDocument,
}

impl TargetDocument {
    /// The document of a target.
    pub fn of(target: &Target) -> Self {
        let timed = |timed: &TimedVelocitySet| TimedSetDocument {
            until_s: timed.until.is_finite().then_some(timed.until),
            set: (&timed.velocities).into(),
        };
        let sets = target.sets();
        Self {
            name: target.name.clone(),
            representation: target.representation,
            status: target.status,
            ship: target.ship().map(ship),
            initial_set: sets.map(|sets| (&sets.initial).into()),
            velocity_sets: sets
                .map_or_else(Vec::new, |sets| sets.velocities.iter().map(timed).collect()),
        }
    }
}

fn ship(track: &ShipTrack) -> ShipDocument {
    ShipDocument {
        position: PositionDocument::of(track.pose.position),
        course_deg: course_deg_from_heading(track.pose.heading),
        speed_mps: track.speed,
        length_m: track.hull.length,
        beam_m: track.hull.beam,
        position_std_m: track.position_std,
        speed_std_mps: track.speed_std,
        course_std_deg: deg_from_radians(track.course_std),
        speed_spread_mps: track.speed_spread,
        course_spread_deg: deg_from_radians(track.course_spread),
        starboard_turn_deg: deg_from_radians(track.starboard_turn),
        turn_rate_deg_per_s: deg_from_radians(track.turn_rate.abs()),
        heading_spread_deg: track.heading_spread.map(deg_from_radians),
        kept_positions: (track.kept_positions.clone()).map(|set| (&ConvexSet::from(set)).into()),
        kept_velocities: (track.kept_velocities.clone()).map(|set| (&ConvexSet::from(set)).into()),
        route: (track.route.iter())
            .map(|leg| KnownLegDocument {
                to: PositionDocument::of(leg.to),
                speed_mps: leg.speed,
            })
            .collect(),
        time_spread_s: track.time_spread,
        cpa_limit_m: track.risk_distance,
    }
}

impl KnownLegDocument {
    fn leg(&self) -> KnownLeg {
        KnownLeg {
            to: self.to.point(),
            speed: self.speed_mps,
        }
    }
}

impl ShipDocument {
    /// The tracked ship; its domain is not in the document. The fault names a kept set that is no
    /// convex polygon; numbers are taken as they are.
    pub fn track(&self) -> Result<ShipTrack, Fault> {
        let positions = self.kept_positions.as_ref().map(InitialSetDocument::set);
        let velocities = self.kept_velocities.as_ref().map(VelocitySetDocument::set);
        Ok(ShipTrack {
            pose: Pose::new(
                self.position.point(),
                heading_from_course_deg(self.course_deg),
            ),
            speed: self.speed_mps,
            hull: Hull::new(self.length_m, self.beam_m),
            position_std: self.position_std_m,
            speed_std: self.speed_std_mps,
            course_std: radians_from_deg(self.course_std_deg),
            speed_spread: self.speed_spread_mps,
            course_spread: radians_from_deg(self.course_spread_deg),
            starboard_turn: radians_from_deg(self.starboard_turn_deg),
            turn_rate: radians_from_deg(self.turn_rate_deg_per_s),
            heading_spread: self.heading_spread_deg.map(radians_from_deg),
            kept_positions: kept("kept_positions", positions)?,
            kept_velocities: kept("kept_velocities", velocities)?,
            route: self.route.iter().map(KnownLegDocument::leg).collect(),
            time_spread: self.time_spread_s,
            risk_distance: self.cpa_limit_m,
            domain: DomainKind::Hull,
        })
    }
}

/// A polygon that earlier plans leave of a ship's positions or velocities.
fn kept(key: &str, set: Option<Result<ConvexSet, Fault>>) -> Result<Option<ConvexPolygon>, Fault> {
    match set.transpose() {
        Ok(Some(ConvexSet::Polygon(polygon))) => Ok(Some(polygon)),
        Ok(Some(ConvexSet::Ellipse(_))) => Err(Fault::new(key, "an ellipse", "a polygon")),
        Ok(None) => Ok(None),
        Err(fault) => Err(Fault::new(key, fault.found, fault.allowed)),
    }
}
