//! Targets of a plan, required to verify a document alone.

use serde::{Deserialize, Serialize};

use super::parts::{InitialSetDocument, PositionDocument, VelocitySetDocument};
use super::plan::{plain, rows, vertices};
use crate::frame::{course_deg_from_heading, deg_from_radians};
use crate::geometry::ConvexSet;
use crate::target::{ShipTrack, Target, TimedVelocitySet};

/// Tracked ship, or the sets of an explicit target as given by the scenario.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct TargetDocument {
    pub name: String,
    pub representation: String,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub ship: Option<ShipDocument>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub initial_set: Option<InitialSetDocument>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub velocity_sets: Vec<TimedSetDocument>,
}

/// Tracked ship, with the keys of the scenario file.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ShipDocument {
    pub position: PositionDocument,
    pub course_deg: f64,
    pub speed_mps: f64,
    pub length_m: f64,
    pub beam_m: f64,
    pub position_std_m: f64,
    pub speed_spread_mps: f64,
    pub course_spread_deg: f64,
    #[serde(default)]
    pub starboard_turn_deg: f64,
    pub turn_rate_deg_per_s: f64,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub kept_positions: Option<InitialSetDocument>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub kept_velocities: Option<VelocitySetDocument>,
}

/// Velocity set with the end of its time interval.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct TimedSetDocument {
    pub until_s: Option<f64>,
    #[serde(flatten)]
    pub set: VelocitySetDocument,
}

/// Builds the document of a target.
pub(super) fn target(target: &Target) -> TargetDocument {
    let timed = |timed: &TimedVelocitySet| TimedSetDocument {
        until_s: timed.until.is_finite().then_some(timed.until),
        set: velocity_set(&timed.velocities),
    };
    let sets = target.sets();
    TargetDocument {
        name: target.name.clone(),
        representation: target.representation.word().to_owned(),
        ship: target.ship().map(ship),
        initial_set: sets.map(|sets| initial_set(&sets.initial)),
        velocity_sets: sets
            .map_or_else(Vec::new, |sets| sets.velocities.iter().map(timed).collect()),
    }
}

fn ship(track: &ShipTrack) -> ShipDocument {
    let [east_m, north_m] = plain(track.pose.position);
    ShipDocument {
        position: PositionDocument { east_m, north_m },
        course_deg: course_deg_from_heading(track.pose.heading),
        speed_mps: track.speed,
        length_m: track.hull.length,
        beam_m: track.hull.beam,
        position_std_m: track.position_std,
        speed_spread_mps: track.speed_spread,
        course_spread_deg: deg_from_radians(track.course_spread),
        starboard_turn_deg: deg_from_radians(track.starboard_turn),
        turn_rate_deg_per_s: deg_from_radians(track.turn_rate.abs()),
        kept_positions: (track.kept_positions.as_ref())
            .map(|set| initial_set(&ConvexSet::from(set.clone()))),
        kept_velocities: (track.kept_velocities.as_ref())
            .map(|set| velocity_set(&ConvexSet::from(set.clone()))),
    }
}

pub(crate) fn initial_set(set: &ConvexSet) -> InitialSetDocument {
    match set {
        ConvexSet::Polygon(set) => InitialSetDocument::Polygon {
            vertices_m: vertices(set),
        },
        ConvexSet::Ellipse(set) => InitialSetDocument::Ellipse {
            center_m: plain(set.center()),
            shape_m2: rows(set),
        },
    }
}

pub(super) fn velocity_set(set: &ConvexSet) -> VelocitySetDocument {
    match set {
        ConvexSet::Polygon(set) => VelocitySetDocument::Polygon {
            vertices_mps: vertices(set),
        },
        ConvexSet::Ellipse(set) => VelocitySetDocument::Ellipse {
            center_mps: plain(set.center()),
            shape_m2_per_s2: rows(set),
        },
    }
}
