//! A target whose velocity ellipse changes with time. Its set contains every position that it may
//! reach. Plans, checker and verification of a document agree on it.

use proptest::collection::vec;
use searoom::frame::{Vector, direction};
use searoom::geometry::Ellipse;
use searoom::obstacle::{Obstacle, SpaceTimeObstacle};
use searoom::pipeline;
use searoom::scenario::Scenario;
use searoom::target::Motion;
use serde_json::json;

use super::documents::{self, checked, document};
use super::generators::{Counter, angle, check, round_slabs, vector};

fn scenario() -> Scenario {
    documents::scenario("uncertainty/changing-ellipses.toml")
}

/// A target changes its velocity at random times, to random velocities of the set that holds.
/// A point of an ellipse farthest along a unit vector.
fn boundary_point(ellipse: &Ellipse, n: Vector) -> Vector {
    let [a, b] = ellipse.semi_axes();
    let (along, across) = (n.dot(&a), n.dot(&b));
    let reach = along.hypot(across).max(f64::MIN_POSITIVE);
    ellipse.center() + (a * along + b * across) / reach
}

#[test]
fn every_position_that_is_reached_is_contained() {
    let changes = vec((0.1..30.0, 0.0..=1.0, angle()), 20);
    check(
        31,
        1500,
        (round_slabs(), angle(), changes),
        |(o, first, changes)| {
            let sets = o.sets();
            let initial = sets.initial.as_ellipse().expect("an ellipse");
            let (mut x, mut t) = (boundary_point(initial, direction(first)), 0.0);
            for (duration, share, toward) in changes {
                let now = sets
                    .velocities
                    .iter()
                    .find(|set| t < set.until)
                    .expect("the last");
                let set = now.velocities.as_ellipse().expect("an ellipse");
                let v = boundary_point(&set.scaled_about_center(share), direction(toward));
                let step = f64::min(now.until - t, duration);
                (x, t) = (x + v * step, t + step);
                assert!(o.signed_distance(x, t).distance <= 1e-9, "{t}");
            }
        },
    );
}

/// Regions of velocities to avoid contain every velocity that meets the set.
#[test]
fn velocity_obstacles_contain_the_velocities_that_meet_the_set() {
    let met = Counter::default();
    check(
        34,
        1500,
        (round_slabs(), vector(200.0), vector(6.0)),
        |(o, x, v)| {
            if o.in_velocity_obstacle(x, v, 80.0) {
                met.add(true);
                let regions = o.outer_velocity_obstacles(x, 80.0);
                assert!(regions.iter().any(|region| region.contains(v)));
            }
        },
    );
    met.assert_above(100);
}

#[test]
fn plans_are_verified_and_a_later_set_that_is_too_small_is_rejected() {
    let mut at_risk = scenario();
    at_risk.max_risk = 0.3;
    for scenario in [scenario(), at_risk] {
        let whole = document(scenario);
        assert!(checked(&whole).verified());
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
            assert!(!checked(&altered).verified(), "{place}");
        }
        let mut altered = whole.clone();
        altered["obstacles"].as_array_mut().expect("slabs").pop();
        assert!(!checked(&altered).verified());
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
