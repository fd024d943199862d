use super::*;
use crate::geometry_fixtures::{places, random_polygon, random_vector};
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use std::f64::consts::TAU;

#[test]
fn hulls_of_degenerate_points_are_points_and_segments() {
    let p = Vector::new(2.0, 3.0);
    let point = ConvexPolygon::hull(&[p, p, p]).expect("a point");
    assert_eq!(point.vertices(), &[p]);
    let line: Vec<Vector> = (0..5)
        .map(|i| Vector::new(f64::from(i), 2.0 * f64::from(i)))
        .collect();
    let segment = ConvexPolygon::hull(&line).expect("a segment");
    assert_eq!(segment.vertices(), &[line[0], line[4]]);
    let refused = |points: &[Vector]| ConvexPolygon::hull(points).expect_err("refused");
    assert!(matches!(refused(&[]), GeometryError::Empty));
    let lost = refused(&[p, Vector::new(f64::NAN, 0.0)]);
    assert!(matches!(lost, GeometryError::NotFinite { index: 1 }));
    // all other points would coincide with it
    let far = refused(&[p, p + Vector::new(1.0, 0.0), Vector::new(1e300, 0.0)]);
    assert!(matches!(far, GeometryError::NotFinite { index: 2 }));
}

#[test]
fn a_vertex_inside_is_named() {
    let dented = places(&[(0.0, 0.0), (4.0, 0.0), (2.0, 1.0), (4.0, 4.0), (0.0, 4.0)]);
    let found = ConvexPolygon::from_vertices(&dented).expect_err("refused");
    assert!(matches!(found, GeometryError::NotConvex { index: 2, .. }));
}

#[test]
fn minkowski_sums_match_the_hull_of_all_vertex_sums() {
    let mut rng = ChaCha8Rng::seed_from_u64(1);
    for _ in 0..2000 {
        let (a, b) = (random_polygon(&mut rng, 2.0), random_polygon(&mut rng, 2.0));
        let sum = a.minkowski_sum(&b);
        let all: Vec<Vector> = a
            .vertices()
            .iter()
            .flat_map(|p| b.vertices().iter().map(move |q| p + q))
            .collect();
        let hull = ConvexPolygon::hull(&all).expect("finite points");
        assert!((sum.area() - hull.area()).abs() < 1e-9);
        for i in 0..64 {
            let n = crate::frame::direction(f64::from(i) * 0.1);
            assert!((sum.support(n) - a.support(n) - b.support(n)).abs() < 1e-9);
        }
        assert_eq!(sum.vertices().len(), hull.vertices().len(), "{a:?} + {b:?}");
    }
}

/// After a translation, rounding decides which end of a horizontal edge is the lower one.
#[test]
fn a_translated_polygon_has_the_same_sums() {
    let north = Vector::new(0.0, 1.0);
    for sides in [4, 16, 36] {
        let of = |radius: f64| {
            let corner = |k| crate::frame::direction(TAU * (f64::from(k) + 0.5) / f64::from(sides));
            let corners: Vec<Vector> = (0..sides).map(|k| corner(k) * radius).collect();
            ConvexPolygon::hull(&corners).expect("finite")
        };
        let (disc, velocities) = (of(40.0), of(1200.0));
        let sum = disc.minkowski_sum(&velocities);
        for far in [1e3, 123456.789, -7654321.25, 9.9e6] {
            let moved = disc.translated(Vector::new(-far, far));
            let found = moved.minkowski_sum(&velocities);
            let off = found.area() / sum.area() - 1.0;
            assert!(off.abs() < 1e-6, "{sides} {far}");
            assert_eq!(found.vertices().len(), sum.vertices().len());
            let lowest = moved.vertices().iter().map(|p| p.dot(&north));
            assert_eq!(moved.vertices()[0].y, lowest.fold(f64::INFINITY, f64::min));
        }
    }
}

#[test]
fn half_spaces_of_the_normals_are_the_set() {
    let mut rng = ChaCha8Rng::seed_from_u64(2);
    for _ in 0..2000 {
        let set = random_polygon(&mut rng, 2.0);
        let p = random_vector(&mut rng, 6.0);
        let slack = set
            .normals()
            .iter()
            .map(|n| n.dot(&p) - set.support(*n))
            .fold(f64::NEG_INFINITY, f64::max);
        let distance = set.signed_distance(p);
        if distance < -1e-9 {
            assert!((slack - distance).abs() < 1e-9);
        } else if distance > 1e-9 {
            assert!(slack > 0.0 && slack <= distance + 1e-9);
        }
    }
}

#[test]
fn not_a_number_is_inside() {
    let square = ConvexPolygon::rectangle(Vector::zeros(), 1.0, 1.0);
    assert!(square.contains(Vector::new(f64::NAN, 100.0)));
    assert!(!square.contains(Vector::new(100.0, 100.0)));
}

#[test]
fn centroid_is_the_area_mean() {
    let l = [(0.0, 0.0), (4.0, 0.0), (4.0, 2.0), (0.0, 2.0)];
    let points: Vec<Vector> = l.iter().map(|&(x, y)| Vector::new(x + 1e6, y)).collect();
    let c = ConvexPolygon::hull(&points).expect("finite").centroid();
    assert!((c - Vector::new(1e6 + 2.0, 1.0)).norm() < 1e-9);
}

/// Along an edge of 27 m, seen a hair from its normal, lies one of 17 nm, whose ends rounding makes
/// equally far.
#[test]
fn the_farthest_vertex_is_beyond_an_edge_that_rounding_hides() {
    let vertices = [
        [787.5535138140174, 241.70459506877978],
        [738.0204339067957, 376.43862576072485],
        [698.1107690765017, 273.683442328529],
        [713.5866593715593, 252.93292045669017],
        [713.586659385903, 252.932920448145],
        [736.8442228494081, 239.0773454672708],
    ];
    let polygon = ConvexPolygon::from_ccw(vertices.map(|[x, y]| Vector::new(x, y)).to_vec());
    assert_eq!(polygon.vertices().len(), 6);
    let hidden = -120.784_151_106_425_23_f64;
    let angles = [-165.0, -120.8, hidden, -90.0, 0.0, 90.0];
    let directions = angles.map(|angle| crate::frame::direction(angle.to_radians()));
    for (found, n) in polygon.supports(&directions).iter().zip(&directions) {
        assert_eq!(*found, polygon.support(*n), "{n}");
    }
}

/// Far from the origin, rounding makes a segment a triangle with a side of some last digits.
#[test]
fn the_farthest_vertex_of_a_sliver_is_found_far_from_the_origin() {
    let corners = [
        (762_685.624_368_940_2, 6_168_232.524_121_132),
        (762_685.624_368_940_4, 6_168_232.524_121_132),
        (762_678.774_740_306_7, 6_168_233.161_103_492),
    ];
    let corners = corners.map(|(x, y)| Vector::new(x, y));
    let mut rng = ChaCha8Rng::seed_from_u64(7);
    for case in 0..2000 {
        let turn = crate::frame::direction(rng.random_range(-3.0..3.0));
        let turned = corners.map(|p| Vector::new(cross(p, turn), p.dot(&turn)));
        let sliver = ConvexPolygon::hull(&turned).unwrap();
        let mut normals = sliver.normals();
        normals.extend((0..5).map(|_| crate::frame::direction(rng.random_range(-3.0..3.0))));
        normals.sort_by(|a, b| a.y.atan2(a.x).total_cmp(&b.y.atan2(b.x)));
        for (found, n) in sliver.supports(&normals).iter().zip(&normals) {
            assert!(sliver.support(*n) - found < 1e-7, "{case}: {n} {sliver:?}");
        }
    }
}

/// Every point of both sets is in the outer intersection, and every vertex of it is in both.
#[test]
fn the_outer_intersection_is_what_two_sets_share() {
    let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(91);
    let (mut shared, mut apart) = (0, 0);
    for _ in 0..400 {
        let mut set = |near: f64| {
            let near = Vector::new(near, 0.0);
            let count = rng.random_range(3..9);
            let points = (0..count).map(|_| near + random_vector(&mut rng, 3.0));
            ConvexPolygon::hull(&points.collect::<Vec<_>>()).expect("finite")
        };
        let (a, b) = (set(0.0), set(2.5));
        let both = a.outer_intersection(&b);
        for _ in 0..200 {
            let p = Vector::new(rng.random_range(-3.0..6.0), rng.random_range(-3.0..3.0));
            if a.contains(p) && b.contains(p) {
                shared += 1;
                assert!(both.as_ref().is_some_and(|both| both.contains(p)));
            }
        }
        apart += usize::from(both.is_none());
        for p in both.iter().flat_map(ConvexPolygon::vertices) {
            assert!(a.signed_distance(*p) < 1e-6 && b.signed_distance(*p) < 1e-6);
        }
    }
    assert!(shared > 1000 && apart > 10, "{shared} {apart}");
    let square = ConvexPolygon::rectangle(Vector::new(0.5, 0.5), 0.5, 0.5);
    let point = ConvexPolygon::point(Vector::new(0.5, 0.5));
    assert_eq!(square.outer_intersection(&square), Some(square.clone()));
    assert_eq!(square.outer_intersection(&point), Some(point.clone()));
    let outside = ConvexPolygon::point(Vector::new(2.0, 0.5));
    assert_eq!(square.outer_intersection(&outside), None);
}
