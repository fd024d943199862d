//! Tests of imported formats: real files, mutated files, and plans of real encounters.

mod common_ocean;
mod corpus;
#[path = "../campaigns/encounter_generator.rs"]
mod encounter_generator;
mod routes;
mod schema;

use std::path::Path;

use searoom::frame::Vector;
use searoom::obstacle::SpaceTimeObstacle;
use searoom::pipeline::{self, RelaxationLevel, Run};
use searoom::scenario::import::{Assumed, Assumption, Contents, Imported, Situation};
use searoom::scenario::{Compliance, Fault, Scenario};
use serde_json::{Value, json};

use encounter_generator::{Placement, random_traffic};

fn benchmark(name: &str) -> Vec<Situation> {
    let file = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("scenarios")
        .join(name);
    situations(Contents::read(&file, &Assumed::default().with_variants(true)).expect("readable"))
}

fn situations(contents: Contents) -> Vec<Situation> {
    let Contents::Situations(situations) = contents else {
        panic!("situations");
    };
    let good = |s: Result<Situation, _>| s.expect("no faults");
    situations.into_iter().map(good).collect()
}

fn dnv_files() -> Vec<String> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenarios/dnv");
    let entries = std::fs::read_dir(folder).expect("a folder");
    let names = entries.map(|entry| entry.expect("an entry").file_name());
    let names = names.map(|name| format!("dnv/{}", name.to_string_lossy()));
    let mut names: Vec<String> = names.filter(|name| name.ends_with(".json")).collect();
    names.sort();
    names
}

fn imported(situation: &Situation) -> Imported {
    situation.scenario(&Assumed::default()).expect("no faults")
}

fn paths(text: &str, assumed: &Assumed) -> Vec<String> {
    let faults = match Contents::parse(text, assumed) {
        Ok(Contents::Situations(situations)) => {
            let mut faults = Vec::new();
            for situation in situations {
                match situation.map(|s| s.scenario(assumed)) {
                    Ok(Ok(_)) => {}
                    Ok(Err(more)) | Err(more) => faults.extend(more),
                }
            }
            faults
        }
        Ok(_) => panic!("situations"),
        Err(faults) => faults,
    };
    let is_whole = |f: &Fault| !f.found.is_empty() && !f.allowed.is_empty();
    assert!(faults.iter().all(is_whole));
    faults.into_iter().map(|fault| fault.path).collect()
}

#[test]
fn every_case_of_imazu_meets_where_it_is_said_to() {
    let cases = benchmark("imazu/imazu.json");
    assert_eq!(cases.len(), 25);
    let mut ships = 0;
    for (index, case) in cases.iter().enumerate() {
        let Imported {
            scenario, notes, ..
        } = imported(case);
        ships += scenario.targets.len() * usize::from(index < 22);
        assert_eq!(notes.len(), 1, "{notes:?}");
        let own = &scenario.own_ship;
        assert_eq!((own.hull.length, own.hull.beam), (100.0, 20.0));
        assert_eq!((own.turning_radius, own.safety_margin), (250.0, 100.0));
        let horizon = scenario.horizon;
        assert!((horizon - 2.0 * 3600.0).abs() < 0.1, "{horizon}");
        let meeting = Vector::new(0.0, 11_112.0);
        assert!((scenario.desired.position_at(1800.0) - meeting).norm() < 0.2);
        for target in &scenario.targets {
            let off = (target.position_at(1800.0) - meeting).norm();
            assert!(off < 0.2, "{}", case.name);
            let ship = target.ship().expect("a ship");
            assert_eq!(ship.speed_spread, 0.5);
            assert!((ship.course_spread - 5.0_f64.to_radians()).abs() < 1e-15);
        }
    }
    assert_eq!(ships, 50);
}

/// Tests that every target of DNV's files is on a collision course: its nominal motion passes
/// within 30 m of own ship.
#[test]
fn every_target_of_dnv_meets_own_ship() {
    let files = dnv_files();
    assert_eq!(files.len(), 28);
    let mut targets = 0;
    for file in files {
        let situation = benchmark(&file).remove(0);
        let scenario = imported(&situation).scenario;
        assert_eq!(situation.name.split(", ").count(), scenario.targets.len());
        let own = &scenario.own_ship;
        assert_eq!((own.hull.length, own.hull.beam), (122.0, 20.0));
        assert!((own.speed - 10.0 * 1852.0 / 3600.0).abs() < 1e-12);
        for target in &scenario.targets {
            targets += 1;
            let apart = |t: f64| (target.position_at(t) - scenario.desired.position_at(t)).norm();
            let all = (0..1800).map(|t| apart(t.into()));
            let least = all.fold(f64::INFINITY, f64::min);
            assert!(least < 35.0, "{file}: {}: {least}", target.name);
        }
    }
    assert_eq!(targets, 71);
}

#[test]
fn what_is_imported_reads_as_what_is_run() {
    let mut assumed = Assumed::default().with(Assumption::SafetyMargin, 500.0);
    for situation in benchmark("imazu/imazu.json") {
        let imported = situation.scenario(&assumed).expect("no faults");
        let read = Scenario::parse(&imported.text).expect("no faults");
        assert_eq!(read, imported.scenario);
        assert_eq!(imported.scenario.own_ship.safety_margin, 500.0);
    }
    assumed = assumed.with(Assumption::CourseSpread, 0.0);
    for file in dnv_files() {
        let imported = benchmark(&file)[0].scenario(&assumed).expect("no faults");
        let read = Scenario::parse(&imported.text).expect("no faults");
        assert_eq!(read, imported.scenario);
        let ship = imported.scenario.targets[0].ship().expect("a ship");
        assert_eq!(ship.course_spread, 0.0);
    }
}

#[test]
fn an_assumption_out_of_range_changes_nothing() {
    let usual = Assumed::default();
    for (what, value) in [
        (Assumption::SpeedSpread, -0.1),
        (Assumption::CourseSpread, 181.0),
        (Assumption::SafetyMargin, f64::NAN),
        (Assumption::Length, 0.0),
        (Assumption::Beam, f64::INFINITY),
    ] {
        assert!(!what.allows(value));
        assert_eq!(usual.clone().with(what, value), usual);
    }
}

const DNV_01: &str = include_str!("../../scenarios/dnv/traffic_situation_01.json");

fn dnv_01() -> Value {
    serde_json::from_str(DNV_01).expect("JSON")
}

/// Returns the document with one value replaced or removed.
fn with(pointer: &str, value: Option<Value>) -> String {
    let mut document = dnv_01();
    let (parent, key) = pointer.rsplit_once('/').expect("a path");
    let parent = document.pointer_mut(parent).expect("there");
    match (parent, value) {
        (Value::Object(map), Some(value)) => {
            map.insert(key.to_owned(), value);
        }
        (Value::Object(map), None) => {
            map.remove(key).expect("there");
        }
        (Value::Array(list), value) => {
            let index: usize = key.parse().expect("an index");
            list.splice(index..=index, value);
        }
        _ => panic!("{pointer}"),
    }
    document.to_string()
}

/// Pointer, its new JSON value or nothing to remove it, and the place of the fault.
const MISTAKES: &str = r#"
/ownShip |  | ownShip
/ownShip | [] | ownShip
/ownShip/waypoints |  | ownShip.waypoints
/ownShip/waypoints/1 |  | ownShip.waypoints
/ownShip/waypoints/0/position/lat | 4000000 | ownShip.waypoints[0].position.lat
/ownShip/waypoints/1/position/lat | 10.0 | ownShip.waypoints[1].position
/ownShip/waypoints/1/leg/sog | "ten" | ownShip.waypoints[1].leg.sog
/ownShip/waypoints/1/leg/sog | 514.4 | ownShip.waypoints[1].leg.sog
/ownShip/waypoints/1/leg/sog | 0 | ownShip.waypoints[1].leg.sog
/ownShip/initial/heading | 361 | ownShip.initial.heading
/ownShip/static/pathType | "bezier" | ownShip.static.pathType
/ownShip/static/initDelay | 10 | ownShip
/ownShip/static/dimensions |  | ownShip.static.dimensions
/ownShip/static/dimensions/length | 400 | ownShip.static.dimensions
/ownShip/static/dimensions/a | -1 | ownShip.static.dimensions.a
/targetShips | {} | targetShips
/targetShips/0/waypoints | [] | targetShips[0].waypoints
/targetShips/0/static/dimensions |  | targetShips[0].static.dimensions
/targetShips/0/waypoints/0/position/lon | "10" | targetShips[0].waypoints[0].position.lon
/title | "two\nlines" | title
"#;

#[test]
fn one_mistake_in_a_dnv_file_is_one_fault_with_its_place() {
    for line in MISTAKES.lines().filter(|line| !line.is_empty()) {
        let cells: Vec<&str> = line.split('|').map(str::trim).collect();
        let value = serde_json::from_str(cells[1]).ok();
        assert_eq!(value.is_none(), cells[1].is_empty(), "{line}");
        let text = with(cells[0], value);
        assert_eq!(paths(&text, &Assumed::default()), [cells[2]], "{line}");
    }
    // neither the whole width nor its parts
    let length = json!({ "length": 122.0 });
    let text = with("/ownShip/static/dimensions", Some(length));
    let found = paths(&text, &Assumed::default());
    assert_eq!(found, ["ownShip.static.dimensions.width"]);
    // a ship without dimensions has the size given by the user
    let sized = Assumed::default()
        .with(Assumption::Length, 80.0)
        .with(Assumption::Beam, 14.0);
    let text = with("/targetShips/0/static/dimensions", None);
    assert_eq!(paths(&text, &sized), Vec::<String>::new());
    let situations = situations(Contents::parse(&text, &sized).expect("good"));
    let Imported {
        scenario, notes, ..
    } = situations[0].scenario(&sized).expect("no faults");
    let ship = scenario.targets[0].ship().expect("a ship");
    assert_eq!(ship.hull.length, 80.0);
    assert!(notes.iter().any(|n| n.contains("80 × 14 m")), "{notes:?}");
}

#[test]
fn every_fault_of_a_file_is_named_at_once() {
    let mut document = dnv_01();
    document["ownShip"]["static"]["pathType"] = json!("bezier");
    document["ownShip"]["waypoints"][1]["leg"]["sog"] = json!(-1);
    document["targetShips"][0]["initial"]["heading"] = json!(true);
    let found = paths(&document.to_string(), &Assumed::default()).join(" ");
    let places =
        "ownShip.static.pathType ownShip.waypoints[1].leg.sog targetShips[0].initial.heading";
    assert_eq!(found, places);
}

#[test]
fn a_broken_case_of_imazu_costs_itself_alone() {
    let text = include_str!("../../scenarios/imazu/imazu.json");
    let broken = text.replacen("\"course_deg\": 270.0", "\"course_deg\": \"west\"", 1);
    let Ok(Contents::Situations(situations)) = Contents::parse(&broken, &Assumed::default()) else {
        panic!("situations");
    };
    assert_eq!(situations.len(), 22);
    let bad: Vec<_> = situations.iter().filter_map(|s| s.as_ref().err()).collect();
    assert_eq!(bad.len(), 1);
    assert_eq!(bad[0][0].path, "cases[1].targets[0].course_deg");
    let own = text.replacen("\"goal_north_m\": 22224.0", "\"goal_north_m\": 1e99", 1);
    assert_eq!(paths(&own, &Assumed::default()), ["own_ship.goal_north_m"]);
}

#[test]
fn keys_that_are_there_twice_and_json_that_is_none_are_refused() {
    let title = r#""title": "HO","#;
    let twice = DNV_01.replacen(title, &title.repeat(2), 1);
    let (half, deep) = (&DNV_01[..DNV_01.len() / 2], "{\"a\":".repeat(10_000));
    for text in [&twice, half, "{}", "{\"a\": 1}", &deep] {
        assert_eq!(paths(text, &Assumed::default()), [""], "{text:.60}");
    }
    let parsed = |text| Contents::parse(text, &Assumed::default());
    for text in [
        r#"{"format": "searoom-plan/1"}"#,
        r#"{"type": "FeatureCollection"}"#,
    ] {
        assert!(matches!(parsed(text), Ok(Contents::Other(_))));
    }
    for text in ["", "title = 'x'", "[own_ship]"] {
        assert!(matches!(parsed(text), Ok(Contents::Scenario)));
    }
}

/// Tests every prefix, and every number replaced by a hostile one: no file content may cause a
/// panic.
#[test]
fn hostile_text_never_panics() {
    let try_all = |text: &str| {
        let parsed = Contents::parse(text, &Assumed::default());
        if let Ok(Contents::Situations(situations)) = parsed {
            for situation in situations.iter().flatten() {
                let _ = situation.scenario(&Assumed::default());
            }
        }
    };
    let text = dnv_01().to_string();
    for end in (0..text.len()).filter(|end| text.is_char_boundary(*end)) {
        try_all(&text[..end]);
    }
    for hostile in [
        "1e308", "-1e308", "5e-324", "-0.0", "[]", "{}", "\"\"", "true", "null", "180", "90",
    ] {
        for (at, _) in text.match_indices(char::is_numeric) {
            try_all(&format!("{}{hostile}{}", &text[..at], &text[at + 1..]));
        }
    }
}

/// Tests the encounters with half a metre per second and five degrees of uncertainty for every
/// target. Imazu's have 500 m between hulls of 100 × 20 m. Every encounter has a verified plan, no
/// target is left out, and no set is entered, even at a risk.
#[test]
fn every_encounter_has_a_plan_clear_of_all_it_declares() {
    let mut planned = 0;
    let imazu = Assumed::default().with(Assumption::SafetyMargin, 500.0);
    let cases = benchmark("imazu/imazu.json").into_iter().take(22);
    let cases = cases.map(|case| (case, imazu.clone()));
    let dnv = dnv_files().into_iter().flat_map(|file| benchmark(&file));
    for (situation, assumed) in cases.chain(dnv.map(|s| (s, Assumed::default()))) {
        let mut scenario = situation.scenario(&assumed).expect("no faults").scenario;
        // outcomes must not depend on the clock
        scenario.deadline = 60.0;
        let run = pipeline::run(scenario);
        let name = &situation.name;
        let plan = run.planned.outcome.plan().expect("a plan");
        assert_eq!(run.max_risk, 0.0, "{name}");
        assert!(!run.enters(), "{name}");
        let verified = run.evaluation.as_ref().is_some_and(|e| e.verified());
        assert!(verified, "{name}");
        for sets in run.targets.iter().map(|t| &t.sets) {
            for segment in plan.trajectory.segments() {
                assert_eq!(sets.hard.first_contact(segment, 1e-6), None, "{name}");
            }
        }
        planned += 1;
    }
    assert_eq!(planned, 50);
}

/// Tests each relaxation level by a result that only this level gives; another level, or none,
/// would also give a plan.
#[test]
fn every_relaxation_level_answers_some_encounter() {
    let answer = |mut scenario: Scenario, compliance| {
        scenario.compliance = compliance;
        scenario.deadline = 60.0;
        let run = pipeline::run(scenario);
        assert!(run.evaluation.as_ref().is_some_and(|e| e.verified()));
        run
    };
    let dnv = |number: &str| {
        let file = format!("dnv/traffic_situation_{number}.json");
        imported(&benchmark(&file)[0]).scenario
    };
    let hurried = |number: &str, delay: f64| {
        let scenario = dnv(number);
        Scenario {
            horizon: scenario.desired.duration() + delay,
            ..scenario
        }
    };
    // in too little time for a manoeuvre by the rules around the whole domains, or around any
    let by_the_rules = answer(hurried("17", 700.0), Compliance::Rules);
    assert_eq!(by_the_rules.level, RelaxationLevel::Rules);
    let clear_of_shapes = answer(hurried("47", 150.0), Compliance::Rules);
    assert_eq!(clear_of_shapes.level, RelaxationLevel::Domains);
    let searched = |run: &Run| run.planned.stats.is_some_and(|stats| stats.expanded > 0);
    let clear_of_hard_sets = answer(dnv("43"), Compliance::Shape);
    assert_eq!(clear_of_hard_sets.level, RelaxationLevel::ReducedDomains);
    assert!(searched(&clear_of_hard_sets));
    // wide detours are not plans of the graph
    let crowd = random_traffic(10, 27, Placement::Origin).expect("drawn");
    let around = answer(crowd.scenario, Compliance::Shape);
    assert_eq!(around.level, RelaxationLevel::ReducedDomains);
    assert_eq!(
        around.planned.method(),
        Some(searoom::planner::PlanMethod::HybridAStar)
    );
    let crowd = random_traffic(10, 201, Placement::Origin).expect("drawn");
    let half = answer(crowd.scenario, Compliance::Shape);
    assert!(half.level == RelaxationLevel::ReducedDomains && half.max_risk == 0.0);
}
