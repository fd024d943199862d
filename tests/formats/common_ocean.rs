//! Tests of CommonOcean scenarios: samples, mutated files, and memory exhaustion attacks.

use searoom::colregs::Role;
use searoom::frame::Vector;
use searoom::geometry::ConvexSet;
use searoom::pipeline;
use searoom::scenario::import::{Assumed, Assumption, Contents, Imported, Situation};
use searoom::scenario::{Fault, Scenario};
use searoom::target::Motion;

const HEAD_ON: &str = include_str!("../../scenarios/commonocean/sample-head-on.xml");
const FAIRWAY: &str = include_str!("../../scenarios/commonocean/sample-fairway.xml");

fn read(text: &str) -> Result<Vec<Result<Situation, Vec<Fault>>>, Vec<Fault>> {
    match Contents::parse(text, &Assumed::default())? {
        Contents::Situations(situations) => Ok(situations),
        // a text cut before its first tag is not XML
        _ => Ok(Vec::new()),
    }
}

fn one(text: &str, assumed: &Assumed) -> Imported {
    let situations = read(text).expect("readable");
    let situation = situations.into_iter().next().expect("one").expect("good");
    let imported = situation.scenario(assumed).expect("no faults");
    let again = Scenario::parse(&imported.text).expect("no faults");
    assert_eq!(again, imported.scenario);
    imported
}

fn faults(text: &str) -> Vec<Fault> {
    match read(text) {
        Err(faults) => faults,
        Ok(situations) => {
            let faults = situations.into_iter().filter_map(Result::err);
            faults.flatten().collect()
        }
    }
}

#[test]
fn a_recorded_ship_on_one_course_is_a_tracked_ship() {
    let Imported {
        scenario, notes, ..
    } = one(HEAD_ON, &Assumed::default());
    assert_eq!(scenario.title, "ZAM_Sample-1_1_T-1");
    assert_eq!(scenario.horizon, 1200.0);
    // the origin of the plane is own ship's start
    assert_eq!(scenario.own_ship.pose.position, Vector::zeros());
    let goal = scenario.desired.waypoints()[1];
    assert!((goal - Vector::new(0.0, 4500.0)).norm() < 1e-9);
    assert!((scenario.desired.duration() - 900.0).abs() < 1e-9);
    let ship = scenario.targets[0].ship().expect("a ship");
    assert_eq!(scenario.targets[0].name, "cargoship 11");
    let sizes = (ship.hull.length, ship.hull.beam, ship.speed);
    assert_eq!(sizes, (90.0, 15.0, 5.0));
    let later = scenario.targets[0].position_at(20.0);
    assert!((later - Vector::new(0.0, 3900.0)).norm() < 1e-9);
    for part in ["100 × 20 m", "taken to go on", "of the goal its middle"] {
        assert!(notes.iter().any(|n| n.contains(part)), "{part}: {notes:?}");
    }
}

/// The ship turns to starboard after three minutes, onto own ship's course line: no risk on its
/// first course, head-on on its route.
#[test]
fn a_recorded_ship_that_turns_has_a_route_and_a_role() {
    let states = HEAD_ON.split("<state>").count() - 1;
    assert_eq!(states, 2);
    let turned = HEAD_ON
        .replace("<x>0.0</x><y>2000.0</y>", "<x>-900.0</x><y>500.0</y>")
        .replace("<x>0.0</x><y>1950.0</y>", "<x>0.0</x><y>500.0</y>")
        .replace("<x>0.0</x><y>1900.0</y>", "<x>0.0</x><y>-400.0</y>")
        .replace("<exact>1</exact>", "<exact>18</exact>")
        .replace("<exact>2</exact>", "<exact>36</exact>");
    let scenario = one(&turned, &Assumed::default()).scenario;
    let ship = scenario.targets[0].ship().expect("a ship");
    assert_eq!(ship.route.len(), 2, "{ship:?}");
    let corner = ship.pose_at(180.0).position;
    assert!(
        (corner - Vector::new(0.0, 2500.0)).norm() < 1e-6,
        "{ship:?}"
    );
    let run = pipeline::run(scenario.clone());
    assert_eq!(run.targets[0].sets.encounter.role, Role::HeadOn);
    assert!(run.safe());
    let mut straight = scenario;
    let Motion::Ship(ship) = &mut straight.targets[0].motion else {
        panic!("a ship");
    };
    ship.route.clear();
    let run = pipeline::run(straight);
    assert_ne!(run.targets[0].sets.encounter.role, Role::HeadOn);
}

#[test]
fn things_that_stand_still_are_sets_with_hull_and_margin() {
    let assumed = Assumed::default().with(Assumption::SafetyMargin, 30.0);
    let Imported {
        scenario, notes, ..
    } = one(FAIRWAY, &assumed);
    let names: Vec<&str> = scenario.targets.iter().map(|t| t.name.as_str()).collect();
    assert_eq!(names, ["shallow 4", "buoy 5", "land 6"]);
    let half = 0.5 * 100.0_f64.hypot(20.0);
    let depth = |index: usize, place: Vector| {
        let sets = scenario.targets[index].sets().expect("sets");
        let polygon = |set: &ConvexSet| set.as_polygon().expect("a polygon").clone();
        let velocity = polygon(&sets.velocities[0].velocities);
        assert_eq!(velocity.vertices(), [Vector::zeros()]);
        -polygon(&sets.initial).signed_distance(place - Vector::new(-800.0, -100.0))
    };
    // the edge of the buoy keeps the margin, the corner of the land does not
    assert!(depth(1, Vector::new(105.0, 240.0)) >= half + 30.0 - 1e-9);
    let corner = depth(2, Vector::new(1300.0, -400.0));
    assert!(corner >= half - 1e-9 && corner < half + 3.0, "{corner}");
    assert!(depth(0, Vector::new(400.0, 400.0)) > half);
    let left_out = ["shallows", "waterways", "trafficSign", "navigationableArea"];
    for part in left_out.map(|name| format!("1 {name}")) {
        assert!(notes.iter().any(|n| n.contains(&part)), "{part}: {notes:?}");
    }
    // the goal may be reached at 836 s, at 3 m/s
    assert!((scenario.desired.legs()[0].speed - 3.0).abs() < 1e-12);
}

#[test]
fn names_of_2020a_are_read_too() {
    let old = FAIRWAY
        .replace("2022a", "2020a")
        .replace("waterway", "waters")
        .replace("shallow id", "draft id")
        .replace("</shallow>", "</draft>");
    let old = one(&old, &Assumed::default());
    let new = one(FAIRWAY, &Assumed::default());
    assert_eq!(old.scenario, new.scenario);
}

#[test]
fn a_ship_that_appears_late_and_slows_is_in_her_sets() {
    let late = HEAD_ON
        .replace("<time><exact>2<", "<time><exact>62<")
        .replace("<time><exact>1<", "<time><exact>61<")
        .replacen("<time><exact>0<", "<time><exact>60<", 1)
        .replace("<y>1900.0<", "<y>1930.0<");
    let Imported {
        scenario, notes, ..
    } = one(&late, &Assumed::default());
    let said = |part: &str| notes.iter().any(|n| n.contains(part));
    assert!(said("appears after 600 s"), "{notes:?}");
    let target = &scenario.targets[0];
    assert!(target.changes().len() > 1);
    let clearance = 0.5 * 90.0_f64.hypot(15.0) + 0.5 * 100.0_f64.hypot(20.0) + 100.0;
    let depth = |time: f64, north: f64| {
        let set = target.sets().expect("sets").outer_section(time);
        -set.signed_distance(Vector::new(0.0, north))
    };
    let waits = [(0.0, 4000.0), (599.0, 4000.0)];
    let moves = [
        (605.0, 3975.0),
        (610.0, 3950.0),
        (620.0, 3930.0),
        (720.0, 3730.0),
    ];
    for (time, north) in waits.into_iter().chain(moves) {
        assert!(depth(time, north) >= clearance - 1e-6, "{time}");
    }
    // the target is nowhere else before it appears
    for side in [-1.03, 1.03] {
        assert!(depth(500.0, 4000.0 + side * clearance) < 0.0);
    }
}

/// A text of the head-on sample, what replaces it, and the place of the fault.
const MISTAKES: &str = r#"
2022a | 1999 | commonOcean
timeStepSize="10.0"  | | commonOcean
timeStepSize="10.0" | timeStepSize="0" | commonOcean
<type>cargoship</type> | <type>kayak</type> | SHIP/type
<type>cargoship</type> | | SHIP
<length>90.0</length> | | SHIP/shape/rectangle
<length>90.0< | <length>ninety< | SHIP/shape/rectangle/length
<y>2000.0< | <y>4000000000< | SHIP/initialState/position/point/y
<y>1950.0< | <y>-1950.0< | SHIP
<time><exact>2< | <time><exact>1< | SHIP
<y>-2000.0</y></point></position> | <y>-2000.0</y></point></position><velocity><exact>-5</exact></velocity> | OWN
<time><intervalStart>60< | <time><intervalStart>160< | OWN/goalState/time
<position>%<rectangle> | <position>%<square> |
planningProblem id="1" | planningProblem id="1" id="1" |
"#;

#[test]
fn one_mistake_is_one_fault_with_its_line() {
    let ship = "commonOcean/dynamicObstacle[11]";
    for row in MISTAKES.lines().filter(|row| !row.is_empty()) {
        let row = row.replace('%', "\n        ").replace("SHIP", ship);
        let row = row.replace("OWN", "commonOcean/planningProblem[1]");
        let cells: Vec<&str> = row.split('|').map(str::trim).collect();
        let [from, to, path] = cells[..] else {
            panic!("{row}");
        };
        assert!(HEAD_ON.contains(from), "{from}");
        let found = faults(&HEAD_ON.replacen(from, to, 1));
        let paths: Vec<&str> = found.iter().map(|f| f.path.as_str()).collect();
        assert_eq!(paths, [path], "{from} -> {to}: {found:?}");
        assert!(found[0].line.is_some(), "{found:?}");
    }
    // a ship without a shape is a fault until the user gives its size
    let begun = HEAD_ON.find("<shape>").expect("there");
    let ends = HEAD_ON.find("</shape>").expect("there") + "</shape>".len();
    let bare = format!("{}{}", &HEAD_ON[..begun], &HEAD_ON[ends..]);
    let situation = read(&bare).expect("readable").remove(0).expect("good");
    let missing = situation
        .scenario(&Assumed::default())
        .expect_err("no size");
    assert_eq!(missing[0].path, format!("{ship}/shape"));
    let sized = Assumed::default()
        .with(Assumption::Length, 80.0)
        .with(Assumption::Beam, 14.0);
    assert!(situation.scenario(&sized).is_ok());
}

/// Tests entities that would expand to gigabytes, nested elements, and an excessive number of them.
#[test]
fn what_is_meant_to_eat_memory_is_refused() {
    let mut bomb =
        String::from("<?xml version=\"1.0\"?><!DOCTYPE commonOcean [<!ENTITY a \"aaaaaaaaaa\">");
    for (before, name) in ('a'..='j').zip('b'..='k') {
        let ten = format!("&{before};").repeat(10);
        bomb += &format!("<!ENTITY {name} \"{ten}\">");
    }
    bomb += "]><commonOcean>&k;</commonOcean>";
    let found = faults(&bomb);
    assert_eq!(found.len(), 1);
    let allowed = &found[0].allowed;
    assert!(allowed.contains("without a document type"), "{found:?}");
    let deep = format!("{}{}", "<a>".repeat(1_000_000), "</a>".repeat(1_000_000));
    assert_eq!(faults(&deep).len(), 1);
    let many = format!("<commonOcean>{}</commonOcean>", "<a/>".repeat(2_500_000));
    let found = faults(&many);
    assert!(found[0].found.contains("nodes limit"), "{found:?}");
}

#[test]
fn hostile_text_never_panics() {
    let whole = |text: &str| {
        for situation in read(text).into_iter().flatten().flatten() {
            let _ = situation.scenario(&Assumed::default());
        }
    };
    for text in [HEAD_ON, FAIRWAY] {
        for end in (0..text.len()).filter(|end| text.is_char_boundary(*end)) {
            whole(&text[..end]);
        }
        for hostile in ["nan", "inf", "-1e308", "5e-324", "", "<a/>", "&amp;"] {
            for (at, _) in text.match_indices(char::is_numeric) {
                whole(&format!("{}{hostile}{}", &text[..at], &text[at + 1..]));
            }
        }
    }
}
