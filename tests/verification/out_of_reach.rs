//! Targets that no plan considers: the plan is the same without them, and the check proves that they
//! are out of reach.

use searoom::document::PlanDocument;
use searoom::pipeline;
use searoom::planner::PLANNERS;
use searoom::scenario::{MOST_WITHOUT_SELECTION, Scenario};
use searoom::target::Motion;
use searoom::verification::{verify, verify_document};
use serde_json::{Value, json};

use crate::alter::{at, list};
use crate::documents::{parsed, text};

const FAR: usize = 2000;

fn ship(name: &str, [east, north]: [f64; 2], course: f64, speed: f64) -> String {
    format!(
        "[[targets]]\nname = \"{name}\"\nposition = {{ east_m = {east}, north_m = {north} }}\n\
         course_deg = {course}\nspeed_mps = {speed}\nlength_m = 60\nbeam_m = 12\n\
         speed_spread_mps = 0.5\ncourse_spread_deg = 5\nposition_std_m = 5\n"
    )
}

/// A ship that is met and one that is passed, among `far` others 40 to 80 km away.
fn scene(far: usize) -> String {
    let golden = 2.4;
    let others = (0..far).map(|k| {
        let (angle, range) = (golden * k as f64, 40_000.0 + 20.0 * k as f64);
        let place = [range * angle.sin(), range * angle.cos()];
        ship(
            &format!("far {k}"),
            place,
            (37 * k % 360) as f64,
            0.01 * (k % 1000) as f64,
        )
    });
    let near = [
        ship("met", [1500.0, 0.0], 270.0, 5.0),
        ship("passed", [900.0, 1200.0], 90.0, 4.0),
    ];
    // the near ones in the middle of the file
    let mut all: Vec<String> = others.collect();
    all.splice(far / 2..far / 2, near);
    text("far", 600.0, &[[0.0, 0.0], [1500.0, 0.0]], &all.concat())
}

fn planned(mut scenario: Scenario) -> PlanDocument {
    scenario.set_aside_out_of_reach();
    PlanDocument::of(&pipeline::run(scenario))
}

/// True where the check refuses the document, or rejects it for a reason with the word.
fn is_rejected(document: &Value, word: &str) -> bool {
    match verify(&document.to_string()) {
        Ok(found) => !found.verified() && found.violations.iter().any(|v| v.what.contains(word)),
        Err(error) => error.to_string().contains("out_of_reach"),
    }
}

#[test]
fn a_plan_is_the_same_without_targets_out_of_reach() {
    let among = planned(parsed(&scene(FAR)));
    let alone = planned(parsed(&scene(0)));
    let listed = among.out_of_reach.as_ref().expect("targets out of reach");
    assert_eq!(listed.rows.len(), FAR);
    assert_eq!((listed.of_targets, among.all_targets()), (FAR + 2, FAR + 2));
    assert_eq!(alone.out_of_reach, None);
    assert_eq!(among.trajectory, alone.trajectory);
    assert_eq!(among.encounters, alone.encounters);
    assert_eq!(among.cost, alone.cost);
    assert_eq!(among.obstacles, alone.obstacles);
    assert!(among.verified && among.is_safe(), "{:?}", among.violations);
    let text = serde_json::to_string(&among).expect("JSON");
    assert!(text.len() < 300_000, "{} bytes", text.len());
    let found = verify(&text).expect("a plan");
    assert!(found.verified() && found.safe(), "{:?}", found.violations);
    assert_eq!(found.out_of_reach, FAR);
}

/// Each row holds the hull and the speeds of its target; every target is there once.
#[test]
fn a_row_holds_what_its_target_may_do() {
    let scenario = parsed(&scene(FAR));
    let document = planned(scenario.clone());
    let rows = document.out_of_reach.expect("some").rows;
    let mut rows = rows.iter();
    for target in &scenario.targets {
        let ship = target.ship().expect("a ship");
        if document.targets.iter().any(|t| t.name == target.name) {
            continue;
        }
        let row = rows.next().expect("a row");
        assert_eq!(row.0, target.name);
        assert_eq!([row.1, row.2], [ship.pose.position.x, ship.pose.position.y]);
        assert!(row.3 >= ship.speed + ship.speed_spread, "{}", row.0);
        assert!(row.4 >= ship.hull.half_diagonal() + 3.0 * ship.position_std);
    }
    assert_eq!(rows.next(), None);
}

/// All are planned for among few targets, with forces, and where a target might be met.
#[test]
fn targets_that_may_matter_are_planned_for() {
    let few = parsed(&scene(MOST_WITHOUT_SELECTION - 2));
    let mut same = few.clone();
    same.set_aside_out_of_reach();
    assert_eq!(same, few);
    let mut forces = parsed(&scene(300));
    let mut planners = PLANNERS.iter();
    let under_forces = planners.find(|planner| planner.facts().name == "optimal-control");
    forces.set_planner(*under_forces.expect("a planner"));
    forces.set_aside_out_of_reach();
    assert_eq!(forces.targets.len(), 302);
    // 33 m/s more, and the nearest ones might be met
    let fast = scene(300).replace("speed_spread_mps = 0.5", "speed_spread_mps = 33");
    let mut fast = parsed(&fast);
    fast.set_aside_out_of_reach();
    let kept = fast.targets.len();
    assert!((3..302).contains(&kept), "{kept}");
    assert_eq!(kept + fast.out_of_reach.targets.len(), 302);
    // a number that is none keeps its target
    let mut lost = parsed(&scene(300));
    let name = lost.targets[7].name.clone();
    if let Motion::Ship(ship) = &mut lost.targets[7].motion {
        ship.pose.position.x = f64::NAN;
    }
    lost.set_aside_out_of_reach();
    assert!(lost.targets.iter().any(|target| target.name == name));
}

#[test]
fn every_alteration_of_the_rows_is_rejected() {
    let document = planned(parsed(&scene(FAR)));
    let sound = serde_json::to_value(&document).expect("JSON");
    let altered = |alter: &dyn Fn(&mut Value)| {
        let mut document = sound.clone();
        alter(&mut document);
        document
    };
    let set = |pointer: &'static str, value: Value| {
        altered(&|document| *at(document, pointer) = value.clone())
    };
    let row = "/out_of_reach/rows/5";
    let rejected = [
        (
            "a row moved near",
            altered(&|document| *at(document, row) = json!(["far 5", 3000.0, 0.0, 2.0, 50.0])),
            "'far 5' out of reach",
        ),
        (
            "a row dropped",
            altered(&|document| {
                list(document, "/out_of_reach/rows").remove(5);
            }),
            "of_targets",
        ),
        (
            "a row twice",
            altered(&|document| {
                let again = at(document, row).clone();
                list(document, "/out_of_reach/rows").push(again);
            }),
            "another target of this name",
        ),
        (
            "a name of a target",
            set("/out_of_reach/rows/5/0", json!("met")),
            "another target of this name",
        ),
        ("no speed", set("/out_of_reach/rows/5/3", Value::Null), ""),
        (
            "speed -1",
            set("/out_of_reach/rows/5/3", json!(-1.0)),
            "greatest speed",
        ),
        (
            "speed 60",
            set("/out_of_reach/rows/5/3", json!(60.0)),
            "out of reach",
        ),
        (
            "no radius",
            set("/out_of_reach/rows/5/4", json!(0.0)),
            "radius",
        ),
        ("no place", set("/out_of_reach/rows/5/1", Value::Null), ""),
        (
            "a time before the horizon",
            set("/out_of_reach/until_s", json!(599.0)),
            "until_s",
        ),
        (
            "no distance",
            set("/out_of_reach/apart_m", json!(0.0)),
            "apart_m",
        ),
        (
            "more distance",
            set("/out_of_reach/apart_m", json!(50_000.0)),
            "out of reach",
        ),
        (
            "a motion under forces",
            set("/planner", json!("optimal-control")),
            "no greatest speed",
        ),
    ];
    for (name, document, word) in &rejected {
        assert!(is_rejected(document, word), "{name}");
    }
    // not a number in memory, which JSON cannot hold
    for index in 1..5 {
        let mut document = document.clone();
        let rows = &mut document.out_of_reach.as_mut().expect("some").rows;
        let row = &mut rows[5];
        *[&mut row.1, &mut row.2, &mut row.3, &mut row.4][index - 1] = f64::NAN;
        let found = verify_document(&document).expect("a plan");
        assert!(!found.verified(), "number {index}");
    }
    let mut gone = sound.clone();
    let keys = gone.as_object_mut().expect("a document");
    keys.remove("out_of_reach");
    // a list that is left out altogether cannot be missed: the input is taken as given
    assert!(verify(&gone.to_string()).expect("a plan").verified());
}
