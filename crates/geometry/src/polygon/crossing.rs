//! Crossings between the edges of a polygon.

use super::turn;
use crate::frame::{Vector, cross};
use crate::{BoxIndex, Window};

/// Index of an edge: it starts at this vertex and ends at the next one of its ring.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct EdgeIndex {
    /// Index of the ring, from 0.
    pub ring: usize,
    /// Index of the vertex in the ring, from 0.
    pub vertex: usize,
}

/// Two edges that cross or overlap.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Crossing {
    /// The edges, in order.
    pub edges: [EdgeIndex; 2],
    /// A common point.
    pub at: Vector,
}

/// An edge with its index.
struct Edge {
    index: EdgeIndex,
    from: Vector,
    to: Vector,
}

/// The first pair of edges, in index order, that share more than an end or a touching point.
///
/// Exact predicates. Usually O(n log n): only edges whose boxes meet are compared.
pub(super) fn first_crossing(rings: &[Vec<Vector>]) -> Option<Crossing> {
    let mut edges: Vec<Edge> = Vec::new();
    for (ring, points) in rings.iter().enumerate() {
        for (vertex, from) in points.iter().enumerate() {
            edges.push(Edge {
                index: EdgeIndex { ring, vertex },
                from: *from,
                to: points[(vertex + 1) % points.len()],
            });
        }
    }
    let window = |e: &Edge| Window::new(e.from.inf(&e.to), e.from.sup(&e.to));
    let boxes = BoxIndex::new(edges.iter().map(window));
    edges.iter().enumerate().find_map(|(i, edge)| {
        let mut later: Vec<usize> = boxes.meeting(&window(edge)).filter(|k| *k > i).collect();
        later.sort_unstable();
        later.into_iter().find_map(|k| {
            let pair = [edge.index, edges[k].index];
            shared(edge, &edges[k]).map(|at| Crossing { edges: pair, at })
        })
    })
}

/// A point of the crossing or the overlap of two edges, if there is one.
fn shared(e: &Edge, f: &Edge) -> Option<Vector> {
    let (a, b) = (turn(e.from, e.to, f.from), turn(e.from, e.to, f.to));
    if a == 0.0 && b == 0.0 {
        // collinear edges may share a point, but not a length
        let along = e.to - e.from;
        let place = |p: Vector| along.dot(&(p - e.from)) / along.norm_squared();
        let (s, t) = (place(f.from), place(f.to));
        let (start, end) = (s.min(t).max(0.0), s.max(t).min(1.0));
        return (start < end).then(|| e.from + along * (0.5 * (start + end)));
    }
    let (c, d) = (turn(f.from, f.to, e.from), turn(f.from, f.to, e.to));
    let opposite = |a: f64, b: f64| (a > 0.0 && b < 0.0) || (a < 0.0 && b > 0.0);
    (opposite(a, b) && opposite(c, d)).then(|| {
        let (u, v) = (e.to - e.from, f.to - f.from);
        e.from + u * (cross(f.from - e.from, v) / cross(u, v)).clamp(0.0, 1.0)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{Rng, SeedableRng};

    /// Compares with a test of every pair of edges.
    #[test]
    fn the_index_finds_what_every_pair_finds() {
        let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(71);
        let mut crossed = 0;
        for case in 0..2000 {
            let grid = case % 2 == 0;
            let count = rng.random_range(3..9);
            let mut points: Vec<Vector> = (0..count)
                .map(|_| {
                    let p = Vector::new(rng.random_range(0.0..6.0), rng.random_range(0.0..6.0));
                    if grid { p.map(f64::round) } else { p }
                })
                .collect();
            points.dedup();
            let count = points.len();
            if count < 3 || points.first() == points.last() {
                continue;
            }
            let edge = |vertex: usize| Edge {
                index: EdgeIndex { ring: 0, vertex },
                from: points[vertex],
                to: points[(vertex + 1) % count],
            };
            let mut expected = None;
            for i in 0..count {
                for k in i + 1..count {
                    if shared(&edge(i), &edge(k)).is_some() && expected.is_none() {
                        expected = Some([edge(i).index, edge(k).index]);
                    }
                }
            }
            let found = first_crossing(std::slice::from_ref(&points));
            crossed += usize::from(found.is_some());
            assert_eq!(found.map(|f| f.edges), expected, "{points:?}");
            if let Some(f) = found {
                for index in f.edges {
                    let e = edge(index.vertex);
                    let off = cross(e.to - e.from, f.at - e.from) / (e.to - e.from).norm();
                    assert!(off.abs() < 1e-9, "{f:?}");
                }
            }
        }
        assert!(crossed > 500 && crossed < 1900, "{crossed}");
    }
}
