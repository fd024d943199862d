//! Decomposition of a polygon into convex pieces.

use std::collections::BTreeMap;

use spade::handles::DirectedEdgeHandle;
use spade::{CdtEdge, ConstrainedDelaunayTriangulation, Point2, Triangulation};

use super::{Polygon, turn};
use crate::ConvexPolygon;
use crate::frame::Vector;

type Mesh = ConstrainedDelaunayTriangulation<Point2<f64>>;
type Edge<'a> = DirectedEdgeHandle<'a, Point2<f64>, (), CdtEdge<()>, ()>;

/// Why a polygon could not be decomposed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum DecompositionError {
    /// A coordinate outside the range of the triangulation.
    #[error("a coordinate is too large or too small to be triangulated")]
    OutOfRange,
}

/// Convex pieces that tile a polygon without overlap, in O(n log n).
///
/// Computes the constrained Delaunay triangulation and removes inner edges, the longest first,
/// while the pieces remain convex (Hertel & Mehlhorn, doi:10.1007/3-540-12689-9_105). Gives at most
/// four times the minimum number of pieces. Exact predicates; every vertex of a piece is a vertex
/// of the polygon.
pub fn convex_pieces(polygon: &Polygon) -> Result<Vec<ConvexPolygon>, DecompositionError> {
    let (sites, edges) = sites(polygon);
    let mut crossed = false;
    let mesh = Mesh::try_bulk_load_cdt(sites, edges, |_| crossed = true)
        .map_err(|_| DecompositionError::OutOfRange)?;
    // a polygon has no crossings; fail rather than lose land if one appears
    if crossed {
        return Err(DecompositionError::OutOfRange);
    }
    let inside = inner_faces(&mesh);
    Ok(merged(&mesh, &inside))
}

/// The distinct vertices of a polygon, and its edges between them.
fn sites(polygon: &Polygon) -> (Vec<Point2<f64>>, Vec<[usize; 2]>) {
    let mut index_of: BTreeMap<[u64; 2], usize> = BTreeMap::new();
    let mut points = Vec::new();
    let mut index = |p: Vector| {
        *index_of
            .entry([p.x.to_bits(), p.y.to_bits()])
            .or_insert_with(|| {
                points.push(Point2::new(p.x, p.y));
                points.len() - 1
            })
    };
    let edges = polygon.edges().map(|(a, b)| [index(a), index(b)]).collect();
    (points, edges)
}

/// The faces inside the polygon: every edge of the polygon separates inside from outside.
fn inner_faces(mesh: &Mesh) -> Vec<bool> {
    let mut inside: Vec<Option<bool>> = vec![None; mesh.num_all_faces()];
    inside[mesh.outer_face().fix().index()] = Some(false);
    let is_edge = |edge: Edge| mesh.is_constraint_edge(edge.as_undirected().fix());
    // edges to cross, from a face that is inside or not
    let mut open: Vec<(Edge, bool)> = mesh.convex_hull().map(|edge| (edge, false)).collect();
    while let Some((edge, here)) = open.pop() {
        let beyond = edge.rev().face();
        let there = here != is_edge(edge);
        let Some(face) = beyond.as_inner() else {
            continue;
        };
        let known = &mut inside[beyond.fix().index()];
        if known.is_none() {
            *known = Some(there);
            open.extend(face.adjacent_edges().map(|edge| (edge, there)));
        }
    }
    inside.into_iter().map(|i| i == Some(true)).collect()
}

/// Vertices of a growing piece, counter-clockwise.
type Loop = Vec<usize>;

/// The inner triangles, merged across their longest common edges while the pieces remain convex.
fn merged(mesh: &Mesh, inside: &[bool]) -> Vec<ConvexPolygon> {
    let at: Vec<Vector> = mesh
        .vertices()
        .map(|v| Vector::new(v.position().x, v.position().y))
        .collect();
    let mut loops: Vec<Loop> = vec![Vec::new(); inside.len()];
    for face in mesh.inner_faces() {
        let index = face.fix().index();
        if inside[index] {
            loops[index] = face.vertices().map(|v| v.fix().index()).to_vec();
        }
    }
    let mut inner: Vec<[usize; 4]> = Vec::new();
    for edge in mesh.undirected_edges() {
        let directed = edge.as_directed();
        let a = directed.face().fix().index();
        let b = directed.rev().face().fix().index();
        if inside[a] && inside[b] && !mesh.is_constraint_edge(edge.fix()) {
            let (u, v) = (directed.from().fix().index(), directed.to().fix().index());
            inner.push([u, v, a, b]);
        }
    }
    let length = |e: &[usize; 4]| (at[e[0]] - at[e[1]]).norm_squared();
    inner.sort_by(|e, f| length(f).total_cmp(&length(e)).then(e.cmp(f)));
    // index of the piece that contains each triangle
    let mut part_of: Vec<usize> = (0..inside.len()).collect();
    for [u, v, a, b] in inner {
        let (a, b) = (whole(&mut part_of, a), whole(&mut part_of, b));
        if let Some(both) = joined(&loops[a], &loops[b], [u, v], &at) {
            loops[a] = both;
            loops[b].clear();
            part_of[b] = a;
        }
    }
    loops
        .into_iter()
        .filter(|l| !l.is_empty())
        .map(|l| ConvexPolygon::from_ccw(l.into_iter().map(|v| at[v]).collect()))
        .collect()
}

fn whole(part_of: &mut [usize], mut face: usize) -> usize {
    while part_of[face] != face {
        part_of[face] = part_of[part_of[face]];
        face = part_of[face];
    }
    face
}

/// Two convex loops merged across their common edge, which runs `from` → `to` in the first; `None`
/// if the result is not convex.
fn joined(a: &Loop, b: &Loop, [from, to]: [usize; 2], at: &[Vector]) -> Option<Loop> {
    // the first loop from `to` around to `from`, the second from `from` around to `to`
    let round = |l: &Loop, start: usize| -> Option<Loop> {
        let first = l.iter().position(|v| *v == start)?;
        Some(l[first..].iter().chain(&l[..first]).copied().collect())
    };
    let (first, second) = (round(a, to)?, round(b, from)?);
    let convex = |before: usize, here: usize, after: usize| {
        before != after && turn(at[before], at[here], at[after]) >= 0.0
    };
    let (m, n) = (first.len(), second.len());
    let fits = convex(first[m - 2], from, second[1]) && convex(second[n - 2], to, first[1]);
    fits.then(|| {
        let mut both = first;
        both.extend_from_slice(&second[1..n - 1]);
        both
    })
}

#[cfg(test)]
mod tests {
    use super::super::tests::ring;
    use super::*;
    use crate::frame::direction;
    use rand::{Rng, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    /// A star-shaped ring around a centre.
    fn star(rng: &mut ChaCha8Rng, centre: Vector, least: f64, most: f64) -> Vec<Vector> {
        let count = rng.random_range(3..20);
        let grid = rng.random_bool(0.3);
        (0..count)
            .map(|k| {
                let angle = std::f64::consts::TAU * f64::from(k) / f64::from(count);
                let p = centre + direction(angle) * rng.random_range(least..most);
                if grid { p.map(f64::round) } else { p }
            })
            .collect()
    }

    /// Reference: each point is in as many pieces as in the polygon, and the areas add up.
    fn assert_tiles(polygon: &Polygon, rng: &mut ChaCha8Rng) -> usize {
        let pieces = convex_pieces(polygon).expect("in range");
        let area: f64 = pieces.iter().map(ConvexPolygon::area).sum();
        assert!((area - polygon.area()).abs() < 1e-9 * (1.0 + polygon.area()));
        let corners = polygon.rings()[0].iter();
        let nothing = [f64::INFINITY, f64::NEG_INFINITY].map(Vector::repeat);
        let [low, high] = corners.fold(nothing, |[low, high], p| [low.inf(p), high.sup(p)]);
        for _ in 0..200 {
            let share = Vector::new(rng.random_range(-0.1..1.1), rng.random_range(-0.1..1.1));
            let p = low + (high - low).component_mul(&share);
            let count = |holds: &dyn Fn(&ConvexPolygon) -> bool| {
                pieces.iter().filter(|piece| holds(piece)).count()
            };
            let within = count(&|piece| piece.signed_distance(p) < -1e-9);
            let touched = count(&|piece| piece.contains(p));
            assert!(within <= 1, "{p:?} is in {within} pieces");
            if touched == within {
                assert_eq!(within == 1, polygon.contains(p), "{p:?}");
            }
        }
        pieces.len()
    }

    #[test]
    fn pieces_tile_the_polygon() {
        let mut rng = ChaCha8Rng::seed_from_u64(72);
        let (mut valid, mut holed) = (0, 0);
        for _ in 0..1500 {
            let mut rings = vec![star(&mut rng, Vector::zeros(), 60.0, 100.0)];
            for hole in 0..rng.random_range(0..3) {
                let centre = Vector::new(30.0 * f64::from(hole) - 20.0, 5.0);
                rings.push(star(&mut rng, centre, 2.0, 14.0));
            }
            let Ok(polygon) = Polygon::new(&rings) else {
                continue;
            };
            valid += 1;
            holed += usize::from(polygon.rings().len() > 1);
            let pieces = assert_tiles(&polygon, &mut rng);
            assert!(pieces < polygon.vertex_count() + 2 * polygon.rings().len());
        }
        assert!(valid > 800 && holed > 300, "{valid} {holed}");
    }

    #[test]
    fn needles_combs_and_touching_rings_tile_too() {
        let mut rng = ChaCha8Rng::seed_from_u64(73);
        let convex = Polygon::new(&[ring("0,0 4,0 4,3 0,3")]);
        assert_eq!(assert_tiles(&convex.expect("valid"), &mut rng), 1);
        let needle = ring("0,0 1000,1e-3 2000,0 1000,2e-3");
        let comb: Vec<Vector> = (0..40)
            .map(|k| Vector::new(f64::from(k), if k % 2 == 0 { 30.0 } else { 1.0 }))
            .rev()
            .chain(ring("0,0 39,0"))
            .collect();
        let pinched = ring("0,0 4,0 2,2 4,4 0,4 2,2");
        // collinear vertices, and the line on which a hole lies
        let straight = ring("0,0 2,0 5,0 9,0 9,9 0,9");
        for rings in [
            vec![needle],
            vec![comb.clone()],
            vec![comb, ring("5,0 8,0.5 6,0.9")],
            vec![pinched],
            vec![straight, ring("5,0 6,3 4,3")],
        ] {
            assert_tiles(&Polygon::new(&rings).expect("valid"), &mut rng);
        }
    }

    #[test]
    fn what_cannot_be_triangulated_is_an_error() {
        let found = Polygon::new(&[ring("0,0 1e300,0 0,1e300")]).map(|p| convex_pieces(&p));
        assert!(!matches!(found, Ok(Ok(_))), "{found:?}");
    }
}
