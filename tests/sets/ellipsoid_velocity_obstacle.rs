//! Tests of the velocity obstacle of ellipsoids as a region against its definition, by a dense
//! search over time.

use super::generators::{Counter, check, directions, ellipsoid, golden_maximum, vector};
use proptest::prelude::*;
use proptest::sample::select;
use searoom::frame::{Vector, cross, direction, heading_of};
use searoom::obstacle::{EllipsoidObstacle, EllipsoidVelocityObstacle, SpaceTimeObstacle};

/// Obstacle, a position outside `O_0` by more than a distance, far enough that rounding does not
/// matter, a horizon, and the distance.
fn cases(
    distances: &'static [f64],
) -> impl Strategy<Value = (EllipsoidObstacle, Vector, f64, f64)> {
    let horizons = select(vec![5.0, 40.0, 300.0, f64::INFINITY]);
    (ellipsoid(), vector(250.0), horizons, select(distances))
        .prop_filter("own ship is outside", |(o, x, _, distance)| {
            o.initial().signed_distance(*x).distance > distance + 0.1
        })
}

/// Maximum `n . v` of the velocities that lead within the distance of the section at some time.
/// Searches times a tenth apart and refines between them. This definition uses sections only.
fn searched(o: &EllipsoidObstacle, x: Vector, horizon: f64, distance: f64, n: Vector) -> f64 {
    let of = |time: f64| (o.support(n, time).value + distance - n.dot(&x)) / time;
    let end = horizon.min(1e10);
    let times: Vec<f64> = (0..400)
        .map(|i| end * 1.1_f64.powi(-i))
        .take_while(|t| *t > 1e-4)
        .collect();
    let best = (0..times.len())
        .max_by(|a, b| of(times[*a]).total_cmp(&of(times[*b])))
        .expect("times");
    let (low, high) = (
        times[(best + 1).min(times.len() - 1)],
        times[best.saturating_sub(1)],
    );
    of(golden_maximum(low, high, of)).max(of(times[best]))
}

/// Distance of a velocity from the region by its supporting lines; negative inside.
fn beyond(region: &EllipsoidVelocityObstacle, v: Vector) -> f64 {
    let [port, starboard] = region.sides().expect("own ship is outside");
    let of = |normal: Vector, offset: f64| normal.dot(&v) - offset;
    let turn = cross(port.normal, starboard.normal).atan2(port.normal.dot(&starboard.normal));
    let turn = turn.rem_euclid(std::f64::consts::TAU);
    (1..2000)
        .map(|i| direction(heading_of(port.normal) + turn * f64::from(i) / 2000.0))
        .map(|n| of(n, region.support(n)))
        .chain([port, starboard].map(|side| of(side.normal, side.offset)))
        .fold(f64::NEG_INFINITY, f64::max)
}

#[test]
fn the_support_is_the_farthest_velocity_of_any_time() {
    let [finite, late] = [(); 2].map(|()| Counter::default());
    check(
        301,
        600,
        cases(&[0.0, 0.0, 30.0]),
        |(o, x, horizon, distance)| {
            let region = o.velocities_within(x, horizon, distance);
            for n in directions(24) {
                let closes = o.initial().support(n) + distance - n.dot(&x);
                if closes.abs() < 1e-3 {
                    continue;
                }
                let found = region.support(n);
                assert_eq!(found.is_finite(), closes < 0.0, "{n:?}");
                if !found.is_finite() {
                    continue;
                }
                let slow = searched(&o, x, horizon, distance, n);
                assert!(
                    (found - slow).abs() < 1e-6 * (1.0 + slow.abs()),
                    "{found} {slow} {n:?}"
                );
                let at = region.boundary_point(n).expect("attained");
                assert!((n.dot(&at) - found).abs() < 1e-9 * (1.0 + at.norm()));
                finite.add(true);
                let last = (o.support(n, horizon).value + distance - n.dot(&x)) / horizon;
                late.add(horizon.is_finite() && (last - found).abs() > 1e-6);
            }
        },
    );
    finite.assert_above(3000);
    late.assert_above(20);
}

#[test]
fn the_region_holds_the_velocities_that_meet_and_no_others() {
    let [within, outside] = [(); 2].map(|()| Counter::default());
    let velocities = proptest::collection::vec(vector(4.0), 10);
    let cases = (cases(&[0.0, 0.0, 20.0]), velocities);
    check(
        302,
        500,
        cases,
        |((o, x, horizon, distance), velocities)| {
            let region = o.velocities_within(x, horizon, distance);
            let picture = region.outer_half_planes(8.0, 1e-3);
            for v in velocities {
                let v = o.velocity().center() + v;
                let out = beyond(&region, v);
                if out.abs() < 1e-3 {
                    continue;
                }
                assert_eq!(region.contains(v), out < 0.0, "{out} {v:?}");
                if v.amax() < 8.0 {
                    let drawn = picture.contains(v);
                    assert!(drawn || out > 0.0, "an outer set: {v:?}");
                    assert!(!drawn || out < 2e-3, "{v:?} {out}");
                }
                // also for each time
                let end = horizon.min(2000.0);
                let meets = (0..=20_000).any(|i| {
                    let t = end * (f64::from(i) / 20_000.0).powi(2);
                    o.signed_distance(x + v * t, t).distance <= distance
                });
                assert!(!meets || out < 0.0, "{v:?} {out}");
                if out > 0.0 {
                    assert!(!meets);
                }
                within.add(meets);
                outside.add(!meets);
            }
        },
    );
    within.assert_above(300);
    outside.assert_above(1000);
}

/// Tests the accuracy: every corner of the drawn polygon is within the promised distance of the
/// region, and contains its boundary.
#[test]
fn the_half_planes_are_outside_by_no_more_than_was_asked() {
    let corners = Counter::default();
    let cases = (cases(&[0.0, 15.0]), select(vec![1e-1, 1e-2, 1e-3]));
    check(303, 400, cases, |((o, x, horizon, distance), accuracy)| {
        let region = o.velocities_within(x, horizon, distance);
        let limit = 6.0;
        let picture = region.outer_half_planes(limit, accuracy);
        assert!(picture.half_planes().len() < 1000);
        for n in directions(360) {
            if let Some(at) = region.boundary_point(n) {
                let out = picture.half_planes().iter();
                let out = out
                    .map(|h| h.normal.dot(&at) - h.offset)
                    .fold(0.0, f64::max);
                assert!(out < 1e-9 * (1.0 + at.norm()), "{n:?} {out}");
            }
        }
        let Some(polygon) = picture.clipped(limit) else {
            return;
        };
        for v in polygon.vertices() {
            let out = beyond(&region, *v);
            assert!(out < accuracy * 1.01 + 1e-6, "{v:?} {out}");
            corners.add(true);
        }
    });
    corners.assert_above(2000);
}

#[test]
fn from_inside_or_from_nowhere_every_velocity_meets() {
    check(
        304,
        100,
        (cases(&[0.0]), vector(50.0)),
        |((o, away, ..), v)| {
            for x in [o.initial().center(), Vector::new(f64::NAN, 0.0)] {
                let region = o.velocity_obstacle(x, 100.0);
                assert!(region.sides().is_none());
                assert!(region.contains(v));
                assert!(region.outer_half_planes(5.0, 1e-3).half_planes().is_empty());
                assert!(directions(8).all(|n| region.support(n).is_infinite()));
            }
            let region = o.velocity_obstacle(away, 100.0);
            assert!(region.contains(Vector::new(f64::NAN, 0.0)));
        },
    );
}

/// Tests discs against the textbook cone: two tangents, shifted by the speed that the target may
/// add to its own.
#[test]
fn discs_have_the_cone_of_the_textbook() {
    use nalgebra::Matrix2;
    use searoom::geometry::Ellipse;
    let disc = |center: Vector, radius: f64| {
        Ellipse::new(center, Matrix2::identity() * (radius * radius)).expect("a disc")
    };
    let velocity = Vector::new(-1.0, 0.5);
    let o = EllipsoidObstacle::new("", disc(Vector::new(100.0, 0.0), 60.0), disc(velocity, 0.3));
    let region = o.velocity_obstacle(Vector::zeros(), f64::INFINITY);
    let [port, starboard] = region.sides().expect("outside");
    let (sin, cos) = (0.6, 0.8);
    for (side, normal) in [
        (starboard, Vector::new(-sin, -cos)),
        (port, Vector::new(-sin, cos)),
    ] {
        assert!((side.normal - normal).norm() < 1e-12, "{side:?}");
        assert!((side.offset - normal.dot(&velocity) - 0.3).abs() < 1e-12);
    }
    // similar shapes: the sum is exact, and so is the apex, a disc of the target's velocities
    let tip = region
        .boundary_point(Vector::new(-1.0, 0.0))
        .expect("attained");
    assert!((tip - Vector::new(-1.3, 0.5)).norm() < 1e-12, "{tip:?}");
}
