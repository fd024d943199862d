//! The plane of a scenario, and positions on it in metres or in degrees.

use std::cell::Cell;

use super::file::Entry;
use super::limits;
use super::section::Section;
use crate::frame::{GEOREFERENCE_REACH_M, Geographic, Georeference, Vector};

/// What a position has to be.
pub(super) const POSITION: &str = "a table { east_m, north_m } or { lat_deg, lon_deg }";

/// What an origin has to be.
const ORIGIN: &str = "a table { lat_deg, lon_deg }";

/// Where the plane lies on the earth, as far as the file says.
#[derive(Debug)]
pub(super) struct Plane {
    earth: Option<Georeference>,
    /// The file has an `origin`, right or wrong.
    given: bool,
    wanted: Cell<bool>,
}

impl Plane {
    /// From the key `origin`.
    pub(super) fn new(root: &mut Section) -> Self {
        let entry = root.take("origin");
        Self {
            given: entry.is_some(),
            earth: entry.and_then(|entry| origin(&entry)),
            wanted: Cell::new(false),
        }
    }

    /// What is known, for the scenario.
    pub(super) fn earth(&self) -> Option<Georeference> {
        self.earth
    }

    /// The same for a field that makes no sense without it: then the origin is missed, once, if it is not there.
    pub(super) fn need_earth(&self) -> Option<Georeference> {
        self.wanted.set(true);
        self.earth
    }

    /// A point in metres from a table of east and north, or of latitude and longitude.
    pub(super) fn position(&self, entry: &Entry) -> Option<Vector> {
        let mut section = entry.section(POSITION)?;
        let metric = section.has("east_m") | section.has("north_m");
        let geographic = section.has("lat_deg") | section.has("lon_deg");
        let point = match (metric, geographic) {
            (true, true) => {
                entry.fault(
                    "east_m or north_m beside lat_deg or lon_deg",
                    "one of the two pairs, not both",
                );
                None
            }
            (false, true) => {
                let place = place(&mut section, limits::LATITUDE);
                place.and_then(|place| self.near(place, entry))
            }
            (_, false) => {
                let [east, north] = ["east_m", "north_m"]
                    .map(|key| section.required_number(key, limits::COORDINATE));
                east.zip(north).map(|(e, n)| Vector::new(e, n))
            }
        };
        section.finish();
        point
    }

    fn near(&self, place: Geographic, entry: &Entry) -> Option<Vector> {
        let earth = self.need_earth()?;
        let point = earth.to_near_plane(place);
        if point.is_none() {
            let far = earth.to_plane(place).norm() / 1000.0;
            let (reach, origin) = (GEOREFERENCE_REACH_M / 1000.0, earth.origin());
            entry.fault(
                format_args!("{place}, {far:.0} km from the origin"),
                format_args!("a place within {reach:.0} km of the origin ({origin})"),
            );
        }
        point
    }

    /// Notes an origin that is not there although something needs it.
    pub(super) fn finish(&self, root: &mut Section) {
        if self.wanted.get() && !self.given {
            root.require(
                "origin",
                format_args!("{ORIGIN}, because the file has a map or a lat_deg"),
            );
        }
    }
}

fn place(section: &mut Section, latitude: super::file::Range) -> Option<Geographic> {
    let lat_deg = section.required_number("lat_deg", latitude);
    let lon_deg = section.required_number("lon_deg", limits::LONGITUDE);
    Some(Geographic {
        lat_deg: lat_deg?,
        lon_deg: lon_deg?,
    })
}

fn origin(entry: &Entry) -> Option<Georeference> {
    let mut section = entry.section(ORIGIN)?;
    let place = place(&mut section, limits::ORIGIN_LATITUDE);
    section.finish();
    Georeference::new(place?)
}
