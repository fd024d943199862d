//! Land: polygons from a GeoJSON file, cut into convex pieces and indexed.
//!
//! Everything is in metres on the scenario's plane. Land is the union of all polygons, which may
//! overlap; the convex pieces tile them. Everything else is water: a map that is cut off somewhere
//! has water beyond the cut.

mod path;
mod reading;

pub use path::LandCrossing;

use searoom_geometry::frame::Vector;
use searoom_geometry::{
    BoxIndex, ConvexPolygon, DecompositionError, EdgeTree, Polygon, Window, convex_pieces,
};
use searoom_input::Remarks;

/// The land of a scenario. Two maps are equal when their polygons are.
#[derive(Clone)]
pub struct Map {
    polygons: Vec<Polygon>,
    pieces: Vec<ConvexPolygon>,
    /// The pieces by their boxes.
    boxes: BoxIndex,
    /// The edges of the polygons.
    edges: EdgeTree,
    remarks: Remarks,
}

impl std::fmt::Debug for Map {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Map")
            .field("polygons", &self.polygons.len())
            .field("pieces", &self.pieces.len())
            .finish_non_exhaustive()
    }
}

impl PartialEq for Map {
    fn eq(&self, other: &Self) -> bool {
        self.polygons == other.polygons
    }
}

impl Map {
    /// Cuts and indexes polygons, O(n log n).
    pub fn new(polygons: Vec<Polygon>) -> Result<Self, DecompositionError> {
        let mut pieces = Vec::new();
        for polygon in &polygons {
            pieces.extend(convex_pieces(polygon)?);
        }
        let boxes = pieces.iter().filter_map(|c| Window::around(c.vertices()));
        let boxes = BoxIndex::new(boxes);
        let edges = EdgeTree::new(polygons.iter().flat_map(Polygon::edges));
        Ok(Self {
            polygons,
            pieces,
            boxes,
            edges,
            remarks: Remarks::default(),
        })
    }

    /// Content of the map file that is not used.
    pub fn remarks(&self) -> &Remarks {
        &self.remarks
    }

    /// The polygons in the order of the file.
    pub fn polygons(&self) -> &[Polygon] {
        &self.polygons
    }

    /// The convex pieces, those of a polygon together.
    pub fn pieces(&self) -> &[ConvexPolygon] {
        &self.pieces
    }

    /// The pieces whose boxes meet a window, in their order. O(log n + found).
    pub fn pieces_within(&self, window: &Window) -> Vec<&ConvexPolygon> {
        let mut found: Vec<usize> = self.boxes.meeting(window).collect();
        found.sort_unstable();
        found.into_iter().map(|index| &self.pieces[index]).collect()
    }

    /// True when `p` is on land, its edge included. NaN is. O(log n).
    pub fn contains(&self, p: Vector) -> bool {
        if !(p.x.is_finite() && p.y.is_finite()) {
            return true;
        }
        let here = Window::at(p);
        self.pieces_within(&here).iter().any(|c| c.contains(p))
    }

    /// Metres from the nearest edge of the land: positive on water, negative on land, infinite
    /// without land. If polygons overlap, an edge inside another polygon counts too, so the result
    /// may be less than the depth. NaN gives NaN. O(log n).
    pub fn signed_distance(&self, p: Vector) -> f64 {
        if !(p.x.is_finite() && p.y.is_finite()) {
            return f64::NAN;
        }
        let nearest = self.edges.nearest(p);
        let distance = nearest.map_or(f64::INFINITY, |edge| edge.distance);
        if self.contains(p) {
            -distance
        } else {
            distance
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{Rng, SeedableRng};
    use searoom_geometry::frame::{Geographic, Georeference};

    fn harbour(name: &str, lat_deg: f64, lon_deg: f64) -> Map {
        let origin = Geographic { lat_deg, lon_deg };
        let earth = Georeference::new(origin).expect("valid");
        let file = format!("{}/../../maps/{name}.geojson", env!("CARGO_MANIFEST_DIR"));
        Map::read(file.as_ref(), &earth, None).unwrap_or_else(|error| panic!("{error}"))
    }

    /// Pieces tile the polygons of real coasts: areas add up, membership agrees with the even-odd
    /// rule, distances with a scan over all edges.
    #[test]
    fn real_maps_are_tiled_and_measured() {
        let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(75);
        for (name, lat, lon, polygons, vertices) in [
            ("trondheim-harbour", 63.44, 10.399, 27, 1_566),
            ("trondheim-fjord-osm", 63.44, 10.399, 8, 963),
            ("oresund-gshhg", 55.8, 12.7, 11, 1_467),
            ("new-york-harbour-gshhg", 40.65, -74.05, 29, 2_528),
            ("froya-skerries-gshhg", 63.8, 8.8, 310, 7_765),
        ] {
            let map = harbour(name, lat, lon);
            assert_eq!(map.polygons().len(), polygons, "{name}");
            let found: usize = map.polygons().iter().map(Polygon::vertex_count).sum();
            assert_eq!(found, vertices, "{name}");
            let land: f64 = map.polygons().iter().map(Polygon::area).sum();
            let tiled: f64 = map.pieces().iter().map(ConvexPolygon::area).sum();
            assert!((land - tiled).abs() < 1e-9 * land, "{name}: {land} {tiled}");
            assert!(map.pieces().len() < vertices, "{name}");
            let all = map.polygons().iter().flat_map(|p| &p.rings()[0]);
            let window = Window::around(all).expect("land");
            for _ in 0..300 {
                let share = Vector::new(rng.random_range(0.0..1.0), rng.random_range(0.0..1.0));
                let p = window.low + (window.high - window.low).component_mul(&share);
                let inside = map.polygons().iter().any(|polygon| polygon.contains(p));
                let edge = map
                    .polygons()
                    .iter()
                    .flat_map(Polygon::edges)
                    .map(|(a, b)| {
                        let t = ((p - a).dot(&(b - a)) / (b - a).norm_squared()).clamp(0.0, 1.0);
                        (p - a - (b - a) * t).norm()
                    })
                    .fold(f64::INFINITY, f64::min);
                assert_eq!(map.contains(p), inside, "{name} {p:?}");
                let signed = if inside { -edge } else { edge };
                assert!(
                    (map.signed_distance(p) - signed).abs() < 1e-6,
                    "{name} {p:?}"
                );
            }
        }
    }

    #[test]
    fn known_places_are_where_they_are() {
        let map = harbour("trondheim-harbour", 63.44, 10.399);
        let origin = Geographic::new(63.44, 10.399);
        let earth = Georeference::new(origin).expect("valid");
        let at = |lat_deg, lon_deg| earth.to_plane(Geographic { lat_deg, lon_deg });
        assert!(map.contains(at(63.4512, 10.3833)), "Munkholmen");
        assert!(!map.contains(at(63.448, 10.39)), "south-east of it");
        assert!(map.contains(at(63.4305, 10.395)), "the city");
        assert!(map.contains(Vector::new(f64::NAN, 0.0)));
        assert!(map.signed_distance(Vector::new(0.0, f64::NAN)).is_nan());
        let nowhere = Map::new(Vec::new()).expect("no land");
        assert_eq!(nowhere.signed_distance(Vector::zeros()), f64::INFINITY);
    }
}
