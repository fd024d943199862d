//! A valid plan and its corruptions: each must be found, and nothing else.

use super::*;
use crate::geometry_fixtures::{places, random_vector};
use crate::sets::moving_ellipse::MovingEllipse;
use crate::ship_fixtures::own_ship;
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use searoom_geometry::frame::{Pose, Side, Vector};
use searoom_geometry::{ConvexPolygon, Ellipse};
use searoom_model::target::{
    Motion, Representation, ShipTrack, Target, TimedVelocitySet, Uncertainty,
};
use searoom_model::trajectory::DesiredTrajectory;
use searoom_model::vessel::Hull;
use searoom_model::vessel::OwnShip;

mod judged;
mod turned;

const RADIUS: f64 = 100.0;

fn own() -> OwnShip {
    own_ship(&[2.5, 5.0, 6.0])
}

fn desired() -> DesiredTrajectory {
    DesiredTrajectory::new(&[Vector::zeros(), Vector::new(1500.0, 0.0)], &[5.0]).expect("valid")
}

/// Appends a segment of `length` metres that turns by `turn` radians.
fn follow(segments: &mut Vec<Segment>, length: f64, speed: f64, turn: f64) {
    let (start, start_time) = segments
        .last()
        .map_or((own().pose, 0.0), |s| (s.end(), s.end_time()));
    let duration = length / speed;
    segments.push(Segment::new(
        start,
        start_time,
        duration,
        speed,
        turn / duration,
    ));
}

/// 200 m ahead, a deviation to starboard and back, ahead to the end.
fn plan() -> Vec<Segment> {
    let mut s = Vec::new();
    let turn = 0.6;
    follow(&mut s, 200.0, 5.0, 0.0);
    follow(&mut s, turn * RADIUS, 5.0, -turn);
    follow(&mut s, 150.0, 6.0, 0.0);
    follow(&mut s, 2.0 * turn * RADIUS, 6.0, 2.0 * turn);
    follow(&mut s, 150.0, 6.0, 0.0);
    follow(&mut s, turn * RADIUS, 5.0, -turn);
    let left = 1500.0 - s[5].end().position.x;
    follow(&mut s, left, 5.0, 0.0);
    s
}

/// The lowest point of [`plan`].
fn lowest() -> f64 {
    plan()[3].pose_after(plan()[3].duration / 2.0).position.y
}

/// A set whose upper side is fixed while its ends move.
fn below(upper: f64) -> SpaceTimeSet {
    let corners = places(&[
        (200.0, -900.0),
        (1200.0, -900.0),
        (1200.0, upper),
        (200.0, upper),
    ]);
    let speeds = places(&[(-0.5, 0.0), (1.0, 0.0), (0.0, -1.0)]);
    let [initial, velocities] =
        [corners, speeds].map(|points| ConvexPolygon::hull(&points).expect("finite"));
    SpaceTimeSet::constant("below", initial, velocities)
}

fn ship(y: f64, speed: f64) -> Target {
    Target {
        name: "other".to_owned(),
        motion: Motion::Ship(ShipTrack {
            position_std: 2.0,
            speed_spread: 0.5,
            course_spread: 0.02,
            ..ShipTrack::exact(
                Pose::new(Vector::new(1500.0, y), std::f64::consts::PI),
                speed,
                Hull::new(60.0, 12.0),
            )
        }),
        representation: Representation::Polytope,
        status: None,
    }
}

/// A ship of which nothing is unknown, with another pose and hull.
fn known(mut target: Target, pose: Pose, hull: Hull) -> Target {
    if let Motion::Ship(track) = &mut target.motion {
        *track = ShipTrack::exact(pose, track.speed, hull);
    }
    target
}

/// Own ship turns on the spot beside an anchored ship and is clear of it before and after. During
/// the turn, own bow sweeps over the other hull.
#[test]
fn a_hull_is_met_in_a_turn_on_the_spot() {
    let mut segments = Vec::new();
    follow(&mut segments, 200.0, 5.0, 0.0);
    let mut onward = segments[0];
    onward.start = Pose::new(segments[0].end().position, 1.5);
    onward.start_time = segments[0].end_time();
    let place = segments[0].end().position + searoom_geometry::frame::direction(0.75) * 14.0;
    let other = known(ship(0.0, 0.0), Pose::new(place, 2.3), Hull::new(6.0, 1.0));
    let along = judge(&segments, &[], std::slice::from_ref(&other));
    assert!(along.min_clearance > 1.0, "{}", along.min_clearance);
    segments.push(onward);
    let turned = judge(&segments, &[], std::slice::from_ref(&other));
    let anchored = other.ship().expect("a ship");
    let anchored = anchored.hull.polygon(&anchored.pose);
    let scan = (0..=1500)
        .map(|k| Pose::new(onward.start.position, 1.5 * f64::from(k) / 1500.0))
        .map(|pose| own().hull.polygon(&pose).separation(&anchored))
        .fold(f64::INFINITY, f64::min);
    let found = turned.min_clearance;
    assert!(scan < -1.0 && (found - scan).abs() < 0.01, "{found} {scan}");
    let mut violations = turned.violations.iter();
    let met = violations.find(|v| v.what.contains("hull of 'other'"));
    assert!((met.expect("met").time - 40.0).abs() < 1e-9);
}

fn judge(segments: &[Segment], sets: &[SpaceTimeSet], targets: &[Target]) -> Evaluation {
    evaluate(&Request {
        targets,
        sets,
        ..Request::new(segments, &own(), &desired(), 400.0)
    })
}

/// First word of each violation.
fn faults(segments: &[Segment]) -> Vec<String> {
    let sets = [below(lowest() - 1e-3)];
    words(&judge(segments, &sets, &[ship(300.0, 5.0)]))
}

fn words(found: &Evaluation) -> Vec<String> {
    let word = |what: &str| what.split(' ').next().unwrap_or_default().to_owned();
    let mut words: Vec<String> = found.violations.iter().map(|v| word(&v.what)).collect();
    words.dedup();
    words
}

#[test]
fn a_valid_plan_passes_with_its_figures() {
    let found = judge(&plan(), &[below(lowest() - 1e-3)], &[ship(300.0, 5.0)]);
    assert!(found.verified(), "{:?}", found.violations);
    let straight = 1500.0 - (plan()[5].end().position.x - 200.0);
    let length = straight + 4.0 * 0.6 * RADIUS + 300.0;
    assert!((found.length - length).abs() < 1e-9);
    let duration: f64 = plan().iter().map(|s| s.duration).sum();
    assert!((found.duration - duration).abs() < 1e-9);
    assert!((found.delay - (duration - 300.0)).abs() < 1e-9);
    assert!(found.space_time_error > 0.0 && found.arc_length_error > 0.0);
    let passage = found.passages[0];
    assert_eq!(passage.passing_side, Side::Port);
    // They meet near the middle of the deviation, where own hull is nearly parallel to the x axis.
    assert!(passage.dcpa > 290.0 && passage.dcpa < 300.0 - lowest());
    assert!(passage.min_clearance < passage.dcpa - 6.0);
    assert_eq!(found.min_clearance, passage.min_clearance);
    assert_eq!(passage.min_margin, f64::INFINITY);
}

/// A corruption of a plan, and the first words of the violations that it causes. Joints are judged one
/// by one, then in sum.
type Corruption = (fn(&mut Vec<Segment>), &'static [&'static str]);

const CORRUPTIONS: [Corruption; 16] = [
    // in another place or at another time
    (
        |s| s.iter_mut().for_each(|s| s.start.position.y += 2e-6),
        &["start"],
    ),
    (
        |s| s.iter_mut().for_each(|s| s.start.position.y += 2e-5),
        &["start", "arrival:"],
    ),
    (
        |s| s.iter_mut().for_each(|s| s.start_time += 1e-6),
        &["start"],
    ),
    (
        |s| s.iter_mut().for_each(|s| s.start_time += 200.0),
        &["start", "arrival"],
    ),
    (
        |s| s[0].start.heading += 1e-8,
        &["start", "position", "heading", "position"],
    ),
    // cut off
    (|s| s.truncate(6), &["arrival:"]),
    (|s| s[6].duration -= 4e-6, &["arrival:"]),
    (Vec::clear, &["segments:"]),
    // on the path as before, but faster
    (
        |s| {
            s[6].speed *= 1.0 + 1e-6;
            s[6].duration /= 1.0 + 1e-6;
        },
        &["speed"],
    ),
    (
        |s| s[5].turn_rate *= 1.0 + 1e-6,
        &["position", "heading", "position", "turn"],
    ),
    // a turn on the spot
    (
        |s| s.push(Segment::new(s[6].end(), s[6].end_time(), 1.0, 0.0, 0.1)),
        &["turn", "speed"],
    ),
    (|s| s[2].start.position.y += 2e-6, &["position"]),
    // the last leg is long, so the arrival is wrong too
    (|s| s[6].start.heading += 1e-7, &["heading", "arrival:"]),
    (|s| s[3].start_time += 1e-6, &["time"]),
    (
        |s| {
            s.remove(4);
        },
        &["position", "time", "position", "time"],
    ),
    (|_| {}, &[]),
];

#[test]
fn every_corruption_is_found_and_nothing_else() {
    for (index, (corrupt, expected)) in CORRUPTIONS.into_iter().enumerate() {
        let mut segments = plan();
        corrupt(&mut segments);
        assert_eq!(faults(&segments), expected, "corruption {index}");
    }
}

#[test]
fn the_depth_decides_on_an_arc() {
    let depth = |d: f64| words(&judge(&plan(), &[below(lowest() + d)], &[]));
    assert_eq!(depth(0.0), Vec::<String>::new());
    assert_eq!(depth(5e-7), Vec::<String>::new());
    assert_eq!(depth(2e-6), ["set"]);
    assert_eq!(depth(1e-5), ["set"]);
    assert_eq!(depth(10.0), ["set"]);
    let found = judge(&plan(), &[below(lowest() + 1e-5)], &[]);
    let bottom = plan()[3].start_time + plan()[3].duration / 2.0;
    assert!((found.violations[0].time - bottom).abs() < 0.1);
}

#[test]
fn a_set_crossed_between_any_two_samples_is_found() {
    // A needle that own ship crosses in a hundredth of a second.
    let at = plan()[0].pose_at(17.0).position;
    let thin = |half: f64| {
        let initial = ConvexPolygon::rectangle(at, half, 30.0);
        SpaceTimeSet::constant("needle", initial, ConvexPolygon::point(Vector::zeros()))
    };
    for half in [0.025, 1e-4, 2e-6, 0.0] {
        let found = judge(&plan(), &[thin(half)], &[]);
        assert_eq!(words(&found), ["set"], "{half}");
    }
}

#[test]
fn the_hulls_are_judged_whatever_the_sets_say() {
    let found = judge(&plan(), &[], &[ship(0.0, 5.0)]);
    assert_eq!(words(&found), ["hull"]);
    assert!(found.min_clearance < 0.0);
    // The nominal motion is clear, but the uncertain hull is not.
    let near = judge(&plan(), &[], &[ship(17.0, 0.0)]);
    assert!(near.passages[0].dcpa > 3.0 && near.min_clearance < 0.0);
    assert_eq!(words(&near), ["hull"]);
}

#[test]
fn what_is_not_a_number_is_never_verified() {
    for index in 0..7 {
        for field in 0..7 {
            for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
                let mut s = plan();
                let it = &mut s[index];
                *match field {
                    0 => &mut it.start.position.x,
                    1 => &mut it.start.position.y,
                    2 => &mut it.start.heading,
                    3 => &mut it.start_time,
                    4 => &mut it.duration,
                    5 => &mut it.speed,
                    _ => &mut it.turn_rate,
                } = bad;
                assert_eq!(faults(&s), ["values:"], "{index} {field} {bad}");
                let found = judge(&s, &[], &[]);
                assert!(found.space_time_error.is_nan() && found.min_clearance.is_nan());
            }
        }
    }
    let mut limits = own();
    limits.turning_radius = f64::NAN;
    limits.pose.heading = f64::NAN;
    let found = evaluate(&Request {
        arrival_hold: f64::NAN,
        ..Request::new(&plan(), &limits, &desired(), f64::NAN)
    });
    assert_eq!(words(&found), ["start", "heading", "turn", "arrival"]);
}

#[test]
fn margins_go_to_the_target_of_their_name() {
    let mut set = below(lowest() - 3.0);
    set.name = "other".to_owned();
    let found = judge(&plan(), &[below(-800.0), set], &[ship(300.0, 5.0)]);
    let passage = found.passages[0];
    assert!((passage.min_margin - 3.0).abs() < 1e-6, "{passage:?}");
    let bottom = plan()[3].start_time + plan()[3].duration / 2.0;
    assert!((passage.min_margin_time - bottom).abs() < 0.1);
}

fn line(from: Vector, heading: f64, duration: f64) -> Segment {
    Segment::straight(Pose::new(from, heading), 0.0, duration, 5.0)
}

fn round(initial: Ellipse, velocity: Ellipse) -> SpaceTimeSet {
    SpaceTimeSet::constant("round", initial, velocity)
}

fn disc(center: Vector, radius: f64) -> Ellipse {
    let axes = [Vector::new(radius, 0.0), Vector::new(0.0, radius)];
    Ellipse::from_axes(center, axes)
}

#[test]
fn a_growing_disc_is_met_to_a_micrometre() {
    // The sum of two discs is exact: radius 50 + 0.5 t, centre at (400 + t, 0).
    let middle = Vector::new(400.0, 0.0);
    let set = round(disc(middle, 50.0), disc(Vector::new(1.0, 0.0), 0.5));
    // Own ship moves at a relative speed of 4 m/s along a tangent of the growing disc's cone.
    let moved = Vector::new(4.0, 0.0);
    let sine = 0.5 / moved.norm();
    let cosine = (1.0 - sine * sine).sqrt();
    for (depth, met) in [(2e-6, true), (-2e-6, false), (0.5, true), (-0.5, false)] {
        let from = Vector::new(0.0, (50.0 - depth + 400.0 * sine) / cosine);
        let passed = line(from, 0.0, 200.0);
        let found = judge(&[passed], std::slice::from_ref(&set), &[]);
        assert_eq!(words(&found).contains(&"set".to_owned()), met, "{depth}");
    }
}

#[test]
fn distances_of_ellipses_match_a_dense_scan() {
    let mut rng = ChaCha8Rng::seed_from_u64(77);
    for case in 0..150 {
        let mut ellipse = |scale: f64, thin: bool| {
            let mut vector = || random_vector(&mut rng, 1.0) * scale;
            let (center, a) = (vector(), vector());
            let b = searoom_geometry::frame::to_port(a) * if thin { 0.0 } else { 0.4 };
            Ellipse::from_axes(center, [a, b])
        };
        let set = (ellipse(30.0, case % 3 == 0), ellipse(1.0, case % 4 == 0));
        let moving = MovingEllipse::new(&[(set.0, 1.0)], &set.1);
        let s = Segment::new(
            Pose::new(random_vector(&mut rng, 80.0), rng.random_range(-3.0..3.0)),
            rng.random_range(0.0..5.0),
            rng.random_range(1.0..20.0),
            rng.random_range(0.0..8.0),
            [0.0, 0.1, -0.2][case % 3],
        );
        // Distance to the section as an ellipse.
        let at = |time: f64| {
            let root = |e: &Ellipse| e.shape().trace().sqrt();
            let (ro, rv) = (root(&set.0), root(&set.1));
            let q = (set.0.shape() / ro + set.1.shape() * (time / rv)) * (ro + rv * time);
            let center = set.0.center() + set.1.center() * time;
            let section = Ellipse::new(center, q).expect("a shape");
            section.signed_distance(s.pose_at(time).position).distance
        };
        let found = moving.least_distance_below(Least::new(), &[s]);
        let scan = (0..=2000)
            .map(|i| at(s.start_time + s.duration * f64::from(i) / 2000.0))
            .fold(f64::INFINITY, f64::min);
        assert!(found.certified, "{case}");
        // A shape matrix keeps half of the digits of a thin axis.
        assert!(
            (at(found.time) - found.value).abs() < 1e-6,
            "{case} {found:?} {}",
            at(found.time)
        );
        assert!(
            found.value <= scan + 1e-6 && scan - found.value < 0.1,
            "{case} {found:?} {scan}"
        );
    }
}

#[test]
fn slabs_are_judged_within_their_time() {
    // At rest for 60 s, then north at 5 m/s.
    let square = ConvexPolygon::rectangle(Vector::new(300.0, 0.0), 20.0, 10.0);
    let timed =
        |until, north| TimedVelocitySet::new(until, ConvexPolygon::point(Vector::new(0.0, north)));
    let judged = |until: f64| {
        let set = SpaceTimeSet {
            from: 0.0,
            name: "slabs".to_owned(),
            sets: Uncertainty::new(
                square.clone(),
                vec![timed(until, 0.0), timed(f64::INFINITY, 5.0)],
            ),
        };
        let found = judge(&[line(Vector::zeros(), 0.0, 300.0)], &[set], &[]);
        words(&found).contains(&"set".to_owned())
    };
    // Own ship is beside the set from 56 s to 64 s; the set needs 2 s to clear its path.
    assert!(!judged(54.0 - 1e-5) && judged(54.0 + 1e-5) && judged(60.0));
}
