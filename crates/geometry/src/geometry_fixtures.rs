//! Places and random sets of the unit tests. Other crates include this file in theirs.
#![allow(dead_code, reason = "each crate uses some")]

use rand::Rng;
use rand_chacha::ChaCha8Rng;

use searoom_geometry::ConvexPolygon;
use searoom_geometry::frame::Vector;

/// Places by their coordinates.
pub fn places(list: &[(f64, f64)]) -> Vec<Vector> {
    list.iter().map(|&(x, y)| Vector::new(x, y)).collect()
}

/// A vector with both components below `most`.
pub fn random_vector(rng: &mut ChaCha8Rng, most: f64) -> Vector {
    Vector::new(rng.random_range(-most..most), rng.random_range(-most..most))
}

/// One to eight points within three times the size of the origin on either axis, often on a grid:
/// repeated ones, ones on a line, and sides that are parallel.
pub fn random_points(rng: &mut ChaCha8Rng, size: f64) -> Vec<Vector> {
    let on_grid = rng.random_bool(0.5);
    (0..rng.random_range(1..9))
        .map(|_| {
            let p = random_vector(rng, 3.0);
            (if on_grid { p.map(f64::round) } else { p }) * size
        })
        .collect()
}

/// The hull of such points.
pub fn random_polygon(rng: &mut ChaCha8Rng, size: f64) -> ConvexPolygon {
    ConvexPolygon::hull(&random_points(rng, size)).expect("finite")
}
