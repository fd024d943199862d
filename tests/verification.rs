//! Tests of the plan document check: documents from the planners pass, and every alteration is
//! detected.
//!
//! To check more random scenes than the default:
//!
//! ```sh
//! SEAROOM_WILD=2000 cargo test --release --no-default-features \
//!     --test verification wild -- --nocapture
//! ```

mod unsound;
mod wild;

use std::path::{Path, PathBuf};

use searoom::document::PlanDocument;
use searoom::frame::Vector;
use searoom::geometry::{ConvexPolygon, outer_disc};
use searoom::obstacle::SlabObstacle;
use searoom::pipeline;
use searoom::planner::Objective;
use searoom::scenario::{Compliance, Scenario};
use searoom::target::{Motion, Representation, ShipTrack, Uncertainty};
use searoom::verification::{Verification, verify};
use serde_json::{Value, json};

fn file(path: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("scenarios")
        .join(path)
}

fn scenario(path: &str) -> Scenario {
    Scenario::read(&file(path)).expect(path)
}

fn document(scenario: Scenario) -> Value {
    let run = pipeline::run(scenario);
    assert!(run.evaluation.as_ref().is_some_and(|e| e.verified()));
    // serialise and parse, as for a file
    let text = serde_json::to_string(&PlanDocument::of(&run)).expect("a document");
    serde_json::from_str(&text).expect("JSON")
}

fn checked(document: &Value) -> Verification {
    verify(&document.to_string()).expect("a plan document")
}

/// Own ship stands on, holds course and speed, and escapes.
fn stand_on() -> Value {
    let mut scenario = scenario("colregs/stand-on.toml");
    scenario.compliance = Compliance::Rules;
    document(scenario)
}

/// Own ship starts inside the set of a ship that it must avoid, and leaves it.
fn inside() -> Value {
    let text = std::fs::read_to_string(file("colregs/head-on.toml")).expect("a scenario");
    let mut scenario = Scenario::parse(&text).expect("a scenario");
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
fn barred() -> Value {
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
    document(Scenario::parse(text).expect("a scenario"))
}

/// One document of each kind: space-time, land, slabs, ellipses, accepted risk, path-time, forces,
/// stand-on, and a start inside a set.
fn documents() -> Vec<(&'static str, Value)> {
    let mut risky = scenario("colregs/give-way.toml");
    risky.max_risk = 0.4;
    let mut round = scenario("colregs/head-on.toml");
    round.targets[0].representation = Representation::Ellipsoid;
    let mut quick = scenario("harbour/ferry-crossing.toml");
    quick.objective = Objective::Time;
    let mut one = scenario("paper/figure_9.toml");
    one.targets.truncate(1);
    vec![
        ("head-on", document(scenario("colregs/head-on.toml"))),
        ("at a risk", document(risky)),
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

#[test]
fn what_was_planned_passes() {
    let mut count = 0;
    for folder in ["colregs", "harbour", "paper", "uncertainty"] {
        for entry in std::fs::read_dir(file(folder)).expect("a folder") {
            let path = entry.expect("an entry").path();
            if path.extension().is_none_or(|e| e != "toml") {
                continue;
            }
            let found = checked(&document(Scenario::read(&path).expect("a scenario")));
            assert!(found.verified(), "{path:?}: {:#?}", found.violations);
            let evaluation = found.evaluation.expect("a plan");
            assert_eq!(evaluation.passages.len(), found.targets.len());
            assert!(evaluation.passages.iter().all(|p| p.min_margin >= -1e-6));
            count += 1;
        }
    }
    assert!(count >= 14, "{count}");
    for (name, document) in documents() {
        let found = checked(&document);
        assert!(found.verified(), "{name}: {:#?}", found.violations);
    }
}
/// Checks a plan of a million seconds (11.5 days), the maximum length. The sample interval grows
/// just enough to limit the file size.
#[test]
fn a_plan_of_a_million_seconds_is_written_and_checked() {
    let text = r#"title = "long"
        horizon_s = 1000000.0
        own_ship = { position = { east_m = 0, north_m = 0 }, course_deg = 90, speed_mps = 5, length_m = 30, beam_m = 8, turning_radius_m = 100 }
        mission = { waypoints = [{ east_m = 0, north_m = 0 }, { east_m = 4900000, north_m = 0 }] }"#;
    let written = document(Scenario::parse(text).expect("a scenario"));
    let samples = "/trajectory/samples";
    let count = written.pointer(samples).and_then(Value::as_array);
    assert!((19_000..20_010).contains(&count.expect("samples").len()));
    assert!(written.to_string().len() < 8 << 20);
    let found = checked(&written);
    assert!(found.violations.is_empty(), "{:?}", found.violations);
    let mut gap = written;
    list(&mut gap, samples).remove(700);
    let found = checked(&gap);
    assert!(
        found
            .violations
            .iter()
            .any(|v| v.what.contains("samples[700]"))
    );
}

/// Checks level sets millions of times smaller than the sets, and sets that hardly spread. The risk
/// depends on the last digits there, and the document must not report less than the check finds.
#[test]
fn plans_at_a_risk_pass_however_small_the_level_sets() {
    let plan = |max_risk: f64, target: &str| {
        let text = format!(
            r#"title = "risk"
            horizon_s = 400.0
            own_ship = {{ position = {{ east_m = 0.0, north_m = 0.0 }}, course_deg = 90.0, speed_mps = 5.0, length_m = 30.0,
                beam_m = 8.0, turning_radius_m = 0.001 }}
            mission = {{ waypoints = [{{ east_m = 0.0, north_m = 0.0 }}, {{ east_m = 1500.0, north_m = 0.0 }}] }}
            planner = {{ max_risk = {max_risk} }}
            [[targets]]
            name = "target"
            {target}"#
        );
        let written = document(Scenario::parse(&text).expect("a scenario"));
        let found = checked(&written);
        assert!(found.violations.is_empty(), "{:?}", found.violations);
        written["cost"]["max_risk"].as_f64().expect("a number")
    };
    // velocities from rest to twice the speed, along the hull
    let risk = plan(
        0.999999,
        r#"position = { east_m = 750.0, north_m = 0.0 }
        course_deg = 144.76848081611433
        speed_mps = 9.201127151574104
        length_m = 269.03333503864656
        beam_m = 1.3089970633978214
        speed_spread_mps = 32.28479795338985
        domain = "hull""#,
    );
    assert!((risk - 0.059130838).abs() < 1e-6, "{risk}");
    // sets that grow by a nanometre per second
    let risk = plan(
        0.5,
        r#"initial_set = { vertices_m = [[1399.7335538893385, -100.26644611066152], [1600.2664461106615, -100.26644611066152],
            [1600.2664461106615, 100.26644611066152], [1399.7335538893385, 100.26644611066152]] }
        velocity_sets = [{ until_s = 0.07809908373380123, vertices_mps = [[-0.8394706159325942, 0.0], [-0.8393040782734484, 0.0],
            [-0.8394706159325942, 2.9215047979011405e-11]] }, { vertices_mps = [[-0.8394706159325942, 0.0], [-0.8394706149325942, 0.0]] }]"#,
    );
    assert!(risk <= 0.5, "{risk}");
}

/// Collects every number below `value` as JSON pointers.
fn numbers(value: &Value, at: &str, found: &mut Vec<String>) {
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

/// True for values on which no proof depends: search statistics, weights, and properties of the map
/// or the run.
fn is_said_only(pointer: &str) -> bool {
    [
        "/search_stats",
        "/timing",
        "/relaxation/",
        "/optimal_control/intervals",
        "/optimal_control/start_intervals",
        "/optimal_control/defect",
        "/optimal_control/force_limits",
        "/optimal_control/starts",
        "/optimal_control/homotopy_classes",
        "/path_time/legs",
        "/path_time/obstacles",
        "/path_time/corners",
        "/mission/alternatives",
        "/land/",
        "/obstacles/",
        "/targets/",
        "/own_ship/",
        "/horizon_s",
        "/max_risk",
        "/risk_weight_m",
        // clear for a longer hold implies clear for a shorter one
        "/cost/arrival_hold_s",
    ]
    .iter()
    .any(|part| pointer.starts_with(part))
        // the largest risk may persist for a time interval
        || pointer.contains("max_risk_t_s")
        || ["roles", "scores", "breaches", "monitors"]
            .iter()
            .any(|judged| pointer.contains(&format!("/{judged}")))
}

/// Tests a hull that is nearest during a turn on the spot, on a heading between two legs.
#[test]
fn a_closest_approach_in_a_turn_on_the_spot_passes() {
    let text = r#"
        title = "corner"
        horizon_s = 600.0
        [own_ship]
        position = { east_m = 0.0, north_m = 0.0 }
        course_deg = 90.0
        speed_mps = 5.0
        length_m = 30.0
        beam_m = 8.0
        turning_radius_m = 100.0
        [mission]
        waypoints = [
            { east_m = 0.0, north_m = 0.0 },
            { east_m = 1000.0, north_m = 0.0 },
            { east_m = 1000.0, north_m = 1000.0 },
        ]
        [planner]
        kind = "path-time"
        [[targets]]
        name = "moored"
        position = { east_m = 1700.0, north_m = -100.0 }
        course_deg = 0.0
        speed_mps = 0.0
        length_m = 60.0
        beam_m = 12.0
    "#;
    let mut document = document(Scenario::parse(text).expect("sound"));
    assert!(!is_caught(&document));
    let dcpa = document["encounters"][0]["dcpa_m"]
        .as_f64()
        .expect("a distance");
    *at(&mut document, "/encounters/0/dcpa_m") = json!(dcpa + 0.1);
    assert!(is_caught(&document));
}

/// Number of altered values per document; all of them if `SEAROOM_MUTATIONS` is set.
const ALTERED: usize = 120;

/// Alters the numbers of the motion, its samples, costs, encounters and mission by a thousandth.
/// Every alteration must be detected.
#[test]
fn every_number_of_the_motion_and_its_figures_is_held() {
    let all = std::env::var_os("SEAROOM_MUTATIONS").is_some();
    for (name, document) in documents() {
        let forces = document["optimal_control"].is_object();
        let is_held = |pointer: &String| {
            // nearer land may lie outside the document
            let one_sided = pointer == "/cost/min_land_distance_m";
            // forces are checked to the tolerance of the dynamics
            let loose = forces
                && ["surge_n", "sway_n", "yaw_nm"]
                    .iter()
                    .any(|k| pointer.ends_with(k));
            // the barge is touched for a time interval; any time in it is a closest approach
            let lasting = (name == "canal" && pointer == "/encounters/0/tcpa_s")
                || pointer.ends_with("/undisturbed_tcpa_s");
            // relaxed amount of a ship domain
            let drawn = pointer.strip_suffix("/amount").is_some_and(|given_up| {
                document.pointer(&format!("{given_up}/kind")) != Some(&json!("risk"))
            });
            // a waiting ship has the same position at any time of the interval
            let waiting = pointer.strip_suffix("/t_s").is_some_and(|sample| {
                sample.starts_with("/trajectory/samples/")
                    && document.pointer(&format!("{sample}/speed_mps")) == Some(&json!(0.0))
            });
            !(is_said_only(pointer) || one_sided || loose || lasting || drawn || waiting)
        };
        let mut pointers = Vec::new();
        numbers(&document, "", &mut pointers);
        pointers.retain(is_held);
        // an odd stride covers every column of the samples
        let stride = if all {
            1
        } else {
            (pointers.len() / ALTERED) | 1
        };
        let mut altered = 0;
        for pointer in pointers.iter().step_by(stride) {
            let value = document
                .pointer(pointer)
                .and_then(Value::as_f64)
                .expect("a number");
            // angles of a state under forces are checked to the tolerance of the dynamics
            let angle = forces
                && ["heading_deg", "yaw_rate_deg_per_s"]
                    .iter()
                    .any(|k| pointer.ends_with(k));
            let step = if angle { 0.1 } else { 1e-3 } * value.abs().max(1.0);
            let sign = if altered % 2 == 0 { 1.0 } else { -1.0 };
            let wrong = value + sign * step;
            let mut document = document.clone();
            *document.pointer_mut(pointer).expect("there") = json!(wrong);
            assert!(
                is_caught(&document),
                "{name}: {pointer} from {value} to {wrong}"
            );
            altered += 1;
        }
        assert!(altered >= ALTERED / 2, "{name}: {altered}");
    }
}

fn is_caught(document: &Value) -> bool {
    match verify(&document.to_string()) {
        Ok(found) => !found.verified(),
        Err(_) => true,
    }
}

fn at<'a>(document: &'a mut Value, pointer: &str) -> &'a mut Value {
    document
        .pointer_mut(pointer)
        .unwrap_or_else(|| panic!("{pointer}"))
}

fn list<'a>(document: &'a mut Value, pointer: &str) -> &'a mut Vec<Value> {
    at(document, pointer).as_array_mut().expect("a list")
}

fn add(number: &mut Value, step: f64) {
    *number = json!(number.as_f64().expect("a number") + step);
}

fn scale(number: &mut Value, factor: f64) {
    *number = json!(number.as_f64().expect("a number") * factor);
}

/// Segments of the document. Samples and figures stay unchanged, so the test states which check
/// detects the alteration.
fn segments(document: &mut Value) -> &mut Vec<Value> {
    list(document, "/trajectory/segments")
}

type Alteration = (&'static str, fn(&mut Value), &'static str);

/// Alterations of the segments, each with a word of an expected violation.
const SEGMENTS: &[Alteration] = &[
    (
        "all moved",
        |d| {
            for s in segments(d) {
                add(&mut s["start"]["north_m"], 0.01);
            }
        },
        "start position",
    ),
    (
        "one moved",
        |d| add(&mut segments(d)[2]["start"]["east_m"], 1e-3),
        "position at the joint",
    ),
    (
        "one turned",
        |d| add(&mut segments(d)[1]["start"]["course_deg"], 0.01),
        "",
    ),
    (
        "all turned",
        |d| {
            for s in segments(d) {
                add(&mut s["start"]["course_deg"], 1.0);
            }
        },
        "",
    ),
    (
        "sped up, over the same time",
        |d| {
            for s in segments(d) {
                scale(&mut s["speed_mps"], 1.01);
            }
        },
        "",
    ),
    (
        "sped up, over the same way",
        |d| {
            let mut time = 0.0;
            for s in segments(d) {
                scale(&mut s["speed_mps"], 1.05);
                scale(&mut s["turn_rate_deg_per_s"], 1.05);
                scale(&mut s["duration_s"], 1.0 / 1.05);
                s["start"]["t_s"] = json!(time);
                time += s["duration_s"].as_f64().expect("a number");
            }
        },
        "speed",
    ),
    (
        "the first cut off",
        |d| drop(segments(d).remove(0)),
        "start time",
    ),
    ("one cut out", |d| drop(segments(d).remove(1)), "joint"),
    ("the last cut off", |d| drop(segments(d).pop()), "arrival"),
    ("none left", |d| segments(d).clear(), "segments: none"),
    (
        "one twice",
        |d| {
            let again = segments(d)[1].clone();
            segments(d).insert(1, again);
        },
        "joint",
    ),
    ("two changed about", |d| segments(d).swap(0, 1), ""),
    ("backwards", |d| segments(d).reverse(), ""),
    (
        "shifted in time",
        |d| {
            for s in segments(d) {
                add(&mut s["start"]["t_s"], 0.5);
            }
        },
        "start time",
    ),
    (
        "shifted in time from the third on",
        |d| {
            for s in segments(d).iter_mut().skip(2) {
                add(&mut s["start"]["t_s"], 0.5);
            }
        },
        "time at the joint",
    ),
    (
        "one longer",
        |d| add(&mut segments(d)[0]["duration_s"], 0.01),
        "joint",
    ),
    (
        "one for less than no time",
        |d| segments(d)[0]["duration_s"] = json!(-1.0),
        "values",
    ),
    (
        "one at less than no speed",
        |d| segments(d)[0]["speed_mps"] = json!(-5.0),
        "values",
    ),
    (
        "turned the other way",
        |d| {
            for s in segments(d) {
                scale(&mut s["turn_rate_deg_per_s"], -1.0);
            }
            // without any turn, this resembles a cut corner
            add(&mut segments(d)[0]["turn_rate_deg_per_s"], 1e-3);
        },
        "",
    ),
    (
        "bent",
        |d| add(&mut segments(d)[0]["turn_rate_deg_per_s"], 0.01),
        "joint",
    ),
    (
        "a wait put in",
        |d| {
            let mut wait = segments(d)[1].clone();
            wait["speed_mps"] = json!(0.0);
            wait["turn_rate_deg_per_s"] = json!(0.0);
            wait["duration_s"] = json!(20.0);
            segments(d).insert(1, wait);
            for s in segments(d).iter_mut().skip(2) {
                add(&mut s["start"]["t_s"], 20.0);
            }
        },
        "",
    ),
    (
        "straight to the end",
        |d| {
            let end = at(d, "/mission/waypoints")
                .as_array()
                .and_then(|w| w.last())
                .cloned()
                .expect("one");
            let own = at(d, "/own_ship").clone();
            let (east, north) = (&own["position"]["east_m"], &own["position"]["north_m"]);
            let way = |a: &Value, b: &Value| b.as_f64().expect("m") - a.as_f64().expect("m");
            let (x, y) = (way(east, &end["east_m"]), way(north, &end["north_m"]));
            let speed = own["speed_mps"].as_f64().expect("m/s");
            *segments(d) = vec![json!({
                "start": { "t_s": 0.0, "east_m": east, "north_m": north, "course_deg": x.atan2(y).to_degrees() },
                "duration_s": x.hypot(y) / speed, "speed_mps": speed, "turn_rate_deg_per_s": 0.0,
            })];
        },
        "",
    ),
];

#[test]
fn every_altered_motion_is_caught() {
    let mut altered = 0;
    for (name, document) in documents() {
        if !document["trajectory"]["segments"].is_array() {
            continue;
        }
        for (what, alter, word) in SEGMENTS {
            let mut document = document.clone();
            alter(&mut document);
            let found = checked(&document);
            assert!(!found.verified(), "{name}, {what}");
            let along_paths = document["path_time"].is_object();
            // path-time plans report it in other words
            let told = found.violations.iter().any(|v| v.what.contains(word));
            assert!(
                told || along_paths,
                "{name}, {what}: {:#?}",
                found.violations
            );
            altered += 1;
        }
    }
    assert!(altered >= 11 * SEGMENTS.len(), "{altered}");
}

/// Tests a motion through the target in an otherwise consistent document: only the sets detect it.
#[test]
fn a_consistent_run_through_a_target_is_caught_by_her_set_and_her_hull() {
    let mut document = document(scenario("colregs/head-on.toml"));
    let straight = SEGMENTS.last().expect("the last");
    straight.1(&mut document);
    let found = checked(&document);
    for part in ["set of 'target'", "hull of 'target'"] {
        assert!(
            found.violations.iter().any(|v| v.what.starts_with(part)),
            "{:#?}",
            found.violations
        );
    }
    let times: Vec<f64> = found.violations.iter().map(|v| v.time).collect();
    assert!(times.is_sorted(), "{times:?}");
    // a smaller set does not help, because it must contain the target
    for v in list(&mut document, "/obstacles/0/initial_set/vertices_m") {
        scale(&mut v[1], 1e-3);
    }
    let found = checked(&document);
    assert!(
        found
            .violations
            .iter()
            .any(|v| v.what.contains("too small for the hull"))
    );
}

/// Alterations of the setting that increase the danger.
const SETTING: &[Alteration] = &[
    ("a set less", |d| drop(list(d, "/obstacles").remove(0)), ""),
    (
        "a set for nobody",
        |d| at(d, "/obstacles/0")["name"] = json!("nobody"),
        "no target",
    ),
    ("a target less", |d| drop(list(d, "/targets").remove(0)), ""),
    (
        "no sets and no targets",
        |d| {
            list(d, "/obstacles").clear();
            list(d, "/targets").clear();
        },
        "encounters",
    ),
    (
        "none of targets, sets and encounters",
        |d| {
            for part in ["/obstacles", "/targets", "/encounters"] {
                list(d, part).clear();
            }
        },
        "cost.min_clearance_m",
    ),
    (
        "a set that ends before the horizon",
        |d| add(&mut at(d, "/obstacles/0")["valid_s"][1], -300.0),
        "",
    ),
    (
        "a set that begins late",
        |d| add(&mut at(d, "/obstacles/0")["valid_s"][0], 1.0),
        "valid from",
    ),
    (
        "a turning radius above the plan's",
        |d| scale(at(d, "/own_ship/turning_radius_m"), 1.0 + 1e-6),
        "turning radius",
    ),
    (
        "a turn on the spot",
        |d| {
            for s in segments(d) {
                s["speed_mps"] = json!(0.0);
            }
        },
        "turning radius",
    ),
    (
        "a speed that own ship has not",
        |d| {
            for s in list(d, "/own_ship/speeds_mps") {
                scale(s, 0.9);
            }
        },
        "speed",
    ),
    (
        "a horizon before arrival",
        |d| *at(d, "/horizon_s") = json!(100.0),
        "arrival time",
    ),
    (
        "own ship elsewhere",
        |d| add(at(d, "/own_ship/position/north_m"), 0.01),
        "start position",
    ),
    (
        "own ship on another course",
        |d| add(at(d, "/own_ship/course_deg"), 0.01),
        "start heading",
    ),
    (
        "a longer ship",
        |d| add(at(d, "/own_ship/length_m"), 5.0),
        "cost.min_clearance_m",
    ),
    (
        "a wider margin",
        |d| add(at(d, "/own_ship/safety_margin_m"), 300.0),
        "too small for the hull",
    ),
    (
        "another mission",
        |d| add(&mut at(d, "/mission/waypoints/1")["north_m"], 1.0),
        "arrival",
    ),
    (
        "a target elsewhere",
        |d| add(at(d, "/targets/0/ship/position/north_m"), 100.0),
        "encounter",
    ),
    (
        "a longer target",
        |d| add(at(d, "/targets/0/ship/length_m"), 200.0),
        "too small for the hull",
    ),
    (
        "a target less well known",
        |d| add(at(d, "/targets/0/ship/position_std_m"), 40.0),
        "too small for the hull",
    ),
    (
        "a target on another course",
        |d| add(at(d, "/targets/0/ship/course_deg"), 1.0),
        "too small for her velocities",
    ),
    (
        "a faster target",
        |d| add(at(d, "/targets/0/ship/speed_mps"), 0.1),
        "too small for her velocities",
    ),
    (
        "a target that may alter more",
        |d| add(at(d, "/targets/0/ship/course_spread_deg"), 1.0),
        "too small for her velocities",
    ),
    (
        "a target that may hurry more",
        |d| add(at(d, "/targets/0/ship/speed_spread_mps"), 0.1),
        "too small for her velocities",
    ),
    (
        "a target that may turn",
        |d| add(at(d, "/targets/0/ship/turn_rate_deg_per_s"), 0.1),
        "too small for her velocities",
    ),
    (
        "a set over the plan",
        |d| {
            for v in list(d, "/obstacles/0/initial_set/vertices_m") {
                scale(&mut v[0], 1.2);
                scale(&mut v[1], 5.0);
            }
        },
        "set of 'target'",
    ),
    (
        "a smaller set of velocities",
        |d| {
            for v in list(d, "/obstacles/0/velocity_set/vertices_mps") {
                scale(&mut v[1], 0.9);
            }
        },
        "too small for her velocities",
    ),
    (
        "one encounter less",
        |d| drop(list(d, "/encounters").remove(0)),
        "encounters",
    ),
    (
        "another side",
        |d| *at(d, "/encounters/0/passing_side") = json!("starboard"),
        "passing_side",
    ),
    (
        "a mission that was not fulfilled",
        |d| *at(d, "/cost/arrived") = json!(false),
        "cost.arrived",
    ),
    ("no cost", |d| *at(d, "/cost") = Value::Null, "cost"),
    (
        "samples cut off",
        |d| drop(list(d, "/trajectory/samples").pop()),
        "samples",
    ),
    (
        "a sample cut out",
        |d| drop(list(d, "/trajectory/samples").remove(40)),
        "samples",
    ),
    (
        "samples changed about",
        |d| list(d, "/trajectory/samples").swap(30, 31),
        "samples",
    ),
    (
        "no samples",
        |d| list(d, "/trajectory/samples").clear(),
        "samples",
    ),
];

#[test]
fn every_altered_setting_is_caught() {
    let original = document(scenario("colregs/head-on.toml"));
    for (what, alter, word) in SETTING {
        let mut document = original.clone();
        alter(&mut document);
        let found = checked(&document);
        assert!(!found.verified(), "{what}");
        assert!(
            found.violations.iter().any(|v| v.what.contains(word)),
            "{what}: {:#?}",
            found.violations
        );
    }
}

/// Alters slabs, ellipses, level sets of risk, forces and land.
#[test]
fn what_only_some_plans_have_is_held_too() {
    let mut turning = document(scenario("uncertainty/turning.toml"));
    let last = list(&mut turning, "/obstacles").len() - 1;
    assert!(last > 0);
    let cases: Vec<(Value, Vec<Alteration>)> = vec![
        (
            turning,
            vec![
                (
                    "a slab less",
                    |d| drop(list(d, "/obstacles").remove(1)),
                    "valid from",
                ),
                (
                    "the last slab less",
                    |d| drop(list(d, "/obstacles").pop()),
                    "valid until",
                ),
                (
                    "a slab elsewhere",
                    |d| add(&mut at(d, "/obstacles/1/initial_set/vertices_m")[0][0], 0.1),
                    "",
                ),
                (
                    "a slab that lags",
                    |d| {
                        for v in list(d, "/obstacles/1/initial_set/vertices_m") {
                            add(&mut v[1], 5.0);
                        }
                    },
                    "does not begin with the final section",
                ),
                (
                    "a target that turns faster",
                    |d| scale(at(d, "/targets/0/ship/turn_rate_deg_per_s"), 1.2),
                    "too small for her velocities",
                ),
            ],
        ),
        (
            document(scenario("uncertainty/changing-velocities.toml")),
            vec![
                (
                    "a velocity set that begins earlier",
                    |d| add(&mut at(d, "/targets/0/velocity_sets/0")["until_s"], -20.0),
                    "too small for the velocity set",
                ),
                (
                    "a larger set",
                    |d| scale(&mut at(d, "/targets/0/initial_set/vertices_m")[0][0], 1.5),
                    "",
                ),
            ],
        ),
        (
            document(scenario("uncertainty/ellipse.toml")),
            vec![
                (
                    "a larger target",
                    |d| scale(&mut at(d, "/targets/0/initial_set/shape_m2")[0][0], 1.1),
                    "too small for the initial set",
                ),
                (
                    "a faster target",
                    |d| {
                        scale(
                            &mut at(d, "/targets/0/velocity_sets/0")["shape_m2_per_s2"][1][1],
                            1.1,
                        )
                    },
                    "too small for the velocity set",
                ),
                (
                    "a larger ellipse",
                    |d| {
                        for row in 0..2 {
                            for column in 0..2 {
                                scale(
                                    &mut at(d, "/obstacles/0/initial_set/shape_m2")[row][column],
                                    9.0,
                                );
                            }
                        }
                    },
                    "set of 'tracked': distance",
                ),
            ],
        ),
        (
            documents().swap_remove(1).1,
            vec![
                (
                    "less risk than was taken",
                    |d| scale(at(d, "/cost/max_risk"), 0.9),
                    "cost.max_risk",
                ),
                (
                    "less risk accepted",
                    |d| *at(d, "/max_risk") = json!(0.1),
                    "",
                ),
                (
                    "more risk accepted",
                    |d| *at(d, "/max_risk") = json!(0.6),
                    "",
                ),
                (
                    "no risk",
                    |d| *at(d, "/cost/max_risk") = json!(0.0),
                    "cost.max_risk",
                ),
            ],
        ),
        (
            document(scenario("harbour/munkholmen.toml")),
            vec![
                (
                    "a margin to land that is not kept",
                    |d| *at(d, "/own_ship/land_margin_m") = json!(70.0),
                    "land",
                ),
                (
                    "land moved",
                    |d| {
                        for piece in list(d, "/land") {
                            for v in piece.as_array_mut().expect("a ring") {
                                add(&mut v[1], 60.0);
                            }
                        }
                    },
                    "land",
                ),
                (
                    "farther from land",
                    |d| add(at(d, "/cost/min_land_distance_m"), 1.0),
                    "cost.min_land_distance_m",
                ),
                (
                    "no land to be far from",
                    |d| *at(d, "/cost/min_land_distance_m") = Value::Null,
                    "cost.min_land_distance_m",
                ),
            ],
        ),
        (
            document(scenario("paper/figure_9.toml")),
            vec![
                (
                    "weaker engines",
                    |d| scale(at(d, "/optimal_control/force_limits/surge_n"), 0.01),
                    "surge force",
                ),
                (
                    "a weaker rudder",
                    |d| scale(at(d, "/optimal_control/force_limits/yaw_nm"), 0.01),
                    "yaw moment",
                ),
                (
                    "a cheaper plan",
                    |d| scale(at(d, "/cost/objective"), 0.9999),
                    "cost.objective",
                ),
                (
                    "other weights",
                    |d| scale(at(d, "/optimal_control/control_weights/1"), 1.001),
                    "cost.objective",
                ),
                (
                    "a ship of another size",
                    |d| scale(at(d, "/own_ship/length_m"), 1.01),
                    "off the plan",
                ),
                (
                    "an error that is counted for longer",
                    |d| scale(at(d, "/cost/space_time_error_until_s"), 1.01),
                    "cost.space_time_error_until_s",
                ),
                (
                    "other forces",
                    |d| {
                        for s in list(d, "/trajectory/samples") {
                            if s["surge_n"].is_number() {
                                scale(&mut s["surge_n"], 0.9);
                            }
                        }
                    },
                    "off the plan",
                ),
                (
                    "a node less",
                    |d| {
                        let nodes = list(d, "/trajectory/samples");
                        let node = nodes.iter().position(|s| {
                            s["t_s"].as_f64() > Some(20.0) && s["surge_n"].is_number()
                        });
                        let node = nodes[node.expect("one")].as_object_mut().expect("a sample");
                        node.remove("surge_n");
                    },
                    "off the plan",
                ),
                (
                    "a larger ellipse",
                    |d| {
                        for row in 0..2 {
                            for column in 0..2 {
                                scale(
                                    &mut at(d, "/obstacles/0/initial_set/shape_m2")[row][column],
                                    1.5,
                                );
                            }
                        }
                    },
                    "set of",
                ),
            ],
        ),
        (
            document(scenario("harbour/canal-transit.toml")),
            vec![
                (
                    "another profile",
                    |d| add(&mut at(d, "/path_time/profile")[3][1], 1.0),
                    "path_time.profile",
                ),
                (
                    "a corner of the profile moved in time while she waits",
                    |d| add(&mut at(d, "/path_time/profile")[8][1], -0.4),
                    "path_time.profile",
                ),
                (
                    "a profile cut off",
                    |d| drop(list(d, "/path_time/profile").pop()),
                    "path_time.profile",
                ),
                (
                    "off the path",
                    |d| add(&mut at(d, "/mission/waypoints")[1]["east_m"], 0.5),
                    "path",
                ),
                (
                    "a slower ship",
                    |d| {
                        for s in list(d, "/own_ship/speeds_mps") {
                            scale(s, 0.5);
                        }
                    },
                    "speed",
                ),
            ],
        ),
    ];
    for (original, alterations) in cases {
        assert!(!is_caught(&original));
        for (what, alter, word) in alterations {
            let mut document = original.clone();
            alter(&mut document);
            let name = &original["scenario"];
            match verify(&document.to_string()) {
                Ok(found) => {
                    assert!(!found.verified(), "{name}, {what}");
                    let told = found.violations.iter().any(|v| v.what.contains(word));
                    assert!(told, "{name}, {what}: {:#?}", found.violations);
                }
                // without this corner, the set is no longer a convex polygon
                Err(error) => assert!(word.is_empty(), "{name}, {what}: {error}"),
            }
        }
    }
}

/// Checks the hold of a stand-on ship, the end of the hold, and the subsequent manoeuvre.
#[test]
fn an_escape_is_what_it_is_said_to_be() {
    let original = stand_on();
    assert!(!is_caught(&original));
    let latest = original["escape"]["latest_s"].as_f64().expect("a time");
    assert!(latest > 60.0 && original["escape"]["turn_deg"].as_f64() >= Some(30.0));
    let cases: Vec<Alteration> = vec![
        (
            "later",
            |d| add(at(d, "/escape/latest_s"), 1.0),
            "escape.latest_s",
        ),
        (
            "earlier",
            |d| add(at(d, "/escape/latest_s"), -1.0),
            "escape.latest_s",
        ),
        (
            "another segment",
            |d| *at(d, "/escape/first_segment") = json!(2),
            "escape.latest_s",
        ),
        (
            "a segment that is not there",
            |d| *at(d, "/escape/first_segment") = json!(99),
            "no segment",
        ),
        (
            "a turn later, said so consistently",
            |d| {
                let next = at(d, "/trajectory/segments/2/start/t_s").clone();
                *at(d, "/escape/first_segment") = json!(2);
                *at(d, "/escape/latest_s") = next;
            },
            "course and speed are held",
        ),
        (
            "another turn",
            |d| scale(at(d, "/escape/turn_deg"), 1.01),
            "escape.turn_deg",
        ),
        (
            "another speed",
            |d| scale(at(d, "/escape/speed_mps"), 1.01),
            "escape.speed_mps",
        ),
        (
            "by less speed, which it is not",
            |d| *at(d, "/escape/turn_deg") = json!(0.0),
            "at most",
        ),
        (
            "another policy",
            |d| *at(d, "/escape/policy") = json!("hope"),
            "escape.policy",
        ),
        (
            "no rules to stand on by",
            |d| *at(d, "/compliance") = json!("shape"),
            "compliance",
        ),
        (
            "a set over the escape",
            |d| {
                let corners = list(d, "/obstacles/0/initial_set/vertices_m");
                let count = corners.len() as f64;
                for axis in [0, 1] {
                    let all = corners.iter().map(|v| v[axis].as_f64().expect("m"));
                    let middle = all.sum::<f64>() / count;
                    for v in corners.iter_mut() {
                        let grown = middle + 1.3 * (v[axis].as_f64().expect("m") - middle);
                        v[axis] = json!(grown);
                    }
                }
            },
            "escape: the document says clear",
        ),
        (
            "a target that is nowhere near",
            |d| {
                for v in list(d, "/obstacles/0/initial_set/vertices_m") {
                    add(&mut v[1], 9000.0);
                }
            },
            "needless",
        ),
        (
            "a set that is in force after the escape alone",
            |d| {
                let late = at(d, "/escape/latest_s").as_f64().expect("a time") + 10.0;
                let target = at(d, "/targets/0/name").clone();
                *at(d, "/relaxations") = json!([
                    { "kind": "risk", "target": target, "amount": 1.0, "unit": "1", "until_s": late }
                ]);
            },
            "escape: the document says clear from",
        ),
    ];
    for (what, alter, word) in cases {
        let mut document = original.clone();
        alter(&mut document);
        let found = checked(&document);
        assert!(!found.verified(), "{what}");
        assert!(
            found.violations.iter().any(|v| v.what.contains(word)),
            "{what}: {:#?}",
            found.violations
        );
    }
    // even turns of a tenth of a degree to both sides within the hold count
    let mut swerving = original.clone();
    segments(&mut swerving)[0]["turn_rate_deg_per_s"] = json!(1e-3);
    let found = checked(&swerving);
    assert!(
        found.violations.iter().any(|v| v.what.contains("are held")),
        "{:#?}",
        found.violations
    );
}

/// Tests a consistent but wrong largest risk: the level sets detect it.
#[test]
fn a_largest_risk_is_neither_more_nor_less_nor_at_another_time() {
    let risky = documents().swap_remove(1).1;
    let mut told = 0;
    for (name, original, index) in [
        ("at a risk", risky, 0),
        ("inside", inside(), 0),
        ("barred", barred(), 0),
        ("barred, the other", barred(), 1),
    ] {
        assert!(!is_caught(&original), "{name}");
        let encounter = format!("/encounters/{index}");
        let risk = |d: &Value| {
            d.pointer(&format!("{encounter}/max_risk"))
                .and_then(Value::as_f64)
        };
        let (said, target) = (
            risk(&original).expect("a risk"),
            original.pointer(&format!("{encounter}/target")).cloned(),
        );
        let tell = |risk: f64| {
            let mut document = original.clone();
            *at(&mut document, &format!("{encounter}/max_risk")) = json!(risk);
            for given_up in list(&mut document, "/relaxations") {
                let of_risk = given_up["kind"] == "risk";
                if of_risk && given_up.get("target") == target.as_ref() {
                    given_up["amount"] = json!(risk);
                }
            }
            let all = list(&mut document, "/encounters").iter();
            let most = all
                .filter_map(|e| e["max_risk"].as_f64())
                .fold(0.0, f64::max);
            *at(&mut document, "/cost/max_risk") = json!(most);
            document
        };
        // a risk of zero has no other value to replace it
        if said == 0.0 {
            continue;
        }
        told += 1;
        assert!(!is_caught(&tell(said)), "{name}");
        for wrong in [said * 0.999, said * 0.5, (said * 1.001).min(1.0)] {
            if wrong != said {
                assert!(is_caught(&tell(wrong)), "{name}: {wrong} instead of {said}");
            }
        }
        let mut late = original.clone();
        let time = format!("{encounter}/max_risk_t_s");
        let end = original["cost"]["duration_s"].as_f64().expect("s");
        let early = at(&mut late, &time).as_f64().expect("s") < 0.5 * end;
        *at(&mut late, &time) = json!(if early { end } else { 0.0 });
        assert!(is_caught(&late), "{name}: at another time");
        *at(&mut late, &time) = Value::Null;
        assert!(is_caught(&late), "{name}: at no time");
        let mut kept = original.clone();
        list(&mut kept, "/relaxations").retain(|r| r["kind"] != "risk");
        assert!(is_caught(&kept), "{name}: nothing given up");
        let mut clear = original.clone();
        *at(&mut clear, &format!("{encounter}/max_risk")) = Value::Null;
        assert!(is_caught(&clear), "{name}: no risk");
    }
    assert!(told >= 3, "{told}");
}

/// Tests consistent but wrong statements on a risk: it must be accepted, and must have a time.
#[test]
fn a_risk_is_within_what_was_accepted_and_has_a_time() {
    let mut risky = documents().swap_remove(1).1;
    assert!(at(&mut risky, "/encounters/0/max_risk_t_s").is_number());
    let clear = document(scenario("colregs/head-on.toml"));
    let forces = document(scenario("forces/give-way.toml"));
    let mut accepting = scenario("colregs/head-on.toml");
    accepting.max_risk = 0.4;
    accepting.targets[0].motion = {
        // far from the path
        let Motion::Ship(mut ship) = accepting.targets[0].motion.clone() else {
            panic!("a ship");
        };
        ship.pose.position.y += 5000.0;
        Motion::Ship(ship)
    };
    let accepting = document(accepting);
    let tell = |d: &mut Value, risk: f64, time: Value| {
        *at(d, "/encounters/0/max_risk") = json!(risk);
        *at(d, "/encounters/0/max_risk_t_s") = time;
        *at(d, "/cost/max_risk") = json!(risk.max(0.0));
        let target = at(d, "/encounters/0/target").clone();
        let given_up = list(d, "/relaxations");
        given_up.retain(|r| r["kind"] != "risk");
        if risk > 0.0 {
            given_up.push(json!({ "kind": "risk", "target": target, "amount": risk }));
        }
    };
    for (name, original) in [
        ("clear", &clear),
        ("forces", &forces),
        ("accepting", &accepting),
    ] {
        assert!(!is_caught(original), "{name}");
        for (risk, time, word) in [
            (
                0.5,
                json!(10.0),
                "max_risk: the document says 0.5, it is from 0 to",
            ),
            (
                -0.5,
                Value::Null,
                "max_risk: the document says -0.5, it is from 0 to",
            ),
            (
                0.0,
                json!(10.0),
                "max_risk_t_s: the document says 10, it is nothing",
            ),
            (
                0.3,
                Value::Null,
                "max_risk_t_s: the document says nothing, it is a time",
            ),
        ] {
            let mut document = original.clone();
            tell(&mut document, risk, time);
            let found = checked(&document).violations;
            let told = found.iter().any(|v| v.what.contains(word));
            assert!(told, "{name}, {word}: {found:#?}");
        }
    }
    let mut late = risky.clone();
    *at(&mut late, "/encounters/0/max_risk_t_s") = Value::Null;
    let found = checked(&late).violations;
    assert_eq!(found.len(), 1, "{found:#?}");
    assert!(
        found[0]
            .what
            .contains("max_risk_t_s: the document says nothing")
    );
}

fn give_up(document: &mut Value, kind: &str, target: &str, amount: f64) {
    let given_up = json!({ "kind": kind, "target": target, "amount": amount });
    list(document, "/relaxations").push(given_up);
}

/// Checks that the words of a document agree with its content, and that figures independent of the
/// motion are recomputed.
#[test]
fn every_claim_of_a_document_is_held() {
    let clear = document(scenario("colregs/head-on.toml"));
    let relaxed = inside();
    assert_eq!(relaxed["outcome"], "relaxed");
    let along = document(scenario("harbour/ferry-crossing.toml"));
    let forces = document(scenario("forces/give-way.toml"));
    let land = document(scenario("harbour/munkholmen.toml"));
    let sets = document(scenario("uncertainty/changing-velocities.toml"));
    let ellipses = document(scenario("uncertainty/ellipse.toml"));
    let cases: Vec<(&Value, Alteration)> = vec![
        (
            &clear,
            (
                "solved as infeasible",
                |d| d["outcome"] = json!("infeasible"),
                "outcome",
            ),
        ),
        (
            &clear,
            (
                "solved as relaxed",
                |d| d["outcome"] = json!("relaxed"),
                "outcome",
            ),
        ),
        (
            &relaxed,
            (
                "relaxed as solved",
                |d| d["outcome"] = json!("solved"),
                "outcome",
            ),
        ),
        (
            &relaxed,
            (
                "relaxed as infeasible",
                |d| d["outcome"] = json!("infeasible"),
                "outcome",
            ),
        ),
        (
            &clear,
            (
                "no plan",
                |d| {
                    d["trajectory"] = Value::Null;
                    d["cost"] = Value::Null;
                },
                "it is infeasible or deadline",
            ),
        ),
        (
            &along,
            (
                "along paths, as free",
                |d| d["planner"] = json!("space-time"),
                "planner",
            ),
        ),
        (
            &forces,
            (
                "forces, as free",
                |d| d["planner"] = json!("space-time"),
                "planner",
            ),
        ),
        (
            &clear,
            (
                "free, as of forces",
                |d| d["planner"] = json!("optimal-control"),
                "planner",
            ),
        ),
        (
            &clear,
            (
                "no risk, given up",
                |d| {
                    give_up(d, "risk", "target", 0.0);
                    d["outcome"] = json!("relaxed");
                },
                "amount: the document says 0, it is nothing",
            ),
        ),
        (
            &clear,
            (
                "rules that nobody asked for",
                |d| {
                    d["compliance"] = json!("shape");
                    give_up(d, "compliance", "target", 1.0);
                    d["outcome"] = json!("relaxed");
                },
                "no part of compliance 'shape'",
            ),
        ),
        (
            &clear,
            (
                "a shape that nobody asked for",
                |d| {
                    d["compliance"] = json!("none");
                    give_up(d, "domain", "target", 1.0);
                    d["outcome"] = json!("relaxed");
                },
                "no part of compliance 'none'",
            ),
        ),
        (
            &clear,
            (
                "a shape, twice",
                |d| {
                    d["compliance"] = json!("shape");
                    give_up(d, "domain", "target", 1.0);
                    give_up(d, "domain", "target", 2.0);
                    d["outcome"] = json!("relaxed");
                },
                "'domain' twice",
            ),
        ),
        (
            &clear,
            (
                "farther apart",
                |d| d["encounters"][0]["undisturbed_dcpa_m"] = json!(5000.0),
                "undisturbed_dcpa_m",
            ),
        ),
        (
            &clear,
            (
                "no distance",
                |d| d["encounters"][0]["undisturbed_dcpa_m"] = Value::Null,
                "undisturbed_dcpa_m",
            ),
        ),
        (
            &clear,
            (
                "before the start",
                |d| d["encounters"][0]["undisturbed_tcpa_s"] = json!(-1.0),
                "undisturbed_tcpa_s",
            ),
        ),
        (
            &clear,
            (
                "at the start",
                |d| d["encounters"][0]["undisturbed_tcpa_s"] = json!(0.0),
                "undisturbed_tcpa_s",
            ),
        ),
        (
            &sets,
            (
                "sets, farther apart",
                |d| add(&mut d["encounters"][0]["undisturbed_dcpa_m"], 1e-3),
                "undisturbed_dcpa_m",
            ),
        ),
        (
            &ellipses,
            (
                "ellipses, farther apart",
                |d| d["encounters"][0]["undisturbed_dcpa_m"] = json!(5000.0),
                "undisturbed_dcpa_m",
            ),
        ),
        (
            &ellipses,
            (
                "ellipses, nearer",
                |d| add(&mut d["encounters"][0]["undisturbed_dcpa_m"], -1e-3),
                "undisturbed_tcpa_s",
            ),
        ),
        (
            &clear,
            (
                "land where none is",
                |d| d["cost"]["min_land_distance_m"] = json!(7.0),
                "min_land_distance_m",
            ),
        ),
        (
            &land,
            (
                "land that is nearer",
                |d| scale(&mut d["cost"]["min_land_distance_m"], 0.5),
                "min_land_distance_m",
            ),
        ),
    ];
    for (original, (what, alter, word)) in cases {
        assert!(!is_caught(original), "{what}");
        let mut document = original.clone();
        alter(&mut document);
        let found = checked(&document).violations;
        let told = found.iter().any(|v| v.what.contains(word));
        assert!(told, "{what}: {found:#?}");
    }
    let mut late = clear.clone();
    for outcome in ["solved", "deadline"] {
        late["outcome"] = json!(outcome);
        late["verdict"] = json!(outcome);
        assert!(!is_caught(&late), "{outcome}");
    }
}

/// A ship at rest on the last waypoint is neither to port nor to starboard of an arriving own ship.
#[test]
fn a_ship_on_the_last_waypoint_may_lie_on_either_side() {
    let rules = r#"
        title = "berth"
        horizon_s = 863.0
        [own_ship]
        position = { east_m = 0.0, north_m = 0.0 }
        course_deg = 351.0
        speed_mps = 5.0
        length_m = 30.0
        beam_m = 8.0
        turning_radius_m = 100.0
        safety_margin_m = 0.0
        [mission]
        waypoints = [{ east_m = 0.0, north_m = 0.0 }, { east_m = 1500.0, north_m = 0.0 }, { east_m = 1371.0, north_m = -647.0 }]
        [[targets]]
        name = "t0"
        position = { east_m = 1371.0, north_m = -647.0 }
        course_deg = 136.0
        speed_mps = 0.0
        length_m = 60
        beam_m = 12
    "#;
    let shape = r#"
        title = "berth"
        horizon_s = 1008.0
        [own_ship]
        position = { east_m = 0.0, north_m = 0.0 }
        course_deg = 90.0
        speed_mps = 5.0
        length_m = 30.0
        beam_m = 8.0
        turning_radius_m = 100.0
        safety_margin_m = 20.0
        [mission]
        waypoints = [{ east_m = 0.0, north_m = 0.0 }, { east_m = 1500.0, north_m = 0.0 }, { east_m = 1098.0, north_m = -938.0 }]
        [[targets]]
        name = "t0"
        position = { east_m = 1098.0, north_m = -938.0 }
        course_deg = 342.0
        speed_mps = 0.0
        length_m = 60
        beam_m = 12
    "#;
    for (text, compliance) in [(rules, Compliance::Rules), (shape, Compliance::Shape)] {
        let mut scenario = Scenario::parse(text).expect("a scenario");
        scenario.compliance = compliance;
        let found = checked(&document(scenario));
        assert!(found.violations.is_empty(), "{:#?}", found.violations);
    }
}

#[test]
fn what_is_no_plan_document_is_named() {
    let original = document(scenario("colregs/head-on.toml"));
    let said = |alter: &dyn Fn(&mut Value)| {
        let mut document = original.clone();
        alter(&mut document);
        verify(&document.to_string())
            .expect_err("no plan document")
            .to_string()
    };
    for (error, expected) in [
        (
            said(&|d| d["format"] = json!("other/2")),
            "format: found 'other/2'; allowed: searoom-plan/1",
        ),
        (
            said(&|d| d["horizon_s"] = json!(-1.0)),
            "horizon_s: found -1; allowed: a positive number",
        ),
        (said(&|d| d["max_risk"] = json!(1.0)), "max_risk: found 1"),
        (
            said(&|d| d["trajectory"]["segments"][3]["speed_mps"] = json!("fast")),
            "trajectory.segments[3].speed_mps: invalid type: string",
        ),
        (
            said(&|d| drop(d.as_object_mut().expect("an object").remove("targets"))),
            "missing field `targets`",
        ),
        (
            said(&|d| d["own_ship"]["turning_radius_m"] = json!(0.0)),
            "own_ship.turning_radius_m: found 0; allowed: a positive number",
        ),
        (
            said(&|d| d["own_ship"]["speeds_mps"] = json!([])),
            "own_ship.speeds_mps: found no speed above 0",
        ),
        (
            said(&|d| d["mission"]["waypoints"] = json!([])),
            "mission.leg_speeds_mps: found 1 speeds for 0 waypoints",
        ),
        (
            said(&|d| {
                d["mission"]["waypoints"] = json!([{ "east_m": 0.0, "north_m": 0.0 }]);
                d["mission"]["leg_speeds_mps"] = json!([]);
            }),
            "mission: found what makes no way",
        ),
        (
            said(&|d| d["obstacles"][0]["initial_set"] = json!({})),
            "obstacles[0].initial_set: found neither",
        ),
        (
            said(&|d| d["obstacles"][0]["valid_s"] = json!([5.0, 5.0])),
            "obstacles[0].valid_s: found 5 to 5",
        ),
        (
            said(&|d| d["targets"][0]["representation"] = json!("box")),
            "targets[0].representation: found 'box'",
        ),
        (
            said(&|d| d["planner"] = json!("x")),
            "planner: found 'x'; allowed: space-time, path-time, optimal-control",
        ),
        (
            said(&|d| d["compliance"] = json!("x")),
            "compliance: found 'x'; allowed: none, shape, rules",
        ),
        (
            said(&|d| d["objective"] = json!("x")),
            "objective: found 'x'; allowed: space-time-error, time, length, length-risk, stage-cost",
        ),
        (
            said(&|d| d["outcome"] = json!("x")),
            "outcome: found 'x'; allowed: solved, relaxed, infeasible, deadline",
        ),
        (
            said(&|d| give_up(d, "bogus", "target", 1.0)),
            "relaxations[0].kind: found 'bogus'; allowed: compliance, domain, risk, arrival",
        ),
        (
            said(&|d| give_up(d, "risk", "nobody", 0.9)),
            "relaxations[0].target: found 'nobody'; allowed: target",
        ),
        (
            said(&|d| give_up(d, "domain", "target", -5.0)),
            "relaxations[0].amount: found -5; allowed: a number that is not negative",
        ),
        (
            said(&|d| d["trajectory"]["segments"] = Value::Null),
            "trajectory.segments: found null without optimal_control",
        ),
        (
            said(&|d| d["land"] = json!([[[0.0, 0.0], [1.0, 1.0]]])),
            "land[0]: found",
        ),
    ] {
        assert!(error.contains(expected), "{error}");
    }
    assert!(verify("").is_err() && verify("[1, 2]").is_err() && verify("{} x").is_err());
    // no file content may cause a panic
    let text = original.to_string();
    for end in (0..text.len()).step_by(997) {
        assert!(verify(text.get(..end).unwrap_or("")).is_err());
    }
}

#[test]
fn no_number_makes_the_check_panic() {
    for (_, document) in documents() {
        let mut pointers = Vec::new();
        numbers(&document, "", &mut pointers);
        let stride = (pointers.len() / 60) | 1;
        for (index, pointer) in pointers.iter().step_by(stride).enumerate() {
            let hostile = [1e300, -1e300, 0.0, 1e-300, -1.0][index % 5];
            let mut document = document.clone();
            *at(&mut document, pointer) = json!(hostile);
            let _ = verify(&document.to_string());
        }
    }
}

#[test]
fn a_document_without_a_plan_is_not_verified_and_not_refused() {
    let mut scenario = scenario("colregs/head-on.toml");
    scenario.horizon = 100.0;
    let run = pipeline::run(scenario);
    let text = serde_json::to_string(&PlanDocument::of(&run)).expect("a document");
    let found = verify(&text).expect("a document");
    assert!(!found.verified() && found.evaluation.is_none() && found.violations.is_empty());
}

/// Tests sets that contain the required region in the first directions checked, but not everywhere.
#[test]
fn sets_that_only_seem_large_enough_are_too_small() {
    let said = |document: &Value, expected: &str| {
        let found = checked(document).violations;
        let told = found.iter().any(|v| v.what.contains(expected));
        assert!(told, "{expected}: {found:?}");
    };
    // an ellipse much longer than the true one and very thin, between two directions
    let mut needle = document(scenario("uncertainty/ellipse.toml"));
    let (sin, cos) = 0.0043_f64.sin_cos();
    let length: f64 = 1e10;
    *at(&mut needle, "/obstacles/0/initial_set/shape_m2") = json!([
        [length * cos * cos, length * cos * sin],
        [length * cos * sin, length * sin * sin]
    ]);
    said(&needle, "too small for the initial set");
    // one-sided velocities: scaled about their centre they contain all, but not those of half the
    // risk
    let text = std::fs::read_to_string(file("colregs/give-way.toml")).expect("a scenario");
    let mut scenario = Scenario::parse(&text).expect("a scenario");
    scenario.max_risk = 0.5;
    let mut lopsided = document(scenario);
    let corners: Vec<[f64; 2]> =
        serde_json::from_value(lopsided["obstacles"][0]["velocity_set"]["vertices_mps"].clone())
            .expect("corners");
    let [low, high] = [f64::min, f64::max].map(|pick: fn(f64, f64) -> f64| {
        [0, 1].map(|k| corners.iter().map(|c| c[k]).reduce(pick).expect("some"))
    });
    let middle = [0, 1].map(|k| 0.5 * (low[k] + high[k]));
    // of the whole set, twice that of the level set
    let reach = (high[0] - low[0]).max(high[1] - low[1]);
    let (east, half) = (middle[0] + 1.6 * reach, 1.4 * reach);
    *at(&mut lopsided, "/obstacles/0/velocity_set/vertices_mps") = json!([
        [east - half, middle[1] - half],
        [east + half, middle[1] - half],
        [east + half, middle[1] + half],
        [east - half, middle[1] + half]
    ]);
    let found = checked(&lopsided).violations;
    let whole = "too small for her velocities";
    assert!(!found.iter().any(|v| v.what.contains(whole)), "{found:?}");
    said(&lopsided, "the velocities at the accepted risk");
}

/// Tests sets around the hull on the expected heading, and for a turning ship on those of its
/// course spread at the start. On another course, its bow is outside them.
#[test]
fn sets_around_a_hull_that_does_not_turn_with_its_course_are_too_small() {
    let around = |ship: &ShipTrack, hull: ConvexPolygon| {
        let own = scenario("colregs/head-on.toml").own_ship;
        let reach = own.hull.half_diagonal() + own.safety_margin + 3.0 * ship.position_std;
        hull.minkowski_sum(&outer_disc(reach, ship.pose.heading))
    };
    let plain = |set: &ConvexPolygon| {
        json!(
            set.vertices()
                .iter()
                .map(|p| [p.x, p.y])
                .collect::<Vec<_>>()
        )
    };
    let rejected = |document: &Value| {
        let found = checked(document).violations;
        assert!(!found.is_empty());
        for violation in found {
            assert!(
                violation.what.contains("too small for the hull"),
                "{violation:?}"
            );
        }
    };
    let mut straight = scenario("colregs/head-on.toml");
    straight.compliance = Compliance::None;
    let ship = straight.targets[0].ship().expect("a ship").clone();
    let mut altered = document(straight);
    let vertices = at(&mut altered, "/obstacles/0/initial_set/vertices_m");
    *vertices = plain(&around(&ship, ship.hull.polygon(&ship.pose)));
    rejected(&altered);

    let mut turning = scenario("uncertainty/turning.toml");
    turning.compliance = Compliance::None;
    let ship = turning.targets[0].ship().expect("a ship").clone();
    let velocities = ship.outer_velocity_sets(ship.turn_rate, turning.horizon);
    let initial = around(&ship, ship.outer_hull(0.0));
    let sets = Uncertainty::new(initial, velocities);
    let slabs = SlabObstacle::new("x", sets).expect("in order");
    let mut altered = document(turning);
    for (entry, slab) in list(&mut altered, "/obstacles")
        .iter_mut()
        .zip(slabs.slabs())
    {
        entry["initial_set"]["vertices_m"] = plain(&slab.obstacle().outer_section(0.0));
    }
    rejected(&altered);
}

#[test]
fn an_objective_that_is_not_the_planners_and_another_relaxation_are_rejected() {
    let clear = document(scenario("colregs/head-on.toml"));
    for (key, value) in [
        ("objective", json!("stage-cost")),
        ("objective", json!("length-risk")),
        (
            "relaxation",
            json!({ "kind": "risk", "target": "target", "amount": 0.9 }),
        ),
    ] {
        let mut altered = clear.clone();
        altered[key] = value;
        let found = checked(&altered).violations;
        assert!(
            found.iter().any(|v| v.what.starts_with(key)),
            "{key}: {found:?}"
        );
    }
    let mut nothing = clear;
    give_up(&mut nothing, "domain", "target", 0.0);
    nothing["outcome"] = json!("relaxed");
    nothing["relaxation"] = nothing["relaxations"][0].clone();
    let found = checked(&nothing).violations;
    assert!(
        found.iter().any(|v| v.what.contains("drawn back by 0")),
        "{found:?}"
    );
}

/// Verifies every plan of random scenes, and compares the planner's statements with the document.
/// Prints the counts.
#[test]
fn plans_of_wild_scenes_are_verified_by_their_documents() {
    let text = std::env::var("SEAROOM_WILD").unwrap_or_default();
    let count = if text.is_empty() { "24" } else { &text };
    let count: u64 = count
        .parse()
        .unwrap_or_else(|_| panic!("SEAROOM_WILD={text} is not a count"));
    let (mut plans, mut relaxed) = (0, 0);
    for seed in 0..count {
        let text = wild::scene(seed);
        let scenario = Scenario::parse(&text).unwrap_or_else(|e| panic!("{text}\n{e:?}"));
        let run = pipeline::run(scenario);
        let Some(evaluation) = &run.evaluation else {
            continue;
        };
        assert!(evaluation.verified(), "{text}\n{:?}", evaluation.violations);
        let document = serde_json::to_string(&PlanDocument::of(&run)).expect("a document");
        let found = verify(&document).expect("a plan document");
        assert!(found.verified(), "{text}\n{:?}", found.violations);
        plans += 1;
        relaxed += usize::from(!run.relaxations.is_empty());
    }
    println!(
        "{count} wild scenes: {plans} plans, {relaxed} of them relaxed; all verified by their documents"
    );
    assert!(
        10 * plans >= 8 * count as usize && plans > relaxed && 20 * relaxed >= plans,
        "{plans} plans, {relaxed} of them relaxed"
    );
}
