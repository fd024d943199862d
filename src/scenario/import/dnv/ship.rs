//! A ship of a DNV situation: its initial state and its static data.

use super::super::situation::GivenHull;
use super::{knots, near, unused};
use crate::frame::{Georeference, Vector, heading_from_course_deg};
use crate::input::{Field, Range};
use crate::scenario::limits;
use crate::vessel::Hull;

/// Metres: rounding of the sum of distances from the reference point to both ends.
const LENGTH_ROUNDED: f64 = 0.5;
/// Seconds until a ship appears.
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

/// The initial state of a ship, as far as the file has it.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Initial {
    /// Metres.
    pub(super) position: Option<Vector>,
    /// m/s.
    pub(super) speed: Option<f64>,
    /// Course, or else heading, radians.
    pub(super) course: Option<f64>,
    /// Heading, or else course, radians.
    pub(super) heading: Option<f64>,
}

pub(super) fn initial(
    ship: &Field,
    earth: &Georeference,
    notes: &mut Vec<String>,
) -> Option<Initial> {
    let Some(field) = ship.get("initial") else {
        return Some(Initial::default());
    };
    unused(&field, &INITIAL_KEYS, notes);
    let position = match field.get("position") {
        Some(place) => near(&place, earth).map(Some),
        None => Some(None),
    };
    let speed = match field.get("sog") {
        Some(speed) => knots(&speed, limits::SHIP_SPEED).map(Some),
        None => Some(None),
    };
    let [cog, heading] = ["cog", "heading"].map(|key| {
        let course = field.optional_number(key, limits::COURSE.in_unit("degrees"))?;
        Some(course.map(heading_from_course_deg))
    });
    let status = match field.get("navStatus") {
        Some(status) => word(&status, &NAV_STATUS, &STATUS_CODES),
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

/// Static data of a ship.
#[derive(Debug, Clone)]
pub(super) struct Static {
    pub(super) name: Option<String>,
    pub(super) hull: GivenHull,
    /// Seconds.
    pub(super) delay: f64,
}

pub(super) fn fixed(ship: &Field, notes: &mut Vec<String>) -> Option<Static> {
    let missing = || GivenHull::Missing(format!("{}.static.dimensions", ship.path()));
    let Some(field) = ship.get("static") else {
        return Some(Static {
            name: None,
            hull: missing(),
            delay: 0.0,
        });
    };
    unused(&field, &STATIC_KEYS, notes);
    let name = match field.get("name") {
        Some(name) => name.line_of_text().map(|text| Some(text.trim().to_owned())),
        None => Some(None),
    };
    let hull = match field.get("dimensions") {
        Some(dimensions) => hull(&dimensions, notes),
        None => Some(missing()),
    };
    if let Some(kind) = field.get("shipType") {
        word(&kind, &SHIP_TYPES, &SHIP_TYPE_CODES)?;
    }
    if let Some(path) = field.get("pathType") {
        // the points of a Bézier curve are not on the track
        word(&path, &["rtz", "linear"], &[])?;
    }
    let delay = field.optional_number("initDelay", DELAY.in_unit("s"))?;
    Some(Static {
        name: name?,
        hull: hull?,
        delay: delay.unwrap_or(0.0),
    })
}

/// Length and breadth. If the reference point is not in the middle, a larger hull about this point.
fn hull(field: &Field, notes: &mut Vec<String>) -> Option<GivenHull> {
    unused(field, &DIMENSION_KEYS, notes);
    let lengths = [("length", ["a", "b"]), ("width", ["c", "d"])].map(|(whole, ends)| {
        let size = field.optional_number(whole, limits::SHIP_LENGTH)?;
        let ends = ends.map(|key| field.optional_number(key, limits::DISTANCE.in_unit("m")));
        let [fore, aft] = [ends[0]?, ends[1]?];
        let (Some(fore), Some(aft)) = (fore, aft) else {
            return Some(size);
        };
        if let Some(size) = size
            && !((fore + aft - size).abs() <= LENGTH_ROUNDED)
        {
            let found = format_args!("a {whole} of {size} m, of which {fore} and {aft} m are to either side");
            field.fault(found, "distances from the reference point that add up to it");
            return None;
        }
        if fore == aft {
            return Some(size.or(Some(2.0 * fore)));
        }
        let around = 2.0 * fore.max(aft);
        notes.push(format!(
            "{}.{whole}: the reference point is not in the middle; {around} m taken, which reaches as far to both sides",
            field.path()
        ));
        Some(Some(around))
    });
    let [length, width] = [lengths[0]?, lengths[1]?];
    Some(match (length, width) {
        (Some(length), Some(beam)) => GivenHull::Known(Hull { length, beam }),
        (None, _) => GivenHull::Missing(format!("{}.length", field.path())),
        (_, None) => GivenHull::Missing(format!("{}.width", field.path())),
    })
}

/// One of these words, or one of these codes.
fn word(field: &Field, words: &[&str], codes: &[u64]) -> Option<()> {
    let known = match field.any_text() {
        Some(word) => words.contains(&word),
        None => field
            .any_number()
            .is_some_and(|number| codes.iter().any(|code| *code as f64 == number)),
    };
    if known {
        Some(())
    } else {
        field.refuse(format_args!("one of \"{}\"", words.join("\", \"")))
    }
}

/// Navigational status of AIS (ITU-R M.1371-5), in the words of DNV's schema.
const NAV_STATUS: [&str; 16] = [
    "Under way using engine",
    "At anchor",
    "Not under command",
    "Restricted maneuverability",
    "Constrained by her draught",
    "Moored",
    "Aground",
    "Engaged in fishing",
    "Under way sailing",
    "Reserved for future amendment DG, HS, MP, C, HSC",
    "Reserved for future amendment DG, HS, MP, A, WIG",
    "Power-driven vessel towing astern",
    "Power-driven vessel pushing ahead or towing alongside",
    "Reserved for future use",
    "AIS-SART (active)",
    "Undefined (default)",
];

/// Codes of [`NAV_STATUS`].
const STATUS_CODES: [u64; 16] = [0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15];

/// Ship types of AIS, with or without the kind of cargo.
const SHIP_TYPES: [&str; 52] = [
    "Not available",
    "Wing in ground",
    "Wing in ground hazardous category A",
    "Wing in ground hazardous category B",
    "Wing in ground hazardous category C",
    "Wing in ground hazardous category D",
    "Fishing",
    "Towing",
    "Towing large",
    "Dredging or underwater operations",
    "Diving operations",
    "Military operations",
    "Sailing",
    "Pleasure craft",
    "High speed craft",
    "High speed craft hazardous category A",
    "High speed craft hazardous category B",
    "High speed craft hazardous category C",
    "High speed craft hazardous category D",
    "High speed craft no information",
    "Pilot vessel",
    "Search and rescue vessel",
    "Tug",
    "Port tender",
    "Anti-pollution equipment",
    "Law enforcement",
    "Medical transport",
    "Noncombatant",
    "Passenger",
    "Passenger hazardous category A",
    "Passenger hazardous category B",
    "Passenger hazardous category C",
    "Passenger hazardous category D",
    "Passenger no information",
    "Cargo",
    "Cargo hazardous category A",
    "Cargo hazardous category B",
    "Cargo hazardous category C",
    "Cargo hazardous category D",
    "Cargo no information",
    "Tanker",
    "Tanker hazardous category A",
    "Tanker hazardous category B",
    "Tanker hazardous category C",
    "Tanker hazardous category D",
    "Tanker no information",
    "Other",
    "Other hazardous category A",
    "Other hazardous category B",
    "Other hazardous category C",
    "Other hazardous category D",
    "Other no information",
];

/// Codes of [`SHIP_TYPES`].
const SHIP_TYPE_CODES: [u64; 52] = [
    0, 20, 21, 22, 23, 24, 30, 31, 32, 33, 34, 35, 36, 37, 40, 41, 42, 43, 44, 49, 50, 51, 52, 53,
    54, 55, 58, 59, 60, 61, 62, 63, 64, 69, 70, 71, 72, 73, 74, 79, 80, 81, 82, 83, 84, 89, 90, 91,
    92, 93, 94, 99,
];
