//! Sets after a release, the land margin, and the time after arrival, from both sides of each
//! bound.

use super::*;
use searoom_geometry::{ConvexSet, Ellipse, Polygon};

fn straight() -> Vec<Segment> {
    let mut segments = Vec::new();
    follow(&mut segments, 1500.0, 5.0, 0.0);
    segments
}

fn rectangle([x, y]: [f64; 2], [right, upper]: [f64; 2]) -> Vec<Vector> {
    places(&[(x, y), (right, y), (right, upper), (x, upper)])
}

/// A set at rest that own ship enters, and that is released at `from` seconds.
fn left(at: &[Vector], from: f64) -> SpaceTimeSet {
    let initial = ConvexPolygon::hull(at).expect("finite");
    let still = ConvexPolygon::point(Vector::zeros());
    SpaceTimeSet {
        from,
        ..SpaceTimeSet::constant("other", initial, still)
    }
}

/// Own ship is within the set from 53 s to 60 s. A release before 60 s does not avoid the
/// violation.
#[test]
fn a_set_is_judged_from_its_release_on() {
    let wall = rectangle([265.0, -10.0], [300.0, 10.0]);
    for from in [0.0, 30.0, 45.0, 52.9, 53.1, 59.9] {
        let found = judge(&straight(), &[left(&wall, from)], &[]);
        assert_eq!(words(&found), ["set"], "{from}");
        assert!(found.violations[0].time >= from);
    }
    let found = judge(&straight(), &[left(&wall, 60.1)], &[]);
    assert!(found.verified(), "{:?}", found.violations);
}

/// Own ship begins on a set that has no inside at the start and is left at once. It crosses a
/// needle, where no depth exceeds the tolerance.
#[test]
fn a_set_without_inside_is_entered_where_it_is_touched() {
    let polygon = |at: &[Vector]| ConvexSet::from(ConvexPolygon::hull(at).expect("finite"));
    let ellipse = |length: f64, width: f64| {
        let axes = [Vector::new(length, 0.0), Vector::new(0.0, width)];
        ConvexSet::from(Ellipse::from_axes(Vector::zeros(), axes))
    };
    let small = polygon(&rectangle([0.1, 0.1], [0.2, 0.3]));
    let round = |initial: ConvexSet| match initial {
        ConvexSet::Polygon(_) => small.clone(),
        ConvexSet::Ellipse(_) => ellipse(0.3, 0.2),
    };
    let moved = |set: &ConvexSet, shift: Vector| match set {
        ConvexSet::Polygon(set) => ConvexSet::from(set.translated(shift)),
        ConvexSet::Ellipse(set) => ConvexSet::from(set.translated(shift)),
    };
    let path = straight();
    for initial in [
        polygon(&[Vector::zeros()]),
        polygon(&[Vector::new(0.0, -30.0), Vector::new(0.0, 30.0)]),
        polygon(&rectangle([-30.0, 0.0], [0.0, 1e-6])),
        ellipse(0.0, 0.0),
        ellipse(0.0, 30.0),
        ellipse(1e-6, 30.0),
    ] {
        let growing = Uncertainty::constant(initial.clone(), round(initial.clone()));
        let mut twice = growing.clone();
        twice.velocities.insert(0, twice.velocities[0].clone());
        twice.velocities[0].until = 20.0;
        for sets in [growing, twice] {
            let set = |shift: Vector| SpaceTimeSet {
                name: "other".to_owned(),
                from: 0.0,
                sets: Uncertainty {
                    initial: moved(&sets.initial, shift),
                    ..sets.clone()
                },
            };
            let found = judge(&path, &[set(Vector::zeros())], &[]);
            assert_eq!(words(&found), ["set"], "{sets:?}");
            assert!(found.violations[0].time < 0.1, "{found:?}");
            let astern = judge(&path, &[set(Vector::new(-1.0, 0.0))], &[]);
            assert!(astern.verified(), "{:?}", astern.violations);
        }
    }
    let across = rectangle([200.0, -30.0], [200.000_001, 30.0]);
    assert_eq!(words(&judge(&path, &[left(&across, 0.0)], &[])), ["set"]);
}

/// The hulls overlap from 52.4 s to 59.6 s, far from the set with the target's name.
#[test]
fn a_hull_is_judged_from_the_release_of_its_set_on() {
    let pose = Pose::new(Vector::new(280.0, 0.0), 0.0);
    let other = known(ship(0.0, 0.0), pose, Hull::new(6.0, 1.0));
    let far = rectangle([200.0, 500.0], [300.0, 510.0]);
    let judged = |segments: &[Segment], from| {
        judge(segments, &[left(&far, from)], std::slice::from_ref(&other))
    };
    for from in [0.0, 35.0, 45.0, 52.3, 53.0, 59.5] {
        let found = judged(&straight(), from);
        assert_eq!(words(&found), ["hull"], "{from}");
        assert!(found.violations[0].time >= from && found.min_clearance < -4.0);
    }
    assert!(judged(&straight(), 59.7).verified());
    // A turn on the spot at 53 s, abeam of the target on both courses.
    let mut turning = straight();
    turning[0].duration = 53.0;
    turning[0].start.position = Vector::new(280.0 - 265.0, -12.0);
    let mut onward = turning[0];
    onward.start = Pose::new(turning[0].end().position, 3.0);
    (onward.start_time, onward.duration) = (53.0, 100.0);
    turning.push(onward);
    let hit = |from| words(&judged(&turning, from)).contains(&"hull".to_owned());
    assert!(hit(0.0) && hit(40.0) && hit(52.9) && !hit(53.1));
}

/// The land margin is 20 m, own side is 4 m off the path.
#[test]
fn land_nearer_than_the_margin_is_a_violation() {
    for share in [0.4, 0.6, 0.9, 0.999, 1.001] {
        let is_near = share < 1.0;
        let upper = -4.0 - 20.0 * share;
        let coast = rectangle([600.0, upper - 100.0], [700.0, upper]);
        let found = evaluate(&Request {
            land: &[Polygon::new(&[coast]).expect("a rectangle")],
            land_margin: 20.0,
            ..Request::new(&straight(), &own(), &desired(), 400.0)
        });
        assert_eq!(words(&found) == ["land:"], is_near, "{share}");
        assert_eq!(found.verified(), !is_near);
        assert!((found.min_land_distance - 20.0 * share).abs() < 1e-6);
    }
}

/// Own ship arrives after 300 s and lies across the path of a ship that passes later, from the side
/// or nearly.
#[test]
fn the_time_after_arrival_is_told_and_not_judged() {
    let coming = |after: f64, north: f64| {
        let from = Vector::new(1500.0 + 5.0 * (300.0 + after), north);
        let pose = Pose::new(from, std::f64::consts::PI);
        known(ship(0.0, 5.0), pose, Hull::new(60.0, 12.0))
    };
    let hold = |targets: &[Target], arrival_hold| {
        let found = evaluate(&Request {
            targets,
            arrival_hold,
            ..Request::new(&straight(), &own(), &desired(), 400.0)
        });
        assert!(found.verified(), "{:?}", found.violations);
        assert_eq!(found.arrival_hold, arrival_hold);
        found
    };
    // Bow to bow, 15 m and 30 m from the centres: the target is at 5 m/s and abeam after 29 s.
    let near = |left: f64, found: f64| (found - left).abs() < 1e-6;
    let found = hold(&[coming(29.0, 14.5)], 60.0);
    assert!(near(14.5 - 4.0 - 6.0, found.hold_clearance), "{found:?}");
    assert!(found.min_clearance > 90.0);
    let found = hold(&[coming(29.0, 14.5), coming(200.0, 0.0)], 10.0);
    let ahead = (5.0_f64 * 19.0 - 45.0).hypot(4.5);
    assert!(near(ahead, found.hold_clearance), "{found:?}");
    assert_eq!(found.passages[0].hold_clearance, found.hold_clearance);
    assert!(found.passages[1].hold_clearance > 800.0);
    let found = hold(&[coming(29.0, 0.0)], 60.0);
    assert!(found.hold_clearance < -9.0);
    let found = hold(&[coming(29.0, 0.0)], 0.0);
    assert!(near(found.min_clearance, found.hold_clearance));
    assert_eq!(hold(&[], 60.0).hold_clearance, f64::INFINITY);
}
