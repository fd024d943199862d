//! Our hulls, distances and contacts in space-time against parry's, and the bridge against both.

use super::*;
use crate::ConvexPolygon;
use crate::frame::direction;
use crate::geometry_fixtures::{random_points as points, random_polygon as set};
use parry2d_f64::query;
use parry2d_f64::query::details::contact_support_map_support_map;
use parry2d_f64::shape::ConvexPolygon as ParryPolygon;
use parry2d_f64::transformation::convex_hull;
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;

fn farthest(set: &ConvexPolygon) -> impl Fn(Vector) -> Vector {
    let vertices = set.vertices().to_vec();
    move |n| {
        let reach = |p: &&Vector| n.dot(p);
        *(vertices.iter().max_by(|a, b| reach(a).total_cmp(&reach(b)))).expect("a vertex")
    }
}

/// The support of the hull in every direction is that of parry's hull, or of the points where these
/// are on a line.
#[test]
fn hulls_are_those_of_parry() {
    let mut rng = ChaCha8Rng::seed_from_u64(901);
    let (mut wide, mut flat) = (0, 0);
    for case in 0..600 {
        let size = [1e-3, 1.0, 1e4][case % 3];
        let given = points(&mut rng, size);
        let ours = ConvexPolygon::hull(&given).expect("finite");
        let theirs: Vec<Vector> = if ours.vertices().len() > 2 {
            wide += 1;
            let given: Vec<Point> = given.iter().map(|p| point(*p)).collect();
            let hull = convex_hull(&given);
            assert!(hull.len() >= ours.vertices().len());
            hull.into_iter().map(vector).collect()
        } else {
            flat += 1;
            given
        };
        for k in 0..72 {
            let n = direction(0.0873 * f64::from(k));
            let along = theirs.iter().map(|p| n.dot(p));
            let most = along.fold(f64::NEG_INFINITY, f64::max);
            assert!((ours.support(n) - most).abs() < 1e-9 * size, "{ours:?}");
        }
    }
    assert!(wide > 300 && flat > 50, "{wide} {flat}");
}

/// The distance of sets that are apart, and the shortest way out of an overlap (parry's by the
/// expanding polytope algorithm).
#[test]
fn distances_and_depths_are_those_of_parry() {
    let mut rng = ChaCha8Rng::seed_from_u64(902);
    let (mut apart, mut over, mut touching, mut alike) = (0, 0, 0, 0);
    for case in 0..900 {
        let size = [1e-2, 1.0, 1e3][case % 3];
        let (a, b) = (set(&mut rng, size), set(&mut rng, size));
        let shift = points(&mut rng, 1.5 * size)[0];
        let b = b.translated(shift);
        let ours = a.separation(&b);
        let close = |d: f64| (d - ours).abs() < 1e-7 * size;
        let found = shortest_between(farthest(&a), farthest(&b), shift).expect("an answer");
        let found = found.shortest.norm();
        if ours > 1e-7 * size {
            apart += 1;
            assert!(close(found), "{ours} {found} {a:?} {b:?}");
            let shapes = [&a, &b].map(|set| {
                let corners: Vec<Point> = set.vertices().iter().map(|p| point(*p)).collect();
                ParryPolygon::from_convex_polyline(corners)
            });
            if let [Some(a), Some(b)] = &shapes {
                let here = Pose::identity();
                let theirs = query::distance(&here, a, &here, b).expect("two shapes");
                assert!(close(theirs.distance), "{ours} {theirs:?}");
            }
        } else if ours < -1e-7 * size {
            over += 1;
            assert!(found == 0.0, "{ours} {found}");
            // by definition: the smallest overlap along a direction
            let along = |n: &Vector| a.support(*n) + b.support(-n);
            let all = (0..360).map(|k| direction(0.01746 * f64::from(k)));
            let opposite = b.normals().into_iter().map(|n| -n);
            let all = all.chain(a.normals()).chain(opposite);
            let least = all.map(|n| along(&n)).fold(f64::INFINITY, f64::min);
            assert!(close(-least), "{ours} {least}");
            let (a, b) = (Farthest::new(farthest(&a)), Farthest::new(farthest(&b)));
            let deep = contact_support_map_support_map(&Pose::identity(), &a, &b, f64::MAX);
            let deep = deep.map_or(0.0, |contact| contact.dist / UNITS);
            // its polytope is within the difference of the sets: it may end too early, never too
            // late
            assert!(deep > ours - 1e-7 * size, "{ours} {deep}");
            alike += usize::from(close(deep));
        } else {
            touching += 1;
            assert!(found <= 1e-7 * size, "{ours} {found}");
        }
    }
    let enough = apart > 300 && over > 150 && touching > 5 && over - alike < 10;
    assert!(enough, "{apart} {over} {touching} {alike}");
}

#[test]
fn what_is_no_number_has_no_answer() {
    let at = |x: f64| move |_| Vector::new(x, 0.0);
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let found = shortest_between(at(bad), at(1.0), Vector::zeros());
        assert!(found.is_none(), "{bad}");
        assert!(shortest_between(at(1.0), at(bad), Vector::new(bad, bad)).is_none());
    }
    let found = shortest_between(at(1.0), at(4.0), Vector::new(f64::NAN, 0.0));
    assert_eq!(found.expect("numbers").shortest, Vector::new(3.0, 0.0));
}

#[test]
fn edges_are_found_as_by_a_scan() {
    let mut rng = ChaCha8Rng::seed_from_u64(904);
    let mut draw = || {
        let [x, y] = [(); 2].map(|()| f64::from(rng.random_range(0..40)));
        Vector::new(x, y)
    };
    for count in [1, 2, 3, 200] {
        let edges: Vec<(Vector, Vector)> = (0..count).map(|_| (draw(), draw())).collect();
        let tree = EdgeTree::new(edges.iter().copied());
        for _ in 0..100 {
            let p = draw();
            let off = |(a, b): &(Vector, Vector)| {
                let edge = ConvexPolygon::hull(&[*a, *b]).expect("finite");
                edge.signed_distance(p)
            };
            let all: Vec<f64> = edges.iter().map(off).collect();
            let nearest = tree.nearest(p).expect("an edge");
            assert_eq!(tree.edge(nearest.index), edges[nearest.index]);
            let least = all.iter().copied().fold(f64::INFINITY, f64::min);
            assert!((nearest.distance - least).abs() < 1e-9);
            assert!((all[nearest.index] - least).abs() < 1e-9);
            let near: Vec<NearEdge> = tree.within(p, 5.0).collect();
            let off = |e: &NearEdge| (e.distance - all[e.index]).abs();
            assert!(near.iter().all(|e| off(e) < 1e-9));
            let found = |k: usize| near.iter().any(|e| e.index == k);
            assert!((0..count).all(|k| all[k] > 5.0 || found(k)));
        }
    }
    let none = EdgeTree::new(std::iter::empty());
    assert!(none.nearest(Vector::zeros()).is_none());
    assert!(none.within(Vector::zeros(), 1e9).next().is_none());
}
