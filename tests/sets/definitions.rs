//! Tests of specific set properties beyond the common suite against their definitions.

use super::generators::{
    Counter, check, directions, disc, ellipse, hull, line, polygon, polytope, segment, slabs,
    vector,
};
use proptest::sample::select;
use searoom::frame::{Pose, Vector, direction, to_port};
use searoom::geometry::ConvexPolygon;
use searoom::obstacle::{
    EllipsoidObstacle, Obstacle, PolytopeObstacle, SlabError, SpaceTimeObstacle,
};
use searoom::target::{TimedVelocitySet, Uncertainty};
use searoom::trajectory::{Segment, Trajectory};

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
    let s = Segment::straight(
        Pose::new(
            at(99.65467289116157, -41.06950535229376),
            3.1943180518723153,
        ),
        0.0,
        34.054769876637884,
        5.8175559313373135,
    );
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
            let around = disc(Vector::zeros(), 40.0).outer_polygon(16);
            let initial = hull(&corners).minkowski_sum(&around);
            let fastest: Vector = direction(heading + 10_f64.powf(off)) * fast;
            let velocity = hull(&[fastest * 0.01, fastest]);
            let o = PolytopeObstacle::new("o", initial.clone(), velocity.clone());
            let (half, side, share) = meeting;
            let meets = fastest * (half * share) + abeam * side;
            let line = Segment::straight(
                Pose::new(meets - direction(own) * (speed * half), own),
                0.0,
                2.0 * half,
                speed,
            );
            let exact = o.peak_risk(&line).risk;
            // a change to the same velocities, within the motion, is searched and not solved
            let timed =
                [half, f64::INFINITY].map(|until| TimedVelocitySet::new(until, velocity.clone()));
            let searched = Obstacle::new("o", Uncertainty::new(initial, timed.to_vec()))
                .expect("increasing")
                .peak_risk(&line)
                .risk;
            assert!((exact - searched).abs() < 1e-7, "{exact} {searched}");
            between.add(exact > 0.0 && exact < 1.0);
        },
    );
    between.assert_above(300);
}

#[test]
fn of_a_flat_minimum_the_earliest_instant_is_told() {
    let square = ConvexPolygon::rectangle(Vector::zeros(), 10.0, 10.0);
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
            let velocities = slab.obstacle().velocity().outer_polygon(3).scaled(duration);
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
    let made = |sets| Obstacle::new("x", Uncertainty::new(still.clone(), sets));
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
