//! Tests of distant conflicts along a route of many legs.

use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use searoom::pipeline;
use searoom::planner::Outcome;
use searoom::scenario::{Compliance, Scenario};

use crate::campaigns::documents::{fault, parsed};

/// Length of a leg in metres.
const LEG: f64 = 500.0;

/// A zigzag of `legs` legs at 5 m/s. A ship crosses every fourth leg when own ship is due there.
fn scenario(legs: usize) -> Scenario {
    let mut points = vec![(0.0, 0.0)];
    for leg in 0..legs {
        let heading: f64 = if leg % 2 == 0 { 0.3 } else { -0.2 };
        let (east, north): (f64, f64) = points[leg];
        points.push((east + LEG * heading.cos(), north + LEG * heading.sin()));
    }
    let waypoints: Vec<String> = points
        .iter()
        .map(|(x, y)| format!("{{ east_m = {x:.3}, north_m = {y:.3} }}"))
        .collect();
    let first = 90.0 - 0.3_f64.to_degrees();
    let mut text = format!(
        "title = \"zigzag\"\nhorizon_s = {}\nmission = {{ waypoints = [{}] }}\n[own_ship]\nposition = {{ east_m = 0, north_m = 0 }}\n\
         course_deg = {first:.6}\nspeed_mps = 5\nlength_m = 30\nbeam_m = 8\nturning_radius_m = 80\nspeeds_mps = [2.5, 5, 6]\n",
        legs as f64 * LEG / 5.0 * 1.5,
        waypoints.join(", ")
    );
    for leg in (2..legs).step_by(4) {
        let (a, b) = (points[leg], points[leg + 1]);
        let (east, north) = (0.5 * (a.0 + b.0), 0.5 * (a.1 + b.1));
        let time = (leg as f64 + 0.5) * LEG / 5.0;
        // from the north, from the south
        let (course, side) = if leg % 8 == 2 { (180, 1.0) } else { (0, -1.0) };
        text += &format!(
            "[[targets]]\nname = \"ship {leg}\"\nposition = {{ east_m = {east:.3}, north_m = {:.3} }}\ncourse_deg = {course}\nspeed_mps = 4\n\
             length_m = 40\nbeam_m = 10\nspeed_spread_mps = 0.01\ncourse_spread_deg = 0.05\n",
            north + side * 4.0 * time
        );
    }
    parsed(&text)
}

/// In an empty sea the desired trajectory itself is the plan, also where each leg has another of own
/// ship's speeds: its cost is nothing but rounding, which must not be taken for a fault.
#[test]
fn a_schedule_at_own_speeds_is_sailed_as_it_is() {
    let mut rng = ChaCha8Rng::seed_from_u64(20);
    for case in 0..120 {
        let legs = rng.random_range(2..=4);
        let (mut north, mut points, mut speeds) = (0.0, vec![0.0], Vec::new());
        for _ in 0..legs {
            north += rng.random_range(500.0..3_000.0);
            points.push(north);
            speeds.push(rng.random_range(3.0..6.0));
        }
        let points = points
            .iter()
            .map(|n| format!("{{ east_m = 0.0, north_m = {n} }}"));
        let points: Vec<String> = points.collect();
        let text = format!(
            "title = \"schedule\"\nhorizon_s = 6000.0\n\
             mission = {{ waypoints = [{}], leg_speeds_mps = {speeds:?} }}\n[own_ship]\n\
             position = {{ east_m = 0.0, north_m = 0.0 }}\ncourse_deg = 0.0\nspeed_mps = 5.0\n\
             length_m = 80.0\nbeam_m = 14.0\nturning_radius_m = 240.0\n",
            points.join(", ")
        );
        let run = pipeline::run(parsed(&text));
        let outcome = &run.planned.outcome;
        assert!(
            matches!(outcome, Outcome::Solved(_)),
            "{case}: {outcome:?}\n{text}"
        );
        let error = run.evaluation.map(|evaluation| evaluation.space_time_error);
        assert!(
            error.is_some_and(|error| error.abs() < 1e-3),
            "{case}: {error:?}"
        );
    }
}

/// Tests conflicts far apart. One manoeuvre around all of them would cost hundreds of times as
/// much, or would not be found.
#[test]
fn conflicts_that_are_far_apart_are_left_and_met_one_after_another() {
    // early action costs more
    let modes = [(Compliance::Shape, 6_000.0), (Compliance::Rules, 10_000.0)];
    let cases = modes
        .into_iter()
        .flat_map(|mode| [8, 20, 40].map(|legs| (mode, legs)));
    for ((compliance, most), legs) in cases {
        let mut scenario = scenario(legs);
        scenario.compliance = compliance;
        let run = pipeline::run(scenario);
        let outcome = &run.planned.outcome;
        assert!(matches!(outcome, Outcome::Solved(_)), "{legs}: {outcome:?}");
        let evaluation = run.evaluation.expect("judged");
        assert!(evaluation.verified(), "{:?}", evaluation.violations);
        let error = evaluation.space_time_error;
        assert!(error < most, "{compliance:?} {legs}: {error}");
        assert!(evaluation.delay.abs() < 60.0);
    }
}

/// With speed in reserve own ship is on schedule again before the next conflict, and then J of all
/// is the sum of J around each target alone.
#[test]
fn conflicts_that_are_far_apart_cost_what_each_costs_alone() {
    let cost = |scenario: Scenario| {
        let run = pipeline::run(scenario);
        assert!(run.relaxations.is_empty(), "{:?}", run.relaxations);
        match &run.planned.outcome {
            Outcome::Solved(plan) => (plan.cost, run.scenario.targets.len()),
            other => panic!("{other:?}"),
        }
    };
    let mut all = scenario(20);
    all.compliance = Compliance::Shape;
    let alone = (0..all.targets.len()).map(|index| {
        let mut one = all.clone();
        one.targets = vec![all.targets[index].clone()];
        cost(one).0
    });
    let sum: f64 = alone.sum();
    let (together, targets) = cost(all);
    assert!(
        targets == 5 && together < 1.02 * sum,
        "{together} of {sum} m²"
    );
}

/// Past the first ship the cheapest way leads to where the others bar every way. Another way keeps
/// all domains.
#[test]
fn an_earlier_conflict_is_passed_in_another_way_where_a_later_one_has_none() {
    let mut scenario = parsed(&fault("passage-of-25-km.toml"));
    scenario.compliance = Compliance::Shape;
    let run = pipeline::run(scenario);
    assert!(run.relaxations.is_empty(), "{:?}", run.relaxations);
    assert!(run.safe());
    let cost = run.planned.outcome.plan().expect("a plan").cost;
    assert!(cost < 800_000.0, "{cost}");
}
