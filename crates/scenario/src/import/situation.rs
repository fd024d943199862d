//! A traffic situation: own ship, its route, and the tracks of the others.

use searoom_geometry::ConvexPolygon;
use searoom_geometry::frame::{Georeference, Pose, Side, Vector};
use searoom_input::Remarks;
use searoom_model::vessel::Hull;

use searoom_model::target::route::Track;
use searoom_model::target::{Motion, Status, Target};

/// Seconds of a mission on a route file: the scenario takes as much of it as half the horizon holds.
const ROUTE_S: f64 = 900.0;

/// A checked situation in SI units and the east-north plane; [`Situation::scenario`] makes a
/// scenario of it.
#[derive(Debug, Clone, PartialEq)]
pub struct Situation {
    /// The title.
    pub name: String,
    /// Name of its outputs, if a file has several situations.
    pub id: Option<String>,
    /// Date and time of the present, RFC 3339.
    pub(super) start_utc: Option<String>,
    pub(super) own: Own,
    pub(super) others: Vec<Other>,
    pub(super) earth: Option<Georeference>,
    /// Statements of the file about the situation.
    pub declared: Declared,
    /// Assumptions and unused parts of the file.
    pub(super) remarks: Remarks,
}

/// Statements of a file about its situation, to be compared with the ships and never planned with.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Declared {
    /// Stated number of others.
    pub ships: Option<usize>,
    /// Stated side of own ship on which each of them is at the start; shorter if nothing is stated.
    pub sides: Vec<Option<Side>>,
}

#[derive(Debug, Clone, PartialEq)]
pub(super) struct Own {
    pub(super) pose: Pose,
    /// m/s.
    pub(super) speed: f64,
    pub(super) hull: GivenHull,
    pub(super) route: OwnRoute,
    /// Seconds by which own ship must arrive, if the format has it.
    pub(super) horizon: Option<f64>,
}

/// Where own ship is bound.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum OwnRoute {
    Points {
        /// At least two, metres.
        points: Vec<Vector>,
        /// m/s, one per leg, positive.
        leg_speeds: Vec<f64>,
    },
    /// A route file, as a scenario beside it names it.
    File(String),
}

/// The hull of a ship as a file has it.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum GivenHull {
    Known(Hull),
    /// The format has no hulls.
    NotInFormat,
    /// The file lacks it: the empty field.
    Missing(String),
    /// The file says that it is unknown, all but these: metres.
    Unknown {
        length: Option<f64>,
        beam: Option<f64>,
    },
}

/// Another ship, or an object at rest.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Other {
    Ship {
        name: String,
        hull: GivenHull,
        track: Track,
        /// Metres by which it may be off its track, everywhere on it.
        off: f64,
        status: Option<Status>,
    },
    /// A ship with its sets.
    Tracked(Box<Target>),
    /// A convex part of an object at rest, metres.
    Fixed {
        name: String,
        shape: ConvexPolygon,
        /// True for land and shallow water, to which no safety margin is kept.
        ground: bool,
    },
}

impl Other {
    /// This one moved by a vector, metres.
    pub(super) fn translated(&self, shift: Vector) -> Self {
        let mut moved = self.clone();
        match &mut moved {
            Self::Ship { track, .. } => track.translate(shift),
            Self::Fixed { shape, .. } => *shape = shape.translated(shift),
            Self::Tracked(target) => {
                if let Motion::Ship(ship) = &mut target.motion {
                    ship.pose.position += shift;
                }
            }
        }
        moved
    }
}

impl Own {
    /// This one moved by a vector, metres.
    pub(super) fn translated(&self, shift: Vector) -> Self {
        let mut moved = self.clone();
        moved.pose.position += shift;
        if let OwnRoute::Points { points, .. } = &mut moved.route {
            points.iter_mut().for_each(|point| *point += shift);
        }
        moved
    }

    /// Duration of the route, seconds.
    pub(super) fn duration(&self) -> f64 {
        let OwnRoute::Points { points, leg_speeds } = &self.route else {
            return ROUTE_S;
        };
        let lengths = points.windows(2).map(|pair| (pair[1] - pair[0]).norm());
        lengths.zip(leg_speeds).map(|(l, v)| l / v).sum()
    }
}
