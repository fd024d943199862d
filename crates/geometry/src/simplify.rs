//! Outer approximation of a convex polygon with fewer vertices.

use super::ConvexPolygon;
use crate::frame::{Vector, cross, direction};

/// Vertex count above which a set is first replaced by the polygon of [`TANGENTS`] tangents.
const MANY: usize = 256;
const TANGENTS: usize = 64;

/// An outer approximation with at most `max_vertices` (at least 3) vertices.
///
/// Repeatedly removes the edge whose removal, by extending its neighbours until they meet, adds the
/// least area. Sets with few enough vertices, points and segments are returned unchanged. O(n²);
/// O(n) for more than `MANY` vertices.
pub fn outer_simplified(set: &ConvexPolygon, max_vertices: usize) -> ConvexPolygon {
    let mut vertices = set.vertices().to_vec();
    if vertices.len() > MANY.max(max_vertices) {
        vertices = between_tangents(set);
    }
    while vertices.len() > max_vertices.max(3) {
        let n = vertices.len();
        let best = (0..n)
            .filter_map(|i| {
                corner_without_edge(&vertices, i).map(|(corner, area)| (i, corner, area))
            })
            .min_by(|a, b| a.2.total_cmp(&b.2));
        let Some((i, corner, _)) = best else { break };
        vertices[i] = corner;
        vertices.remove((i + 1) % n);
    }
    ConvexPolygon::from_ccw(vertices)
}

/// The corners between tangents in evenly spaced directions.
fn between_tangents(set: &ConvexPolygon) -> Vec<Vector> {
    let step = std::f64::consts::TAU / TANGENTS as f64;
    let tangent = |k: usize| {
        let normal = direction(step * k as f64);
        (normal, set.support(normal))
    };
    let tangents: Vec<(Vector, f64)> = (0..TANGENTS).map(tangent).collect();
    let next = tangents.iter().cycle().skip(1);
    (tangents.iter().zip(next))
        .map(|((n, a), (m, b))| Vector::new(a * m.y - b * n.y, b * n.x - a * m.x) / cross(*n, *m))
        .collect()
}

/// Where the neighbours of the edge from vertex `i` meet, and the area that this adds; `None` when
/// they diverge.
fn corner_without_edge(v: &[Vector], i: usize) -> Option<(Vector, f64)> {
    let n = v.len();
    let (a, b) = (v[(i + n - 1) % n], v[i]);
    let (c, d) = (v[(i + 1) % n], v[(i + 2) % n]);
    let (e, f) = (b - a, d - c);
    let turn = cross(e, f);
    if turn <= 1e-9 * e.norm() * f.norm() {
        return None;
    }
    let t = cross(c - b, f) / turn;
    let corner = b + e * t;
    (t >= 0.0).then(|| (corner, 0.5 * cross(corner - b, c - b).abs()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::outer_disc;

    #[test]
    fn nothing_of_the_set_is_lost() {
        let round: Vec<Vector> = (0..10_000)
            .map(|k| direction(f64::from(k) * 6.283e-4))
            .map(|d| Vector::new(700.0 + 90.0 * d.x, 40.0 * d.y))
            .collect();
        let many = ConvexPolygon::hull(&round).expect("finite");
        for set in [&many, &outer_disc(50.0, 0.2)] {
            for most in [3, 4, 5, 8, 15] {
                let few = outer_simplified(set, most);
                assert_eq!(few.vertices().len(), most);
                for i in 0..200 {
                    let d = direction(f64::from(i) * 0.0315);
                    assert!(few.support(d) >= set.support(d) - 1e-9);
                }
            }
        }
        assert!(outer_simplified(&many, 30).area() < 1.02 * many.area());
        let point = ConvexPolygon::point(Vector::new(1.0, 2.0));
        assert_eq!(outer_simplified(&point, 4), point);
    }
}
