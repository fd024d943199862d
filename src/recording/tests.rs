//! A recording is read back as a user's tools would read it.

use std::collections::BTreeMap;

use rerun::{ChunkStore, ChunkStoreConfig};

use super::*;
use crate::evaluation::Violation;
use crate::pipeline;
use crate::planner::{NoPlan, Outcome};
use crate::scenario::Scenario;

/// A name that no entity path would take unescaped.
const NAME: &str = "ferry / Ærø";

const HEAD_ON: &str = r#"
title = "Head-on"
horizon_s = 400.0
own_ship = { position = { east_m = 0.0, north_m = 0.0 }, course_deg = 90.0, speed_mps = 5.0, length_m = 30.0, beam_m = 8.0, turning_radius_m = 100.0, speeds_mps = [2.5, 5.0, 6.0], safety_margin_m = 20.0 }
mission = { waypoints = [{ east_m = 0.0, north_m = 0.0 }, { east_m = 1500.0, north_m = 0.0 }] }
[[targets]]
name = "ferry / Ærø"
position = { east_m = 1500.0, north_m = 0.0 }
course_deg = 270.0
speed_mps = 5.0
length_m = 60.0
beam_m = 12.0
speed_spread_mps = 0.5
course_spread_deg = 5.0
"#;

/// Sets of the other kinds.
const OTHER_SETS: &str = r#"
[[targets]]
name = "round"
initial_set = { center_m = [900.0, 500.0], shape_m2 = [[900.0, 0.0], [0.0, 400.0]] }
velocity_set = { center_mps = [0.0, 0.1], shape_m2_per_s2 = [[0.04, 0.0], [0.0, 0.0]] }
[[targets]]
name = "slabs"
initial_set = { vertices_m = [[900.0, -500.0], [960.0, -500.0], [960.0, -540.0]] }
velocity_sets = [{ until_s = 60.0, vertices_mps = [[0.0, 0.0]] }, { vertices_mps = [[0.1, 0.0], [0.0, -0.4]] }]
"#;

fn scenario() -> Scenario {
    Scenario::parse(HEAD_ON).expect("a valid scenario")
}

fn run() -> Run {
    let run = pipeline::run(scenario());
    assert!(run.planned.outcome.plan().is_some());
    run
}

fn run_without_plan() -> Run {
    let mut run = run();
    run.planned.outcome = Outcome::Infeasible(NoPlan::NoCandidate {
        target: NAME.to_owned(),
        time: 120.0,
    });
    run.evaluation = None;
    run
}

/// Every kind of target and plan that a recording may meet: two targets, one of them explicit sets.
fn run_with_sets() -> Run {
    let sets = r#"
[[targets]]
name = "drifting"
initial_set = { vertices_m = [[700.0, 300.0], [700.0, 340.0], [760.0, 340.0], [760.0, 300.0]] }
velocity_set = { vertices_mps = [[0.0, 0.1], [0.2, -0.1], [-0.2, -0.1]] }
"#;
    let text = format!("{HEAD_ON}{sets}{OTHER_SETS}");
    pipeline::run(Scenario::parse(&text).expect("a valid scenario"))
}

/// Rows and timelines of every entity of the recording's own store.
fn read(path: &Path) -> BTreeMap<String, (u64, Vec<String>)> {
    let mut file = std::fs::File::open(path).expect("opens");
    let stores = ChunkStore::from_rrd_reader(&ChunkStoreConfig::DEFAULT, &mut file).expect("reads");
    let mut entities = BTreeMap::new();
    for (_, store) in stores.iter().filter(|(id, _)| id.is_recording()) {
        for chunk in store.iter_physical_chunks() {
            let entry: &mut (u64, Vec<String>) =
                entities.entry(chunk.entity_path().to_string()).or_default();
            entry.0 += chunk.num_rows() as u64;
            entry
                .1
                .extend(chunk.timelines().keys().map(ToString::to_string));
        }
    }
    entities
}

#[test]
fn a_recording_reads_back_with_every_entity_on_one_timeline() {
    let folder = tempfile::tempdir().expect("folder");
    let path = folder.path().join("new/deep/head-on.rrd");
    write(&run(), None, &path).expect("writes");
    let entities = read(&path);
    let name = EntityPathPart::new(NAME).escaped_string();
    for expected in [
        "/summary".to_owned(),
        "/chart/map".to_owned(),
        "/chart/map/desired".to_owned(),
        "/chart/map/planned".to_owned(),
        "/chart/map/own_ship".to_owned(),
        "/chart/map/closest_points".to_owned(),
        format!("/chart/map/targets/{name}"),
        format!("/chart/map/hard_sets/{name}"),
        format!("/chart/map/shaped_sets/{name}"),
        "/chart/map/explored/free".to_owned(),
        "/chart/map/explored/blocked".to_owned(),
        format!("/space_time/shaped_sets/{name}"),
        "/space_time/planned".to_owned(),
        "/space_time/explored/free".to_owned(),
        "/curves/clearance_m".to_owned(),
        "/curves/margin_m".to_owned(),
        "/curves/risk".to_owned(),
        "/velocities/plane/own_ship".to_owned(),
        format!("/velocities/plane/obstacles/{name}"),
        "/curves/speed_kn".to_owned(),
        "/curves/course_deg".to_owned(),
    ] {
        assert!(
            entities.contains_key(&expected),
            "{expected} in {entities:#?}"
        );
    }
    for (entity, (_, timelines)) in &entities {
        assert!(
            timelines.iter().all(|t| t == TIMELINE),
            "{entity} {timelines:?}"
        );
    }
}

#[test]
fn a_run_without_a_plan_is_recorded_too() {
    let folder = tempfile::tempdir().expect("folder");
    let path = folder.path().join("none.rrd");
    write(&run_without_plan(), None, &path).expect("writes");
    let entities = read(&path);
    assert!(!entities.contains_key("/chart/map/planned"));
    assert!(entities.contains_key("/chart/map/conflict"));
    assert!(entities.contains_key("/curves/margin_m"));
}

#[test]
fn a_failed_write_leaves_nothing_and_names_the_file() {
    let folder = tempfile::tempdir().expect("folder");
    // a folder of that name is in the way
    let path = folder.path().join("taken.rrd");
    std::fs::create_dir_all(path.join("inside")).expect("folder");
    let error = write(&run(), None, &path).expect_err("a folder is in the way");
    assert!(error.to_string().contains("taken.rrd"), "{error}");
    let left: Vec<_> = std::fs::read_dir(folder.path()).expect("lists").collect();
    assert_eq!(left.len(), 1, "{left:?}");
}

#[test]
fn targets_that_are_sets_and_plans_that_are_wrong_are_recorded() {
    let folder = tempfile::tempdir().expect("folder");
    let path = folder.path().join("sets.rrd");
    let mut run = run_with_sets();
    if let Some(evaluation) = &mut run.evaluation {
        evaluation.violations.push(Violation {
            what: "set of 'drifting': 1.2 m deep, 0 m allowed".to_owned(),
            time: 100.0,
        });
    }
    write(&run, None, &path).expect("writes");
    let entities = read(&path);
    for name in ["drifting", "round", "slabs"] {
        assert!(entities.contains_key(&format!("/chart/map/hard_sets/{name}")));
        assert!(entities.contains_key(&format!("/space_time/hard_sets/{name}")));
        assert!(entities.contains_key(&format!("/velocities/plane/obstacles/{name}")));
    }
    assert!(!entities.contains_key("/chart/map/shaped_sets/drifting"));
    assert!(entities.contains_key("/chart/map/violations"));
}

#[test]
fn nothing_is_said_of_the_margin_after_arrival() {
    let mut run = run();
    let late = run.scenario.desired.duration() + 50.0;
    let end = run.scenario.desired.end() + crate::frame::Vector::new(250.0, 0.0);
    let points = [run.scenario.desired.waypoints()[0], end];
    run.scenario.desired =
        crate::trajectory::DesiredTrajectory::new(&points, &[5.0]).expect("valid");
    let scene = Scene::new(&run);
    assert!((scene.end - late).abs() < 1e-9);
    let margins = curves::margins(&scene, &[&run.sets[0].hard]);
    let plan = run.planned.outcome.plan().expect("a plan");
    let arrival = plan.trajectory.end_time();
    let before = scene.samples.iter().filter(|t| **t <= arrival).count();
    assert!(before < scene.samples.len());
    assert_eq!(margins.len(), before);
    let folder = tempfile::tempdir().expect("folder");
    let path = folder.path().join("early.rrd");
    write(&run, None, &path).expect("writes");
    let recorded = Recorded::read(&path).expect("whole");
    let drawn = recorded.table("curves/margin_m").expect("there");
    let last = drawn.rows.last().expect("rows").times[0].expect("a time");
    assert!((last - scene.samples[before - 1]).abs() < 1e-6, "{last}");
    let speeds = recorded.table(curves::SPEED).expect("there");
    let last = &speeds.rows.last().expect("rows").values;
    let scalars = speeds
        .components
        .iter()
        .position(|c| c.starts_with("Scalars:"));
    let own = &last[scalars.expect("scalars")][1];
    assert_eq!(own.as_f64(), Some(0.0), "she rests: {last:?}");
    assert_numbers(&recorded);
}

/// A value that is no number equals nothing, not even itself: no two recordings would be alike.
fn assert_numbers(recorded: &Recorded) {
    for entity in recorded.entities() {
        let table = recorded.table(&entity.path).expect("listed");
        for row in &table.rows {
            for values in row.values.iter().filter_map(|v| v.as_array()) {
                assert!(
                    !values.iter().any(holds_nothing),
                    "{}: {values:?}",
                    entity.path
                );
            }
        }
    }
}

/// A number that is none is read as nothing.
fn holds_nothing(value: &serde_json::Value) -> bool {
    match value {
        serde_json::Value::Null => true,
        serde_json::Value::Array(inner) => inner.iter().any(holds_nothing),
        _ => false,
    }
}

fn compared(scenario: &Scenario) -> Vec<crate::study::compare::Entry> {
    crate::study::compare::compare(scenario, &[scenario.max_risk])
}

fn recorded_comparison(scenario: &Scenario, path: &Path) -> Recorded {
    let entries = compared(scenario);
    let written = Compared {
        scenario,
        entries: &entries,
        table: "a table",
        document: "{\"plan_s\": 0.25, \"more\": [{\"plan_s\": 3}]}",
    };
    write_comparison(&written, path).expect("writes");
    Recorded::read(path).expect("whole")
}

/// What the labels of an entity say.
fn labels(recorded: &Recorded, entity: &str) -> Vec<String> {
    let table = recorded.table(entity).expect(entity);
    let is_label = |c: &String| c.ends_with(":labels");
    let place = table.components.iter().position(is_label).expect("labels");
    let rows = table
        .rows
        .iter()
        .filter_map(|row| row.values[place].as_array());
    rows.flatten()
        .map(|v| v.as_str().expect("text").to_owned())
        .collect()
}

#[test]
fn a_comparison_is_one_recording_with_every_motion() {
    let folder = tempfile::tempdir().expect("folder");
    let scenario = scenario();
    let path = folder.path().join("compared.rrd");
    let recorded = recorded_comparison(&scenario, &path);
    let again = folder.path().join("again.rrd");
    recorded_comparison(&scenario, &again);
    let bytes = |path: &Path| std::fs::read(path).expect("a file");
    assert!(bytes(&path) == bytes(&again));
    assert_eq!(
        recorded.comparison(),
        Some("{\"plan_s\": 0.25, \"more\": [{\"plan_s\": 3}]}")
    );
    assert_eq!(recorded.document(), None);
    let entities = read(&path);
    for entry in compared(&scenario)
        .iter()
        .filter(|e| e.trajectory().is_some())
    {
        let method = entry.candidate.method.to_string();
        let name = EntityPathPart::new(&method).escaped_string();
        let mut parts = vec![
            format!("/chart/map/methods/{name}/way"),
            format!("/chart/map/methods/{name}/own_ship/hull"),
            format!("/space_time/methods/{name}/way"),
            format!("/curves/clearance_m/{name}"),
        ];
        if let crate::study::compare::Method::Planner { kind, .. } = entry.candidate.method {
            // no graph is searched for forces
            if kind != crate::planner::PlannerKind::OptimalControl {
                parts.push(format!("/chart/map/methods/{name}/explored/free"));
            }
            let target = EntityPathPart::new(NAME).escaped_string();
            parts.push(format!("/chart/map/methods/{name}/sets/{target}"));
            parts.push(format!("/space_time/methods/{name}/sets/{target}"));
        }
        for part in parts {
            assert!(entities.contains_key(&part), "{part} in {entities:#?}");
        }
    }
    assert!(!entities.contains_key("/chart/map/planned"));
    for (entity, (_, timelines)) in &entities {
        assert!(timelines.iter().all(|t| t == TIMELINE), "{entity}");
    }
    assert_numbers(&recorded);
    let again = recorded_comparison(&scenario, &folder.path().join("again.rrd"));
    for entity in recorded.entities() {
        let same = recorded.table(&entity.path) == again.table(&entity.path);
        // when it was made
        assert!(same || entity.path == "/__properties", "{}", entity.path);
    }
}

#[test]
fn a_refused_edge_says_what_it_meets_when_and_why() {
    let folder = tempfile::tempdir().expect("folder");
    let path = folder.path().join("edges.rrd");
    write(&run(), None, &path).expect("writes");
    let recorded = Recorded::read(&path).expect("whole");
    let said = labels(&recorded, "/chart/map/explored/blocked");
    assert!(!said.is_empty());
    for reason in &said {
        let (what, limit) = reason.split_once(": ").expect("two parts");
        let time = what.strip_prefix(NAME).and_then(|t| t.strip_prefix(" at "));
        let time = time
            .and_then(|t| t.strip_suffix(" s"))
            .and_then(|t| t.parse::<f64>().ok());
        assert!((1.0..300.0).contains(&time.expect("a time")), "{reason}");
        let known = [
            "the shape about her (head-on, Rule 14)",
            "hulls and a margin of 20 m",
        ];
        assert!(known.contains(&limit), "{reason}");
    }
    assert!(said.iter().any(|r| r.contains("Rule 14")), "{said:?}");

    let shore = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenarios/harbour/munkholmen.toml");
    let run = pipeline::run(Scenario::read(&shore).expect("valid"));
    write(&run, None, &path).expect("writes");
    let said = labels(
        &Recorded::read(&path).expect("whole"),
        "/chart/map/explored/blocked",
    );
    let aground = said.iter().filter(|r| r.starts_with("land at ")).count();
    assert!(aground > 0, "{said:?}");
}

#[test]
fn a_plan_of_forces_has_its_states_and_forces_as_curves() {
    let folder = tempfile::tempdir().expect("folder");
    let path = folder.path().join("figure_9.rrd");
    let scenario = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenarios/paper/figure_9.toml");
    let run = pipeline::run(Scenario::read(&scenario).expect("valid"));
    write(&run, None, &path).expect("writes");
    let entities = read(&path);
    let nodes = run.control.as_ref().expect("forces").intervals as u64 + 1;
    for entity in ["/curves/states", "/curves/forces"] {
        assert_eq!(entities[entity].0, nodes, "{entity}");
    }
    for entity in [
        "/chart/map/planned",
        "/space_time/planned",
        "/chart/map/hard_sets/ahead",
    ] {
        assert!(entities.contains_key(entity), "{entity} in {entities:#?}");
    }
}

/// What the curves say of the risk is what the plan document says, and of the set that it speaks of.
#[test]
fn the_largest_risk_of_the_curves_is_the_one_that_is_reported() {
    let text = HEAD_ON.replace("[[targets]]", "[planner]\nmax_risk = 0.4\n[[targets]]");
    let run = pipeline::run(Scenario::parse(&text).expect("a valid scenario"));
    let [peak] = run.risks[..] else {
        panic!("one target");
    };
    assert!(run.is_shaped() && peak.risk > 0.1, "{peak:?}");
    let scene = Scene::new(&run);
    let curves = curves::risk_curves(&scene, &curves::risk_times(&scene));
    let largest = |name: &str| {
        let curve = curves.iter().find(|c| c.name == format!("{NAME}, {name}"));
        let values = curve.expect("drawn").values.iter().copied();
        values.fold(0.0, f64::max)
    };
    let reported = largest("shaped set");
    assert!((reported - peak.risk).abs() < 1e-9, "{reported} {peak:?}");
    // the hard set alone would have said something else
    assert!(largest("hard set") < peak.risk - 1e-3);
    let margins = curves::margin_curves(&scene);
    let kept = margins.iter().find(|c| c.name == "sets kept out of");
    let least = kept.expect("level sets are neither").values.iter().copied();
    let least = least.fold(f64::INFINITY, f64::min);
    assert!(least.abs() < 1.0, "the plan keeps close: {least}");
}

/// The diagram is there whether the plan is clear or the way is barred, and only for plans along paths.
#[test]
fn a_path_time_plan_has_its_diagram() {
    let folder = tempfile::tempdir().expect("folder");
    let path = folder.path().join("path-time.rrd");
    let crossing = HEAD_ON
        .replace("course_deg = 270.0", "course_deg = 180.0")
        .replace(
            "east_m = 1500.0, north_m = 0.0 }\ncourse",
            "east_m = 700.0, north_m = 700.0 }\ncourse",
        );
    for (text, clear) in [(HEAD_ON, false), (crossing.as_str(), true)] {
        let text = text.replace(
            "[[targets]]",
            "[planner]\nkind = \"path-time\"\n[[targets]]",
        );
        let run = pipeline::run(Scenario::parse(&text).expect("a valid scenario"));
        assert_eq!(run.released.iter().all(Option::is_none), clear);
        write(&run, None, &path).expect("writes");
        let entities = read(&path);
        let name = EntityPathPart::new(NAME).escaped_string();
        let set = format!("obstacles/{name}");
        for part in ["axes", "profile", "now", "own_ship", &set] {
            assert!(
                entities.contains_key(&format!("/path_time/plane/{part}")),
                "{part}"
            );
        }
    }
    write(&run(), None, &path).expect("writes");
    assert!(
        !read(&path)
            .keys()
            .any(|entity| entity.starts_with("/path_time"))
    );
}

/// Where a curve is drawn, a column of its table; a look is in the first row alone.
#[test]
fn fewer_rows_draw_the_same_curves() {
    let folder = tempfile::tempdir().expect("folder");
    let path = folder.path().join("one.rrd");
    let run = run();
    write(&run, None, &path).expect("writes");
    let scene = Scene::new(&run);
    let drawn = Recorded::read(&path).expect("whole");
    let columns = drawn.table(curves::CLEARANCE).expect("there").columns();
    assert_eq!(columns.header, ["sim_time_s", NAME, "safety margin"]);
    let rows: Vec<Vec<f64>> = columns
        .rows
        .iter()
        .map(|row| row.iter().map(|c| c.parse().expect("a number")).collect())
        .collect();
    let whole = curves::clearances(&scene, &scene.motion, &run.scenario.targets[0]);
    assert!(
        rows.len() < whole.len() / 2 && rows.len() > 10,
        "{}",
        rows.len()
    );
    let [least, greatest] = [f64::min, f64::max].map(|of| whole.iter().copied().reduce(of));
    let (least, greatest) = (least.expect("some"), greatest.expect("some"));
    // the extremes to the last digit
    assert!(rows.iter().any(|r| r[1] == least) && rows.iter().any(|r| r[1] == greatest));
    for (time, clearance) in scene.samples.iter().zip(&whole) {
        let after = rows
            .iter()
            .position(|r| r[0] >= time - 1e-6)
            .expect("covered");
        let (a, b) = (&rows[after.saturating_sub(1)], &rows[after]);
        let share = if b[0] > a[0] {
            (time - a[0]) / (b[0] - a[0])
        } else {
            0.0
        };
        let shown = a[1] + share * (b[1] - a[1]);
        let off = (shown - clearance).abs();
        assert!(off < 1.1e-3 * (greatest - least), "{off} m at {time} s");
    }
}
