use super::*;
use crate::geometry_fixtures::{random_polygon, random_vector};
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// From every face, outside and inside, of sets with and without an interior.
#[test]
fn the_slack_found_from_face_to_face_is_that_of_all_faces() {
    let mut rng = ChaCha8Rng::seed_from_u64(12);
    let (mut outside, mut inside) = (0, 0);
    let drawn = |rng: &mut ChaCha8Rng| {
        let [initial, velocity] = [20.0, 1.0].map(|size| random_polygon(rng, size));
        PolytopeObstacle::new("", initial, velocity)
    };
    for _ in 0..4000 {
        let o = drawn(&mut rng);
        let place = random_vector(&mut rng, 90.0);
        let time = [0.0, rng.random_range(0.0..30.0), -3.0][rng.random_range(0..3)];
        let all = o.slack(place, time).value;
        outside += usize::from(all > 0.0);
        inside += usize::from(all <= 0.0);
        for face in 0..=o.faces().len() {
            let near = o.slack_near(place, time, face);
            let off = (near.value - all).abs();
            assert!(off <= 1e-12 * (1.0 + all.abs()), "{o:?}");
            assert_eq!(o.faces()[near.face].slack(place, time), near.value);
        }
    }
    assert!(outside > 500 && inside > 200, "{outside} {inside}");
    let lost = drawn(&mut rng).slack_near(Vector::new(f64::NAN, 0.0), 1.0, 0);
    assert!(lost.value.is_nan());
}

#[test]
fn degenerate_sets_block_exactly_their_points() {
    let at = |x: f64, y: f64| Vector::new(x, y);
    let line = PolytopeObstacle::new(
        "mast",
        ConvexPolygon::point(at(0.0, 0.0)),
        ConvexPolygon::point(at(2.0, 1.0)),
    );
    assert!(line.contains(at(20.0, 10.0), 10.0));
    assert!(!line.contains(at(20.0, 10.0 + 1e-6), 10.0));
    assert!(!line.contains(at(0.0, 0.0), -1.0));
    assert!(line.contains(at(f64::NAN, 0.0), 1.0) && line.contains(at(1e9, 0.0), f64::NAN));
}

/// Local searches in a set of many vertices find the faces and vertices that a search of all finds.
#[test]
fn a_set_of_many_vertices_has_the_supports_of_its_polygons() {
    let round = |count: u32, size: f64| {
        let place = |k: u32| {
            searoom_geometry::frame::direction(
                f64::from(k) * std::f64::consts::TAU / f64::from(count),
            )
        };
        let points: Vec<Vector> = (0..count).map(|k| place(k) * size).collect();
        ConvexPolygon::hull(&points).expect("finite")
    };
    let (initial, velocity) = (round(3000, 90.0), round(700, 2.0));
    let set = PolytopeObstacle::new("", initial.clone(), velocity.clone());
    assert!(set.faces().len() >= 3000);
    for face in set.faces() {
        let off = |found: f64, all: f64| (found - all).abs() <= 1e-12 * all.abs();
        assert!(off(face.initial_support, initial.support(face.normal)));
        assert!(off(face.velocity_support, velocity.support(face.normal)));
    }
    let vertices = set.moving_vertices();
    assert!(vertices.len() >= 3000);
    let section = set.section(10.0);
    for vertex in vertices {
        let place = vertex.origin + vertex.velocity * 10.0;
        assert!(section.signed_distance(place).abs() < 1e-9);
    }
}
