//! Tests of set relations that need no slow definition: nesting by alpha, ellipses around sums, and
//! Dubins paths.

use super::generators::{directions, ellipse, ellipsoid, polytope, seeded, slabs, vector};
use rand::Rng;
use searoom::frame::{Pose, Vector, direction, wrap};
use searoom::obstacle::{EllipsoidObstacle, SpaceTimeObstacle};
use searoom::vessel::dubins;

/// Checks one obstacle whose centre velocity is near `drift`.
fn nested<O: SpaceTimeObstacle>(o: &O, x: Vector, time: f64, levels: [f64; 2]) -> bool {
    let [less, more] = levels;
    let (inner, outer) = (o.at_risk(1.0 - less), o.at_risk(1.0 - more));
    let alpha = o.alpha(x, time);
    // nested, and contained exactly according to alpha
    assert!(!inner.contains(x, time) || outer.contains(x, time));
    for (level, set) in [(less, &inner), (more, &outer)] {
        if (alpha - level).abs() > 1e-6 {
            assert_eq!(set.contains(x, time), alpha < level, "{alpha} {level}");
        }
    }
    if (alpha - 1.0).abs() > 1e-6 {
        assert_eq!(o.contains(x, time), alpha < 1.0, "{alpha}");
    }
    alpha > less && alpha < more
}

#[test]
fn relation_15_sets_are_nested_by_alpha_which_is_one_at_their_edge() {
    let mut rng = seeded(315);
    let mut between = 0;
    for _ in 0..4000 {
        let (less, more) = (rng.random_range(0.05..0.5), rng.random_range(0.5..0.95));
        let (p, e, s) = (polytope(&mut rng), ellipsoid(&mut rng), slabs(&mut rng));
        let time = rng.random_range(1.0..60.0);
        let n = direction(rng.random_range(-3.2..3.2));
        // on a ray from the centre outward, which crosses every level
        let at = |inner: f64, outer: f64, share: f64| inner + (outer - inner) * share;
        let share = rng.random_range(0.0..1.3);
        let mut place = |o: &dyn SpaceTimeObstacle| {
            let (far, near) = (o.support(n, time).value, -o.support(-n, time).value);
            n * at(near, far, share) + vector(&mut rng, 20.0)
        };
        let [x, y, z] = [place(&p), place(&e), place(&s)];
        between += usize::from(nested(&p, x, time, [less, more]));
        between += usize::from(nested(&e, y, time, [less, more]));
        between += usize::from(nested(&s, z, time, [less, more]));
    }
    assert!(between > 300, "{between}");
}

#[test]
fn relation_22_the_outer_ellipse_holds_the_sum_and_is_the_one_of_least_trace() {
    let mut rng = seeded(322);
    let mut compared = 0;
    for round in 0..1500 {
        let o = if round % 3 == 0 {
            // similar shapes: the sum is an ellipse
            let initial = ellipse(&mut rng, 60.0);
            let shrunk = initial.scaled_about_center(rng.random_range(0.001..0.05));
            EllipsoidObstacle::new("", initial, shrunk)
        } else {
            ellipsoid(&mut rng)
        };
        let time = rng.random_range(0.1..60.0);
        for n in directions(36) {
            let (sum, outer) = (o.sum_support(n, time), o.support(n, time).value);
            assert!(outer >= sum - 1e-9 * (1.0 + sum.abs()), "{o:?} {n:?}");
            if round % 3 == 0 {
                assert!(
                    (outer - sum).abs() < 1e-6 * (1.0 + sum.abs()),
                    "{o:?} {n:?}"
                );
            }
        }
        // the minimum over c of (1 + 1/c) Q_o + (1 + c) t² Q_v, by search
        let trace = |shape: nalgebra::Matrix2<f64>| shape.trace();
        let (q, v) = (
            trace(o.initial().shape()),
            trace(o.velocity().shape()) * time * time,
        );
        if q > 1e-6 && v > 1e-6 && !o.is_flat() {
            let of = |log: f64| (1.0 + (-log).exp()) * q + (1.0 + log.exp()) * v;
            let (mut low, mut high) = (-30.0, 30.0);
            for _ in 0..200 {
                let (a, b) = (low + (high - low) * 0.382, low + (high - low) * 0.618);
                if of(a) < of(b) {
                    high = b;
                } else {
                    low = a;
                }
            }
            let found = trace(o.outer_section(time).shape());
            let least = of(0.5 * (low + high));
            assert!((found - least).abs() < 1e-9 * least, "{found} {least}");
            compared += 1;
        }
    }
    assert!(compared > 700, "{compared}");
}

#[test]
fn relation_23_dubins_paths_are_reversible_short_and_steady() {
    let mut rng = seeded(323);
    let (mut steady, mut all) = (0, 0);
    for _ in 0..4000 {
        let mut pose = || Pose::new(vector(&mut rng, 500.0), rng.random_range(-3.2..3.2));
        let (from, to) = (pose(), pose());
        let radius = rng.random_range(10.0..200.0);
        let length =
            |a: &Pose, b: &Pose, r: f64| dubins::shortest(a, b, r).expect("finite").length();
        let best = length(&from, &to, radius);
        let chord = (to.position - from.position).norm();
        assert!(best >= chord - 1e-9);
        for path in dubins::paths(&from, &to, radius) {
            assert!(best <= path.length());
        }
        let back = |p: &Pose| Pose::new(p.position, wrap(p.heading + std::f64::consts::PI));
        assert!((length(&back(&to), &back(&from), radius) - best).abs() < 1e-6);
        // a turn without radius: the chord alone
        let turns = 3.0 * std::f64::consts::TAU;
        assert!(length(&from, &to, 1e-6) - chord < 1e-6 * turns + 1e-9);
        // a small displacement changes the length little, unless the shortest word changes
        let moved = Pose::new(to.position + vector(&mut rng, 1e-6), to.heading);
        all += 1;
        steady += usize::from((length(&from, &moved, radius) - best).abs() < 1e-5);
    }
    assert!(steady * 1000 > all * 999, "{steady} of {all}");
}
