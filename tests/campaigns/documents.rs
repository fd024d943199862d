//! Plan documents of every kind, and the check's answer to a changed one.
#![allow(dead_code, reason = "tests and campaigns use a part each")]

use std::path::{Path, PathBuf};

use searoom::document::PlanDocument;
use searoom::frame::Vector;
use searoom::pipeline;
use searoom::planner::Objective;
use searoom::scenario::{Compliance, Scenario};
use searoom::target::{Motion, Representation};
use searoom::verification::{Verification, verify};
use serde_json::Value;

/// The folder with `maps`, `scenarios` and `tests`: that of the package, or the one above.
pub fn repository() -> &'static Path {
    let mut folders = Path::new(env!("CARGO_MANIFEST_DIR")).ancestors();
    let found = folders.find(|folder| folder.join("maps").is_dir());
    found.expect("a folder with maps")
}

pub fn file(path: &str) -> PathBuf {
    repository().join("scenarios").join(path)
}

pub fn scenario(path: &str) -> Scenario {
    unhurried(Scenario::read(&file(path)).expect(path))
}

/// The scenario of a text without faults.
pub fn parsed(text: &str) -> Scenario {
    unhurried(Scenario::parse(text).expect("a scenario"))
}

/// Deadline of a scenario that has none, seconds.
const DEFAULT_DEADLINE: f64 = 5.0;

/// The scenario with so much time that no result depends on the clock, on a machine that pauses too.
/// A deadline of its own is kept.
pub fn unhurried(mut scenario: Scenario) -> Scenario {
    if scenario.deadline == DEFAULT_DEADLINE {
        scenario.deadline = 60.0;
    }
    scenario
}

/// A file of `tests/faults`.
pub fn fault(name: &str) -> String {
    let path = repository().join("tests/faults").join(name);
    std::fs::read_to_string(path).expect("a fault")
}

/// Text of a scenario in which a ship of 30 m sails along the waypoints, with more tables or keys.
pub fn text(title: &str, horizon: f64, waypoints: &[[f64; 2]], more: &str) -> String {
    let places = waypoints.iter();
    let places = places.map(|[east, north]| format!("{{ east_m = {east}, north_m = {north} }}"));
    let places: Vec<String> = places.collect();
    format!(
        "title = \"{title}\"\nhorizon_s = {horizon}\nmission = {{ waypoints = [{}] }}\n\
         own_ship = {{ position = {{ east_m = 0, north_m = 0 }}, course_deg = 90, speed_mps = 5, \
         length_m = 30, beam_m = 8, turning_radius_m = 100 }}\n{more}\n",
        places.join(", ")
    )
}

pub fn document(scenario: Scenario) -> Value {
    let run = pipeline::run(unhurried(scenario));
    let verified = run.evaluation.as_ref().is_some_and(|e| e.verified());
    let (title, outcome) = (&run.scenario.title, &run.planned.outcome);
    assert!(verified, "{title}: {outcome:?}, {:?}", run.evaluation);
    // serialise and parse, as for a file
    let text = serde_json::to_string(&PlanDocument::of(&run)).expect("a document");
    serde_json::from_str(&text).expect("JSON")
}

pub fn checked(document: &Value) -> Verification {
    verify(&document.to_string()).expect("a plan document")
}

pub fn is_caught(document: &Value) -> bool {
    match verify(&document.to_string()) {
        Ok(found) => !found.verified(),
        Err(_) => true,
    }
}

/// Own ship gives way, and may take a risk.
pub fn give_way_at_risk(max_risk: f64) -> Value {
    let mut scenario = scenario("colregs/give-way.toml");
    scenario.max_risk = max_risk;
    document(scenario)
}

/// Own ship stands on, holds course and speed, and escapes.
pub fn stand_on() -> Value {
    let mut scenario = scenario("colregs/stand-on.toml");
    scenario.compliance = Compliance::Rules;
    document(scenario)
}

/// Own ship starts inside the set of a ship that it must avoid, and leaves it.
pub fn inside() -> Value {
    let mut scenario = scenario("colregs/head-on.toml");
    scenario.own_ship.safety_margin = 80.0;
    let Motion::Ship(ship) = &mut scenario.targets[0].motion else {
        panic!("a ship");
    };
    ship.pose.position = Vector::new(70.0, 20.0);
    ship.pose.heading = 0.4;
    ship.speed = 3.0;
    document(scenario)
}

/// The end is blocked: own ship stops before it at an accepted risk. It passes a ship that may
/// cross early or late.
pub fn barred() -> Value {
    let text = r#"
        title = "barred"
        horizon_s = 300.0
        own_ship = { position = { east_m = 0.0, north_m = 0.0 }, course_deg = 90.0, speed_mps = 5.0, length_m = 30.0,
            beam_m = 8.0, turning_radius_m = 100.0, safety_margin_m = 10.0 }
        mission = { waypoints = [{ east_m = 0.0, north_m = 0.0 }, { east_m = 1000.0, north_m = 0.0 }] }
        planner = { kind = "path-time", max_risk = 0.6 }
        [[targets]]
        name = "at the end"
        initial_set = { vertices_m = [[980.0, -2.0], [1080.0, -2.0], [1080.0, 2.0], [980.0, 2.0]] }
        velocity_set = { vertices_mps = [[0.3, -0.3], [0.3, 0.3], [-0.3, 0.3], [-0.3, -0.3]] }
        [[targets]]
        name = "beside"
        initial_set = { vertices_m = [[480.0, 60.0], [520.0, 60.0], [520.0, 70.0], [480.0, 70.0]] }
        velocity_set = { vertices_mps = [[0.0, 0.0], [0.1, -2.0], [-0.1, -2.0]] }
    "#;
    document(parsed(text))
}

/// One document of each kind: space-time, land, slabs, ellipses, accepted risk, path-time, forces,
/// stand-on, and a start inside a set.
pub fn documents() -> Vec<(&'static str, Value)> {
    let mut round = scenario("colregs/head-on.toml");
    round.targets[0].representation = Representation::Ellipsoid;
    let mut quick = scenario("harbour/ferry-crossing.toml");
    quick.objective = Objective::Time;
    let mut one = scenario("paper/figure_9.toml");
    one.targets.truncate(1);
    vec![
        ("head-on", document(scenario("colregs/head-on.toml"))),
        ("at a risk", give_way_at_risk(0.4)),
        ("ellipsoid", document(round)),
        ("munkholmen", document(scenario("harbour/munkholmen.toml"))),
        ("turning", document(scenario("uncertainty/turning.toml"))),
        (
            "changing velocities",
            document(scenario("uncertainty/changing-velocities.toml")),
        ),
        ("ellipses", document(scenario("uncertainty/ellipse.toml"))),
        ("canal", document(scenario("harbour/canal-transit.toml"))),
        ("quick ferry", document(quick)),
        ("figure 9", document(scenario("paper/figure_9.toml"))),
        ("one ellipsoid", document(one)),
        ("stand-on", stand_on()),
        ("inside", inside()),
    ]
}

/// Collects every number below `value` as JSON pointers.
pub fn numbers(value: &Value, at: &str, found: &mut Vec<String>) {
    match value {
        Value::Number(_) => found.push(at.to_owned()),
        Value::Array(list) => {
            for (i, v) in list.iter().enumerate() {
                numbers(v, &format!("{at}/{i}"), found);
            }
        }
        Value::Object(map) => {
            for (key, v) in map {
                numbers(v, &format!("{at}/{key}"), found);
            }
        }
        _ => {}
    }
}
