//! A space-time polytope seen along a straight path: paper eqs. (27)-(29), formulas section 6.

use super::PolytopeObstacle;
use crate::frame::Vector;

/// A corner of a path-time obstacle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PathTime {
    /// Metres along the path.
    pub distance: f64,
    /// Seconds.
    pub time: f64,
}

/// The corners of `{(s, t) : start + s direction in O_t}` within `0 <= s <= length`, `0 <= t <= horizon`,
/// in order around it; empty where they do not meet. `direction` is a unit vector. The rectangle is
/// clipped face by face (Sutherland & Hodgman, doi:10.1145/360767.360802), O((n + m)²).
pub fn along_path(
    obstacle: &PolytopeObstacle,
    start: Vector,
    direction: Vector,
    length: f64,
    horizon: f64,
) -> Vec<PathTime> {
    let corner = |distance, time| PathTime { distance, time };
    let mut polygon = vec![
        corner(0.0, 0.0),
        corner(length, 0.0),
        corner(length, horizon),
        corner(0.0, horizon),
    ];
    for face in obstacle.faces() {
        let per_metre = face.normal.dot(&direction);
        let reach = face.initial_support - face.normal.dot(&start);
        let outside =
            |p: &PathTime| per_metre * p.distance - face.velocity_support * p.time - reach;
        let mut kept = Vec::with_capacity(polygon.len() + 1);
        for (i, a) in polygon.iter().enumerate() {
            let b = &polygon[(i + 1) % polygon.len()];
            let (fa, fb) = (outside(a), outside(b));
            if fa <= 0.0 {
                kept.push(*a);
            }
            if (fa <= 0.0) != (fb <= 0.0) {
                let share = fa / (fa - fb);
                kept.push(corner(
                    a.distance + (b.distance - a.distance) * share,
                    a.time + (b.time - a.time) * share,
                ));
            }
        }
        polygon = kept;
        if polygon.is_empty() {
            break;
        }
    }
    polygon
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::ConvexPolygon;
    use rand::{Rng, SeedableRng};

    #[test]
    fn the_projection_is_membership_along_the_path() {
        let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(51);
        let mut met = 0;
        for _ in 0..300 {
            let mut set = |n: usize, scale: f64| {
                let points: Vec<Vector> = (0..n)
                    .map(|_| {
                        Vector::new(rng.random_range(-1.0..1.0), rng.random_range(-1.0..1.0))
                            * scale
                    })
                    .collect();
                ConvexPolygon::hull(&points).expect("finite")
            };
            let o = PolytopeObstacle::new("x", set(5, 80.0), set(4, 3.0));
            let start = Vector::new(
                rng.random_range(-200.0..0.0),
                rng.random_range(-100.0..100.0),
            );
            let direction = crate::frame::direction(rng.random_range(-0.6..0.6));
            let (length, horizon) = (400.0, 120.0);
            let corners = along_path(&o, start, direction, length, horizon);
            let points: Vec<Vector> = corners
                .iter()
                .map(|c| Vector::new(c.distance, c.time))
                .collect();
            let polygon = ConvexPolygon::hull(&points).ok();
            met += usize::from(polygon.is_some());
            for _ in 0..200 {
                let (s, t) = (
                    rng.random_range(0.0..length),
                    rng.random_range(0.0..horizon),
                );
                let slack = o.slack(start + direction * s, t).value;
                let inside = polygon
                    .as_ref()
                    .is_some_and(|p| p.contains(Vector::new(s, t)));
                if slack.abs() > 1e-6 {
                    assert_eq!(inside, slack < 0.0, "{s} {t} {slack}");
                }
            }
        }
        assert!(met > 100);
    }
}
