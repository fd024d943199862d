//! Polygons with holes, convex or not: land as a map draws it.

mod crossing;
mod decomposition;

pub use crossing::{Crossing, EdgeIndex};
pub use decomposition::{DecompositionError, convex_pieces};

use robust::{Coord, orient2d};

use crate::frame::{Vector, cross};
use crossing::first_crossing;

/// Why rings are not a polygon. Rings count from 0, the outer one first; vertices of a ring count
/// from 0.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum PolygonError {
    /// A ring with fewer than three different vertices.
    #[error("ring {ring} has {found} different vertices; at least 3 are needed")]
    TooFewVertices {
        /// Index of the ring.
        ring: usize,
        /// Number of different vertices.
        found: usize,
    },
    /// A coordinate that is not a finite number.
    #[error("vertex {vertex} of ring {ring} is not finite")]
    NotFinite {
        /// Index of the ring.
        ring: usize,
        /// Index of the vertex.
        vertex: usize,
    },
    /// Two edges that cross or overlap.
    #[error(
        "edge {} of ring {} crosses edge {} of ring {}",
        crossing.edges[0].vertex, crossing.edges[0].ring, crossing.edges[1].vertex, crossing.edges[1].ring
    )]
    Crosses {
        /// The edges, and a common point.
        crossing: Crossing,
    },
    /// A hole that is not inside the outer ring, or inside another hole.
    #[error("hole {ring} is not inside the outer ring, or is inside another hole")]
    HoleOutside {
        /// Index of the ring.
        ring: usize,
    },
}

/// A closed region between an outer ring and its holes.
///
/// Rings may touch themselves and one another in points only. The outer ring is counter-clockwise
/// and holes are clockwise, so the inside is to port of every edge.
#[derive(Debug, Clone, PartialEq)]
pub struct Polygon {
    rings: Vec<Vec<Vector>>,
}

impl Polygon {
    /// From the outer ring and the holes, each an open list of vertices in either orientation.
    ///
    /// Repeated vertices are dropped. A sweep with exact predicates finds crossings, usually in O(n
    /// log n).
    pub fn new(rings: &[Vec<Vector>]) -> Result<Self, PolygonError> {
        let mut kept = Vec::with_capacity(rings.len().max(1));
        for (ring, points) in rings.iter().enumerate() {
            let finite = |p: &Vector| p.x.is_finite() && p.y.is_finite();
            if let Some(vertex) = points.iter().position(|p| !finite(p)) {
                return Err(PolygonError::NotFinite { ring, vertex });
            }
            let mut points: Vec<Vector> = points.iter().map(|p| p.add_scalar(0.0)).collect();
            points.dedup();
            while points.len() > 1 && points.first() == points.last() {
                points.pop();
            }
            if points.len() < 3 {
                let found = points.len();
                return Err(PolygonError::TooFewVertices { ring, found });
            }
            kept.push(points);
        }
        if kept.is_empty() {
            return Err(PolygonError::TooFewVertices { ring: 0, found: 0 });
        }
        if let Some(crossing) = first_crossing(&kept) {
            return Err(PolygonError::Crosses { crossing });
        }
        for (ring, points) in kept.iter_mut().enumerate() {
            // a ring without area has overlapping edges and was rejected above
            if (signed_area(points) > 0.0) != (ring == 0) {
                points.reverse();
            }
        }
        for ring in 1..kept.len() {
            let inside = |other: usize| surrounds(&kept[other], &kept[ring]);
            if !inside(0) || (1..kept.len()).any(|other| other != ring && inside(other)) {
                return Err(PolygonError::HoleOutside { ring });
            }
        }
        Ok(Self { rings: kept })
    }

    /// The outer ring, counter-clockwise, then the holes, clockwise; open lists.
    pub fn rings(&self) -> &[Vec<Vector>] {
        &self.rings
    }

    /// Number of vertices of all rings.
    pub fn vertex_count(&self) -> usize {
        self.rings.iter().map(Vec::len).sum()
    }

    /// Directed edges, the inside to port.
    pub fn edges(&self) -> impl Iterator<Item = (Vector, Vector)> + '_ {
        self.rings.iter().flat_map(|ring| {
            let next = ring.iter().cycle().skip(1);
            ring.iter().copied().zip(next.copied())
        })
    }

    /// Enclosed area without the holes.
    pub fn area(&self) -> f64 {
        self.rings.iter().map(|ring| signed_area(ring)).sum()
    }

    /// True when `p` is inside; either value on the boundary. Exact; NaN is inside. O(vertices).
    pub fn contains(&self, p: Vector) -> bool {
        if !(p.x.is_finite() && p.y.is_finite()) {
            return true;
        }
        winds(self.edges(), p)
    }
}

/// Even-odd rule with the half-open convention on the height of the ends.
fn winds(edges: impl Iterator<Item = (Vector, Vector)>, p: Vector) -> bool {
    let mut inside = false;
    for (a, b) in edges {
        if (a.y > p.y) != (b.y > p.y) && (turn(a, b, p) > 0.0) == (b.y > a.y) {
            inside = !inside;
        }
    }
    inside
}

/// True when a ring contains another that it does not cross, by majority of the other's vertices:
/// all but those that touch agree.
fn surrounds(ring: &[Vector], other: &[Vector]) -> bool {
    let within = |p: &Vector| {
        let next = ring.iter().cycle().skip(1);
        winds(ring.iter().copied().zip(next.copied()), *p)
    };
    let free = |p: &&Vector| !ring.contains(p);
    match other.iter().find(free) {
        Some(p) => within(p),
        // all vertices are shared, but the middle of an edge is not
        None => within(&((other[0] + other[1]) * 0.5)),
    }
}

/// Positive when `c` lies to port of the line from `a` to `b`; the sign is exact.
pub(super) fn turn(a: Vector, b: Vector, c: Vector) -> f64 {
    let coord = |p: Vector| Coord { x: p.x, y: p.y };
    orient2d(coord(a), coord(b), coord(c))
}

fn signed_area(ring: &[Vector]) -> f64 {
    let origin = ring[0];
    let next = ring.iter().cycle().skip(1);
    ring.iter()
        .zip(next)
        .map(|(a, b)| 0.5 * cross(a - origin, b - origin))
        .sum()
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use crate::geometry_fixtures::places;

    /// Points `x,y` with blanks between them.
    pub fn ring(points: &str) -> Vec<Vector> {
        let number = |text: &str| text.parse().expect("a number");
        let points = points.split(' ').filter_map(|p| p.split_once(','));
        points
            .map(|(x, y)| Vector::new(number(x), number(y)))
            .collect()
    }

    fn square(low: f64, high: f64) -> Vec<Vector> {
        places(&[(low, low), (high, low), (high, high), (low, high)])
    }

    #[test]
    fn rings_are_turned_so_that_the_inside_is_to_port() {
        let mut outer = square(0.0, 10.0);
        outer.reverse();
        let polygon = Polygon::new(&[outer, square(4.0, 6.0)]).expect("valid");
        assert_eq!(polygon.area(), 96.0);
        assert!(signed_area(&polygon.rings()[0]) > 0.0);
        assert!(signed_area(&polygon.rings()[1]) < 0.0);
        assert!(polygon.contains(Vector::new(1.0, 5.0)));
        assert!(!polygon.contains(Vector::new(5.0, 5.0)));
        assert!(!polygon.contains(Vector::new(-1.0, 4.0)));
        assert!(polygon.contains(Vector::new(f64::NAN, 4.0)));
    }

    #[test]
    fn what_is_no_polygon_is_named() {
        let bow_tie = ring("0,0 10,10 10,0 0,10");
        let Err(PolygonError::Crosses { crossing }) = Polygon::new(&[bow_tie]) else {
            panic!("crosses");
        };
        assert!((crossing.at - Vector::new(5.0, 5.0)).norm() < 1e-12);
        let crosses = |rings: &[Vec<Vector>]| {
            matches!(Polygon::new(rings), Err(PolygonError::Crosses { .. }))
        };
        assert!(crosses(&[ring("0,0 10,0 5,0")]));
        assert!(crosses(&[square(0.0, 10.0), square(5.0, 15.0)]));
        let few = ring("0,0 10,0 10,0 0,0");
        assert_eq!(
            Polygon::new(&[few]),
            Err(PolygonError::TooFewVertices { ring: 0, found: 2 })
        );
        assert!(Polygon::new(&[]).is_err());
        let lost = ring("0,0 10,nan 10,0");
        assert!(matches!(
            Polygon::new(&[lost]),
            Err(PolygonError::NotFinite { ring: 0, vertex: 1 })
        ));
        let outside = |ring| Err(PolygonError::HoleOutside { ring });
        for hole in [square(20.0, 22.0), square(-5.0, 15.0)] {
            assert_eq!(Polygon::new(&[square(0.0, 10.0), hole]), outside(1));
        }
        let nested = [square(0.0, 10.0), square(1.0, 9.0), square(4.0, 5.0)];
        assert_eq!(Polygon::new(&nested), outside(2));
    }

    #[test]
    fn touching_in_points_is_allowed() {
        // a hole that touches the outer ring in a vertex, and a ring that touches itself
        let hole = ring("0,0 3,1 1,3");
        assert!(Polygon::new(&[square(0.0, 10.0), hole]).is_ok());
        let pinched = ring("0,0 4,0 2,2 4,4 0,4 2,2");
        let polygon = Polygon::new(&[pinched]).expect("touches only");
        assert_eq!(polygon.area(), 8.0);
    }
}
