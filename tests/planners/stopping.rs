//! Own ship stops, slows or waits where no plan arrives clear of the sets.

use searoom::document::{PlanDocument, SimulationDocument};
use searoom::frame::Vector;
use searoom::obstacle::SpaceTimeObstacle;
use searoom::pipeline::{self, Relaxation, RelaxationLevel, Run};
use searoom::scenario::{Behaviour, Scenario};
use searoom::simulation::Simulation;
use searoom::verification::verify;

use crate::campaigns::documents::unhurried;
use crate::campaigns::stopping;

fn fault(name: &str) -> Scenario {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/faults");
    unhurried(Scenario::read(&folder.join(name)).expect("a scenario"))
}

fn planned(scenario: Scenario) -> Run {
    let run = pipeline::run(scenario);
    let document = serde_json::to_string(&PlanDocument::of(&run)).expect("JSON");
    let found = verify(&document).expect("a document");
    assert!(
        found.verified(),
        "{}: {:?}",
        run.scenario.title,
        found.violations
    );
    assert_eq!(found.safe(), run.safe());
    run
}

fn sailed(scenario: Scenario) -> SimulationDocument {
    let mut simulation = Simulation::new(scenario, false).expect("a scenario for the closed loop");
    while !simulation.finished() {
        simulation.step();
    }
    simulation.record()
}

/// The plan is safe, lasts to the horizon, and says that it gives up the arrival and for whom.
fn assert_stops(name: &str, target: &str) -> Run {
    let run = planned(fault(name));
    assert!(run.safe() && !run.arrives(), "{name}: {}", run.word());
    assert_eq!(run.level, RelaxationLevel::Waiting, "{name}");
    let plan = run.planned.outcome.plan().expect("a plan");
    let end = plan.trajectory.end_time();
    assert!((end - run.scenario.horizon).abs() < 1e-6, "{name}: {end} s");
    let arrival = run.relaxations.iter().any(|given_up| {
        matches!(given_up, Relaxation::Arrival { target: barring, amount }
            if barring == target && *amount == plan.to_go)
    });
    assert!(arrival, "{name}: {:?}", run.relaxations);
    run
}

/// 84 m before the set own ship has no room to turn, but it may stop.
#[test]
fn own_ship_stops_before_a_ship_at_rest_ahead() {
    let name = "stop-before-resting-ship.toml";
    assert_stops(name, "stopped tanker");
    let sailed = sailed(fault(name));
    assert!(sailed.safe && !sailed.contact && !sailed.arrived);
}

#[test]
fn own_ship_stops_before_a_ship_that_closes_the_canal() {
    let name = "canal-closed-by-resting-ship.toml";
    let run = assert_stops(name, "resting");
    // 300 s at full speed lead to the set
    let sailed_m = run.evaluation.expect("judged").length;
    assert!(sailed_m > 900.0, "{sailed_m} m");
    let sailed = sailed(fault(name));
    assert!(sailed.safe && !sailed.contact && !sailed.arrived);
}

#[test]
fn own_ship_stays_in_a_basin_that_a_moored_ship_closes() {
    let name = "way-closed-by-moored-ship.toml";
    assert_stops(name, "moored across the entrance");
    let sailed = sailed(fault(name));
    assert!(sailed.safe && !sailed.contact && !sailed.arrived);
}

/// With a horizon of 700 s there is time to arrive.
#[test]
fn own_ship_waits_for_a_fast_craft_where_the_horizon_ends_before_it_arrives() {
    let run = assert_stops("horizon-too-short-to-arrive.toml", "RIB");
    assert!(run.planned.outcome.plan().expect("a plan").to_go < 2000.0);
    let sailed = sailed(fault("horizon-too-short-to-arrive.toml"));
    assert!(sailed.safe && !sailed.contact);
}

/// No motion is clear of the sets: own ship moves aside, and meets no hull on the expected track.
#[test]
fn own_ship_keeps_to_the_side_where_the_canal_leaves_no_room_for_the_sets() {
    let run = planned(fault("canal-meeting-no-sidestep.toml"));
    assert_eq!(run.level, RelaxationLevel::Inside);
    let judged = run.evaluation.expect("judged");
    // 19 m of room to starboard
    assert!(judged.passages[0].dcpa > 9.5, "{}", judged.passages[0].dcpa);
    assert!(judged.min_land_distance > 10.0 - 1e-6);
    let sailed = sailed(fault("canal-meeting-no-sidestep.toml"));
    assert!(!sailed.contact && sailed.arrived);
}

/// Plans a scene, and expects a safe plan that arrives and breaks no rule.
fn assert_by_the_rules(name: &str) -> Run {
    let run = planned(fault(name));
    assert!(run.safe() && run.arrives(), "{name}: {}", run.word());
    let reports = run.judged_compliance();
    let broken: Vec<_> = reports.iter().flatten().flat_map(|r| r.broken()).collect();
    assert!(broken.is_empty(), "{name}: {broken:?}");
    run
}

/// Between a moored barge and an oncoming ship there is room for own ship, but not by the rules.
#[test]
fn own_ship_lets_the_oncoming_ship_pass_before_it_passes_the_barge() {
    let name = "canal-parked-and-oncoming.toml";
    let judged = assert_by_the_rules(name).evaluation.expect("judged");
    let [barge, oncoming] = &judged.passages[..] else {
        panic!("two ships");
    };
    assert!(oncoming.tcpa < barge.tcpa, "{judged:?}");
    assert!(oncoming.dcpa > 80.0, "{}", oncoming.dcpa);
    let sailed = sailed(fault(name));
    assert!(sailed.safe && !sailed.contact && sailed.arrived);
}

/// The ship closes the way out until it has passed.
#[test]
fn own_ship_stays_in_a_basin_until_a_slow_ship_has_left_the_entrance() {
    let name = "way-closed-by-slow-ship.toml";
    let run = assert_by_the_rules(name);
    let plan = run.planned.outcome.plan().expect("a plan");
    let segments = plan.trajectory.segments();
    assert!(segments.iter().any(|s| s.speed == 0.0), "{segments:?}");
    let sailed = sailed(fault(name));
    assert!(sailed.safe && !sailed.contact && sailed.arrived);
}

/// The ship that closes the canal leaves after ten minutes: own ship goes on to the end.
#[test]
fn own_ship_goes_on_when_the_way_is_free_again() {
    let mut scenario = fault("canal-closed-by-resting-ship.toml");
    scenario.simulation.duration = Some(4000.0);
    let ship = scenario.targets[0].ship().expect("a ship");
    let (here, away) = (ship.pose.position, Vector::new(2000.0, 2000.0));
    let track = [(600.0, here), (1100.0, here + away), (5000.0, here + away)];
    scenario.simulation.behaviours = vec![Behaviour::Track(track.to_vec())];
    let sailed = sailed(scenario);
    assert!(
        !sailed.contact && sailed.arrived,
        "{} m left",
        sailed.to_go_m
    );
}

#[test]
fn nothing_is_unsafe_that_stopping_would_make_safe() {
    stopping::run(0..100).assert_met();
}

/// A plan that gives up its arrival has to last until the horizon, unless a set is over its end.
#[test]
fn a_plan_that_ends_early_on_the_way_is_rejected() {
    let run = planned(fault("stop-before-resting-ship.toml"));
    let document = serde_json::to_string(&PlanDocument::of(&run)).expect("JSON");
    let mut document: serde_json::Value = serde_json::from_str(&document).expect("JSON");
    let segments = &mut document["trajectory"]["segments"];
    let segments = segments.as_array_mut().expect("segments");
    let last = segments.last_mut().expect("a wait");
    let duration = last["duration_s"].as_f64().expect("seconds");
    last["duration_s"] = (duration - 1.0).into();
    let found = verify(&document.to_string()).expect("a document");
    let early = |what: &str| what.contains("set is over the last waypoint");
    assert!(
        found.violations.iter().any(|v| early(&v.what)),
        "{:?}",
        found.violations
    );
}

/// Stopping at once is clear: 26 scenes.
#[test]
fn a_ship_at_rest_160_to_400_m_ahead_is_never_met() {
    let mut short = 0;
    let may_stop = |scenario: &Scenario| {
        let (sets, own) = (pipeline::sets(scenario), &scenario.own_ship);
        sets[0]
            .hard
            .signed_distance(own.pose.position, 0.0)
            .distance
            > 1.0
    };
    let scenes = (0..).map(stopping::at_rest_ahead).filter(may_stop);
    for scenario in scenes.take(26) {
        let run = planned(scenario);
        assert!(run.safe(), "{}: {}", run.scenario.title, run.word());
        short += usize::from(!run.arrives());
    }
    assert!(short >= 2, "only {short} of 26 stop");
}
