//! Tests of the least alteration against a dense search and required relations.

mod set_generators;

use rand::Rng;
use rand_chacha::ChaCha8Rng;
use searoom::frame::{Pose, Vector, direction};
use searoom::geometry::{ConvexPolygon, ConvexSet, Ellipse};
use searoom::obstacle::{EllipsoidObstacle, Obstacle, PolytopeObstacle, SpaceTimeObstacle};
use searoom::study::assess::{Alteration, Query, Situation, assess, least_alteration};
use searoom::target::{TimedVelocitySet, Uncertainty};
use set_generators::{seeded, vector};
use std::f64::consts::PI;

/// Number of headings per half turn, and of speeds, in the dense search.
const STEPS: usize = 4000;

fn polygon(rng: &mut ChaCha8Rng, center: Vector, reach: f64) -> ConvexPolygon {
    let n = rng.random_range(1..7);
    let points: Vec<Vector> = (0..n).map(|_| center + vector(rng, reach)).collect();
    ConvexPolygon::hull(&points).expect("finite")
}

fn ellipse(rng: &mut ChaCha8Rng, center: Vector, reach: f64) -> Ellipse {
    let f = nalgebra::Matrix2::from_columns(&[vector(rng, reach), vector(rng, reach)]);
    Ellipse::new(center, f * f.transpose()).expect("a shape")
}

/// Random obstacle of any kind; some meet own ship.
fn obstacle(rng: &mut ChaCha8Rng) -> Obstacle {
    let place = direction(rng.random_range(-PI..PI)) * rng.random_range(100.0..1500.0);
    let way = -place / rng.random_range(50.0..400.0) + vector(rng, 4.0);
    match rng.random_range(0..3) {
        0 => PolytopeObstacle::new("p", polygon(rng, place, 80.0), polygon(rng, way, 1.0)).into(),
        1 => EllipsoidObstacle::new("e", ellipse(rng, place, 60.0), ellipse(rng, way, 0.7)).into(),
        _ => {
            let ends = [60.0, 130.0, f64::INFINITY];
            let timed = ends.map(|until| TimedVelocitySet::new(until, polygon(rng, way, 1.5)));
            let sets = Uncertainty::new(polygon(rng, place, 60.0), timed.to_vec());
            Obstacle::new("s", sets).expect("increasing")
        }
    }
}

fn situation<'a>(rng: &mut ChaCha8Rng, obstacles: &'a [Obstacle]) -> Situation<'a> {
    Situation {
        pose: Pose::new(Vector::zeros(), rng.random_range(-PI..PI)),
        speed: rng.random_range(1.0..8.0),
        max_speed: 9.0,
        horizon: if rng.random_bool(0.8) {
            300.0
        } else {
            f64::INFINITY
        },
        obstacles,
    }
}

fn is_free(s: &Situation, heading: f64, speed: f64) -> bool {
    let velocity = direction(heading) * speed;
    s.obstacles
        .iter()
        .all(|o| !o.in_velocity_obstacle(s.pose.position, velocity, s.horizon))
}

/// First free sample.
fn sampled(step: f64, last: f64, free: impl Fn(f64) -> bool) -> Option<f64> {
    let count = (last / step).floor() as usize;
    (0..=count).map(|i| i as f64 * step).find(|x| free(*x))
}

/// Checks that the closed form is free, not later than the samples, and that smaller values are not
/// free.
fn holds(
    exact: Option<f64>,
    sampled: Option<f64>,
    step: f64,
    free: impl Fn(f64) -> bool,
    what: &str,
) {
    match (exact, sampled) {
        (Some(exact), sampled) => {
            assert!(free(exact), "{what}: {exact} is not free");
            assert!(exact >= 0.0);
            if let Some(sampled) = sampled {
                assert!(
                    exact <= sampled + 1e-8,
                    "{what}: {exact}, sampled {sampled}"
                );
            }
            for i in 0..((exact - 1e-8) / step).max(0.0) as usize {
                assert!(!free(i as f64 * step), "{what}: {i} before {exact}");
            }
            // up to the boundary itself
            let before = exact - 1e-6;
            assert!(
                before <= 0.0 || !free(before),
                "{what}: {exact} is not the first"
            );
        }
        (None, Some(sampled)) => panic!("{what}: none, sampled {sampled}"),
        (None, None) => {}
    }
}

#[test]
fn the_least_alteration_is_that_of_a_dense_search() {
    let mut rng = seeded(1);
    let (mut turned, mut none, mut changed) = (0, 0, 0);
    for case in 0..400 {
        let count = rng.random_range(1..5);
        let obstacles: Vec<_> = (0..count).map(|_| obstacle(&mut rng)).collect();
        let s = situation(&mut rng, &obstacles);
        let found = least_alteration(&s);
        let step = PI / STEPS as f64;
        for (side, sign, exact) in [
            ("starboard", -1.0, found.starboard),
            ("port", 1.0, found.port),
        ] {
            let free = |turn: f64| is_free(&s, s.pose.heading + sign * turn, s.speed);
            let what = format!("{case} {side} {s:?}");
            holds(exact, sampled(step, PI, free), step, free, &what);
            turned += usize::from(exact.is_some_and(|t| t > 0.0));
            none += usize::from(exact.is_none());
        }
        let step = s.max_speed / STEPS as f64;
        let free = |change: f64| is_free(&s, s.pose.heading, s.speed + change);
        let slower = |change: f64| free(-change);
        let (down, up) = (
            sampled(step, s.speed, slower),
            sampled(step, s.max_speed - s.speed, free),
        );
        let what = format!("{case} speed {s:?}");
        match found.speed {
            Some(change) if change < 0.0 => {
                holds(Some(-change), down, step, slower, &what);
                assert!(up.is_none_or(|up| up >= -change - 1e-8), "{what}");
            }
            Some(change) => {
                holds(Some(change), up, step, free, &what);
                assert!(down.is_none_or(|down| down >= change - 1e-8), "{what}");
            }
            None => assert!(down.is_none() && up.is_none(), "{what}"),
        }
        changed += usize::from(found.speed.is_some_and(|c| c != 0.0));
    }
    assert!(
        turned > 100 && none > 5 && changed > 50,
        "{turned} {none} {changed}"
    );
}

fn mirrored(obstacle: &Obstacle) -> Obstacle {
    let flip = |p: &Vector| Vector::new(p.x, -p.y);
    let polygon = |set: &ConvexPolygon| {
        let points: Vec<Vector> = set.vertices().iter().map(flip).collect();
        ConvexPolygon::hull(&points).expect("finite")
    };
    let ellipse = |set: &Ellipse| {
        let q = set.shape();
        let shape = nalgebra::Matrix2::new(q[(0, 0)], -q[(0, 1)], -q[(1, 0)], q[(1, 1)]);
        Ellipse::new(flip(&set.center()), shape).expect("a shape")
    };
    let map = |set: &ConvexSet| match set {
        ConvexSet::Polygon(set) => ConvexSet::from(polygon(set)),
        ConvexSet::Ellipse(set) => ConvexSet::from(ellipse(set)),
    };
    let sets = obstacle.sets();
    let timed = sets.velocities.iter();
    let timed = timed.map(|set| TimedVelocitySet::new(set.until, map(&set.velocities)));
    let sets = Uncertainty::new(map(&sets.initial), timed.collect());
    Obstacle::new(obstacle.name(), sets).expect("increasing")
}

fn near(a: Option<f64>, b: Option<f64>) -> bool {
    match (a, b) {
        (Some(a), Some(b)) => (a - b).abs() < 1e-6,
        (None, None) => true,
        _ => false,
    }
}

#[test]
fn a_mirrored_scene_has_the_mirrored_answer() {
    let mut rng = seeded(2);
    for _ in 0..300 {
        let count = rng.random_range(1..4);
        let obstacles: Vec<_> = (0..count).map(|_| obstacle(&mut rng)).collect();
        let other: Vec<_> = obstacles.iter().map(mirrored).collect();
        let s = situation(&mut rng, &obstacles);
        let m = Situation {
            pose: Pose::new(Vector::zeros(), -s.pose.heading),
            obstacles: &other,
            ..s
        };
        let (here, there) = (least_alteration(&s), least_alteration(&m));
        assert!(near(here.starboard, there.port), "{here:?} {there:?} {s:?}");
        assert!(near(here.port, there.starboard), "{here:?} {there:?} {s:?}");
        assert!(near(here.speed, there.speed), "{here:?} {there:?} {s:?}");
    }
}

#[test]
fn own_ship_inside_a_set_is_helped_by_nothing_and_far_away_by_none_needed() {
    let around = |center: Vector| {
        let sides = [(10.0, -5.0), (10.0, 5.0), (-10.0, 5.0), (-10.0, -5.0)];
        let corners: Vec<Vector> = sides
            .iter()
            .map(|&(x, y)| center + Vector::new(x, y))
            .collect();
        ConvexPolygon::hull(&corners).expect("finite")
    };
    let at = |center: Vector, velocity: Vector| -> Obstacle {
        PolytopeObstacle::new("p", around(center), ConvexPolygon::point(velocity)).into()
    };
    let still = |obstacles: &[Obstacle], speed: f64| {
        least_alteration(&Situation {
            pose: Pose::new(Vector::zeros(), 0.0),
            speed,
            max_speed: 6.0,
            horizon: 400.0,
            obstacles,
        })
    };
    let nothing = Alteration {
        starboard: None,
        port: None,
        speed: None,
    };
    let held = Alteration {
        starboard: Some(0.0),
        port: Some(0.0),
        speed: Some(0.0),
    };
    assert_eq!(still(&[at(Vector::zeros(), Vector::zeros())], 5.0), nothing);
    assert_eq!(
        still(&[at(Vector::new(0.0, 900.0), Vector::zeros())], 5.0),
        held
    );
    assert_eq!(still(&[], 5.0), held);
    // at rest with an approaching target: turning does not help, speed does
    let stopped = still(&[at(Vector::new(0.0, 400.0), Vector::new(0.0, -2.0))], 0.0);
    assert_eq!((stopped.starboard, stopped.port), (None, None));
    assert!((stopped.speed.expect("ahead of her") - 10.0 / 197.5).abs() < 1e-6);
    // tangents to a box at rest dead ahead, through its near corners
    let ahead = still(&[at(Vector::new(410.0, 0.0), Vector::zeros())], 5.0);
    let tangent = (5.0_f64).atan2(400.0);
    assert!((ahead.starboard.expect("a turn") - tangent).abs() < 1e-8);
    assert!((ahead.port.expect("a turn") - tangent).abs() < 1e-8);
    // 400 m away, reached only after the horizon of 400 s at 1 m/s or less
    assert!((ahead.speed.expect("slower") + 4.0).abs() < 1e-8);
}

#[test]
fn the_answers_are_those_of_the_obstacles() {
    let mut rng = seeded(3);
    for _ in 0..100 {
        let obstacles = [obstacle(&mut rng), obstacle(&mut rng)];
        let s = Situation {
            horizon: 300.0,
            ..situation(&mut rng, &obstacles)
        };
        let query = Query {
            velocities: vec![s.velocity(), vector(&mut rng, 8.0)],
            ..Query::default()
        };
        let answer = assess("Random", "hard", &s, &query);
        let all = answer.hold_course.targets.iter();
        for (held, same) in all.zip(&answer.velocities[0].targets) {
            assert_eq!((held.dcpa_m, held.tcpa_s), (same.dcpa_m, same.tcpa_s));
            assert!((0.0..=1.0).contains(&held.max_risk));
            if held.dcpa_m > 1e-9 {
                assert!(!same.in_velocity_obstacle);
                assert!(held.max_risk <= 1e-11, "{}", held.max_risk);
            }
        }
    }
}

/// Tests points, segments, needles and repeated vertices, near and far: the answer is free, and no
/// smaller sample is.
#[test]
fn degenerate_sets_are_left_too() {
    let mut rng = seeded(4);
    let mut turned = 0;
    for case in 0..600 {
        let count = rng.random_range(1..4);
        let obstacles: Vec<Obstacle> = (0..count)
            .map(|_| match rng.random_range(0..3) {
                0 => set_generators::polytope(&mut rng).into(),
                1 => set_generators::ellipsoid(&mut rng).into(),
                _ => set_generators::slabs(&mut rng).into(),
            })
            .collect();
        let far = [1.0, 100.0, 1e4][rng.random_range(0..3)];
        let mut s = situation(&mut rng, &obstacles);
        s.pose.position = vector(&mut rng, 150.0 * far);
        s.horizon *= far;
        // usually directly toward one of them
        if let searoom::geometry::ConvexSet::Polygon(section) = obstacles[0].section(100.0 * far) {
            let relative = section.vertices()[0] - s.pose.position;
            s.pose.heading = relative.y.atan2(relative.x);
            s.speed = (relative.norm() / (100.0 * far)).clamp(0.1, 9.0);
        }
        let found = least_alteration(&s);
        let step = PI / 500.0;
        for (sign, exact) in [(-1.0, found.starboard), (1.0, found.port)] {
            let free = |turn: f64| is_free(&s, s.pose.heading + sign * turn, s.speed);
            let what = format!("{case} {sign} {s:?}");
            holds(exact, sampled(step, PI, free), step, free, &what);
            turned += usize::from(exact.is_some_and(|t| t > 0.0));
        }
        if let Some(change) = found.speed {
            assert!(
                is_free(&s, s.pose.heading, s.speed + change),
                "{case} {change} {s:?}"
            );
        }
    }
    assert!(turned > 100, "{turned}");
}

#[test]
fn the_regions_of_slabs_are_their_velocity_obstacle() {
    let mut rng = seeded(5);
    let (mut inside, mut outside) = (0, 0);
    for _ in 0..300 {
        let slabs = set_generators::slabs(&mut rng);
        let position = vector(&mut rng, 200.0);
        let horizon = [20.0, 90.0, f64::INFINITY][rng.random_range(0..3)];
        let regions = slabs.outer_velocity_obstacles(position, horizon);
        for _ in 0..200 {
            let v = vector(&mut rng, 6.0);
            let beyond = regions
                .iter()
                .map(|r| {
                    let planes = r.half_planes().iter();
                    let most = planes.map(|h| h.normal.dot(&v) - h.offset);
                    most.fold(f64::NEG_INFINITY, f64::max)
                })
                .fold(f64::INFINITY, f64::min);
            let meets = Obstacle::from(slabs.clone()).in_velocity_obstacle(position, v, horizon);
            if beyond.abs() > 1e-9 {
                assert_eq!(
                    meets,
                    beyond < 0.0,
                    "{slabs:?} {position:?} {v:?} {horizon}"
                );
            }
            inside += usize::from(meets);
            outside += usize::from(!meets);
        }
    }
    assert!(inside > 1000 && outside > 1000, "{inside} {outside}");
}
