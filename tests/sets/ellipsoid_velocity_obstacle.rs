//! Tests of the velocity obstacle of ellipsoids as a region against its definition, by a dense
//! search over time.

use super::generators::{Counter, check, disc, ellipsoid, golden_maximum, vector};
use proptest::prelude::*;
use proptest::sample::select;
use searoom::frame::Vector;
use searoom::obstacle::{EllipsoidObstacle, SpaceTimeObstacle};

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
    let low = times[(best + 1).min(times.len() - 1)];
    let high = times[best.saturating_sub(1)];
    of(golden_maximum(low, high, of)).max(of(times[best]))
}

/// Every tangent touches the region, and the velocities between them are those that meet.
#[test]
fn the_tangents_hold_the_velocities_that_come_near_and_few_others() {
    let [touching, within, outside, more] = [(); 4].map(|()| Counter::default());
    let velocities = proptest::collection::vec(vector(4.0), 40);
    let cases = (cases(&[0.0, 0.0, 30.0]), velocities);
    check(
        301,
        500,
        cases,
        |((o, x, horizon, distance), velocities)| {
            let region = o.outer_velocities_within(x, horizon, distance);
            let tangents = region.half_planes();
            for h in &tangents[1..tangents.len() - 1] {
                let closes = o.initial().support(h.normal) + distance - h.normal.dot(&x);
                if closes < -1e-3 {
                    let slow = searched(&o, x, horizon, distance, h.normal);
                    let off = (h.offset - slow).abs();
                    assert!(off < 1e-6 * (1.0 + slow.abs()), "{h:?} {slow}");
                    touching.add(true);
                }
            }
            for v in velocities {
                let v = o.velocity().center() + v;
                let nearest = o.closest_approach(x, v, horizon).distance - distance;
                if nearest < -1e-6 || distance == 0.0 && o.in_velocity_obstacle(x, v, horizon) {
                    let beyond = tangents.iter().map(|h| h.normal.dot(&v) - h.offset);
                    assert!(
                        beyond.fold(f64::NEG_INFINITY, f64::max) < 1e-9 * (1.0 + v.norm()),
                        "{v:?}"
                    );
                    within.add(true);
                } else if nearest > 1e-6 {
                    outside.add(!region.contains(v));
                    more.add(region.contains(v));
                }
            }
        },
    );
    touching.assert_above(20_000);
    within.assert_above(1000);
    outside.assert_above(5000);
    assert!(
        more.count() * 200 < outside.count(),
        "{} {}",
        more.count(),
        outside.count()
    );
}

#[test]
fn from_inside_or_from_nowhere_every_velocity_meets() {
    check(304, 100, cases(&[0.0]), |(o, ..)| {
        for x in [o.initial().center(), Vector::new(f64::NAN, 0.0)] {
            assert!(
                o.outer_velocities_within(x, 100.0, 0.0)
                    .half_planes()
                    .is_empty()
            );
        }
    });
}

/// Tests discs against the textbook cone: two tangents, shifted by the speed that the target may
/// add to its own.
#[test]
fn discs_have_the_cone_of_the_textbook() {
    let velocity = Vector::new(-1.0, 0.5);
    let o = EllipsoidObstacle::new("", disc(Vector::new(100.0, 0.0), 60.0), disc(velocity, 0.3));
    let region = o.outer_velocities_within(Vector::zeros(), f64::INFINITY, 0.0);
    let sides = region.half_planes();
    let (first, last) = (sides[0], sides[sides.len() - 1]);
    let (sin, cos) = (0.6, 0.8);
    for (side, normal) in [
        (last, Vector::new(-sin, -cos)),
        (first, Vector::new(-sin, cos)),
    ] {
        assert!((side.normal - normal).norm() < 1e-12, "{side:?}");
        assert!((side.offset - normal.dot(&velocity) - 0.3).abs() < 1e-12);
    }
}
