//! A ship of a DNV situation: its initial state and its static data.

use super::super::situation::GivenHull;
use super::{knots, near, unused};
use crate::limits;
use searoom_geometry::frame::{Georeference, Vector, heading_from_course_deg};
use searoom_input::{Field, Range, Remarks};
use searoom_model::vessel::Hull;

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
    remarks: &mut Remarks,
) -> Option<Initial> {
    let Some(field) = ship.get("initial") else {
        return Some(Initial::default());
    };
    unused(&field, &INITIAL_KEYS, remarks);
    let position = field.optional("position", |place| near(place, earth));
    let speed = field.optional("sog", |speed| knots(speed, limits::SHIP_SPEED));
    let [cog, heading] = ["cog", "heading"].map(|key| {
        let course = field.optional_number(key, limits::COURSE.in_unit("degrees"))?;
        Some(course.map(heading_from_course_deg))
    });
    let (cog, heading) = (cog?, heading?);
    Some(Initial {
        position: position?,
        speed: speed?,
        course: cog.or(heading),
        heading: heading.or(cog),
    })
}

#[derive(Debug, Clone)]
pub(super) struct Static {
    pub(super) name: Option<String>,
    pub(super) hull: GivenHull,
    /// Seconds.
    pub(super) delay: f64,
}

pub(super) fn fixed(ship: &Field, remarks: &mut Remarks) -> Option<Static> {
    let missing = || GivenHull::Missing(format!("{}.static.dimensions", ship.path()));
    let Some(field) = ship.get("static") else {
        return Some(Static {
            name: None,
            hull: missing(),
            delay: 0.0,
        });
    };
    unused(&field, &STATIC_KEYS, remarks);
    let name = field.optional("name", Field::line_of_text);
    let hull = match field.get("dimensions") {
        Some(dimensions) => hull(&dimensions, remarks),
        None => Some(missing()),
    };
    if let Some(path) = field.get("pathType")
        && !matches!(path.any_text(), Some("rtz" | "linear"))
    {
        // the points of a Bézier curve are not on the track
        path.refuse::<()>("one of \"rtz\", \"linear\"")?;
    }
    let delay = field.optional_number("initDelay", DELAY.in_unit("s"))?;
    Some(Static {
        name: name?.map(|name| name.trim().to_owned()),
        hull: hull?,
        delay: delay.unwrap_or(0.0),
    })
}

/// Length and breadth. If the reference point is not in the middle, a larger hull about this point.
fn hull(field: &Field, remarks: &mut Remarks) -> Option<GivenHull> {
    unused(field, &DIMENSION_KEYS, remarks);
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
            return field.reject(
                format_args!(
                    "a {whole} of {size} m, of which {fore} and {aft} m are to either side"
                ),
                "distances from the reference point that add up to it",
            );
        }
        if fore == aft {
            return Some(size.or(Some(2.0 * fore)));
        }
        let around = 2.0 * fore.max(aft);
        remarks.notes.push(format!(
            "{}.{whole}: the reference point is not in the middle; {around} m taken, \
             which reaches as far to both sides",
            field.path()
        ));
        Some(Some(around))
    });
    let [length, width] = [lengths[0]?, lengths[1]?];
    Some(match (length, width) {
        (Some(length), Some(beam)) => GivenHull::Known(Hull::new(length, beam)),
        (None, _) => GivenHull::Missing(format!("{}.length", field.path())),
        (_, None) => GivenHull::Missing(format!("{}.width", field.path())),
    })
}
