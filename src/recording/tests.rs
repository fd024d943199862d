//! A recording is read back as a user's tools would read it.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use rerun::external::re_entity_db::EntityDb;
use rerun::external::re_log_encoding::{DecoderApp, Encoder};
use rerun::external::re_log_types::{LogMsg, StoreId, StoreKind};
use rerun::{ChunkStore, ChunkStoreConfig};

use super::canvas::{Canvas, ViewModel, covered};
use super::views::closest::ENCOUNTER;
use super::views::{curves, ships};
use super::*;
use crate::document::{EntityContents, PlanDocument, planned_legs};
use crate::evaluation::Violation;
use crate::frame::Vector;
use crate::geometry::Window;
use crate::pipeline::{self, Run};
use crate::planner::{NoPlan, Outcome};
use crate::scenario::Scenario;
use crate::simulation::Simulation;
use crate::study::compare::{Entry, Method};
use crate::target::Representation;

/// A name that an entity path has to escape.
const NAME: &str = "ferry / Ærø";

const HEAD_ON: &str = r#"
title = "Head-on"
horizon_s = 400.0
own_ship = { position = { east_m = 0.0, north_m = 0.0 }, course_deg = 90.0, speed_mps = 5.0, length_m = 30.0, beam_m = 8.0, turning_radius_m = 100.0, speeds_mps = [2.5, 5.0, 6.0], safety_margin_m = 20.0 }
mission = { waypoints = [{ east_m = 0.0, north_m = 0.0 }, { east_m = 1500.0, north_m = 0.0 }] }
planner = { compliance = "shape" }
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

fn write_run(run: &Run, path: &Path) -> Result<(), RecordingError> {
    write(run, &PlanDocument::of(run), path)
}

fn recorded_run(run: &Run) -> Recorded {
    let folder = tempfile::tempdir().expect("folder");
    let path = folder.path().join("run.rrd");
    write_run(run, &path).expect("writes");
    Recorded::read(&path).expect("whole")
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

/// Every kind of target, a ship and explicit sets, and a fault of the check.
fn run_with_sets() -> Run {
    let sets = r#"
[[targets]]
name = "drifting"
initial_set = { vertices_m = [[700.0, 300.0], [700.0, 340.0], [760.0, 340.0], [760.0, 300.0]] }
velocity_set = { vertices_mps = [[0.0, 0.1], [0.2, -0.1], [-0.2, -0.1]] }
"#;
    let text = format!("{HEAD_ON}{sets}{OTHER_SETS}");
    let mut run = pipeline::run(Scenario::parse(&text).expect("a valid scenario"));
    let evaluation = run.evaluation.as_mut().expect("judged");
    evaluation.violations.push(Violation::new(
        "set of 'drifting': 1.2 m deep, 0 m allowed".to_owned(),
        100.0,
    ));
    run
}

/// Rows in time of every entity of the recording, without those of the layout. There is one
/// timeline.
fn read(path: &Path) -> BTreeMap<String, u64> {
    let mut file = std::fs::File::open(path).expect("opens");
    let stores = ChunkStore::from_rrd_reader(&ChunkStoreConfig::DEFAULT, &mut file).expect("reads");
    let mut entities = BTreeMap::new();
    for (_, store) in stores.iter().filter(|(id, _)| id.is_recording()) {
        for chunk in store.iter_physical_chunks() {
            let rows: &mut u64 = entities.entry(chunk.entity_path().to_string()).or_default();
            if !chunk.is_static() {
                *rows += chunk.num_rows() as u64;
            }
            assert!(chunk.timelines().keys().all(|t| t.as_str() == TIMELINE));
        }
    }
    entities
}

/// Writes a run and checks which entities are there and which are not. `{}` stands for the name of
/// the ship.
fn assert_entities(run: &Run, there: &str, absent: &str) -> BTreeMap<String, u64> {
    let folder = tempfile::tempdir().expect("folder");
    let path = folder.path().join("new/deep/a.rrd");
    write_run(run, &path).expect("writes");
    let entities = read(&path);
    let name = EntityPathPart::new(NAME).escaped_string();
    for (names, expected) in [(there, true), (absent, false)] {
        for entity in names.split_whitespace() {
            let entity = format!("/{}", entity.replace("{}", &name));
            let found = entities.contains_key(&entity);
            assert_eq!(found, expected, "{entity} in {entities:#?}");
        }
    }
    entities
}

#[test]
fn every_kind_of_run_has_its_entities() {
    let there = "summary legs chart/map chart/map/desired chart/map/planned chart/map/own_ship
        chart/map/closest_points chart/map/labels chart/map/names chart/map/targets/{} chart/map/hard_sets/{}
        chart/map/domain_sets/{} chart/map/explored/free chart/map/explored/blocked
        space_time/domain_sets/{} space_time/planned space_time/explored/free
        curves/clearance_m curves/margin_m curves/risk curves/speed_kn curves/course_deg
        velocities/plane/own_ship velocities/plane/obstacles/{}";
    assert_entities(&run(), there, "chart/map/conflict");
    let there = "chart/map/conflict curves/margin_m";
    assert_entities(&run_without_plan(), there, "chart/map/planned legs");
    let mut there = "chart/map/violations".to_owned();
    for name in ["drifting", "round", "slabs"] {
        there += &format!(
            " chart/map/hard_sets/{name} space_time/hard_sets/{name} \
             velocities/plane/obstacles/{name}"
        );
    }
    assert_entities(&run_with_sets(), &there, "chart/map/domain_sets/drifting");

    let forces = "scenarios/paper/figure_9.toml";
    let mut scenario = Scenario::read(forces.as_ref()).expect("valid");
    scenario.deadline = 60.0;
    let run = pipeline::run(scenario);
    let there = "chart/map/planned space_time/planned chart/map/hard_sets/ahead";
    let entities = assert_entities(&run, there, "legs");
    let nodes = run.planned.control.as_ref().expect("forces").intervals as u64 + 1;
    for entity in ["/curves/states", "/curves/forces"] {
        assert_eq!(entities[entity], nodes, "{entity}");
    }
}

#[test]
fn the_legs_are_those_of_the_plan() {
    let run = run();
    let table = recorded_run(&run).table("legs").expect("legs");
    let texts = table.rows.iter().flat_map(|row| &row.values);
    let mut texts = texts.map(|value| value[0].as_str().unwrap_or_default());
    let text = texts.find(|text| text.contains("from")).expect("a table");
    let cells = |row: &str| {
        row.split('|')
            .map(|c| c.trim().to_owned())
            .collect::<Vec<_>>()
    };
    let mut rows: Vec<Vec<String>> = text.lines().skip(2).map(cells).collect();
    let events: Vec<String> = rows.iter().map(|row| row[7].clone()).collect();
    rows.retain(|row| !row[1].is_empty());
    let legs = planned_legs(&PlanDocument::of(&run));
    assert_eq!(rows.len(), legs.len());
    for (row, leg) in rows.iter().zip(&legs) {
        assert_eq!(row[3], format!("{:03.0}", leg.course_deg().round() % 360.0));
        assert_eq!(row[4], format!("{:.1}", 3600.0 / 1852.0 * leg.motion.speed));
    }
    let told = legs
        .iter()
        .flat_map(|leg| &leg.events)
        .cloned()
        .collect::<Vec<_>>();
    let (told, events) = (told.join(" "), events.join(" "));
    let words = |text: &str| {
        text.split_whitespace()
            .map(str::to_owned)
            .collect::<Vec<_>>()
    };
    assert_eq!(words(&events), words(&told));
    assert!(told.contains(NAME), "{told}");
}

/// Compares with the file, which gives own ship and the ferry in latitude and longitude.
#[test]
fn a_scenario_with_an_origin_is_recorded_on_the_earth() {
    let file = "scenarios/sound/kronborg.toml";
    let mut scenario = Scenario::read(file.as_ref()).expect("valid");
    scenario.land = None;
    scenario.deadline = 60.0;
    let run = pipeline::run(scenario);
    let plan = run.planned.outcome.plan().expect("a plan");
    let earth = run.scenario.earth.expect("an origin");
    let recorded = recorded_run(&run);
    let near = |found: &serde_json::Value, lat_deg: f64, lon_deg: f64| {
        for (axis, expected) in [lat_deg, lon_deg].into_iter().enumerate() {
            let found = found[axis].as_f64().expect("degrees");
            assert!((found - expected).abs() < 1e-9, "{found} {expected}");
        }
    };
    let own = moving(&recorded, "geographic/own_ship", ":positions");
    near(&own[0].1[0], 56.008, 12.668);
    for (time, place) in &own {
        let there = earth.to_geographic(plan.trajectory.pose_at(*time).position);
        near(&place[0], there.lat_deg, there.lon_deg);
    }
    let ferry = moving(&recorded, "geographic/targets/ferry", ":positions");
    assert_eq!(ferry.len(), own.len());
    near(&ferry[0].1[0], 56.040, 12.690);
    let lines = |entity: &str| {
        let table = recorded.table(entity).expect(entity);
        let is_line = |c: &String| c.ends_with(":line_strings");
        let place = table.components.iter().position(is_line).expect("lines");
        table.rows[0].values[place].clone()
    };
    let desired = lines("geographic/desired");
    for (index, lat_deg, lon_deg) in [
        (0, 56.008, 12.668),
        (1, 56.040, 12.652),
        (2, 56.052, 12.631),
    ] {
        near(&desired[0][index], lat_deg, lon_deg);
    }
    let planned = lines("geographic/planned");
    near(&planned[0][0], 56.008, 12.668);
    let last = planned
        .as_array()
        .and_then(|all| all.last()?.as_array()?.last());
    let end = earth.to_geographic(plan.trajectory.pose_at(plan.trajectory.end_time()).position);
    near(last.expect("a line"), end.lat_deg, end.lon_deg);

    let elsewhere = recorded_run(&self::run());
    let on_earth = |e: &EntityContents| e.path.contains("geographic");
    assert!(!elsewhere.entities().iter().any(on_earth));
}

fn messages(bytes: &[u8]) -> Vec<LogMsg> {
    let messages = DecoderApp::decode_eager(bytes).expect("decodes");
    messages.map(|message| message.expect("decodes")).collect()
}

fn encoded(messages: impl IntoIterator<Item = LogMsg>) -> Vec<u8> {
    Encoder::encode(messages.into_iter().map(Ok)).expect("encodes")
}

/// The stores of a file, as `rerun rrd merge` writes them: it activates every layout, and the order
/// of the stores is that of a hash map, so each is the last once.
fn merged(bytes: &[u8]) -> Vec<Vec<u8>> {
    let mut stores: Vec<EntityDb> = Vec::new();
    for message in messages(bytes) {
        let of_store = |store: &EntityDb| store.store_id() == message.store_id();
        let place = stores.iter().position(of_store).unwrap_or_else(|| {
            stores.push(EntityDb::new(message.store_id().clone()));
            stores.len() - 1
        });
        stores[place].add_log_msg(&message).expect("added");
    }
    let in_order = |stores: &[EntityDb]| {
        let all = stores.iter().flat_map(|store| store.to_messages(None));
        encoded(all.map(|message| message.expect("a message")))
    };
    let number = stores.len();
    let orders = (0..number).map(|_| {
        stores.rotate_left(1);
        in_order(&stores)
    });
    orders.collect()
}

/// The bytes of a recording of [`run`], and its plan document.
fn written() -> (Vec<u8>, String) {
    let folder = tempfile::tempdir().expect("folder");
    let path = folder.path().join("run.rrd");
    write_run(&run(), &path).expect("writes");
    let document = Recorded::read(&path).expect("whole").document();
    let bytes = std::fs::read(path).expect("written");
    (bytes, document.expect("a plan"))
}

fn read_again(bytes: &[u8]) -> Result<Recorded, ReadError> {
    let folder = tempfile::tempdir().expect("folder");
    let path = folder.path().join("again.rrd");
    std::fs::write(&path, bytes).expect("written");
    Recorded::read(&path)
}

#[test]
fn a_recording_keeps_its_layout_and_its_plan_when_rerun_writes_it_again() {
    let (bytes, document) = written();
    assert!(read_again(&bytes).is_ok_and(|whole| whole.checksum == Checksum::Valid));
    let orders = merged(&bytes);
    assert_eq!(orders.len(), 2, "the recording and its layout");
    for again in orders {
        let activated: Vec<StoreId> = (messages(&again).into_iter())
            .filter_map(|message| match message {
                LogMsg::BlueprintActivationCommand(command) => Some(command.blueprint_id),
                _ => None,
            })
            .collect();
        let [layout] = &activated[..] else {
            panic!("{activated:?}")
        };
        let is_layout = layout.recording_id().as_str().starts_with("layout_");
        assert!(is_layout, "{layout:?}");
        let read = read_again(&again).expect("whole");
        assert_eq!(read.checksum, Checksum::Gone);
        assert_eq!(read.document().as_deref(), Some(&*document));

        // a cut, a longer file and another length of a message are seen
        let broken = |bytes: &[u8]| matches!(read_again(bytes), Err(ReadError::Broken { .. }));
        for part in 1..8 {
            let at = again.len() * part / 8;
            assert!(broken(&again[..at]), "cut at {at}");
            let longer = [&again[..at], b"0", &again[at..]].concat();
            assert!(broken(&longer), "a byte more at {at}");
        }
        assert!(broken(&[&again[..], &bytes].concat()));
        let mut lengthened = again.clone();
        lengthened[12 + 8] ^= 1;
        assert!(broken(&lengthened), "the length of the first message");
    }
}

#[test]
fn two_recordings_in_one_file_are_read_one_by_one() {
    let (bytes, document) = written();
    let folder = tempfile::tempdir().expect("folder");
    let path = folder.path().join("two.rrd");
    let mut other = run_without_plan();
    other.scenario.title = "Another".to_owned();
    write_run(&other, &path).expect("writes");
    let both = [
        messages(&bytes),
        messages(&std::fs::read(&path).expect("read")),
    ]
    .concat();
    std::fs::write(&path, encoded(both)).expect("written");
    let error = Recorded::read(&path).expect_err("two");
    assert!(error.to_string().contains("2 recordings"), "{error}");
    let all = Recorded::read_all(&path).expect("whole");
    let documents: Vec<Option<String>> = all.iter().map(Recorded::document).collect();
    assert!(documents.contains(&Some(document)), "{documents:?}");
    assert_ne!(documents[0], documents[1]);
    assert!(all.iter().all(|one| one.checksum == Checksum::Gone));
}

/// Earlier versions kept the checksum in the name of an empty layout.
#[test]
fn a_recording_of_an_earlier_version_is_read() {
    let (bytes, document) = written();
    let name = format!("checksum_{:016}", 0);
    let seal = checksum::opening(StoreId::new(StoreKind::Blueprint, APPLICATION, name));
    let mut all = messages(&bytes);
    all[0] = checksum::opening(all[0].store_id().clone());
    let mut earlier = encoded([seal].into_iter().chain(all));
    checksum::seal(&mut earlier);
    let read = read_again(&earlier).expect("whole");
    assert_eq!(read.checksum, Checksum::Valid);
    assert_eq!(read.document().as_deref(), Some(&*document));
    let middle = earlier.len() / 2;
    let mut damaged = earlier.clone();
    damaged[middle] ^= 1;
    assert!(read_again(&damaged).is_err());
    for again in merged(&earlier) {
        let read = read_again(&again).expect("whole");
        assert_eq!(read.checksum, Checksum::Gone);
        assert_eq!(read.document().as_deref(), Some(&*document));
    }
}

#[test]
fn recordings_of_other_programs_are_refused() {
    let (bytes, _) = written();
    let named = |message: LogMsg| match message {
        LogMsg::ArrowMsg(store, message) => {
            let name = store.recording_id().to_string();
            LogMsg::ArrowMsg(StoreId::new(store.kind(), "other", name), message)
        }
        message => {
            let store = message.store_id();
            let name = store.recording_id().to_string();
            checksum::opening(StoreId::new(store.kind(), "other", name))
        }
    };
    let other = encoded(messages(&bytes).into_iter().map(named));
    let error = read_again(&other).expect_err("another program's");
    assert!(
        error.to_string().contains("no recording of Searoom"),
        "{error}"
    );
}

#[test]
fn a_failed_write_leaves_nothing_and_names_the_file() {
    let folder = tempfile::tempdir().expect("folder");
    // a folder of that name is in the way
    let path = folder.path().join("taken.rrd");
    std::fs::create_dir_all(path.join("inside")).expect("folder");
    let error = write_run(&run(), &path).expect_err("a folder is in the way");
    assert!(error.to_string().contains("taken.rrd"), "{error}");
    let left: Vec<_> = std::fs::read_dir(folder.path()).expect("lists").collect();
    assert_eq!(left.len(), 1, "{left:?}");
}

#[test]
fn nothing_is_said_of_the_margin_after_arrival() {
    let mut run = run();
    let late = run.scenario.desired.duration() + 50.0;
    let end = run.scenario.desired.end() + crate::frame::Vector::new(250.0, 0.0);
    let points = [run.scenario.desired.waypoints()[0], end];
    run.scenario.desired =
        crate::trajectory::DesiredTrajectory::new(&points, &[5.0]).expect("valid");
    let model = ViewModel::new(&run);
    assert!((model.end - late).abs() < 1e-9);
    let margins = curves::margins(&model, &[&run.targets[0].sets.hard]);
    let plan = run.planned.outcome.plan().expect("a plan");
    let arrival = plan.trajectory.end_time();
    let before = model.samples.iter().filter(|t| **t <= arrival).count();
    assert!(before < model.samples.len());
    assert_eq!(margins.len(), before);
    let recorded = recorded_run(&run);
    let drawn = recorded.table("curves/margin_m").expect("there");
    let last = drawn.rows.last().expect("rows").time.expect("a time");
    assert!((last - model.samples[before - 1]).abs() < 1e-6, "{last}");
    let speeds = recorded.table(curves::SPEED).expect("there");
    let last = &speeds.rows.last().expect("rows").values;
    let scalars = speeds
        .components
        .iter()
        .position(|c| c.starts_with("Scalars:"));
    let own = &last[scalars.expect("scalars")][1];
    assert_eq!(own.as_f64(), Some(0.0), "it rests: {last:?}");
    assert_numbers(&recorded);
}

/// A NaN does not equal itself: no two recordings would be alike.
fn assert_numbers(recorded: &Recorded) {
    for entity in recorded.entities() {
        let table = recorded.table(&entity.path).expect("listed");
        for row in &table.rows {
            for values in row.values.iter().filter_map(|v| v.as_array()) {
                let nothing = values.iter().any(holds_nothing);
                assert!(!nothing, "{}: {values:?}", entity.path);
            }
        }
    }
}

/// Checks that recordings hold the same, but for some entities.
fn assert_alike(recorded: &Recorded, again: &Recorded, but: &[&str]) {
    for EntityContents { path, .. } in recorded.entities() {
        let same = recorded.table(&path) == again.table(&path);
        assert!(same || but.contains(&path.as_str()), "{path}");
    }
}

/// A NaN is read as null.
fn holds_nothing(value: &serde_json::Value) -> bool {
    match value {
        serde_json::Value::Null => true,
        serde_json::Value::Array(inner) => inner.iter().any(holds_nothing),
        _ => false,
    }
}

/// Stands for the document of a comparison.
const COMPARED: &str = "{\"plan_s\": 0.25, \"more\": [{\"plan_s\": 3}]}";

fn recorded_comparison(scenario: &Scenario, entries: &[Entry], path: &Path) -> Recorded {
    let written = Compared {
        scenario,
        entries,
        table: "a table",
        document: COMPARED,
    };
    write_comparison(&written, path).expect("writes");
    Recorded::read(path).expect("whole")
}

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

/// Labels with what they cover, static ones without a time.
fn label_boxes(recorded: &Recorded, canvas: &Canvas, entity: &str) -> Vec<(Option<f64>, Window)> {
    let table = recorded.table(entity).expect(entity);
    let place = |name: &str| table.components.iter().position(|c| c.ends_with(name));
    let [labels, points] = ["Points2D:labels", "Points2D:positions"].map(|c| place(c).expect(c));
    let mut all = Vec::new();
    for row in &table.rows {
        let values = |place: usize| row.values[place].as_array().into_iter().flatten();
        for (text, point) in values(labels).zip(values(points)) {
            let [east, north] = [0, 1].map(|axis| point[axis].as_f64().expect("a number"));
            let text = text.as_str().expect("a text");
            let covered = covered(canvas, Vector::new(east, north), text);
            all.push((row.time, covered));
        }
    }
    all
}

/// A label is read in five seconds where it covers neither a ship nor another label.
#[test]
fn labels_cover_no_ship_at_the_encounter() {
    for name in ["give-way", "head-on", "overtaking", "stand-on"] {
        let file = format!("scenarios/colregs/{name}.toml");
        let run = pipeline::run(Scenario::read(file.as_ref()).expect("valid"));
        let model = ViewModel::new(&run);
        let recorded = recorded_run(&run);
        let texts = labels(&recorded, "chart/map/labels");
        let nearest = format!("CPA {} m at ", crate::text::tenths(model_dcpa(&run)));
        assert!(
            texts.iter().any(|text| text.starts_with(&nearest)),
            "{texts:?}"
        );
        assert!(texts.contains(&"breaks no rule".to_owned()), "{texts:?}");
        let fixed = label_boxes(&recorded, &model, "chart/map/labels");
        let names = label_boxes(&recorded, &model, "chart/map/names");
        let own = [ships::own_ship(&model)];
        let closest = run.evaluation.as_ref().expect("judged").passages[0].tcpa;
        for &time in &model.cursor_times {
            let ships = ships::sighted(&model, &own, time).expect("ships");
            let now = names
                .iter()
                .filter(|(at, _)| at.is_some_and(|at| (at - time).abs() < 1e-6));
            let now: Vec<Window> = now.map(|(_, covered)| *covered).collect();
            assert_eq!(now.len(), 2, "{name} at {time}");
            let met = (time - closest).abs() < ENCOUNTER * model.end;
            let there = fixed.iter().filter(|_| met).map(|(_, covered)| *covered);
            let shown: Vec<Window> = now.into_iter().chain(there).collect();
            for (index, label) in shown.iter().enumerate() {
                // the viewer rounds to single precision
                let label = label.grown(-0.01 * model.pixel());
                let free = ships.iter().all(|ship| !ship.covers().meets(&label));
                assert!(free, "{name} at {time}: label {index} covers a ship");
                let others = shown[..index].iter().all(|other| !other.meets(&label));
                assert!(others, "{name} at {time}: label {index} covers another");
            }
        }
    }
}

fn model_dcpa(run: &Run) -> f64 {
    run.evaluation.as_ref().expect("judged").passages[0].dcpa
}

#[test]
fn a_comparison_is_one_recording_with_every_motion() {
    let folder = tempfile::tempdir().expect("folder");
    let scenario = scenario();
    let path = folder.path().join("compared.rrd");
    let entries = crate::study::compare::compare(&scenario, &[scenario.max_risk]);
    let recorded = recorded_comparison(&scenario, &entries, &path);
    assert_eq!(recorded.comparison().as_deref(), Some(COMPARED));
    assert_eq!(recorded.document(), None);
    let entities = read(&path);
    for entry in entries.iter().filter(|e| e.trajectory().is_some()) {
        let method = entry.candidate.method;
        let name = EntityPathPart::new(entry.name()).escaped_string();
        let mut parts = vec![
            format!("/chart/map/methods/{name}/way"),
            format!("/chart/map/methods/{name}/own_ship/hull"),
            format!("/space_time/methods/{name}/way"),
            format!("/curves/clearance_m/{name}"),
        ];
        if let Method::Planner {
            planner,
            representation,
            ..
        } = method
        {
            // no graph is searched for forces
            if !planner.facts().relaxes_domains_only {
                parts.push(format!("/chart/map/explored/{name}/free"));
            }
            if representation == Some(Representation::Ellipsoid) {
                let target = EntityPathPart::new(NAME).escaped_string();
                parts.push(format!("/chart/map/methods/{name}/sets/{target}"));
                parts.push(format!("/space_time/methods/{name}/sets/{target}"));
            }
        }
        for part in parts {
            assert!(entities.contains_key(&part), "{part} in {entities:#?}");
        }
    }
    assert!(!entities.contains_key("/chart/map/planned"));
    assert_numbers(&recorded);
    let again = recorded_comparison(&scenario, &entries, &folder.path().join("again.rrd"));
    assert_alike(&recorded, &again, &[]);
}

#[test]
fn a_refused_edge_says_what_it_meets_when_and_why() {
    let reasons = labels(&recorded_run(&run()), "/chart/map/explored/blocked");
    assert!(!reasons.is_empty());
    for reason in &reasons {
        let (what, limit) = reason.split_once(": ").expect("two parts");
        let time = what.strip_prefix(NAME).and_then(|t| t.strip_prefix(" at "));
        let (minutes, seconds) = time.and_then(|t| t.split_once(':')).expect("a time");
        let [minutes, seconds] = [minutes, seconds].map(|t| t.parse::<u32>().expect("a number"));
        assert!((1..300).contains(&(60 * minutes + seconds)), "{reason}");
        let known = [
            "its ship domain (own ship head-on, Rule 14)",
            "hulls and a margin of 20 m",
        ];
        assert!(known.contains(&limit), "{reason}");
    }
    assert!(reasons.iter().any(|r| r.contains("Rule 14")), "{reasons:?}");

    let harbour = "scenarios/harbour/munkholmen.toml";
    let mut scenario = Scenario::read(harbour.as_ref()).expect("valid");
    scenario.compliance = crate::scenario::Compliance::Shape;
    let run = pipeline::run(scenario);
    let reasons = labels(&recorded_run(&run), "/chart/map/explored/blocked");
    let aground = reasons.iter().filter(|r| r.starts_with("land at ")).count();
    assert!(aground > 0, "{reasons:?}");
}

/// The curves of the risk reach the value of the plan document, for the same set.
#[test]
fn the_largest_risk_of_the_curves_is_the_one_that_is_reported() {
    let text = HEAD_ON.replace("\"shape\"", "\"shape\", max_risk = 0.4");
    let run = pipeline::run(Scenario::parse(&text).expect("a valid scenario"));
    let [peak] = run.risks()[..] else {
        panic!("one target");
    };
    let has_domain = run.targets.iter().any(|t| t.whole != t.sets.hard);
    assert!(has_domain && peak.risk > 0.1, "{peak:?}");
    let model = ViewModel::new(&run);
    let curves = curves::risk_curves(&model, &curves::risk_times(&model));
    let largest = |name: &str| {
        let curve = curves.iter().find(|c| c.name == format!("{NAME}, {name}"));
        let values = curve.expect("drawn").values.iter().copied();
        values.fold(0.0, f64::max)
    };
    let reported = largest("with domain");
    assert!((reported - peak.risk).abs() < 1e-9, "{reported} {peak:?}");
    // the hard set alone would report something else
    assert!(largest("hard set") < peak.risk - 1e-3);
    let margins = curves::margin_curves(&model);
    let kept = margins.iter().find(|c| c.name == "sets kept out of");
    let least = kept.expect("level sets are neither").values.iter().copied();
    let least = least.fold(f64::INFINITY, f64::min);
    assert!(least.abs() < 1.0, "the plan keeps close: {least}");
}

/// Viewers merge recordings of one name.
#[test]
fn the_same_run_has_the_same_name_and_another_has_another() {
    let folder = tempfile::tempdir().expect("folder");
    let written = |run: &Run, plan: &PlanDocument| {
        let path = folder.path().join("a.rrd");
        write(run, plan, &path).expect("writes");
        std::fs::read(path).expect("a file")
    };
    let names = |bytes: &[u8]| -> BTreeSet<String> {
        let stores = ChunkStore::from_rrd_reader(&ChunkStoreConfig::DEFAULT, &mut &bytes[..]);
        let ids = stores.expect("reads").into_keys();
        ids.filter(StoreId::is_recording)
            .map(|id| format!("{id:?}"))
            .collect()
    };
    let plan = PlanDocument::of(&run());
    let mut slower = plan.clone();
    slower.timing.plan_s += 1.0;
    let first = written(&run(), &plan);
    assert_eq!(names(&first), names(&written(&run(), &plan)));
    for other in [
        written(&run(), &slower),
        written(&run_without_plan(), &plan),
    ] {
        assert!(names(&first).is_disjoint(&names(&other)));
    }
}

/// A target that is seen with errors, and own ship off its plan.
const CLOSED_LOOP: &str = r#"
position_std_m = 5.0
behaviour = { kind = "random" }
[simulation]
sensor = { kind = "ais", position_std_m = 5.0 }
vessel = { kind = "nomoto" }
"#;

fn sailed(scenario: &Scenario) -> Simulation {
    let simulation = Simulation::keeping_plans(scenario.clone(), false);
    let mut simulation = simulation.expect("a closed loop");
    while !simulation.finished() {
        simulation.step();
    }
    simulation
}

fn recorded_simulation(scenario: &Scenario, simulation: &Simulation) -> Recorded {
    let folder = tempfile::tempdir().expect("folder");
    let path = folder.path().join("sailed.rrd");
    let simulated = Simulated {
        scenario,
        document: &simulation.record(),
        plans: simulation.plans(),
        text: "the result",
    };
    write_simulation(&simulated, &path).expect("writes");
    Recorded::read(&path).expect("whole")
}

/// The values of a component in the rows in time.
fn moving(recorded: &Recorded, entity: &str, component: &str) -> Vec<(f64, serde_json::Value)> {
    let table = recorded.table(entity).expect(entity);
    let is_meant = |c: &String| c.ends_with(component);
    let place = table.components.iter().position(is_meant).expect(component);
    let rows = table.rows.into_iter();
    rows.filter_map(|mut row| Some((row.time?, row.values.swap_remove(place))))
        .collect()
}

#[test]
fn a_simulation_is_read_back_as_it_was_sailed() {
    let text = format!("{HEAD_ON}{CLOSED_LOOP}").replace("\"shape\"", "\"none\"");
    let scenario = Scenario::parse(&text).expect("a valid scenario");
    let simulation = sailed(&scenario);
    let document = simulation.record();
    let recorded = recorded_simulation(&scenario, &simulation);
    assert_numbers(&recorded);
    assert_eq!(recorded.document(), None);
    let kept: crate::document::SimulationDocument =
        serde_json::from_str(&recorded.simulation().expect("there")).expect("a simulation");
    assert_eq!(kept.conduct, document.conduct);
    let [span] = &recorded.timelines()[..] else {
        panic!("one timeline");
    };
    assert!((span.last - document.duration_s).abs() < 1e-6 && span.first == 0.0);

    // every plan at its time
    let drawn: Vec<f64> = (moving(&recorded, "chart/map/planned", ":strips").iter())
        .map(|(time, _)| *time)
        .collect();
    let followed = document.replans.iter().filter(|replan| replan.followed);
    let followed: Vec<f64> = followed.map(|replan| replan.start_t_s).collect();
    assert!(followed.len() > 10);
    assert_eq!(drawn, followed);

    // the curves reach what is reported
    let least = |values: &serde_json::Value| values[0].as_f64().expect("a number");
    let curve = |entity: &str| -> Vec<f64> {
        let rows = moving(&recorded, entity, ":scalars");
        rows.iter().map(|(_, values)| least(values)).collect()
    };
    let clearances = curve("curves/clearance_m").into_iter();
    let clearance = clearances.fold(f64::INFINITY, f64::min);
    let reported = document.targets[0].least_clearance_m.expect("a number");
    let off = curve("curves/off_plan_m").into_iter().fold(0.0, f64::max);
    let so = document.conduct.largest_off_plan_m;
    for (drawn, reported) in [(clearance, reported), (off, so)] {
        assert!((drawn - reported).abs() < 0.01, "{drawn} {reported}");
    }
    assert!(so > 0.1, "{so}");

    // the line of the closest approach is as long as the reported distance
    let table = recorded.table("chart/map/closest_points").expect("there");
    let is_line = |c: &String| c.ends_with(":strips");
    let place = table.components.iter().position(is_line).expect("lines");
    let line = &table.rows[0].values[place][0];
    let end = |k: usize| {
        let [east, north] = [0, 1].map(|axis| line[k][axis].as_f64().expect("a number"));
        Vector::new(east, north)
    };
    let length = (end(0) - end(1)).norm();
    assert!((length - reported).abs() < 0.01, "{length} {reported}");

    // names and lanes have the roles of the plans
    let role = &simulation.plans()[0].encounters[0]
        .conduct
        .as_ref()
        .expect("judged")
        .roles[0]
        .role;
    assert_eq!(role.word(), "head-on");
    let names = labels(&recorded, "chart/map/names");
    assert!(
        names.contains(&format!("{NAME}\nown ship: {role}")),
        "{names:?}"
    );
    let least = format!(
        "Own ship\nclosest so far {} m",
        crate::text::tenths(reported)
    );
    assert_eq!(names[names.len() - 2], least);
    let lanes = moving(&recorded, "roles", ":state");
    assert_eq!(lanes[0].1[0], format!("{role}: own ship to {NAME}"));

    // without domains the plan is clear of the hard set, which is in its document
    let (time, strips) = &moving(&recorded, "chart/map/hard_sets", ":strips")[0];
    let crate::document::InitialSetDocument::Polygon { vertices_m } =
        &simulation.plans()[0].obstacles[0].initial_set
    else {
        panic!("a polygon");
    };
    assert_eq!(*time, 0.0);
    for (drawn, vertex) in strips[0].as_array().expect("points").iter().zip(vertices_m) {
        for axis in 0..2 {
            let drawn = drawn[axis].as_f64().expect("a number");
            assert!((drawn - vertex[axis]).abs() < 1e-3, "{drawn} {vertex:?}");
        }
    }

    // the wall clock alone differs
    let again = recorded_simulation(&scenario, &sailed(&scenario));
    let timed = ["/curves/planning_ms", "/simulation_document"];
    assert_alike(&recorded, &again, &timed);
}

#[test]
fn an_hour_with_ten_targets_is_small() {
    let (own, target) = HEAD_ON.split_once("[[targets]]").expect("two parts");
    let own = own.replace("400.0", "4000.0").replace("1500.0", "20000.0");
    let mut text = format!("{own}\n[simulation]\nduration_s = 3600\nreplan_s = 10\nstep_s = 5\n");
    for number in 0..10 {
        let target = target.replace(NAME, &format!("ship {number}")).replace(
            "north_m = 0.0",
            &format!("north_m = {}", 9000 + 500 * number),
        );
        text += &format!("[[targets]]{target}behaviour = {{ kind = \"random\" }}\n");
    }
    let scenario = Scenario::parse(&text).expect("a valid scenario");
    let simulation = sailed(&scenario);
    assert_eq!(simulation.plans().len(), 360);
    let recorded = recorded_simulation(&scenario, &simulation);
    assert!(recorded.bytes < 2_000_000, "{}", recorded.bytes);
    for entity in ["ships", "hard_sets", "estimates"] {
        let rows = moving(&recorded, &format!("chart/map/{entity}"), ":strips");
        assert_eq!(rows.len(), 361, "{entity}");
    }
}
