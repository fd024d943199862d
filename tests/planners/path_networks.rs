//! The path-time planner through the whole program: what is planned is right by its own judgement
//! and by that of its document.

use searoom::document::PlanDocument;
use searoom::obstacle::SpaceTimeObstacle;
use searoom::pipeline::{self, Relaxation, RelaxationLevel, Run};
use searoom::planner::path_time::PathTimePlanner;
use searoom::planner::{Objective, Plan};
use searoom::trajectory::Trajectory;
use searoom::verification::verify;
use serde_json::{Value, json};

use crate::campaigns::documents::{parsed, scenario};

fn document(run: &Run) -> Value {
    serde_json::to_value(PlanDocument::of(run)).expect("JSON")
}

/// Violations of a document; empty for a sound one.
fn faults(document: &Value) -> String {
    match verify(&document.to_string()) {
        Ok(found) if found.verified() => String::new(),
        Ok(found) => format!("{:?}", found.violations),
        Err(error) => error.to_string(),
    }
}

/// The run of a text, right by its own judgement and by that of its document where it has a plan.
fn verified(text: &str) -> Run {
    let mut scenario = parsed(text);
    scenario.planner = &PathTimePlanner;
    scenario.compliance = searoom::scenario::Compliance::Shape;
    let run = pipeline::run(scenario);
    if run.planned.outcome.plan().is_some() {
        let judged = run.evaluation.as_ref().expect("every plan is judged");
        assert!(judged.verified(), "{:?}", judged.violations);
        assert_eq!(faults(&document(&run)), "");
    }
    run
}

fn plan(run: &Run) -> &Plan {
    run.planned.outcome.plan().expect("a plan")
}

fn trajectory(run: &Run) -> &Trajectory {
    &plan(run).trajectory
}

/// A start in a set, on a network that is cut where its path meets itself: own ship leaves it, and
/// arrives at the end.
#[test]
fn out_of_a_set_the_plan_goes_on_to_the_end() {
    let run = verified(include_str!("../faults/exit3-path-time-stops-short.toml"));
    assert_eq!(run.level, RelaxationLevel::Inside);
    let plan = plan(&run);
    let off = (plan.trajectory.end().position - run.scenario.desired.end()).norm();
    assert!(plan.to_go == 0.0 && off < 1e-6, "{off}");
    let until = run.targets[0].released.expect("it starts inside");
    assert!(until > 0.0 && until < 20.0, "{until}");
}

/// A path that comes to a place twice, and an alternative that does: from one pass to the other
/// only by sailing the alternative.
#[test]
fn one_pass_of_a_place_is_not_another() {
    verified(include_str!("../faults/exit3-path-time-place-twice.toml"));
    verified(include_str!(
        "../faults/exit3-path-time-millimetre-leg.toml"
    ));
}

/// Own ship waits at the start on another course than the first leg's, and turns when it moves off.
#[test]
fn a_wait_at_the_start_is_not_turned() {
    let text = include_str!("../faults/exit3-path-time-wait-turned.toml");
    let run = verified(text);
    let first = trajectory(&run).segments()[0];
    assert_eq!(first.speed, 0.0);
    assert_eq!(first.start.heading, run.scenario.own_ship.pose.heading);
}

/// The error of a plan is that against the mission, on whatever path it sails: so the mission
/// itself, which nobody bars, is sailed.
#[test]
fn the_error_on_an_alternative_is_that_against_the_mission() {
    let text = include_str!("../faults/verify-rejects-path-time-alternative.toml");
    let run = verified(text);
    assert!((trajectory(&run).length() - run.scenario.desired.length()).abs() < 1e-6);
    assert!(plan(&run).cost < 1e-9, "{}", plan(&run).cost);
    // with a wreck on the last leg of the mission alone the alternative is taken, at its price
    let wreck = "\n[[targets]]\nname = \"wreck\"\nposition = { east_m = 100.0, north_m = 75.0 }\ncourse_deg = 0.0\n\
                 speed_mps = 0.0\nlength_m = 10.0\nbeam_m = 6.0\n";
    let run = verified(&format!("{text}{wreck}"));
    let error = run.evaluation.as_ref().expect("judged").space_time_error;
    assert!(run.relaxations.is_empty() && error > 1000.0, "{error}");
    assert!((plan(&run).cost - error).abs() < 1e-6 * error);
    let mut less = document(&run);
    less["cost"]["objective"] = json!(1.01 * error);
    assert!(faults(&less).contains("cost.objective"));
}

/// A slower ship is ahead on a path without a way past. Own ship follows, clear of the whole shape
/// up to the horizon, and says that it does not arrive.
#[test]
fn behind_a_slower_ship_own_ship_follows_and_says_that_it_does_not_arrive() {
    let run = verified(include_str!("../../scenarios/colregs/overtaking.toml"));
    assert_eq!(run.level, RelaxationLevel::Waiting);
    let judged = run.evaluation.as_ref().expect("judged");
    let clearance = judged.min_clearance;
    assert!(clearance > 20.0 && run.max_risk == 0.0, "{clearance}");
    assert!(judged.delay.is_nan() && judged.duration == run.scenario.horizon);
    let [Relaxation::Arrival { target, amount }] = &run.relaxations[..] else {
        panic!("{:?}", run.relaxations);
    };
    assert_eq!(target, "target");
    assert!((amount - (1500.0 - judged.length)).abs() < 1e-6, "{amount}");
    let reason = run.reason().expect("why");
    let ahead = "is there or ahead up to the horizon";
    assert!(reason.contains(ahead), "{reason}");
    let document = document(&run);
    assert_eq!(document["cost"]["arrived"], false);
    assert_eq!(document["cost"]["delay_s"], Value::Null);
    assert_eq!(document["outcome"], "relaxed");
    // documents that claim an arrival or more distance sailed, or end before the horizon, are
    // rejected
    let altered = |alter: &dyn Fn(&mut Value)| {
        let mut altered = document.clone();
        alter(&mut altered);
        faults(&altered)
    };
    assert!(altered(&|d| d["cost"]["arrived"] = json!(true)).contains("cost.arrived"));
    let silent = altered(&|d| {
        d["outcome"] = json!("solved");
        d["relaxations"] = json!([]);
        d["cost"]["arrived"] = json!(true);
    });
    assert!(silent.contains("arrival"), "{silent}");
    let nearer = altered(&|d| {
        d["relaxations"][0]["amount"] = json!(100.0);
    });
    assert!(nearer.contains("relaxation of arrival, amount"), "{nearer}");
    let shorter = altered(&|d| {
        let segments = d["trajectory"]["segments"].as_array_mut();
        let last = segments.and_then(|s| s.last_mut()).expect("some");
        last["duration_s"] = json!(last["duration_s"].as_f64().expect("a number") - 1.0);
    });
    assert!(shorter.contains("s from the horizon"), "{shorter}");
}

/// A ship comes the other way, and nothing along the path is clear. Own ship stops and lets itself
/// be passed. Inside the set it makes no way; when the ship is past it goes on to the end.
#[test]
fn where_a_ship_comes_down_the_path_own_ship_stops() {
    use Objective::{Length, SpaceTimeError, Time};
    for objective in [SpaceTimeError, Time, Length] {
        let mut scenario = scenario("colregs/head-on.toml");
        (scenario.planner, scenario.objective) = (&PathTimePlanner, objective);
        let run = pipeline::run(scenario);
        assert_eq!(run.level, RelaxationLevel::Inside);
        assert_eq!(faults(&document(&run)), "");
        let until = run.targets[0].released.expect("it is entered");
        let hard = &run.targets[0].sets.hard;
        let trajectory = trajectory(&run);
        let mut inside = 0;
        for time in trajectory.sample_times(0.5, 10_000) {
            let at = trajectory.pose_at(time).position;
            if hard.signed_distance(at, time).distance < -1e-3 {
                inside += 1;
                assert_eq!(trajectory.speed_at(time), 0.0, "at {time} s");
                assert!(time <= until);
            }
        }
        assert!(inside > 20 && trajectory.segments()[1].start_time < until);
        assert_eq!(plan(&run).to_go, 0.0);
    }
}

/// Own ship starts within sets. In one scene holding the speed clears every hull and waiting meets
/// one. In the other a ship lies at anchor ahead, and own ship has to turn before it moves. The
/// hulls decide, not the time in the sets.
#[test]
fn the_least_harm_meets_no_nominal_hull_where_that_can_be() {
    for text in [
        include_str!("../faults/least-harm-to-hulls.toml"),
        include_str!("../faults/least-harm-at-anchor.toml"),
    ] {
        let run = verified(text);
        assert_eq!(run.level, RelaxationLevel::Inside);
        let own = &run.scenario.own_ship;
        let trajectory = trajectory(&run);
        for time in trajectory.sample_times(0.5, 10_000) {
            let hull = own.hull.polygon(&trajectory.pose_at(time));
            for target in &run.scenario.targets {
                let ship = target.ship().expect("a ship");
                let apart = hull.separation(&ship.hull.polygon(&ship.pose_at(time)));
                assert!(apart > 0.0, "{} at {time} s: {apart}", target.name);
            }
        }
    }
}

/// A ship lies at anchor over the last waypoint. Own ship stays off and says so, also where the
/// horizon ends before it gets there.
#[test]
fn before_a_ship_over_the_end_own_ship_stops() {
    let anchored = |horizon: f64| {
        let text = format!(
            "title = \"anchored\"\nhorizon_s = {horizon}\n[own_ship]\nposition = {{ east_m = 0.0, north_m = 0.0 }}\ncourse_deg = 90.0\n\
             speed_mps = 5.0\nlength_m = 20.0\nbeam_m = 6.0\nturning_radius_m = 50.0\n[mission]\n\
             waypoints = [{{ east_m = 0.0, north_m = 0.0 }}, {{ east_m = 600.0, north_m = 0.0 }}]\n[planner]\ncompliance = \"none\"\n\
             [[targets]]\nname = \"anchored\"\nposition = {{ east_m = 600.0, north_m = 0.0 }}\ncourse_deg = 0.0\nspeed_mps = 0.0\n\
             length_m = 40.0\nbeam_m = 8.0\n"
        );
        verified(&text)
    };
    for horizon in [130.0, 1000.0] {
        let run = anchored(horizon);
        assert_eq!(run.level, RelaxationLevel::Waiting);
        let judged = run.evaluation.as_ref().expect("judged");
        assert!(judged.min_clearance >= run.scenario.own_ship.safety_margin - 1e-6);
        assert!(judged.length > 500.0, "{}", judged.length);
        assert_eq!(judged.duration, horizon);
    }
}

/// The shipped scenario does what it says: the ferry takes the other path, and sails slower for the
/// ship that crosses. Without the dredger it takes its own path; without the coaster it sails at
/// full speed.
#[test]
fn on_the_alternative_path_the_ferry_lets_the_coaster_pass() {
    let run = |left_out: &str| {
        let mut scenario = scenario("harbour/alternative-path.toml");
        scenario.targets.retain(|target| target.name != left_out);
        pipeline::run(scenario)
    };
    let arrival = |run: &Run| {
        let verified = run.evaluation.as_ref().is_some_and(|e| e.verified());
        assert!(run.relaxations.is_empty() && verified);
        let diagram = run.planned.path_time.as_ref().expect("a diagram");
        let other = diagram.legs.iter().any(|leg| leg.path == 1);
        (other, trajectory(run).end_time(), trajectory(run).length())
    };
    let (other, both, length) = arrival(&run(""));
    let (without_coaster, alone, _) = arrival(&run("coaster"));
    let (without_dredger, ..) = arrival(&run("dredger"));
    assert!(other && without_coaster && !without_dredger);
    let at_full_speed = (alone - length / 5.0).abs() < 1e-6;
    assert!(at_full_speed && both > alone + 5.0, "{both} {alone}");
}

/// Own ship turns on the spot before it leaves along a way that begins 0.8 micrometres from it.
#[test]
fn a_turn_on_the_spot_is_where_the_way_begins() {
    let run = verified(include_str!(
        "../faults/exit3-path-time-beside-own-position.toml"
    ));
    let plan = run.planned.outcome.plan().expect("a plan");
    let [turn, leaves, ..] = plan.trajectory.segments() else {
        panic!("two segments");
    };
    assert_eq!(turn.duration, 0.0);
    assert_eq!(turn.start.position, leaves.start.position);
}
