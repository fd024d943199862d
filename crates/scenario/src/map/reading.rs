//! GeoJSON (RFC 7946) → [`Map`], noting every fault.

use std::fmt::Display;
use std::path::Path;

use geojson::{FeatureCollection, GeoJson, Geometry, GeometryValue, JsonObject, Position};

use super::Map;
use searoom_geometry::frame::{GEOREFERENCE_REACH_M, Geographic, Georeference, Vector};
use searoom_geometry::{ConvexPolygon, Polygon, PolygonError, outer_disc};
use searoom_input::text::counted;
use searoom_input::{Fault, InputError, Remarks, read_text};

/// Mebibytes of a map.
const FILE_MEBIBYTES: u64 = 64;

/// Allowed features.
const POLYGON: &str =
    "a Polygon or a MultiPolygon; points and lines where the map has a point_radius_m";

/// Properties of charts (S-57) by which a feature may be water or deep enough.
const DEPTHS: [&str; 4] = ["DRVAL1", "DRVAL2", "VALSOU", "WATLEV"];

/// Collections within one another: the reader of JSON allows about as many.
const NESTED: usize = 100;

/// Allowed positions.
const POSITION: &str =
    "[longitude, latitude] in degrees, WGS84: longitude from -180 to 180, latitude from -90 to 90";

/// Messages of exchanged and of far positions, which usually concern all polygons of a map.
const EXCHANGED: &str = ", which looks like [latitude, longitude]";
const FAR: &str = " from the origin";

impl Map {
    /// Reads a GeoJSON file: a feature collection, a feature or a geometry of polygons with holes,
    /// on the plane of a georeference. With `point_radius`, metres, a point is land up to this
    /// distance, and so is a line; without it both are skipped, with a caution. The error holds
    /// every fault, at most one for each polygon.
    pub fn read(
        file: &Path,
        earth: &Georeference,
        point_radius: Option<f64>,
    ) -> Result<Self, InputError> {
        let text = read_text(file, FILE_MEBIBYTES, "a map")?;
        Self::parse(&text, earth, point_radius).map_err(|faults| InputError::faults(file, faults))
    }

    /// [`Map::read`] of a text.
    pub fn parse(
        text: &str,
        earth: &Georeference,
        point_radius: Option<f64>,
    ) -> Result<Self, Vec<Fault>> {
        let mut reading = Reading {
            earth,
            point_radius,
            polygons: Vec::new(),
            faults: Vec::new(),
            skipped: [0; 3],
            depths: 0,
        };
        reading.document(text);
        if !reading.faults.is_empty() {
            let none = reading.polygons.is_empty();
            let faults = reading.faults;
            return Err(if none { together(faults) } else { faults });
        }
        if reading.polygons.is_empty() {
            let [points, lines, _] = reading.skipped;
            let (found, more) = match points + lines {
                0 => ("no polygon", ""),
                _ => (
                    "points and lines but no polygon",
                    ", as map = { file = …, point_radius_m = … } in the scenario",
                ),
            };
            let allowed = format!("at least one feature that is {POLYGON}{more}");
            reading.fault(None, found, allowed);
            return Err(reading.faults);
        }
        let remarks = reading.remarks();
        let map = Self::new(reading.polygons).map_err(|error| {
            let allowed = "polygons that can be cut into convex pieces";
            vec![Fault::new("", error, allowed)]
        })?;
        Ok(Self { remarks, ..map })
    }
}

/// Merges the faults of a map without a good polygon if all are exchanged or all are far positions.
fn together(mut faults: Vec<Fault>) -> Vec<Fault> {
    let all = |sign: &str| faults.iter().all(|fault| fault.found.contains(sign));
    if faults.len() > 1 && (all(EXCHANGED) || all(FAR)) {
        let more = faults.len() - 1;
        faults.truncate(1);
        faults[0]
            .found
            .push_str(&format!(", and so in {more} more polygons"));
    }
    faults
}

struct Reading<'a> {
    earth: &'a Georeference,
    /// Metres.
    point_radius: Option<f64>,
    polygons: Vec<Polygon>,
    faults: Vec<Fault>,
    /// Points, lines and features without a geometry that are left out.
    skipped: [usize; 3],
    /// Features with one of the [`DEPTHS`].
    depths: usize,
}

impl Reading<'_> {
    fn fault(&mut self, feature: Option<usize>, found: impl Display, allowed: impl Display) {
        let path = feature.map_or_else(String::new, |index| format!("features[{index}]"));
        self.faults.push(Fault::new(path, found, allowed));
    }

    fn document(&mut self, text: &str) {
        match text.parse::<GeoJson>() {
            Ok(GeoJson::FeatureCollection(collection)) => self.collection(&collection),
            Ok(GeoJson::Feature(feature)) => {
                self.properties(feature.properties.as_ref());
                self.feature(0, feature.geometry.as_ref());
            }
            Ok(GeoJson::Geometry(geometry)) => self.feature(0, Some(&geometry)),
            Err(error) => {
                let found = format!("no GeoJSON ({error})");
                self.fault(None, found, "GeoJSON as in RFC 7946");
            }
        }
    }

    fn collection(&mut self, collection: &FeatureCollection) {
        let crs = collection
            .foreign_members
            .as_ref()
            .and_then(|m| m.get("crs"));
        // GeoJSON of 2008 could name another system; RFC 7946 knows WGS84 alone
        if let Some(crs) = crs.map(ToString::to_string)
            && !crs.contains("CRS84")
            && !crs.contains("4326")
        {
            let short: String = crs.chars().take(80).collect();
            self.fault(
                None,
                format!("the reference system {short}"),
                "WGS84, or none named",
            );
        }
        for (index, feature) in collection.features.iter().enumerate() {
            self.properties(feature.properties.as_ref());
            self.feature(index, feature.geometry.as_ref());
        }
    }

    fn properties(&mut self, properties: Option<&JsonObject>) {
        let has_depth = |all: &JsonObject| {
            let mut depths = DEPTHS.iter().filter_map(|key| all.get(*key));
            depths.any(|value| !value.is_null())
        };
        self.depths += usize::from(properties.is_some_and(has_depth));
    }

    /// RFC 7946 allows a feature without a place.
    fn feature(&mut self, index: usize, geometry: Option<&Geometry>) {
        match geometry {
            Some(geometry) => self.geometry(index, geometry, 0),
            None => self.skipped[2] += 1,
        }
    }

    fn geometry(&mut self, index: usize, geometry: &Geometry, depth: usize) {
        match &geometry.value {
            GeometryValue::Polygon { coordinates } => self.polygon(index, coordinates),
            GeometryValue::MultiPolygon { coordinates } if !coordinates.is_empty() => {
                for polygon in coordinates {
                    self.polygon(index, polygon);
                }
            }
            GeometryValue::Point { coordinates } => self.line(index, &[coordinates]),
            GeometryValue::MultiPoint { coordinates } => {
                for point in coordinates {
                    self.line(index, &[point]);
                }
            }
            GeometryValue::LineString { coordinates } => {
                self.line(index, &coordinates.iter().collect::<Vec<_>>());
            }
            GeometryValue::MultiLineString { coordinates } => {
                for line in coordinates {
                    self.line(index, &line.iter().collect::<Vec<_>>());
                }
            }
            GeometryValue::GeometryCollection { geometries } if depth < NESTED => {
                for geometry in geometries {
                    self.geometry(index, geometry, depth + 1);
                }
            }
            other => self.fault(Some(index), format!("a {}", other.type_name()), POLYGON),
        }
    }

    /// A point as a disc, and a line as a strip with round ends; both are outer approximations.
    fn line(&mut self, feature: usize, positions: &[&Position]) {
        let Some(radius) = self.point_radius else {
            self.skipped[usize::from(positions.len() > 1)] += 1;
            return;
        };
        let mut points = Vec::with_capacity(positions.len());
        for (index, position) in positions.iter().enumerate() {
            match self.point(position) {
                Ok(point) => points.push(point),
                Err((found, allowed)) => {
                    let found = format!("{found} at position {index}");
                    return self.fault(Some(feature), found, allowed);
                }
            }
        }
        let disc = outer_disc(radius, 0.0);
        let around = |ends: &[Vector]| {
            let moved = ends.iter().map(|end| disc.translated(*end));
            let vertices: Vec<Vector> = moved.flat_map(|disc| disc.vertices().to_vec()).collect();
            ConvexPolygon::hull(&vertices).ok()
        };
        let parts = points.windows(points.len().clamp(1, 2)).map(around);
        for part in parts {
            let ring = part.map(|part| vec![part.vertices().to_vec()]);
            match ring.map(|ring| Polygon::new(&ring)) {
                Some(Ok(polygon)) => self.polygons.push(polygon),
                _ => self.fault(Some(feature), "a place that is not finite", POSITION),
            }
        }
    }

    fn remarks(&self) -> Remarks {
        let mut remarks = Remarks::default();
        let [points, lines, without] = self.skipped;
        let parts = [(points, "point"), (lines, "line")].into_iter();
        let parts = parts.filter(|(count, _)| *count > 0);
        let parts: Vec<String> = parts.map(|(count, word)| counted(count, word)).collect();
        if !parts.is_empty() {
            remarks.caution(
                format_args!("{} of the map", parts.join(" and ")),
                "skipped, as if it were water there; map = { file = …, point_radius_m = … } takes \
                 them as land",
            );
        }
        if without > 0 {
            let features = counted(without, "feature");
            remarks.note("map", format_args!("{features} without a geometry skipped"));
        }
        if self.depths > 0 {
            let statement = format_args!(
                "{} with {} taken as land, whatever its depth",
                counted(self.depths, "feature"),
                DEPTHS.join(", ")
            );
            remarks.note("map", statement);
        }
        remarks
    }

    fn polygon(&mut self, feature: usize, rings: &[Vec<Position>]) {
        let mut projected = Vec::with_capacity(rings.len());
        for (index, ring) in rings.iter().enumerate() {
            match self.ring(ring) {
                Ok(ring) => projected.push(ring),
                Err((found, allowed)) => {
                    let found = format!("in ring {index} {found}");
                    return self.fault(Some(feature), found, allowed);
                }
            }
        }
        match Polygon::new(&projected) {
            Ok(polygon) => self.polygons.push(polygon),
            Err(error) => {
                let (found, allowed) = self.described(&error);
                self.fault(Some(feature), found, allowed);
            }
        }
    }

    /// A closed ring on the plane without its last point, or what was found and what is allowed.
    fn ring(&self, ring: &[Position]) -> Result<Vec<Vector>, (String, String)> {
        if ring.len() < 4 {
            let allowed = "at least 4, the first once more at the end";
            return Err((format!("{} positions", ring.len()), allowed.to_owned()));
        }
        let mut points = Vec::with_capacity(ring.len());
        for (index, position) in ring.iter().enumerate() {
            points.push(
                self.point(position).map_err(|(found, allowed)| {
                    (format!("{found} at position {index}"), allowed)
                })?,
            );
        }
        if ring[0].as_slice()[..2] != ring[ring.len() - 1].as_slice()[..2] {
            let found = "an end that is not its beginning".to_owned();
            return Err((found, "a closed ring".to_owned()));
        }
        points.pop();
        Ok(points)
    }

    fn point(&self, position: &Position) -> Result<Vector, (String, String)> {
        let &[lon_deg, lat_deg, ..] = position.as_slice() else {
            let numbers = position.as_slice().len();
            let found = format!("{numbers} numbers where a place is meant");
            return Err((found, POSITION.to_owned()));
        };
        let place = Geographic { lat_deg, lon_deg };
        if let Some(point) = self.earth.to_near_plane(place) {
            return Ok(point);
        }
        let written = format!("[{lon_deg:?}, {lat_deg:?}]");
        let exchanged = Geographic::new(lon_deg, lat_deg);
        if self.earth.to_near_plane(exchanged).is_some() {
            let found = format!("{written}{EXCHANGED},");
            let allowed = format!("{POSITION}; or an origin that is not exchanged itself");
            return Err((found, allowed));
        }
        if !place.is_on_earth() {
            return Err((written, POSITION.to_owned()));
        }
        let far = self.earth.to_plane(place).norm() / 1000.0;
        let (reach, origin) = (GEOREFERENCE_REACH_M / 1000.0, self.earth.origin());
        Err((
            format!("{written}, {far:.0} km{FAR},"),
            format!("land within {reach:.0} km of the origin ({origin})"),
        ))
    }

    /// Fault of a polygon: the content found and the content allowed.
    fn described(&self, error: &PolygonError) -> (String, String) {
        match error {
            PolygonError::Crosses { crossing } => {
                let place = self.earth.to_geographic(crossing.at);
                let [a, b] = crossing.edges;
                let edge = |e: searoom_geometry::EdgeIndex| {
                    format!("edge {} of ring {}", e.vertex, e.ring)
                };
                (
                    format!(
                        "a boundary that crosses itself at {place}: {} and {}",
                        edge(a),
                        edge(b)
                    ),
                    "rings that touch themselves and one another in points at most".to_owned(),
                )
            }
            PolygonError::TooFewVertices { .. }
            | PolygonError::NotFinite { .. }
            | PolygonError::HoleOutside { .. } => (
                error.to_string(),
                "an outer ring, then holes inside it, each of 3 different vertices or more"
                    .to_owned(),
            ),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn earth() -> Georeference {
        let origin = Geographic::new(63.44, 10.4);
        Georeference::new(origin).expect("valid")
    }

    fn collection(geometries: &[&str]) -> String {
        let features: Vec<String> = geometries
            .iter()
            .map(|g| format!(r#"{{"type":"Feature","properties":null,"geometry":{g}}}"#))
            .collect();
        format!(
            r#"{{"type":"FeatureCollection","features":[{}]}}"#,
            features.join(",")
        )
    }

    fn polygon(rings: &str) -> String {
        format!(r#"{{"type":"Polygon","coordinates":[{rings}]}}"#)
    }

    const ISLAND: &str = "[[10.4,63.44],[10.41,63.44],[10.41,63.45],[10.4,63.44]]";

    fn only_fault(text: &str) -> Fault {
        let faults = Map::parse(text, &earth(), None).expect_err("faulty");
        assert_eq!(faults.len(), 1, "{faults:?}");
        faults[0].clone()
    }

    #[test]
    fn every_shape_of_document_with_polygons_is_a_map() {
        let island = polygon(ISLAND);
        let moved = ISLAND.replace("10.4", "10.6");
        let several = format!(r#"{{"type":"MultiPolygon","coordinates":[[{ISLAND}],[{moved}]]}}"#);
        let feature = format!(r#"{{"type":"Feature","properties":{{}},"geometry":{island}}}"#);
        for (text, count) in [
            (island.clone(), 1),
            (several.clone(), 2),
            (feature, 1),
            (collection(&[&island, &several]), 3),
        ] {
            let map = Map::parse(&text, &earth(), None).expect("a map");
            assert_eq!(map.polygons().len(), count);
        }
        // a height is of no interest, nor is the order of turning
        let high = "[[10.4,63.44,3],[10.41,63.45,3],[10.41,63.44,3],[10.4,63.44,3]]";
        assert!(Map::parse(&polygon(high), &earth(), None).is_ok());
    }

    /// Positions of a ring, what is found, and what is allowed.
    const RINGS: &str = "
63.44,10.4 63.44,10.41 63.45,10.41 63.44,10.4: looks like [latitude, longitude]; [longitude, latitude]
10.4,63.44 10.41 10.41,63.45 10.4,63.44: in ring 0 1 numbers where a place is meant at position 1; [longitude, latitude]
10.4,63.44 1e308,63.44 10.41,63.45 10.4,63.44: in ring 0 [1e308, 63.44] at position 1; [longitude, latitude]
10.4,63.44 10.41,93.44 10.41,63.45 10.4,63.44: in ring 0 [10.41, 93.44] at position 1; [longitude, latitude]
5.4,60.44 5.41,60.44 5.41,60.45 5.4,60.44: km from the origin; within 100 km of the origin (lat 63.44
10.4,63.44 10.41,63.45 10.41,63.44 10.4,63.45 10.4,63.44: crosses itself at lat 63.445; touch
10.4,63.44 10.41,63.44 10.41,63.45 10.4,63.45: an end that is not its beginning; a closed ring
10.4,63.44 10.41,63.44 10.4,63.44: 3 positions; at least 4
10.4,63.44 10.4,63.44 10.4,63.44 10.4,63.44: 1 different vertices; 3 different
";

    #[test]
    fn faults_name_their_feature_and_what_is_allowed() {
        let island = polygon(ISLAND);
        let hole = format!("{ISLAND},{}", ISLAND.replace("63.4", "63.5"));
        let rings = RINGS.lines().filter_map(|row| {
            let (points, said) = row.split_once(": ")?;
            let (found, allowed) = said.split_once("; ")?;
            let points = points.replace(' ', "],[");
            Some((polygon(&format!("[[{points}]]")), found, allowed))
        });
        let mut cases = vec![
            (
                r#"{"type":"MultiPolygon","coordinates":[]}"#.to_owned(),
                "a MultiPolygon",
                POLYGON,
            ),
            (polygon(&hole), "hole 1 is not inside", "holes inside"),
        ];
        cases.extend(rings);
        for (geometry, found, allowed) in &cases {
            let fault = only_fault(&collection(&[&island, geometry]));
            assert_eq!(fault.path, "features[1]", "{fault}");
            assert!(fault.found.contains(found), "{fault}");
            assert!(fault.allowed.contains(allowed), "{fault}");
        }
        let all: Vec<&str> = cases.iter().map(|(g, _, _)| g.as_str()).collect();
        let together = Map::parse(&collection(&all), &earth(), None).expect_err("faulty");
        assert_eq!(together.len(), cases.len(), "all at once");
    }

    /// Points and lines are land up to the radius and never less; without one they are counted.
    #[test]
    fn points_and_lines_are_discs_and_strips_or_are_counted() {
        let point = r#"{"type":"Point","coordinates":[10.4,63.44]}"#;
        let line = r#"{"type":"LineString","coordinates":[[10.42,63.44],[10.42,63.45]]}"#;
        let both = format!(r#"{{"type":"GeometryCollection","geometries":[{point},{line}]}}"#);
        let island = polygon(&ISLAND.replace("10.4", "10.6"));
        let text = collection(&[&island, &both, "null"]);
        let skipped = Map::parse(&text, &earth(), None).expect("a map");
        assert_eq!(skipped.polygons().len(), 1);
        let remarks = skipped.remarks();
        assert!(remarks.cautions[0].starts_with("1 point and 1 line of the map: skipped"));
        assert_eq!(remarks.notes, ["map: 1 feature without a geometry skipped"]);
        let map = Map::parse(&text, &earth(), Some(50.0)).expect("a map");
        assert!(map.remarks().cautions.is_empty());
        let line = |lat| earth().to_plane(Geographic::new(lat, 10.42));
        for k in 0..64 {
            let to = searoom_geometry::frame::direction(f64::from(k) * 0.1) * 50.0;
            for middle in [Vector::zeros(), line(63.44), line(63.445), line(63.45)] {
                assert!(map.contains(middle + to * 0.9999), "{k}");
            }
            assert!(!map.contains(to * 1.02), "{k}");
        }
        let far = text.replace("[10.4,63.44]}", "[1.4,63.44]}");
        let faults = Map::parse(&far, &earth(), Some(50.0)).expect_err("far");
        assert!(faults[0].found.contains("km from the origin"), "{faults:?}");
        assert!(Map::parse(&far, &earth(), None).is_ok());
    }

    /// One fault, not one for each of a thousand islands.
    #[test]
    fn a_map_that_is_wrong_as_a_whole_is_one_fault() {
        let island = |places: [(f64, f64); 3]| {
            let [a, b, c] = places.map(|(x, y)| format!("[{x},{y}]"));
            polygon(&format!("[{a},{b},{c},{a}]"))
        };
        let swapped = island([(63.44, 10.4), (63.44, 10.41), (63.45, 10.41)]);
        let fault = only_fault(&collection(&[&swapped, &swapped, &swapped]));
        assert_eq!(fault.path, "features[0]");
        assert!(fault.found.contains("[latitude, longitude]"), "{fault}");
        assert!(
            fault.found.ends_with("and so in 2 more polygons"),
            "{fault}"
        );
        assert!(
            fault.allowed.contains("an origin that is not exchanged"),
            "{fault}"
        );
        let far = island([(5.4, 60.44), (5.41, 60.44), (5.41, 60.45)]);
        let fault = only_fault(&collection(&[&far, &far]));
        assert!(
            fault.found.contains("km from the origin") && fault.found.ends_with("1 more polygons")
        );
        // one right island: each of the others is named
        let mixed = collection(&[&swapped, &polygon(ISLAND), &swapped]);
        assert_eq!(
            Map::parse(&mixed, &earth(), None)
                .expect_err("faulty")
                .len(),
            2
        );
    }

    #[test]
    fn what_is_no_map_is_named() {
        for text in ["", "{}", "[1, 2]", "{\"type\":\"Topology\"}", "\u{0}"] {
            assert!(only_fault(text).found.starts_with("no GeoJSON"), "{text}");
        }
        assert_eq!(only_fault(&collection(&[])).found, "no polygon");
        let utm = collection(&[&polygon(ISLAND)]).replacen(
            '{',
            r#"{"crs":{"type":"name","properties":{"name":"urn:ogc:def:crs:EPSG::25832"}},"#,
            1,
        );
        assert!(only_fault(&utm).found.contains("25832"));
    }

    /// No text may cause a panic.
    #[test]
    fn hostile_text_is_refused_and_never_panics() {
        let text = collection(&[&polygon(ISLAND)]);
        for end in 0..text.len() {
            assert!(Map::parse(&text[..end], &earth(), None).is_err());
        }
        for hostile in ["1e308", "-1e308", "5e-324", "null", "[]", "\"a\"", "1e999"] {
            for (at, _) in text.match_indices(char::is_numeric) {
                let mutated = format!("{}{hostile}{}", &text[..at], &text[at + 1..]);
                let _ = Map::parse(&mutated, &earth(), None);
            }
        }
    }
}
