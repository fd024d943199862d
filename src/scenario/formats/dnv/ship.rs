//! A ship of a DNV situation: how she is at the start, and what does not change about her.

use super::super::super::file::Range;
use super::super::super::limits;
use super::super::ais_words::{NAV_STATUS, SHIP_TYPE_CODES, SHIP_TYPES, STATUS_CODES};
use super::super::json::Json;
use super::super::situation::HullSaid;
use super::{knots, near, unused};
use crate::frame::{Georeference, Vector, heading_from_course_deg};
use crate::vessel::Hull;

/// Metres by which the distances from the reference point to the ends may miss the length.
const LENGTH_ROUNDED: f64 = 0.5;
/// Seconds that a ship may be late in appearing.
const DELAY: Range = Range::between(0.0, 1e6);
const STATIC_KEYS: [&str; 10] = [
    "id",
    "mmsi",
    "imo",
    "name",
    "dimensions",
    "shipType",
    "stationType",
    "positionFixingDevice",
    "pathType",
    "initDelay",
];
const INITIAL_KEYS: [&str; 5] = ["position", "sog", "cog", "heading", "navStatus"];
const DIMENSION_KEYS: [&str; 8] = ["length", "width", "height", "draught", "a", "b", "c", "d"];

/// What a ship is at the start, as far as the file says.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Initial {
    /// Metres.
    pub(super) position: Option<Vector>,
    /// m/s.
    pub(super) speed: Option<f64>,
    /// Where she goes, or points where that is not said: radians.
    pub(super) course: Option<f64>,
    /// Where she points, or goes where that is not said: radians.
    pub(super) heading: Option<f64>,
}

pub(super) fn initial(
    ship: &Json,
    earth: &Georeference,
    notes: &mut Vec<String>,
) -> Option<Initial> {
    let Some(entry) = ship.take("initial") else {
        return Some(Initial::default());
    };
    unused(&entry, &INITIAL_KEYS, notes);
    let position = match entry.take("position") {
        Some(place) => near(&place, earth).map(Some),
        None => Some(None),
    };
    let speed = match entry.take("sog") {
        Some(speed) => knots(&speed, limits::SHIP_SPEED).map(Some),
        None => Some(None),
    };
    let [cog, heading] = ["cog", "heading"].map(|key| {
        let course = entry.optional_number(key, limits::COURSE, "degrees")?;
        Some(course.map(heading_from_course_deg))
    });
    let status = match entry.take("navStatus") {
        Some(status) => status.word(&NAV_STATUS, &STATUS_CODES),
        None => Some(()),
    };
    status?;
    let (cog, heading) = (cog?, heading?);
    Some(Initial {
        position: position?,
        speed: speed?,
        course: cog.or(heading),
        heading: heading.or(cog),
    })
}

/// What does not change about a ship.
#[derive(Debug, Clone)]
pub(super) struct Static {
    pub(super) name: Option<String>,
    pub(super) hull: HullSaid,
    /// Seconds.
    pub(super) delay: f64,
}

pub(super) fn fixed(ship: &Json, notes: &mut Vec<String>) -> Option<Static> {
    let missing = || HullSaid::Missing(format!("{}.static.dimensions", ship.path()));
    let Some(entry) = ship.take("static") else {
        return Some(Static {
            name: None,
            hull: missing(),
            delay: 0.0,
        });
    };
    unused(&entry, &STATIC_KEYS, notes);
    let name = match entry.take("name") {
        Some(name) => name.text().map(|text| Some(text.to_owned())),
        None => Some(None),
    };
    let hull = match entry.take("dimensions") {
        Some(dimensions) => hull(&dimensions, notes),
        None => Some(missing()),
    };
    if let Some(kind) = entry.take("shipType") {
        kind.word(&SHIP_TYPES, &SHIP_TYPE_CODES)?;
    }
    if let Some(path) = entry.take("pathType") {
        // the points of a Bézier curve are not on the track
        path.word(&["rtz", "linear"], &[])?;
    }
    let delay = entry.optional_number("initDelay", DELAY, "s")?;
    Some(Static {
        name: name?,
        hull: hull?,
        delay: delay.unwrap_or(0.0),
    })
}

/// Length and breadth. Where the reference point is not in the middle, the hull that reaches as far to all sides.
fn hull(entry: &Json, notes: &mut Vec<String>) -> Option<HullSaid> {
    unused(entry, &DIMENSION_KEYS, notes);
    let lengths = [("length", ["a", "b"]), ("width", ["c", "d"])].map(|(whole, ends)| {
        let size = entry.optional_number(whole, limits::SHIP_LENGTH, "m")?;
        let ends = ends.map(|key| entry.optional_number(key, limits::DISTANCE, "m"));
        let [fore, aft] = [ends[0]?, ends[1]?];
        let (Some(fore), Some(aft)) = (fore, aft) else {
            return Some(size);
        };
        if let Some(size) = size
            && !((fore + aft - size).abs() <= LENGTH_ROUNDED)
        {
            let found = format_args!("a {whole} of {size} m, of which {fore} and {aft} m are to either side");
            entry.fault(found, "distances from the reference point that add up to it");
            return None;
        }
        if fore == aft {
            return Some(size.or(Some(2.0 * fore)));
        }
        let around = 2.0 * fore.max(aft);
        notes.push(format!(
            "{}.{whole}: the reference point is not in the middle; {around} m taken, which reaches as far to both sides",
            entry.path()
        ));
        Some(Some(around))
    });
    let [length, width] = [lengths[0]?, lengths[1]?];
    Some(match (length, width) {
        (Some(length), Some(beam)) => HullSaid::Is(Hull { length, beam }),
        (None, _) => HullSaid::Missing(format!("{}.length", entry.path())),
        (_, None) => HullSaid::Missing(format!("{}.width", entry.path())),
    })
}
