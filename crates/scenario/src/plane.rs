//! The plane of a scenario, and positions on it in metres or in degrees.

use std::cell::Cell;

use super::limits;
use searoom_geometry::frame::{GEOREFERENCE_REACH_M, Geographic, Georeference, Vector};
use searoom_input::{Field, Range, Table};

const POSITION: &str = "a table { east_m, north_m } or { lat_deg, lon_deg }";
const ORIGIN: &str = "a table { lat_deg, lon_deg }";

/// Place of the plane on the earth, if the file has one.
#[derive(Debug)]
pub(super) struct Plane {
    earth: Option<Georeference>,
    /// True if the file has an `origin`, right or wrong.
    given: bool,
    /// True if some field needs the origin.
    wanted: Cell<bool>,
}

impl Plane {
    pub(super) fn new(root: &mut Table) -> Self {
        let field = root.take("origin");
        Self {
            given: field.is_some(),
            earth: field.and_then(|field| origin(&field)),
            wanted: Cell::new(false),
        }
    }

    /// A plane whose positions are in metres.
    pub(super) fn in_metres() -> Self {
        Self {
            earth: None,
            given: false,
            wanted: Cell::new(false),
        }
    }

    pub(super) fn earth(&self) -> Option<Georeference> {
        self.earth
    }

    /// The georeference for a field that needs it: a missing origin is then one fault.
    pub(super) fn need_earth(&self) -> Option<Georeference> {
        self.wanted.set(true);
        self.earth
    }

    pub(super) fn required_position(&self, table: &mut Table) -> Option<Vector> {
        self.position(&table.require("position", POSITION)?)
    }

    /// A point in metres from a table of east and north, or of latitude and longitude.
    pub(super) fn position(&self, field: &Field) -> Option<Vector> {
        let mut table = field.table(POSITION)?;
        let metric = table.has("east_m") | table.has("north_m");
        let geographic = table.has("lat_deg") | table.has("lon_deg");
        let point = match (metric, geographic) {
            (true, true) => field.reject(
                "east_m or north_m beside lat_deg or lon_deg",
                "one of the two pairs, not both",
            ),
            (false, true) => {
                let place = place(&mut table, limits::LATITUDE);
                place.and_then(|place| near(field, place, &self.need_earth()?))
            }
            (_, false) => {
                let [east, north] =
                    ["east_m", "north_m"].map(|key| table.required_number(key, limits::COORDINATE));
                east.zip(north).map(|(e, n)| Vector::new(e, n))
            }
        };
        table.finish();
        point
    }

    pub(super) fn finish(&self, root: &mut Table) {
        if self.wanted.get() && !self.given {
            root.require(
                "origin",
                format_args!("{ORIGIN}, because the file has a map, a route or a lat_deg"),
            );
        }
    }
}

/// A place as a point of the plane; a fault if it is too far from the origin.
pub(super) fn near(field: &Field, place: Geographic, earth: &Georeference) -> Option<Vector> {
    let point = earth.to_near_plane(place);
    if point.is_none() {
        let far = earth.to_plane(place).norm() / 1000.0;
        let (reach, origin) = (GEOREFERENCE_REACH_M / 1000.0, earth.origin());
        field.fault(
            format_args!("{place}, {far:.0} km from the origin"),
            format_args!("a place within {reach:.0} km of the origin ({origin})"),
        );
    }
    point
}

fn place(table: &mut Table, latitude: Range) -> Option<Geographic> {
    let lat_deg = table.required_number("lat_deg", latitude);
    let lon_deg = table.required_number("lon_deg", limits::LONGITUDE);
    Some(Geographic {
        lat_deg: lat_deg?,
        lon_deg: lon_deg?,
    })
}

fn origin(field: &Field) -> Option<Georeference> {
    let mut table = field.table(ORIGIN)?;
    let place = place(&mut table, limits::ORIGIN_LATITUDE);
    table.finish();
    Georeference::new(place?)
}
