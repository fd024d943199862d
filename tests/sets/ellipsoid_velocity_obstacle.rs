//! Tests of the velocity obstacle of ellipsoids as a region against its definition, by a dense
//! search over time.

use super::generators::{directions, ellipsoid, seeded, vector};
use rand::Rng;
use rand_chacha::ChaCha8Rng;
use searoom::frame::{Vector, cross, direction, heading_of};
use searoom::obstacle::{EllipsoidObstacle, EllipsoidVelocityObstacle, SpaceTimeObstacle};

const HORIZONS: [f64; 4] = [5.0, 40.0, 300.0, f64::INFINITY];

/// Random position outside `O_0` by more than `distance`, far enough that rounding does not matter.
fn place(rng: &mut ChaCha8Rng, o: &EllipsoidObstacle, distance: f64) -> Vector {
    loop {
        let x = vector(rng, 250.0);
        if o.initial().signed_distance(x).distance > distance + 0.1 {
            return x;
        }
    }
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
    let (mut low, mut high) = (
        times[(best + 1).min(times.len() - 1)],
        times[best.saturating_sub(1)],
    );
    for _ in 0..100 {
        let (a, b) = (low + (high - low) * 0.382, low + (high - low) * 0.618);
        if of(a) > of(b) {
            high = b;
        } else {
            low = a;
        }
    }
    of(0.5 * (low + high)).max(of(times[best]))
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
    let mut rng = seeded(301);
    let (mut finite, mut late) = (0, 0);
    for round in 0..600 {
        let o = ellipsoid(&mut rng);
        let distance = [0.0, 0.0, 30.0][round % 3];
        let x = place(&mut rng, &o, distance);
        let horizon = HORIZONS[rng.random_range(0..4)];
        let region = o.velocities_within(x, horizon, distance);
        for n in directions(24) {
            let closes = o.initial().support(n) + distance - n.dot(&x);
            if closes.abs() < 1e-3 {
                continue;
            }
            let found = region.support(n);
            assert_eq!(found.is_finite(), closes < 0.0, "{o:?} {x:?} {n:?}");
            if !found.is_finite() {
                continue;
            }
            let slow = searched(&o, x, horizon, distance, n);
            assert!(
                (found - slow).abs() < 1e-6 * (1.0 + slow.abs()),
                "{found} {slow} {horizon} {distance} {o:?} {x:?} {n:?}"
            );
            let at = region.boundary_point(n).expect("attained");
            assert!((n.dot(&at) - found).abs() < 1e-9 * (1.0 + at.norm()));
            finite += 1;
            let last = (o.support(n, horizon).value + distance - n.dot(&x)) / horizon;
            late += usize::from(horizon.is_finite() && (last - found).abs() > 1e-6);
        }
    }
    assert!(finite > 3000 && late > 20, "{finite} {late}");
}

#[test]
fn the_region_holds_the_velocities_that_meet_and_no_others() {
    let mut rng = seeded(302);
    let (mut within, mut outside) = (0, 0);
    for round in 0..500 {
        let o = ellipsoid(&mut rng);
        let distance = [0.0, 0.0, 20.0][round % 3];
        let x = place(&mut rng, &o, distance);
        let horizon = HORIZONS[rng.random_range(0..4)];
        let region = o.velocities_within(x, horizon, distance);
        let picture = region.outer_half_planes(8.0, 1e-3);
        for _ in 0..10 {
            let v = o.velocity().center() + vector(&mut rng, 4.0);
            let out = beyond(&region, v);
            if out.abs() < 1e-3 {
                continue;
            }
            assert_eq!(
                region.contains(v),
                out < 0.0,
                "{out} {horizon} {distance} {o:?} {x:?} {v:?}"
            );
            if v.amax() < 8.0 {
                let drawn = picture.contains(v);
                assert!(drawn || out > 0.0, "an outer set: {o:?} {x:?} {v:?}");
                assert!(!drawn || out < 2e-3, "{o:?} {x:?} {v:?} {out}");
            }
            // also for each time
            let end = horizon.min(2000.0);
            let meets = (0..=20_000).any(|i| {
                let t = end * (f64::from(i) / 20_000.0).powi(2);
                o.signed_distance(x + v * t, t).distance <= distance
            });
            assert!(!meets || out < 0.0, "{o:?} {x:?} {v:?} {out}");
            if out > 0.0 {
                assert!(!meets);
            }
            within += usize::from(meets);
            outside += usize::from(!meets);
        }
    }
    assert!(within > 300 && outside > 1000, "{within} {outside}");
}

/// Tests the accuracy: every corner of the drawn polygon is within the promised distance of the
/// region, and contains its boundary.
#[test]
fn the_half_planes_are_outside_by_no_more_than_was_asked() {
    let mut rng = seeded(303);
    let mut corners = 0;
    for round in 0..400 {
        let o = ellipsoid(&mut rng);
        let distance = [0.0, 15.0][round % 2];
        let x = place(&mut rng, &o, distance);
        let horizon = HORIZONS[rng.random_range(0..4)];
        let region = o.velocities_within(x, horizon, distance);
        let accuracy = [1e-1, 1e-2, 1e-3][rng.random_range(0..3)];
        let limit = 6.0;
        let picture = region.outer_half_planes(limit, accuracy);
        assert!(picture.half_planes().len() < 1000);
        for n in directions(360) {
            if let Some(at) = region.boundary_point(n) {
                let out = picture.half_planes().iter();
                let out = out
                    .map(|h| h.normal.dot(&at) - h.offset)
                    .fold(0.0, f64::max);
                assert!(out < 1e-9 * (1.0 + at.norm()), "{o:?} {x:?} {n:?} {out}");
            }
        }
        let Some(polygon) = picture.clipped(limit) else {
            continue;
        };
        for v in polygon.vertices() {
            let out = beyond(&region, *v);
            assert!(
                out < accuracy * 1.01 + 1e-6,
                "{o:?} {x:?} {v:?} {out} {accuracy}"
            );
            corners += 1;
        }
    }
    assert!(corners > 2000, "{corners}");
}

#[test]
fn from_inside_or_from_nowhere_every_velocity_meets() {
    let mut rng = seeded(304);
    for _ in 0..100 {
        let o = ellipsoid(&mut rng);
        for x in [o.initial().center(), Vector::new(f64::NAN, 0.0)] {
            let region = o.velocity_obstacle(x, 100.0);
            assert!(region.sides().is_none());
            assert!(region.contains(vector(&mut rng, 50.0)));
            assert!(region.outer_half_planes(5.0, 1e-3).half_planes().is_empty());
            assert!(directions(8).all(|n| region.support(n).is_infinite()));
        }
        let away = place(&mut rng, &o, 0.0);
        let region = o.velocity_obstacle(away, 100.0);
        assert!(region.contains(Vector::new(f64::NAN, 0.0)));
    }
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
