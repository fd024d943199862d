use super::*;
use crate::geometry_fixtures::random_vector;
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;

pub fn random_ellipse(rng: &mut ChaCha8Rng) -> Ellipse {
    let [center, a, b] = [(); 3].map(|()| random_vector(rng, 5.0));
    let thin = [1.0, 1.0, 1e-3, 1e-7, 0.0][rng.random_range(0..5)];
    Ellipse::from_axes(center, [a, b * thin])
}

/// Reference: the largest signed distance of a supporting line outside, the least inside.
fn searched(e: &Ellipse, p: Vector) -> f64 {
    let at = |angle: f64| {
        let n = direction(angle);
        n.dot(&p) - e.support(n)
    };
    // uniform in the angle, and in the parameter of the boundary, which resolves a thin end
    let [a, b] = e.semi_axes();
    let mut angles: Vec<f64> = (0..1000)
        .flat_map(|i| {
            let angle = std::f64::consts::TAU * f64::from(i) / 1000.0 - 3.2;
            let z = direction(angle);
            let normal = a * (z.x * b.norm()) + b * (z.y * a.norm_squared() / b.norm());
            let other = crate::frame::heading_of(normal);
            [angle, angle + 6.0, other, other + std::f64::consts::TAU]
        })
        .filter(|angle| angle.is_finite())
        .collect();
    angles.sort_by(f64::total_cmp);
    let refined = |i: usize| {
        let (mut low, mut high) = (angles[i - 1], angles[i + 1]);
        for _ in 0..100 {
            let (a, b) = (low + (high - low) * 0.382, low + (high - low) * 0.618);
            if at(a) > at(b) {
                high = b;
            } else {
                low = a;
            }
        }
        at(0.5 * (low + high))
    };
    (1..angles.len() - 1)
        .filter(|&i| at(angles[i]) >= at(angles[i - 1]).max(at(angles[i + 1])))
        .map(refined)
        .fold(f64::NEG_INFINITY, f64::max)
}

#[test]
fn distance_matches_a_search_over_supporting_lines() {
    let mut rng = ChaCha8Rng::seed_from_u64(11);
    let mut inside = 0;
    for _ in 0..2000 {
        let e = random_ellipse(&mut rng);
        let p = if rng.random_bool(0.3) {
            // near the axes, where the nearest point is not unique
            let [a, b] = e.semi_axes();
            let (s, t) = (rng.random_range(-1.5..1.5), rng.random_range(-1e-6..1e-6));
            e.center() + a * s + b * t
        } else {
            random_vector(&mut rng, 9.0)
        };
        let found = e.signed_distance(p);
        let slow = searched(&e, p);
        let off = (found.distance - slow).abs();
        assert!(off < 1e-9, "{e:?} {p:?} {slow} {found:?}");
        assert!((found.normal.norm() - 1.0).abs() < 1e-12);
        let n = found.normal;
        let by_normal = n.dot(&p) - e.support(n);
        assert!((by_normal - slow).abs() < 1e-9, "{e:?} {p:?}");
        if slow.abs() > 1e-9 {
            assert_eq!(e.contains(p), slow < 0.0, "{e:?} {p:?}");
        }
        inside += usize::from(slow < 0.0);
    }
    assert!(inside > 300);
}

#[test]
fn matrices_that_are_no_shape_are_refused_by_what_is_found() {
    let at = Vector::new(1.0, 2.0);
    let found = |a, b, c, d| Ellipse::new(at, Matrix2::new(a, b, c, d));
    assert!(matches!(
        found(1.0, 0.5, 0.4, 1.0),
        Err(ShapeError::NotSymmetric { .. })
    ));
    assert!(matches!(
        found(1.0, 2.0, 2.0, 1.0),
        Err(ShapeError::NotPositiveSemidefinite { eigenvalue }) if (eigenvalue + 1.0).abs() < 1e-12
    ));
    assert!(matches!(
        found(1.0, f64::NAN, 0.0, 1.0),
        Err(ShapeError::NotFinite {
            row: 0,
            column: 1,
            ..
        })
    ));
    assert!(matches!(
        Ellipse::new(Vector::new(0.0, f64::INFINITY), Matrix2::identity()),
        Err(ShapeError::CenterNotFinite { index: 1, .. })
    ));
    for singular in [[1.0, 1.0, 1.0], [4.0, 0.0, 0.0], [0.0, 0.0, 0.0]] {
        let [a, b, c] = singular;
        let e = found(a, b, b, c).expect("singular is a set");
        assert_eq!(e.semi_axes()[1].norm(), 0.0);
        assert!((e.shape() - Matrix2::new(a, b, b, c)).amax() < 1e-14);
    }
    for extreme in [1e-300, 1e300] {
        let e = found(extreme, 0.0, 0.0, extreme * 1e-6).expect("a shape");
        assert!((e.semi_axes()[0].norm() / extreme.sqrt() - 1.0).abs() < 1e-12);
    }
}

#[test]
fn a_shape_is_given_back() {
    let mut rng = ChaCha8Rng::seed_from_u64(12);
    for _ in 0..1000 {
        let e = random_ellipse(&mut rng);
        let again = Ellipse::new(e.center(), e.shape()).expect("a shape");
        assert!((again.shape() - e.shape()).amax() < 1e-12 * (1.0 + e.shape().amax()));
    }
}

#[test]
fn the_circumscribed_polygon_contains_and_touches() {
    let mut rng = ChaCha8Rng::seed_from_u64(13);
    for _ in 0..300 {
        let e = random_ellipse(&mut rng);
        let polygon = e.outer_polygon(16);
        for p in e.sampled_boundary(97) {
            assert!(polygon.signed_distance(p) <= 1e-12);
        }
        let ratio = 16.0 / std::f64::consts::PI * (std::f64::consts::PI / 16.0).tan();
        assert!((polygon.area() - ratio * e.area()).abs() < 1e-9);
        assert!(polygon.vertices().len() <= 16);
    }
}

#[test]
fn not_a_number_is_inside() {
    let e = Ellipse::point(Vector::zeros());
    assert!(e.contains(Vector::new(f64::NAN, 100.0)));
    let lost = e.signed_distance(Vector::new(f64::NAN, 0.0));
    assert!(lost.distance.is_nan());
    assert!(e.contains(Vector::zeros()) && !e.contains(Vector::new(1e-150, 0.0)));
}
