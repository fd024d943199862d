//! A target whose velocity ellipse changes with time: its set contains every position that it may
//! reach, and plans, checker and verification of a document agree on it.

use std::path::Path;

use nalgebra::Matrix2;
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use searoom::document::PlanDocument;
use searoom::frame::{Pose, Vector, direction, to_port};
use searoom::geometry::Ellipse;
use searoom::obstacle::{EllipsoidObstacle, Obstacle, SpaceTimeObstacle};
use searoom::pipeline;
use searoom::scenario::Scenario;
use searoom::target::{Motion, TimedVelocitySet, Uncertainty};
use searoom::tolerance;
use searoom::trajectory::Segment;
use searoom::verification::verify;
use serde_json::{Value, json};

/// Changes of the velocities, seconds.
const ENDS: [f64; 3] = [20.0, 45.0, f64::INFINITY];

fn changing(initial: Ellipse, velocities: [Ellipse; 3]) -> Obstacle {
    let timed = ENDS.iter().zip(velocities);
    let timed = timed.map(|(until, set)| TimedVelocitySet::new(*until, set));
    Obstacle::new("x", Uncertainty::new(initial, timed.collect())).expect("increasing")
}

fn seeded(seed: u64) -> ChaCha8Rng {
    ChaCha8Rng::seed_from_u64(seed)
}

fn vector(rng: &mut ChaCha8Rng, scale: f64) -> Vector {
    let mut number = || rng.random_range(-scale..scale);
    Vector::new(number(), number())
}

/// An ellipse, sometimes a segment or a point.
fn ellipse(rng: &mut ChaCha8Rng, scale: f64) -> Ellipse {
    let set = round(rng, scale);
    let [along, _] = set.semi_axes();
    match rng.random_range(0..6) {
        0 => Ellipse::point(set.center()),
        1 => Ellipse::new(set.center(), along * along.transpose()).expect("a shape"),
        2 => Ellipse::new(set.center(), Matrix2::identity() * scale).expect("a shape"),
        _ => set,
    }
}

fn segment(rng: &mut ChaCha8Rng, straight: bool) -> Segment {
    Segment {
        start: Pose::new(vector(rng, 200.0), rng.random_range(-3.0..3.0)),
        start_time: rng.random_range(0.0..30.0),
        duration: rng.random_range(1.0..60.0),
        speed: rng.random_range(0.0..8.0),
        turn_rate: if straight { 0.0 } else { 0.05 },
    }
}

/// An ellipse with an interior.
fn round(rng: &mut ChaCha8Rng, scale: f64) -> Ellipse {
    let (center, along) = (vector(rng, scale), vector(rng, scale));
    let across = to_port(along) * rng.random_range(0.2..1.0);
    let shape = along * along.transpose() + across * across.transpose();
    Ellipse::new(center, shape).expect("a shape")
}

fn scenario() -> Scenario {
    let path = Path::new(env!("CARGO_MANIFEST_DIR"));
    let path = path.join("scenarios/uncertainty/changing-ellipses.toml");
    Scenario::read(&path).expect("a scenario")
}

/// A target changes its velocity at random times, to random velocities of the set that holds.
#[test]
fn every_position_that_is_reached_is_contained() {
    let mut rng = seeded(31);
    for case in 0..300 {
        let initial = ellipse(&mut rng, 60.0);
        let velocities = [(); 3].map(|()| ellipse(&mut rng, 2.0));
        let o = changing(initial, velocities);
        for _ in 0..20 {
            let (mut x, mut t) = (
                initial.boundary_point(direction(rng.random_range(0.0..6.3))),
                0.0,
            );
            while t < 80.0 {
                let now = ENDS.iter().position(|end| t < *end).expect("the last");
                let set = velocities[now].scaled_about_center(rng.random_range(0.0..=1.0));
                let v = set.boundary_point(direction(rng.random_range(0.0..6.3)));
                let step = f64::min(ENDS[now] - t, rng.random_range(0.1..30.0));
                (x, t) = (x + v * step, t + step);
                assert!(o.signed_distance(x, t).distance <= 1e-9, "{case} {t}");
            }
        }
    }
}

/// Three equal velocity ellipses one after another are one velocity ellipse.
#[test]
fn velocities_that_do_not_change_are_one_ellipsoid() {
    let mut rng = seeded(32);
    for case in 0..300 {
        let (initial, velocity) = (ellipse(&mut rng, 60.0), ellipse(&mut rng, 2.0));
        let many = changing(initial, [velocity; 3]);
        let one = Obstacle::from(EllipsoidObstacle::new("x", initial, velocity));
        let (x, v) = (vector(&mut rng, 200.0), vector(&mut rng, 4.0));
        let t = rng.random_range(0.0..90.0);
        let n = direction(rng.random_range(0.0..6.3));
        let near = |a: f64, b: f64| (a - b).abs() < 1e-7 * (1.0 + a.abs()) || a == b;
        assert!(
            near(one.support(n, t).value, many.support(n, t).value),
            "{case}"
        );
        assert!(near(one.alpha(x, t), many.alpha(x, t)), "{case} {t}");
        let [a, b] = [&one, &many].map(|o| o.closest_approach(x, v, 80.0));
        assert!(near(a.distance, b.distance), "{case} {a:?} {b:?}");
        let s = segment(&mut rng, case % 2 == 0);
        let [a, b] = [&one, &many].map(|o| o.peak_risk(&s).risk);
        assert!(
            (a - b).abs() < 1e-6 + 2.0 * tolerance::RISK,
            "{case} {a} {b}"
        );
        let rest = many.remainder(30.0);
        assert!(
            near(rest.support(n, t).value, one.support(n, t + 30.0).value),
            "{case}"
        );
    }
}

/// A point on the edge of a level set has the risk of that level, and level sets are nested.
#[test]
fn risk_is_the_level_at_which_a_point_leaves_the_set() {
    let mut rng = seeded(33);
    for case in 0..300 {
        let velocities = [(); 3].map(|()| round(&mut rng, 2.0));
        let o = changing(round(&mut rng, 20.0), velocities);
        let (t, risk) = (rng.random_range(1.0..90.0), rng.random_range(0.05..0.95));
        let level = o.at_risk(risk);
        let edge = level
            .section(t)
            .as_ellipse()
            .expect("an ellipse")
            .boundary_point(direction(rng.random_range(0.0..6.3)));
        assert!((o.risk(edge, t) - risk).abs() < 1e-6, "{case} {t}");
        let n = direction(rng.random_range(0.0..6.3));
        assert!(level.support(n, t).value <= o.support(n, t).value + 1e-9);
    }
}

/// Regions of velocities to avoid contain every velocity that meets the set.
#[test]
fn velocity_obstacles_contain_the_velocities_that_meet_the_set() {
    let mut rng = seeded(34);
    let mut met = 0;
    for case in 0..300 {
        let velocities = [(); 3].map(|()| round(&mut rng, 2.0));
        let o = changing(round(&mut rng, 60.0), velocities);
        let (x, v) = (vector(&mut rng, 200.0), vector(&mut rng, 6.0));
        if o.in_velocity_obstacle(x, v, 80.0) {
            met += 1;
            let regions = o.velocity_obstacles(x, 80.0).expect("half-planes");
            assert!(regions.iter().any(|region| region.contains(v)), "{case}");
        }
    }
    assert!(met > 30, "{met}");
}

fn document(scenario: Scenario) -> Value {
    let run = pipeline::run(scenario);
    let evaluation = run.evaluation.as_ref().expect("a plan");
    assert!(evaluation.verified(), "{:?}", evaluation.violations);
    serde_json::to_value(PlanDocument::of(&run)).expect("a document")
}

fn is_accepted(document: &Value) -> bool {
    verify(&document.to_string())
        .expect("a plan document")
        .verified()
}

#[test]
fn plans_are_verified_and_a_later_set_that_is_too_small_is_rejected() {
    let mut at_risk = scenario();
    at_risk.max_risk = 0.3;
    for scenario in [scenario(), at_risk] {
        let whole = document(scenario);
        assert!(is_accepted(&whole));
        assert_eq!(whole["obstacles"].as_array().expect("slabs").len(), 2);
        for (place, factor) in [
            ("/obstacles/0/initial_set/shape_m2/0/0", 0.99),
            ("/obstacles/0/velocity_set/shape_m2_per_s2/1/1", 0.99),
            ("/obstacles/1/initial_set/shape_m2/0/0", 0.99),
            ("/obstacles/1/velocity_set/shape_m2_per_s2/0/0", 0.99),
            ("/obstacles/1/velocity_set/center_mps/1", 1.01),
            // less than a micrometre per second too slow, but a tenth of a millimetre later
            ("/obstacles/1/velocity_set/center_mps/1", 1.0 - 1e-7),
            ("/obstacles/0/valid_s/1", 1.1),
            ("/targets/0/velocity_sets/1/shape_m2_per_s2/0/0", 1.02),
            ("/targets/0/velocity_sets/0/until_s", 0.9),
        ] {
            let mut altered = whole.clone();
            let value = altered.pointer_mut(place).expect(place);
            *value = json!(value.as_f64().expect("a number") * factor);
            assert!(!is_accepted(&altered), "{place}");
        }
        let mut altered = whole.clone();
        altered["obstacles"].as_array_mut().expect("slabs").pop();
        assert!(!is_accepted(&altered));
    }
}

/// The checker finds a plan for smaller later velocities inside the set.
#[test]
fn a_plan_for_smaller_later_velocities_is_rejected() {
    let whole = scenario();
    let mut smaller = whole.clone();
    let Motion::Sets(sets) = &mut smaller.targets[0].motion else {
        panic!("sets");
    };
    sets.velocities[1].velocities = sets.velocities[1].velocities.scaled_about_center(0.5);
    let run = pipeline::run(smaller);
    let plan = run.planned.outcome.plan().expect("a plan");
    assert!(run.evaluation.as_ref().expect("judged").verified());
    let hard: Vec<Obstacle> = pipeline::sets(&whole).into_iter().map(|s| s.hard).collect();
    let found = pipeline::judge(&whole, &hard, &plan.trajectory);
    assert!(!found.verified() && !found.violations.is_empty());
}
