//! Own ship stays at the last waypoint until a time.

use searoom::document::PlanDocument;
use searoom::pipeline::{self, RelaxationLevel, Run};
use searoom::planner::{PlanMethod, planner_words};
use searoom::scenario::Scenario;
use searoom::simulation::Simulation;
use searoom::target::Motion;
use searoom::verification::verify;

use crate::campaigns::documents::unhurried;

const ANCHORED: &str = include_str!("../faults/own-ship-at-anchor.toml");

/// The lines of a mission in the scenario of the ship at anchor.
fn with_mission(mission: &str) -> Scenario {
    let (before, after) = ANCHORED.split_once("[mission]\n").expect("a mission");
    let (_, targets) = after.split_once("[[targets]]").expect("a target");
    let text = format!("{before}[mission]\n{mission}\n[[targets]]{targets}");
    unhurried(Scenario::parse(&text).expect("a scenario"))
}

/// The run of a scenario, whose document is accepted and says the same of its safety.
fn planned(scenario: Scenario) -> Run {
    let run = pipeline::run(scenario);
    let document = serde_json::to_string(&PlanDocument::of(&run)).expect("JSON");
    let found = verify(&document).expect("a document");
    assert!(found.verified(), "{:?}", found.violations);
    assert_eq!(found.safe(), run.safe());
    run
}

/// Time and distance from the last waypoint of the motion, every second.
fn distances(run: &Run) -> Vec<(f64, f64)> {
    let plan = run.planned.outcome.plan().expect("a plan");
    let place = run.scenario.desired.end();
    let end = plan.trajectory.end_time();
    let times = (0..=end as u32).map(f64::from);
    let off = |time: f64| (plan.trajectory.pose_at(time).position - place).norm();
    times.map(|time| (time, off(time))).collect()
}

/// A coaster runs over the place of a ship at anchor at 953 s. She clears it in time, lies there
/// before and after, and the plan lasts as long as the stay.
#[test]
fn a_ship_at_anchor_clears_her_place_and_returns() {
    for mission in [
        "waypoints = [{ east_m = 0.0, north_m = 0.0 }]",
        "waypoints = [{ east_m = 0.0, north_m = 0.0 }]\nspeed_kn = 6.0\nstay_until_s = 1800.0",
        "waypoints = [{ east_m = 0.0, north_m = 0.0 }, { east_m = 0.0, north_m = 10.0 }]\n\
         speed_kn = 6.0\nstay_until_s = 1800.0",
    ] {
        let run = planned(with_mission(mission));
        assert!(run.safe() && run.arrives(), "{mission}: {}", run.word());
        assert!(run.level < RelaxationLevel::Waiting, "{mission}");
        assert_eq!(run.planned.method(), Some(PlanMethod::OffStation));
        let plan = run.planned.outcome.plan().expect("a plan");
        assert!((plan.trajectory.end_time() - 1800.0).abs() < 1e-6);
        let off = distances(&run);
        let away = |time: f64| off[time as usize].1;
        assert!(away(10.0) < 1e-3 && away(1799.0) < 1e-3, "{mission}");
        // the coaster's hull is there from 936 to 970 s
        assert!(away(940.0) > 100.0 && away(965.0) > 100.0, "{mission}");
        // what is before the stay has cost: nothing is off the desired trajectory
        let evaluation = run.evaluation.as_ref().expect("an evaluation");
        assert!(evaluation.space_time_error < 1.0 && evaluation.delay.abs() < 1.0);
    }
}

/// No ship comes before 600 s, so she lies where she is; after an earlier end nothing is claimed.
#[test]
fn a_stay_that_ends_before_a_ship_comes_is_a_rest() {
    let run = planned(with_mission(
        "waypoints = [{ east_m = 0.0, north_m = 0.0 }]\nspeed_kn = 6.0\nstay_until_s = 300.0",
    ));
    assert!(run.safe() && run.relaxations.is_empty(), "{}", run.word());
    assert_eq!(run.planned.method(), Some(PlanMethod::Stay));
    let plan = run.planned.outcome.plan().expect("a plan");
    assert!((plan.trajectory.end_time() - 300.0).abs() < 1e-9);
    assert!(distances(&run).iter().all(|(_, off)| *off < 1e-9));
}

/// On her way to a place that a ship passes over, she arrives or is off it in time; she lies there at
/// the end.
#[test]
fn a_stay_after_a_passage_is_kept() {
    let run = planned(with_mission(
        "waypoints = [{ east_m = 0.0, north_m = 0.0 }, { east_m = 0.0, north_m = 1500.0 }]\n\
         speed_kn = 6.0\nstay_until_s = 1700.0",
    ));
    assert!(run.safe() && run.arrives(), "{}", run.word());
    let plan = run.planned.outcome.plan().expect("a plan");
    assert!((plan.trajectory.end_time() - 1700.0).abs() < 1e-6);
    assert!(distances(&run).last().is_some_and(|(_, off)| *off < 1e-3));
}

/// Along a path there is no way off the place: own ship stays in the set, which is not called safe.
#[test]
fn along_a_path_a_stay_in_a_set_is_not_safe() {
    let mut scenario = with_mission(
        "waypoints = [{ east_m = 0.0, north_m = 0.0 }, { east_m = 0.0, north_m = 10.0 }]\n\
         speed_kn = 6.0\nstay_until_s = 1800.0",
    );
    let path_time = planner_words()
        .into_iter()
        .find(|(name, _)| *name == "path-time");
    scenario.set_planner(path_time.expect("a planner").1);
    let run = planned(scenario);
    assert!(!run.safe(), "{}", run.word());
    assert_eq!(run.level, RelaxationLevel::Inside);
}

/// A document whose motion ends before its stay, or rests on after it, is rejected.
#[test]
fn a_motion_that_does_not_end_with_its_stay_is_rejected() {
    let run = planned(with_mission(
        "waypoints = [{ east_m = 0.0, north_m = 0.0 }]\nspeed_kn = 6.0\nstay_until_s = 300.0",
    ));
    let mut document = PlanDocument::of(&run);
    assert_eq!(document.mission.stay_until_s, Some(300.0));
    for (until, expected) in [
        (400.0, "before that of the stay"),
        (200.0, "after that of the stay"),
    ] {
        document.mission.stay_until_s = Some(until);
        let text = serde_json::to_string(&document).expect("JSON");
        let found = verify(&text).expect("a document");
        let what: Vec<&str> = found.violations.iter().map(|v| v.what.as_str()).collect();
        assert!(what.iter().any(|what| what.contains(expected)), "{what:?}");
    }
}

/// In the closed loop, planned again every 30 s, she is never hit and lies at her place at the end.
#[test]
fn the_loop_keeps_a_stay() {
    let scenario = with_mission("waypoints = [{ east_m = 0.0, north_m = 0.0 }]\nspeed_kn = 6.0");
    let mut simulation = Simulation::new(scenario, false).expect("a scenario for the closed loop");
    while !simulation.finished() {
        simulation.step();
    }
    let sailed = simulation.record();
    assert!(sailed.safe && !sailed.contact && sailed.arrived);
    assert!(
        (sailed.duration_s - 1800.0).abs() < 1.0,
        "{} s",
        sailed.duration_s
    );
    assert!(sailed.to_go_m < 1e-3, "{} m", sailed.to_go_m);
}

/// Only the ship domain of a ship that passes abeam reaches the place, and there is no room to leave:
/// own ship lies still, clear of the hard set, and gives a part of the domain up.
#[test]
fn a_domain_over_the_place_is_reduced_before_a_set_is_entered() {
    let mut scenario = with_mission(
        "waypoints = [{ east_m = 0.0, north_m = 0.0 }, { east_m = 0.0, north_m = 10.0 }]\n\
         speed_kn = 6.0\nstay_until_s = 1800.0",
    );
    for target in &mut scenario.targets {
        let Motion::Ship(ship) = &mut target.motion else {
            panic!("a ship");
        };
        ship.pose.position.x = 700.0;
        ship.course_spread = 0.01;
    }
    let path_time = planner_words()
        .into_iter()
        .find(|(name, _)| *name == "path-time");
    scenario.set_planner(path_time.expect("a planner").1);
    let run = planned(scenario);
    assert!(run.safe() && run.arrives(), "{}", run.word());
    assert!(run.level <= RelaxationLevel::ReducedDomains);
}

/// A round trip begins at its end: the wait before own ship sets out is no stay.
#[test]
fn the_stay_of_a_round_trip_begins_after_the_trip() {
    let run = planned(with_mission(
        "waypoints = [{ east_m = 0.0, north_m = 0.0 }, { east_m = 1500.0, north_m = 0.0 }, \
         { east_m = 0.0, north_m = 0.0 }]\nspeed_kn = 6.0\nstay_until_s = 1800.0",
    ));
    let evaluation = run.evaluation.as_ref().expect("an evaluation");
    assert!(
        evaluation.length > 2_000.0 && evaluation.delay > -100.0,
        "{evaluation:?}"
    );
}

/// Each is accepted by `verify`, lasts as long as its stay, and is as safe as it can be.
#[test]
fn stays_in_the_way_of_others_end_as_they_ought_to() {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/faults");
    for (name, safe, arrives) in [
        // a corner, at which own ship turns on the spot
        ("stay-along-a-bend", true, true),
        ("stay-across-own-course", true, true),
        // the stay ends before the ship has passed
        ("stay-without-return", true, false),
        // the place is covered, and another ship passes where own ship stops
        ("stay-before-a-moored-ship", true, false),
        // own ship is in the set of a ship at rest, which is no reason to be run down by another
        ("stay-beside-a-neighbour", false, true),
    ] {
        let scenario = Scenario::read(&folder.join(format!("{name}.toml")));
        let run = planned(unhurried(scenario.expect("a scenario")));
        assert_eq!(
            (run.safe(), run.arrives()),
            (safe, arrives),
            "{name}: {}",
            run.word()
        );
        let plan = run.planned.outcome.plan().expect("a plan");
        let until = run.scenario.stay.expect("a stay");
        assert!((plan.trajectory.end_time() - until).abs() < 1e-6, "{name}");
        let evaluation = run.evaluation.as_ref().expect("an evaluation");
        assert!(
            evaluation.min_clearance > 0.0,
            "{name}: {}",
            evaluation.min_clearance
        );
    }
}

/// The loop keeps the remainder of a plan whose stay is to come.
#[test]
fn the_loop_keeps_the_way_to_a_stay() {
    let scenario = with_mission(
        "waypoints = [{ east_m = 600.0, north_m = 0.0 }]\nspeed_kn = 6.0\nstay_until_s = 800.0",
    );
    let mut simulation = Simulation::new(scenario, false).expect("a scenario for the closed loop");
    while !simulation.finished() {
        simulation.step();
    }
    let sailed = simulation.record();
    let first = sailed.conduct.first_plan_cost_m2.expect("a plan");
    assert!(
        sailed.conduct.cost_m2 <= 1.01 * first,
        "{} {first}",
        sailed.conduct.cost_m2
    );
}

/// A moored ship overlaps own ship's berth, where a round trip starts and ends. A motion that lies
/// there has not come round: all of the trip is left.
#[test]
fn a_ship_that_lies_where_her_round_trip_ends_has_not_arrived() {
    let text = include_str!("../faults/stay-round-trip-from-a-quay.toml");
    for text in [text.to_owned(), text.replace("stay_until_s = 600.0\n", "")] {
        let run = planned(unhurried(Scenario::parse(&text).expect("a scenario")));
        let plan = run.planned.outcome.plan().expect("a motion");
        let sailed = plan.trajectory.length();
        let trip = run.scenario.desired.length();
        assert!(!run.safe());
        assert_eq!(run.arrives(), sailed > 0.9 * trip, "sailed {sailed} m");
    }
}

/// The seconds from the present to the end of a stay round to more than the horizon.
#[test]
fn a_stay_may_end_with_the_horizon() {
    let text = include_str!("../faults/stay-to-the-end-of-the-horizon.toml");
    let run = planned(unhurried(Scenario::parse(text).expect("a scenario")));
    assert!(run.safe() && run.arrives(), "{}", run.word());
    assert!(
        run.scenario
            .stay
            .is_some_and(|stay| stay <= run.scenario.horizon)
    );
}

/// Legs lie on each other: what is left is said alike by planner and checker, whose numbers round
/// differently.
#[test]
fn on_legs_that_lie_on_each_other_the_rest_of_the_way_is_one_number() {
    for text in [
        include_str!("../faults/legs-on-each-other.toml"),
        include_str!("../faults/two-laps.toml"),
    ] {
        let run = planned(unhurried(Scenario::parse(text).expect("a scenario")));
        assert!(!run.arrives(), "{}", run.word());
    }
}
