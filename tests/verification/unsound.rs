//! Documents that agree with themselves in all figures but are unsound, and sound plans that are
//! hard to tell from them.

use std::f64::consts::TAU;

use searoom::evaluation::{Freedom, Request, evaluate};
use searoom::frame::Vector;
use searoom::planner::Planner;
use searoom::planner::path_time::PathTimePlanner;
use searoom::planner::space_time::SpaceTimePlanner;
use searoom::scenario::Scenario;
use searoom::trajectory::Segment;
use searoom::verification::verify;
use serde_json::{Value, json};

use crate::alter::{assert_word, at, list};
use crate::documents::{checked, document, fault, inside, scenario, text};

fn pairs(value: &Value) -> Vec<[f64; 2]> {
    serde_json::from_value(value.clone()).expect("pairs of numbers")
}

fn scaled(corners: &Value, factor: f64) -> Value {
    let corners = pairs(corners);
    let count = corners.len() as f64;
    let middle = [0, 1].map(|k| corners.iter().map(|c| c[k]).sum::<f64>() / count);
    let scaled = |c: &[f64; 2]| [0, 1].map(|k| middle[k] + factor * (c[k] - middle[k]));
    json!(corners.iter().map(scaled).collect::<Vec<_>>())
}

/// Corners of a square, half of whose side is `half`.
fn square([x, y]: [f64; 2], half: f64) -> Value {
    let corners = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
    json!(corners.map(|(east, north)| [x + half * east, y + half * north]))
}

/// Unsound documents. A slab of half a nanosecond carries the set aside, or a level set lies to one
/// side of the velocities, in two slabs. A motion jumps through a wall during a turn of many
/// circles, or nobody sails a round trip.
#[test]
fn unsound_documents_are_rejected() {
    for (name, expected) in [
        ("tiny-slab", "set of 'log': too small for the velocity set"),
        ("lopsided", "too small for the velocities at the accepted"),
        ("teleport", "position at the joint of segments 3 and 4"),
        ("null-plan", "0 m sailed, with the path still ahead"),
    ] {
        let document: Value = serde_json::from_str(&fault(&format!("{name}.json"))).expect("JSON");
        assert_word(&document, name, expected);
    }
}

/// At any risk: the document takes a set that does not move with the target for the level set.
#[test]
fn sets_under_forces_hold_the_velocities_at_a_risk() {
    let mut plan = document(scenario("forces/give-way.toml"));
    plan["max_risk"] = json!(1e-12);
    let horizon = plan["horizon_s"].clone();
    let center = pairs(&json!([plan["obstacles"][0]["initial_set"]["center_m"]]))[0];
    let square = square(center, 700.0);
    let set = |velocity: [f64; 2]| {
        json!([{ "name": plan["targets"][0]["name"], "valid_s": [0.0, horizon],
            "initial_set": { "vertices_m": square }, "velocity_set": { "vertices_mps": [velocity] } }])
    };
    let mut away = plan.clone();
    away["obstacles"] = set([35.0, -35.0]);
    let level = "too small for the velocities at the accepted risk";
    assert_word(&away, "away", level);
    let mut round = plan.clone();
    *at(&mut round, "/obstacles/0/velocity_set/center_mps") = json!([3.0, -3.0]);
    assert_word(&round, "round", level);
}

/// Along a path out and back that is not sailed to its end.
#[test]
fn a_path_is_sailed_to_its_end() {
    let mut waypoints = [[0.0, 0.0], [1000.0, 0.0], [500.0, 600.0], [0.0, 0.0]];
    let parsed = |waypoints: &[[f64; 2]]| {
        Scenario::parse(&text("round", 900.0, waypoints, "")).expect("a scenario")
    };
    let mut scenario = parsed(&waypoints);
    let own = &scenario.own_ship;
    let wait = |duration: f64| Segment::straight(own.pose, 0.0, duration, 0.0);
    let path = [scenario.desired.waypoints()];
    for freedom in [Freedom::Limits, Freedom::Paths(&path)] {
        for duration in [0.0, 100.0] {
            let found = evaluate(&Request {
                freedom,
                ..Request::new(&[wait(duration)], own, &scenario.desired, 900.0)
            });
            let found = found.violations;
            assert!(
                found.iter().any(|v| v.what.starts_with("arrival: ")),
                "{found:?}"
            );
        }
    }
    for planner in [&SpaceTimePlanner as &dyn Planner, &PathTimePlanner] {
        scenario.planner = planner;
        let plan = document(scenario.clone());
        assert!(plan["cost"]["length_m"].as_f64() > Some(2000.0));
        assert!(checked(&plan).verified());
    }
    // at the crossing of a figure of eight, with the second half still to be sailed
    waypoints[3] = [500.0, 0.0];
    let mut scenario = parsed(&waypoints);
    scenario.own_ship.pose.position = Vector::new(500.0, 0.0);
    let plan = document(scenario);
    assert!(plan["cost"]["length_m"].as_f64() > Some(100.0) && checked(&plan).verified());
}

/// In 10 nanoseconds a ship of a million metres a second is through a set of a millimetre.
#[test]
fn the_fastest_ship_is_looked_at_in_the_shortest_times() {
    let mut scenario = scenario("colregs/head-on.toml");
    scenario.own_ship.speeds = vec![1e6];
    let run = [Segment::straight(
        scenario.own_ship.pose,
        0.0,
        1500.0 / 1e6,
        1e6,
    )];
    let place = scenario.own_ship.pose.position + Vector::new(700.123_456, 0.0);
    let corners = [(0.0, -1.0), (1e-3, 0.0), (0.0, 1.0)].map(|(x, y)| place + Vector::new(x, y));
    let [wall, still] = [&corners[..], &[Vector::zeros()]]
        .map(|points| searoom::geometry::ConvexPolygon::hull(points).expect("finite"));
    let sets = [searoom::evaluation::SpaceTimeSet::constant(
        "wall", wall, still,
    )];
    let found = evaluate(&Request {
        freedom: Freedom::Any,
        sets: &sets,
        ..Request::new(&run, &scenario.own_ship, &scenario.desired, 900.0)
    });
    let through = |v: &searoom::evaluation::Violation| v.what.contains("'wall': distance");
    assert!(
        found.violations.iter().any(through),
        "{:?}",
        found.violations
    );
}

/// Each velocity set after the first is too small alone: an explicit set, one of a ship that may
/// turn, and one at a risk.
#[test]
fn each_later_velocity_set_that_is_too_small_is_found() {
    let mut at_risk = scenario("uncertainty/turning.toml");
    at_risk.max_risk = 0.3;
    let mut found = 0;
    for plan in [
        document(scenario("uncertainty/turning.toml")),
        document(scenario("uncertainty/changing-velocities.toml")),
        document(at_risk),
    ] {
        assert!(checked(&plan).verified());
        let slabs = plan["obstacles"].as_array().expect("slabs").len();
        assert!(slabs > 1);
        for slab in 1..slabs {
            let mut altered = plan.clone();
            let corners = &mut altered["obstacles"][slab]["velocity_set"]["vertices_mps"];
            *corners = scaled(corners, 0.9);
            assert_word(&altered, &format!("slab {slab}"), "too small for ");
            found += 1;
        }
    }
    assert!(found > 5, "{found}");
}

/// Numbers whose squares are none.
#[test]
fn what_is_known_may_be_too_large_for_any_set() {
    let plan = document(scenario("uncertainty/changing-velocities.toml"));
    for key in ["initial_set/vertices_m", "velocity_sets/0/vertices_mps"] {
        let mut huge = plan.clone();
        *at(&mut huge, &format!("/targets/0/{key}/0")) = json!([1e300, 0.0]);
        match verify(&huge.to_string()) {
            Ok(_) => assert_word(&huge, key, "too small for"),
            Err(error) => assert!(error.to_string().contains("vertices"), "{error}"),
        }
    }
}

/// A slab that ends before it begins, within the slack of a long horizon.
#[test]
fn slabs_follow_one_another_to_the_digit() {
    let mut plan = document(scenario("uncertainty/changing-velocities.toml"));
    let slabs = list(&mut plan, "/obstacles");
    let end = slabs[0]["valid_s"][1].as_f64().expect("an end");
    let mut between = slabs[0].clone();
    between["valid_s"] = json!([end - 2e-8, end - 1e-8]);
    slabs.insert(1, between);
    assert_word(&plan, "a slab that ends early", "expected");
    let mut plan = document(scenario("uncertainty/changing-velocities.toml"));
    plan["targets"][0]["velocity_sets"][0]["until_s"] = json!(-1.0);
    let error = verify(&plan.to_string()).expect_err("a set until before the start");
    assert!(error.to_string().contains("do not increase"), "{error}");
}

/// Own position at a time, and the time from which something is claimed of the first target's set.
fn after_release(plan: &Value, later: f64) -> ([f64; 2], f64) {
    let until = plan["relaxations"][0]["until_s"]
        .as_f64()
        .expect("a release");
    let samples = plan["trajectory"]["samples"].as_array().expect("samples");
    let then = samples
        .iter()
        .find(|s| s["t_s"].as_f64() >= Some(until + later));
    let then = then.expect("a sample");
    let place = ["east_m", "north_m"].map(|key| then[key].as_f64().expect("a number"));
    (place, then["t_s"].as_f64().expect("a time"))
}

/// A plan that is within the set again, or within the hull, some seconds after it has left the set.
#[test]
fn what_is_entered_after_a_release_is_found() {
    let plan = inside();
    assert!(checked(&plan).verified());
    let entered = |document: &Value, what: &str, time: f64, by: f64| {
        let found = checked(document).violations;
        let entered = found.iter().find(|v| v.what.contains(what));
        let then = entered.is_some_and(|v| (v.time - time).abs() < by);
        assert!(then, "{found:#?}");
    };
    for later in [3.0, 30.0] {
        let (place, time) = after_release(&plan, later);
        // the set fast across its way
        let mut set = plan.clone();
        let obstacle = &mut set["obstacles"][0];
        let from = obstacle["valid_s"][0].as_f64().expect("a start");
        let center = [place[0], place[1] - 50.0 * (time - from)];
        obstacle["initial_set"]["vertices_m"] = square(center, 9.0);
        obstacle["velocity_set"]["vertices_mps"] = json!([[0.0, 50.0]]);
        entered(&set, "set of 'target': distance", time, 1.0);
        // its hull fast across its way
        let mut hull = plan.clone();
        let ship = &mut hull["targets"][0]["ship"];
        ship["position"] = json!({ "east_m": place[0], "north_m": place[1] - 50.0 * time });
        ship["course_deg"] = json!(0.0);
        ship["speed_mps"] = json!(50.0);
        for spread in [
            "speed_spread_mps",
            "course_spread_deg",
            "turn_rate_deg_per_s",
        ] {
            ship[spread] = json!(0.0);
        }
        entered(&hull, "hull of 'target': distance", time, 3.0);
    }
}

/// A hundred thousand corners are not looked at each with each.
#[test]
fn a_set_of_very_many_corners_is_checked() {
    const CORNERS: u32 = 100_000;
    let mut plan = document(scenario("uncertainty/changing-velocities.toml"));
    let corner = |k: u32| {
        let (sin, cos) = (TAU * f64::from(k) / f64::from(CORNERS)).sin_cos();
        [3e5 + 1e4 * cos, 3e5 + 1e4 * sin]
    };
    let corners: Vec<_> = (0..CORNERS).map(corner).collect();
    plan["targets"][0] = json!({ "name": plan["targets"][0]["name"], "representation": "polytope",
        "initial_set": { "vertices_m": corners }, "velocity_sets": [{ "until_s": null, "vertices_mps": [[0.0, 0.0]] }] });
    plan["obstacles"] = json!([{ "name": plan["targets"][0]["name"], "valid_s": [0.0, plan["horizon_s"]],
        "initial_set": { "vertices_m": corners }, "velocity_set": { "vertices_mps": [[0.0, 0.0]] } }]);
    let begun = std::time::Instant::now();
    let found = checked(&plan);
    // each with each took 44 s
    assert!(begun.elapsed().as_secs() < 10, "{:?}", begun.elapsed());
    let wrong = |what: &str| found.violations.iter().any(|v| v.what.contains(what));
    assert!(
        !wrong("too small") && !wrong("set of '"),
        "{:#?}",
        found.violations
    );
}
