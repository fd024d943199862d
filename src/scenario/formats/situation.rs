//! A traffic situation as every foreign format has it: own ship, her route, and the tracks of the others.

use crate::frame::{Georeference, Pose, Side, Vector};
use crate::geometry::ConvexPolygon;
use crate::vessel::Hull;

use super::track::Track;

/// A situation read from a foreign file, checked, SI and east-north. [`Situation::scenario`](super::Situation::scenario)
/// makes a scenario of it.
///
/// # Examples
///
/// ```
/// use searoom::scenario::formats::{Assumed, Contents, Situation};
///
/// let Contents::Situations { mut situations, .. } =
///     Contents::read("scenarios/imazu/imazu.json".as_ref(), &Assumed::default())?
/// else {
///     panic!("situations");
/// };
/// let last: Situation = situations.remove(21).expect("no faults");
/// assert_eq!((last.id(), last.others()), (Some("imazu-22"), 3));
/// # Ok::<(), searoom::scenario::ScenarioError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Situation {
    pub(super) name: String,
    /// What outputs are called where a file has several.
    pub(super) id: Option<String>,
    pub(super) own: Own,
    pub(super) others: Vec<Other>,
    pub(super) earth: Option<Georeference>,
    pub(super) declared: Declared,
    /// What was assumed or not used, in sentences.
    pub(super) notes: Vec<String>,
}

/// What a file says of its situation beside the ships: to be compared with them, never planned with.
///
/// # Examples
///
/// ```
/// use searoom::scenario::formats::{Assumed, Contents, Declared};
///
/// let Contents::Situations { mut situations, .. } =
///     Contents::read("scenarios/imazu/imazu.json".as_ref(), &Assumed::default())?
/// else {
///     panic!("situations");
/// };
/// let case_12 = situations.remove(11).expect("no faults");
/// let declared: &Declared = case_12.declared();
/// // the table has one ship less than its drawing
/// assert_eq!((declared.ships, case_12.others()), (Some(3), 2));
/// # Ok::<(), searoom::scenario::ScenarioError>(())
/// ```
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Declared {
    /// How many others there ought to be.
    pub ships: Option<usize>,
    /// On which side of own ship each of them ought to be at the start; shorter where nothing is said.
    pub sides: Vec<Option<Side>>,
}

/// Own ship.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Own {
    pub(super) pose: Pose,
    /// m/s.
    pub(super) speed: f64,
    pub(super) hull: HullSaid,
    /// At least two points, metres.
    pub(super) route: Vec<Vector>,
    /// m/s, one per leg, positive.
    pub(super) leg_speeds: Vec<f64>,
    /// Seconds by which she has to be there, where the format says.
    pub(super) horizon: Option<f64>,
}

/// What a file says of a hull.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum HullSaid {
    /// This.
    Is(Hull),
    /// The format has no place for it.
    Unsaid,
    /// The format has a place, which is empty: the field.
    Missing(String),
}

/// Another ship, or a thing that stands still.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Other {
    /// A ship.
    Ship {
        name: String,
        hull: HullSaid,
        track: Track,
    },
    /// A thing that stands still: a convex part of it, metres.
    Fixed {
        name: String,
        shape: ConvexPolygon,
        /// True for land and shallow water, to which no safety margin is kept.
        ground: bool,
    },
}

impl Other {
    /// The same elsewhere, metres.
    pub(super) fn translated(&self, shift: Vector) -> Self {
        match self.clone() {
            Self::Ship { name, hull, track } => Self::Ship {
                name,
                hull,
                track: track.translated(shift),
            },
            Self::Fixed {
                name,
                shape,
                ground,
            } => Self::Fixed {
                name,
                shape: shape.translated(shift),
                ground,
            },
        }
    }
}

impl Own {
    /// Seconds that her route takes.
    pub(super) fn duration(&self) -> f64 {
        let lengths = self.route.windows(2).map(|pair| (pair[1] - pair[0]).norm());
        lengths.zip(&self.leg_speeds).map(|(l, v)| l / v).sum()
    }
}

impl Situation {
    /// Its title.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// What outputs are called where a file has several situations.
    pub fn id(&self) -> Option<&str> {
        self.id.as_deref()
    }

    /// What the file says of the situation besides.
    pub fn declared(&self) -> &Declared {
        &self.declared
    }

    /// The others, ships and things, as the file has them.
    pub fn others(&self) -> usize {
        self.others.len()
    }
}
