//! With one target, larger sets never make a plan cheaper: the plan for them is clear of the smaller
//! sets too, and the search for the smaller sets finds one that is as cheap.

use searoom::pipeline;

use crate::campaigns::documents::{fault, parsed};

/// Cost of the plan, m², for a target at a place (metres), on a course (degrees) at a speed (m/s).
fn cost([east, north, course, speed]: [f64; 4], margin: f64, spread: f64, deviation: f64) -> f64 {
    let scenario = parsed(&format!(
        r#"title = "larger sets"
        horizon_s = 1600
        own_ship = {{ position = {{ east_m = 0, north_m = 0 }}, course_deg = 90, speed_mps = 5,
            length_m = 50, beam_m = 10, turning_radius_m = 150, speeds_mps = [2.5, 5, 6],
            safety_margin_m = {margin} }}
        mission = {{ waypoints = [{{ east_m = 0, north_m = 0 }}, {{ east_m = 4000, north_m = 0 }}] }}
        planner = {{ compliance = "none" }}
        targets = [{{ name = "t", position = {{ east_m = {east}, north_m = {north} }},
            course_deg = {course}, speed_mps = {speed}, length_m = 80, beam_m = 14,
            position_std_m = {deviation}, speed_spread_mps = {spread} }}]"#
    ));
    let run = pipeline::run(scenario);
    assert!(run.evaluation.as_ref().is_some_and(|e| e.safe()));
    run.planned.outcome.plan().expect("a plan").cost
}

/// Scenes whose plans for larger sets cost down to half of those for the smaller ones, while
/// refinements that fell behind were given up.
#[test]
fn larger_sets_make_no_plan_cheaper() {
    for target in [
        [3396.5, -3293.1, 354.39, 5.441],
        [-753.4, -1057.8, 71.65, 6.844],
        [3648.1, 2550.6, 202.82, 5.429],
    ] {
        let small = cost(target, 20.0, 0.3, 5.0);
        for (margin, spread, deviation) in [(26.0, 0.3, 5.0), (20.0, 0.45, 5.0), (20.0, 0.3, 8.0)] {
            let large = cost(target, margin, spread, deviation);
            assert!(small <= large * (1.0 + 1e-6), "{target:?}: {small} {large}");
        }
    }
}

/// No plan is found around the full domains, nor around the hard sets, but around halved domains.
#[test]
fn halved_domains_are_tried_before_a_risk_is_taken() {
    let scenario = parsed(&fault("little-time-to-spare.toml"));
    let run = pipeline::run(scenario);
    assert!(run.safe(), "{:?}", run.relaxations);
}
