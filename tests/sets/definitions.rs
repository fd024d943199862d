//! Tests of specific set properties beyond the common suite against their definitions.

use super::generators::{
    Counter, check, directions, ellipse, hull, line, polygon, polytope, segment, slabs, vector,
};
use nalgebra::{Matrix2, Matrix3, Vector3};
use proptest::prelude::*;
use proptest::sample::select;
use searoom::frame::{Pose, Vector, direction, to_port};
use searoom::geometry::{ConvexPolygon, Ellipse};
use searoom::obstacle::{
    EllipsoidObstacle, PolytopeObstacle, SlabError, SlabObstacle, SpaceTimeObstacle,
};
use searoom::target::{DomainKind, ShipTrack, TimedVelocitySet, Uncertainty};
use searoom::trajectory::{Segment, Trajectory};
use searoom::vessel::Hull;

/// Definition, paper eqs. (22)-(25), as a linear programme in `(d, alpha)`: least `alpha >= 0` with
/// `d / t in alpha (V - v)` and `x - v t - d in O_0`, by every vertex of its feasible set.
fn alpha_by_vertices(o: &PolytopeObstacle, x: Vector, t: f64) -> f64 {
    let centroid = o.velocity().centroid();
    let q = x - centroid * t;
    let mut rows: Vec<(Vector3<f64>, f64)> = vec![(Vector3::new(0.0, 0.0, -1.0), 0.0)];
    for n in o.velocity().normals() {
        let spread = o.velocity().support(n) - n.dot(&centroid);
        rows.push((Vector3::new(n.x, n.y, -t * spread), 0.0));
    }
    for n in o.initial().normals() {
        rows.push((
            Vector3::new(-n.x, -n.y, 0.0),
            o.initial().support(n) - n.dot(&q),
        ));
    }
    let mut least = f64::INFINITY;
    for i in 0..rows.len() {
        for j in 0..i {
            for k in 0..j {
                let a = Matrix3::from_rows(&[i, j, k].map(|r| rows[r].0.transpose()));
                if a.determinant().abs() < 1e-9 {
                    continue;
                }
                let b = Vector3::new(rows[i].1, rows[j].1, rows[k].1);
                let Some(z) = a.try_inverse().map(|inverse| inverse * b) else {
                    continue;
                };
                if rows.iter().all(|(row, limit)| row.dot(&z) <= limit + 1e-7) {
                    least = least.min(z.z);
                }
            }
        }
    }
    least
}

#[test]
fn alpha_of_a_polytope_is_the_linear_programme() {
    let found = Counter::default();
    let set = |scale| proptest::collection::vec(vector(scale), 3..6);
    let cases = (set(40.0), set(2.0), vector(120.0), 1.0..40.0);
    check(201, 1500, cases, |(initial, velocity, x, t)| {
        let o = PolytopeObstacle::new("x", hull(&initial), hull(&velocity));
        let slow = alpha_by_vertices(&o, x, t);
        let alpha = o.alpha(x, t);
        if slow < 50.0 {
            found.add(alpha > 0.0);
            assert!((alpha - slow).abs() < 1e-5 * (1.0 + slow), "{alpha} {slow}");
        }
    });
    found.assert_above(500);
}

#[test]
fn the_search_for_the_closest_approach_agrees_with_the_closed_form() {
    // a polytope and the ellipsoid of two flat sets describe the same set
    let thin = |center, axis: Vector, width: f64| {
        let across = to_port(axis).normalize() * width;
        let shape = axis * axis.transpose() + across * across.transpose();
        Ellipse::new(center, shape).expect("a shape")
    };
    let axes = vector(30.0).prop_filter("a length", |a| a.norm() > 1e-3);
    let cases = (axes, vector(50.0), vector(2.0), vector(300.0), vector(4.0));
    check(202, 500, cases, |(a, p, v, x, own)| {
        let exact = PolytopeObstacle::new("x", hull(&[p - a, p + a]), ConvexPolygon::point(v));
        let nearly = EllipsoidObstacle::new("x", thin(p, a, 1e-4), Ellipse::point(v));
        let flat = EllipsoidObstacle::new("x", thin(p, a, 0.0), Ellipse::point(v));
        assert!(flat.is_flat() && !nearly.is_flat());
        for horizon in [5.0, 100.0, f64::INFINITY] {
            let exact = exact.closest_approach(x, own, horizon);
            let flat = flat.closest_approach(x, own, horizon);
            let nearly = nearly.closest_approach(x, own, horizon);
            assert!(
                (exact.distance - flat.distance).abs() < 1e-9,
                "{exact:?} {flat:?}"
            );
            assert!(
                (exact.distance - nearly.distance).abs() < 1e-3,
                "{exact:?} {nearly:?}"
            );
            // the width rounds the ends by some centimetres
            let same_time = (exact.time - nearly.time).abs() < 0.5;
            assert!(exact.distance <= 1.0 || same_time, "{exact:?} {nearly:?}");
        }
    });
}

/// Tests a segment of velocities, whose width is zero except for rounding; rounding must not
/// determine the descent direction.
#[test]
fn the_largest_risk_over_a_segment_of_velocities() {
    let at = |x, y| Vector::new(x, y);
    let o = PolytopeObstacle::new(
        "x",
        hull(&[
            at(-46.30827663940356, -43.78531967927327),
            at(-87.84681538759017, -28.32344102563171),
        ]),
        hull(&[
            at(3.0889836874879917, -1.9728428804482787),
            at(1.3447887713747981, -0.7744303115552711),
        ]),
    );
    let s = Segment {
        start: Pose::new(
            at(99.65467289116157, -41.06950535229376),
            3.1943180518723153,
        ),
        start_time: 0.0,
        duration: 34.054769876637884,
        speed: 5.8175559313373135,
        turn_rate: 0.0,
    };
    let sampled = (0..20_000)
        .map(|i| f64::from(i) * s.duration / 20_000.0)
        .map(|t| o.risk(s.pose_at(t).position, t))
        .fold(0.0, f64::max);
    let peak = o.peak_risk(&s);
    assert!(
        sampled > 0.01 && peak.risk >= sampled && peak.risk < sampled + 1e-3,
        "{peak:?} {sampled}"
    );
}

/// Tests a long hull with velocities along it, against bisection over contacts. Faces that alpha
/// hardly moves are adjacent to a face that it does not move.
#[test]
fn the_largest_risk_where_the_velocities_lie_along_a_face() {
    let between = Counter::default();
    let set = (-3.2..3.2, 20.0..150.0, 1.0..20.0);
    // a course that differs from the hull's by rounding, and by more
    let fastest = (-17.0..-8.0, 5.0..40.0);
    let meeting = (20.0..150.0, -60.0..60.0, 0.0..1.0);
    let cases = (set, fastest, meeting, -3.2..3.2, 1.0..8.0);
    check(
        231,
        2000,
        cases,
        |((heading, long, wide), (off, fast), meeting, own, speed)| {
            let [ahead, abeam] = [direction(heading), to_port(direction(heading))];
            let corners = [(1.0, 1.0), (-1.0, 1.0), (-1.0, -1.0), (1.0, -1.0)]
                .map(|(x, y): (f64, f64)| ahead * (x * long) + abeam * (y * wide));
            let disc =
                Ellipse::new(Vector::zeros(), Matrix2::identity() * 1600.0).expect("a shape");
            let initial = hull(&corners).minkowski_sum(&disc.outer_polygon(16));
            let fastest: Vector = direction(heading + 10_f64.powf(off)) * fast;
            let o = PolytopeObstacle::new("o", initial, hull(&[fastest * 0.01, fastest]));
            let (half, side, share) = meeting;
            let meets = fastest * (half * share) + abeam * side;
            let line = Segment {
                start: Pose::new(meets - direction(own) * (speed * half), own),
                start_time: 0.0,
                duration: 2.0 * half,
                speed,
                turn_rate: 0.0,
            };
            let exact = o.peak_risk(&line).risk;
            let searched = SlabObstacle::unchanging(&o).peak_risk(&line).risk;
            assert!((exact - searched).abs() < 1e-7, "{exact} {searched}");
            between.add(exact > 0.0 && exact < 1.0);
        },
    );
    between.assert_above(300);
}

#[test]
fn of_a_flat_minimum_the_earliest_instant_is_told() {
    let square = hull(
        &[(-10.0, -10.0), (10.0, -10.0), (10.0, 10.0), (-10.0, 10.0)]
            .map(|(x, y)| Vector::new(x, y)),
    );
    let o = PolytopeObstacle::new("x", square, ConvexPolygon::point(Vector::zeros()));
    let past = o.closest_approach(
        Vector::new(-100.0, 15.0),
        Vector::new(5.0, 0.0),
        f64::INFINITY,
    );
    assert!(
        (past.distance - 5.0).abs() < 1e-12 && (past.time - 18.0).abs() < 1e-12,
        "{past:?}"
    );
    // alongside from the start, at the same speed
    let still = o.closest_approach(Vector::new(0.0, 15.0), Vector::zeros(), 100.0);
    assert!(
        still.time == 0.0 && (still.distance - 5.0).abs() < 1e-12,
        "{still:?}"
    );
}

#[test]
fn the_half_planes_are_the_velocities_that_meet() {
    let [within, outside] = [(); 2].map(|()| Counter::default());
    let horizons = select(vec![20.0, 100.0, f64::INFINITY]);
    let velocities = proptest::collection::vec(vector(3.0), 20);
    let cases = (polytope(), vector(200.0), horizons, velocities, vector(5.0));
    check(203, 2500, cases, |(o, x, horizon, velocities, drawn)| {
        let region = o.velocity_obstacle(x, horizon);
        if o.contains(x, 0.0) {
            assert!(region.half_planes().is_empty());
        }
        for v in velocities {
            let v = o.velocity().centroid() + v;
            let planes = region.half_planes().iter();
            let margin = planes.map(|h| h.normal.dot(&v) - h.offset);
            let margin = margin.fold(f64::NEG_INFINITY, f64::max);
            if margin.abs() < 1e-6 {
                continue;
            }
            let meets = o.in_velocity_obstacle(x, v, horizon);
            assert_eq!(region.contains(v), meets, "{v:?} {margin}");
            within.add(meets && !region.half_planes().is_empty());
            outside.add(!meets);
        }
        if let Some(picture) = region.clipped(5.0)
            && picture.signed_distance(drawn).abs() > 1e-6
        {
            assert_eq!(picture.contains(drawn), region.contains(drawn));
        }
    });
    within.assert_above(2000);
    outside.assert_above(2000);
}

#[test]
fn slabs_are_the_sums_of_what_went_before() {
    check(209, 400, (slabs(), 0.0..120.0), |(o, t)| {
        // definition: every vertex of O_0 with every choice of one velocity in each slab
        let mut all = o.sets().initial.outer_polygon(3).vertices().to_vec();
        for slab in o.slabs() {
            let duration = (f64::min(t, slab.end()) - slab.start()).max(0.0);
            let velocities = slab.obstacle().sets().velocities[0]
                .velocities
                .outer_polygon(3)
                .scaled(duration);
            all = all
                .iter()
                .flat_map(|p| velocities.vertices().iter().map(move |v| p + v))
                .collect();
            all = hull(&all).vertices().to_vec();
        }
        let slow = hull(&all);
        for n in directions(32) {
            assert!((o.support(n, t).value - slow.support(n)).abs() < 1e-8);
        }
        assert!(
            (o.section(t).outer_polygon(3).area() - slow.area()).abs() < 1e-6 * (1.0 + slow.area())
        );
    });
}

#[test]
fn one_slab_is_the_polytope_and_so_are_slabs_of_one_set() {
    let cases = (polytope(), vector(200.0), vector(4.0), 0.0..60.0, segment());
    check(210, 400, cases, |(p, x, v, t, s)| {
        let timed = [7.0, 20.0, f64::INFINITY]
            .map(|until| TimedVelocitySet::new(until, p.velocity().clone()));
        let sets = Uncertainty::new(p.initial().clone(), timed.to_vec());
        let many = SlabObstacle::new("x", sets).expect("increasing");
        let one = SlabObstacle::unchanging(&p);
        for o in [&one, &many] {
            let (a, b) = (
                o.closest_approach(x, v, 100.0),
                p.closest_approach(x, v, 100.0),
            );
            assert!((a.distance - b.distance).abs() < 1e-7);
            assert!(
                (a.time - b.time).abs() < 1e-4 || b.distance > 0.0,
                "{a:?} {b:?}"
            );
            if p.signed_distance(x, t).distance.abs() > 1e-6 {
                assert!((o.risk(x, t) - p.risk(x, t)).abs() < 1e-7);
            }
            if let Some(first) = p.first_contact(&s, 1e-6) {
                let found = o.first_contact(&s, 0.0).expect("met");
                assert!(found <= first + 1e-6, "{found} {first}");
            }
        }
    });
}

#[test]
fn the_risk_along_a_trajectory_is_the_largest_of_its_segments() {
    let between = Counter::default();
    check(
        214,
        200,
        (polytope(), segment(), segment()),
        |(o, first, second)| {
            let second = Segment {
                start: first.end(),
                start_time: first.end_time(),
                ..second
            };
            let trajectory = Trajectory::new(vec![first, second]).expect("joined");
            let peak = o.peak_risk_along(&trajectory);
            let (a, b) = (o.peak_risk(&first), o.peak_risk(&second));
            assert_eq!(peak.risk, a.risk.max(b.risk));
            for t in trajectory.sample_times(0.5, u32::MAX) {
                assert!(o.risk(trajectory.pose_at(t).position, t) <= peak.risk + 1e-9);
            }
            between.add(peak.risk > 0.0 && peak.risk < 1.0);
        },
    );
    between.assert_above(10);
}

#[test]
fn velocity_sets_out_of_order_are_refused() {
    let still = ConvexPolygon::point(Vector::zeros());
    let timed = |until| TimedVelocitySet::new(until, still.clone());
    let made = |sets| SlabObstacle::new("x", Uncertainty::new(still.clone(), sets));
    assert_eq!(made(vec![]).err(), Some(SlabError::Empty));
    for bad in [5.0, 3.0, f64::NAN, f64::INFINITY] {
        let found = made(vec![timed(5.0), timed(bad), timed(9.0)]).err();
        assert!(
            matches!(
                found,
                Some(SlabError::NotIncreasing {
                    index: 1,
                    after: 5.0,
                    ..
                })
            ),
            "{found:?}"
        );
    }
    assert!(
        made(vec![timed(5.0), timed(4.0)]).is_ok(),
        "the last has no end"
    );
}

/// Tests a target with arbitrary turns within its rate: it stays in the sets.
#[test]
fn a_target_that_turns_stays_in_its_slabs() {
    let ship = (-3.0..3.0, 1.0..8.0, 0.0..1.0, 0.0..0.2);
    let turns = proptest::collection::vec(-1.0..=1.0, 500);
    let cases = (ship, 0.001..0.03, turns);
    check(
        211,
        100,
        cases,
        |((heading, speed, speed_spread, course_spread), rate, turns)| {
            let ship = ShipTrack {
                pose: Pose::new(Vector::zeros(), heading),
                speed,
                hull: Hull {
                    length: 50.0,
                    beam: 10.0,
                },
                position_std: 0.0,
                speed_spread,
                course_spread,
                turn_rate: 0.0,
                domain: DomainKind::Hull,
            };
            let velocities = ship.outer_velocity_sets(rate, 200.0);
            let point = ConvexPolygon::point(Vector::zeros());
            let o =
                SlabObstacle::new("x", Uncertainty::new(point, velocities)).expect("increasing");
            for policy in 0..3 {
                let mut x = Vector::zeros();
                let mut course = heading + course_spread;
                for (step, share) in turns.iter().enumerate() {
                    let t = 0.5 * step as f64;
                    let share = match policy {
                        0 => 1.0,
                        1 => *share,
                        _ => (0.1 * t).sin().signum(),
                    };
                    x += direction(course) * (speed + speed_spread) * 0.5;
                    course += rate * share * 0.5;
                    let apart = o.signed_distance(x, t + 0.5).distance;
                    assert!(apart <= 1e-6, "{policy} {t} {apart}");
                }
            }
        },
    );
}

#[test]
fn degenerate_motion_of_degenerate_sets_is_answered() {
    let sets = (polygon(10.0), polygon(1.0), ellipse(10.0), ellipse(1.0));
    check(212, 300, (sets, line()), |((p, v, e, w), s)| {
        let polytope = PolytopeObstacle::new("x", p, v);
        let ellipsoid = EllipsoidObstacle::new("x", e, w);
        for o in [&polytope as &dyn SpaceTimeObstacle, &ellipsoid] {
            let wait = Segment {
                speed: 0.0,
                duration: 0.0,
                ..s
            };
            let place = wait.start.position;
            let at = o.signed_distance(place, wait.start_time).distance;
            if at.abs() > 1e-6 {
                assert_eq!(o.first_contact(&wait, 0.0).is_some(), at < 0.0);
            }
            let risk = o.risk(place, wait.start_time);
            let peak = o.peak_risk(&wait);
            assert!((peak.risk - risk).abs() < 1e-6, "{peak:?} {risk} {at}");
            let found = o.closest_approach(place, Vector::zeros(), 0.0);
            let now = o.signed_distance(place, 0.0).distance.max(0.0);
            assert!((found.distance - now).abs() < 1e-9 && found.time == 0.0);
        }
    });
}
