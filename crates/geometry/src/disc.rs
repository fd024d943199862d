//! Polygons around discs.

use super::ConvexPolygon;
use crate::frame::{Vector, direction};

/// Number of sides of the polygon around a disc. With 16 sides it extends at most 2 % beyond the
/// radius.
pub const DISC_SIDES: usize = 16;

/// Outer approximation of the disc of `radius` metres about the origin: the circumscribed regular
/// [`DISC_SIDES`]-gon with one edge normal along `axis` (radians).
///
/// A radius of zero gives the point. The excess is at most `radius (1 / cos(pi / 16) - 1)`, 1.96 %
/// of the radius.
pub fn outer_disc(radius: f64, axis: f64) -> ConvexPolygon {
    if radius == 0.0 {
        return ConvexPolygon::point(Vector::zeros());
    }
    let half = std::f64::consts::PI / DISC_SIDES as f64;
    let circumradius = radius / half.cos();
    let points: Vec<Vector> = (0..DISC_SIDES)
        .map(|k| direction(axis + half * (2 * k + 1) as f64) * circumradius)
        .collect();
    ConvexPolygon::from_ccw(points)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_polygon_contains_the_disc_and_little_more() {
        for radius in [1e-3, 1.0, 250.0] {
            let disc = outer_disc(radius, 0.3);
            for i in 0..1000 {
                let h = disc.support(direction(f64::from(i) * 0.0063));
                assert!(h >= radius * (1.0 - 1e-12) && h <= radius * 1.0197);
            }
        }
        assert_eq!(outer_disc(0.0, 0.0).vertices().len(), 1);
    }
}
