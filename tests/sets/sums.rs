//! Tests of ellipsoids in space-time: sums of ellipses, their outer ellipse, and contact with it.

use nalgebra::Matrix2;
use searoom::frame::{Pose, Vector, to_port};
use searoom::geometry::Ellipse;
use searoom::obstacle::{EllipsoidObstacle, SpaceTimeObstacle};
use searoom::trajectory::Segment;

use super::generators::{
    Counter, check, directions, disc, ellipse, ellipsoid, golden_maximum, line, polytope,
    sum_support, vector,
};

#[test]
fn without_relative_motion_the_spread_alone_approaches() {
    // the initial guess of the search is 0 / 0 here
    let v = Vector::new(1.0, 2.0);
    let o = EllipsoidObstacle::new("x", disc(Vector::zeros(), 10.0), disc(v, 0.5));
    let away = Vector::new(100.0, 0.0);
    let met = o.closest_approach(away, v, f64::INFINITY);
    assert!(
        met.distance == 0.0 && (met.time - 180.0).abs() < 1e-9,
        "{met:?}"
    );
    let near = o.closest_approach(away, v, 100.0);
    assert!(
        (near.distance - 40.0).abs() < 1e-9 && near.time == 100.0,
        "{near:?}"
    );
    // start at the target's position and move with it
    let within = o.closest_approach(Vector::zeros(), v, 100.0);
    assert_eq!((within.distance, within.time), (0.0, 0.0));
}

#[test]
fn a_distance_that_falls_for_ever_is_not_attained() {
    // v on the boundary of V, moving away beside the target
    let velocity = disc(Vector::new(1.0, 0.0), 0.5);
    let o = EllipsoidObstacle::new("x", disc(Vector::zeros(), 10.0), velocity);
    let beside = Vector::new(30.0, 25.0);
    let found = o.closest_approach(beside, Vector::new(1.0, 0.5), f64::INFINITY);
    assert!(!found.attained && found.time.is_infinite(), "{found:?}");
    assert!(found.distance > 14.9 && found.distance < 15.1, "{found:?}");
    let limited = o.closest_approach(beside, Vector::new(1.0, 0.5), 50.0);
    assert!(limited.attained && limited.time == 50.0, "{limited:?}");
}

/// Tests a derivative that jumps where the nearest point rounds the end of a needle; chords alone
/// converge too slowly.
#[test]
fn beside_the_end_of_a_needle_the_search_still_ends() {
    let a = Vector::new(-28.85, -16.73);
    let across = to_port(a).normalize() * 1e-4;
    let needle = a * a.transpose() + across * across.transpose();
    let initial = Ellipse::new(Vector::new(18.78, -9.35), needle).expect("a shape");
    let o = EllipsoidObstacle::new("x", initial, Ellipse::point(Vector::new(0.815, 1.2)));
    let (x, v) = (Vector::new(-150.7, 154.3), Vector::new(3.69, 2.87));
    let found = o.closest_approach(x, v, 100.0);
    let at = |t: f64| o.signed_distance(x + v * t, t).distance;
    let least = (0..100_000)
        .map(|i| at(f64::from(i) * 1e-3))
        .fold(f64::INFINITY, f64::min);
    assert!(found.distance <= least + 1e-9, "{found:?} {least}");
}

#[test]
fn the_ellipsoid_around_a_polytope_contains_it() {
    check(207, 500, (polytope(), line()), |(inner, s)| {
        let outer = EllipsoidObstacle::outer_of(&inner);
        for t in [0.0, 1.0, 40.0] {
            for p in inner.section(t).vertices() {
                assert!(outer.signed_distance(*p, t).distance <= 1e-9, "{t}");
            }
        }
        if let Some(t) = inner.first_contact(&s, 1e-6) {
            assert!(outer.first_contact(&s, 0.0).is_some_and(|o| o <= t + 1e-9));
        }
    });
}

#[test]
fn an_interval_of_contact_ends_where_the_line_leaves() {
    let met = Counter::default();
    check(208, 1500, (ellipsoid(), line()), |(o, s)| {
        let Some(inside) = o.line_contact(&s) else {
            return;
        };
        met.add(true);
        assert_eq!(Some(inside.start), o.first_contact(&s, 0.0));
        let at = |t: f64| o.signed_distance(s.pose_at(t).position, t).distance;
        for i in 0..=50 {
            let t = inside.start + (inside.end - inside.start) * f64::from(i) / 50.0;
            assert!(at(t) < 1e-6, "{inside:?} {t} {}", at(t));
        }
        let after = inside.end + 1e-6;
        assert!(after > s.end_time() || at(after) > -1e-6, "{inside:?}");
    });
    met.assert_above(100);
}

/// Tests t = 0, where the cubic is zero along the line of a segment and everywhere around a point.
#[test]
fn on_the_line_of_a_flat_set_contact_begins_when_it_is_reached() {
    let segment_shape = Matrix2::new(100.0, 0.0, 0.0, 0.0);
    let growing =
        Ellipse::new(Vector::zeros(), Matrix2::new(0.25, 0.0, 0.0, 0.01)).expect("a shape");
    for shape in [segment_shape, Matrix2::zeros()] {
        let initial = Ellipse::new(Vector::zeros(), shape).expect("a shape");
        let o = EllipsoidObstacle::new("x", initial, growing);
        for (own, speed) in [(100.0, 5.0), (100.0, 0.0), (-60.0, 0.0), (11.0, 0.0)] {
            let line = Segment::straight(
                Pose::new(Vector::new(own, 0.0), std::f64::consts::PI),
                0.0,
                400.0,
                speed,
            );
            let found = o.first_contact(&line, 0.0).expect("reached in the end");
            let reach = |t: f64| o.support(Vector::new(own.signum(), 0.0), t).value;
            let gap = (line.pose_at(found).position.x.abs() - reach(found)).abs();
            assert!(found > 1.0 && gap < 1e-6, "{own} {speed} {found} {gap}");
            let alpha = o.alpha(Vector::new(own, 0.0), found);
            assert!(speed > 0.0 || (alpha - 1.0).abs() < 1e-6, "{alpha}");
        }
    }
}

#[test]
fn numbers_that_overflow_are_contact() {
    let [initial, velocity] = [10.0, 1.0].map(|radius| disc(Vector::zeros(), radius));
    let o = EllipsoidObstacle::new("x", initial, velocity);
    let lost = Segment::new(
        Pose::new(Vector::new(150.0, -80.0), 1.0),
        0.0,
        1e5,
        1e305,
        1e-7,
    );
    assert!(lost.is_valid() && o.first_contact(&lost, 0.0).is_some());
    // a circle of one metre, traversed more often than the resolution of the time
    let whirl = Segment {
        start_time: 10.0,
        speed: 1e30,
        turn_rate: 1e30,
        ..lost
    };
    assert!(whirl.is_valid() && o.first_contact(&whirl, 0.0).is_some());
}

#[test]
fn an_arc_against_the_outer_ellipse_errs_early_by_a_hundredth_of_a_micrometre() {
    let circle = disc(Vector::zeros(), 10.0);
    let o = EllipsoidObstacle::new("x", circle, Ellipse::point(Vector::zeros()));
    // a circle of 20 m about (30, 0) approaches the origin to 10 m: it touches, and slightly
    // farther it does not
    for (shift, meets) in [(0.0, true), (-1e-7, true), (1e-7, false)] {
        let arc = Segment::new(
            Pose::new(Vector::new(30.0 + shift, 20.0), std::f64::consts::PI),
            0.0,
            std::f64::consts::TAU * 20.0 / 5.0,
            5.0,
            0.25,
        );
        assert_eq!(o.first_contact(&arc, 0.0).is_some(), meets, "{shift}");
    }
}

/// The sum of similar shapes is an ellipse.
#[test]
fn the_outer_ellipse_of_similar_shapes_is_their_sum() {
    let cases = (ellipse(60.0), 0.001..0.1, vector(2.0), 0.1..60.0);
    check(
        321,
        1000,
        cases,
        |(initial, share, drift, time): (Ellipse, f64, _, _)| {
            let velocity = Ellipse::new(drift, initial.shape() * share * share).expect("a shape");
            let o = EllipsoidObstacle::new("", initial, velocity);
            for n in directions(36) {
                let (sum, outer) = (sum_support(&o, n, time), o.support(n, time).value);
                assert!((outer - sum).abs() < 1e-6 * (1.0 + sum.abs()), "{n:?}");
            }
        },
    );
}

#[test]
fn the_outer_ellipse_holds_the_sum_and_is_the_one_of_least_trace() {
    let compared = Counter::default();
    check(322, 1500, (ellipsoid(), 0.1..60.0), |(o, time)| {
        for n in directions(36) {
            let (sum, outer) = (sum_support(&o, n, time), o.support(n, time).value);
            assert!(outer >= sum - 1e-9 * (1.0 + sum.abs()), "{n:?}");
        }
        // the minimum over c of (1 + 1/c) Q_o + (1 + c) t² Q_v, by search
        let q = o.initial().shape().trace();
        let v = o.velocity().shape().trace() * time * time;
        if q > 1e-6 && v > 1e-6 && o.flat().is_none() {
            let of = |log: f64| (1.0 + (-log).exp()) * q + (1.0 + log.exp()) * v;
            let least = of(golden_maximum(-30.0, 30.0, |log| -of(log)));
            let found = o.outer_section(time).shape().trace();
            assert!((found - least).abs() < 1e-9 * least, "{found} {least}");
            compared.add(true);
        }
    });
    compared.assert_above(700);
}
