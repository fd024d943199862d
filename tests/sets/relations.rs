//! Tests of set relations that need no slow definition: nesting by alpha, ellipses around sums, and
//! Dubins paths.

use std::f64::consts::{PI, TAU};

use proptest::prelude::*;
use searoom::frame::{Pose, direction, wrap};
use searoom::geometry::Ellipse;
use searoom::obstacle::{EllipsoidObstacle, SpaceTimeObstacle};
use searoom::vessel::dubins;

use super::generators::{
    Counter, check, directions, ellipse, ellipsoid, golden_maximum, obstacle, vector,
};

#[test]
fn relation_15_sets_are_nested_by_alpha_which_is_one_at_their_edge() {
    let between = Counter::default();
    let levels = (0.05..0.5, 0.5..0.95);
    // on a ray from the centre outward, which crosses every level
    let ray = (-3.2..3.2, 0.0..1.3, vector(20.0));
    let cases = (obstacle(), 1.0..60.0, levels, ray);
    check(
        315,
        12_000,
        cases,
        |(o, time, (less, more), (heading, share, off))| {
            let n = direction(heading);
            let (far, near) = (o.support(n, time).value, -o.support(-n, time).value);
            let x = n * (near + (far - near) * share) + off;
            let (inner, outer) = (o.at_risk(1.0 - less), o.at_risk(1.0 - more));
            let alpha = o.alpha(x, time);
            assert!(!inner.contains(x, time) || outer.contains(x, time));
            for (level, set) in [(less, &inner), (more, &outer), (1.0, &o)] {
                if (alpha - level).abs() > 1e-6 {
                    assert_eq!(set.contains(x, time), alpha < level, "{alpha} {level}");
                }
            }
            between.add(alpha > less && alpha < more);
        },
    );
    between.assert_above(300);
}

/// The sum of similar shapes is an ellipse.
#[test]
fn relation_22_the_outer_ellipse_of_similar_shapes_is_their_sum() {
    let cases = (ellipse(60.0), 0.001..0.1, vector(2.0), 0.1..60.0);
    check(
        321,
        1000,
        cases,
        |(initial, share, drift, time): (Ellipse, f64, _, _)| {
            let velocity = Ellipse::new(drift, initial.shape() * share * share).expect("a shape");
            let o = EllipsoidObstacle::new("", initial, velocity);
            for n in directions(36) {
                let (sum, outer) = (o.sum_support(n, time), o.support(n, time).value);
                assert!((outer - sum).abs() < 1e-6 * (1.0 + sum.abs()), "{n:?}");
            }
            if initial.area() > 100.0 {
                assert!(o.outer_excess(time).abs() < 1e-8);
            }
        },
    );
}

#[test]
fn relation_22_the_outer_ellipse_holds_the_sum_and_is_the_one_of_least_trace() {
    let compared = Counter::default();
    check(322, 1500, (ellipsoid(), 0.1..60.0), |(o, time)| {
        for n in directions(36) {
            let (sum, outer) = (o.sum_support(n, time), o.support(n, time).value);
            assert!(outer >= sum - 1e-9 * (1.0 + sum.abs()), "{n:?}");
        }
        // the minimum over c of (1 + 1/c) Q_o + (1 + c) t² Q_v, by search
        let (q, v) = (
            o.initial().shape().trace(),
            o.velocity().shape().trace() * time * time,
        );
        if q > 1e-6 && v > 1e-6 && !o.is_flat() {
            let of = |log: f64| (1.0 + (-log).exp()) * q + (1.0 + log.exp()) * v;
            let least = of(golden_maximum(-30.0, 30.0, |log| -of(log)));
            let found = o.outer_section(time).shape().trace();
            assert!((found - least).abs() < 1e-9 * least, "{found} {least}");
            compared.add(true);
        }
    });
    compared.assert_above(700);
}

#[test]
fn relation_23_dubins_paths_are_reversible_short_and_steady() {
    let (steady, all) = (Counter::default(), 4000);
    let pose = || (vector(500.0), -3.2..3.2).prop_map(|(place, heading)| Pose::new(place, heading));
    let cases = (pose(), pose(), 10.0..200.0, vector(1e-6));
    check(323, all, cases, |(from, to, radius, small)| {
        let length =
            |a: &Pose, b: &Pose, r: f64| dubins::shortest(a, b, r).expect("finite").length();
        let best = length(&from, &to, radius);
        let chord = (to.position - from.position).norm();
        assert!(best >= chord - 1e-9);
        for path in dubins::paths(&from, &to, radius) {
            assert!(best <= path.length());
        }
        let back = |p: &Pose| Pose::new(p.position, wrap(p.heading + PI));
        assert!((length(&back(&to), &back(&from), radius) - best).abs() < 1e-6);
        // a turn without radius: the chord alone
        assert!(length(&from, &to, 1e-6) - chord < 1e-6 * 3.0 * TAU + 1e-9);
        // a small displacement changes the length little, unless the shortest word changes
        let moved = Pose::new(to.position + small, to.heading);
        steady.add((length(&from, &moved, radius) - best).abs() < 1e-5);
    });
    steady.assert_above(all as usize * 999 / 1000);
}
