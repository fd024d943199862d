//! Altered motions: every one is detected.

use searoom::evaluation::Violation;
use searoom::scenario::Scenario;
use serde_json::{Value, json};

use crate::alter::{add, alter, assert_word, at, rows, scale, segments};
use crate::documents::{checked, document, documents, is_caught, scenario, text};

/// Alterations of the segments.
const TABLE: &str = r#"
all moved | /trajectory/segments/*/start/north_m + 0.01 | start position
one moved | /trajectory/segments/2/start/east_m + 0.001 | position at the joint
one turned | /trajectory/segments/1/start/course_deg + 0.01 |
all turned | /trajectory/segments/*/start/course_deg + 1 |
faster, over the same time | /trajectory/segments/*/speed_mps * 1.01 |
the first cut off | /trajectory/segments/0 remove | start time
one cut out | /trajectory/segments/1 remove | joint
the last cut off | /trajectory/segments/last remove | arrival
none left | /trajectory/segments = [] | segments: none
later | /trajectory/segments/*/start/t_s + 0.5 | start time
later from the third on | /trajectory/segments/2../start/t_s + 0.5 | time at the joint
one longer | /trajectory/segments/0/duration_s + 0.01 | joint
negative duration | /trajectory/segments/0/duration_s = -1 | values
negative speed | /trajectory/segments/0/speed_mps = -5 | values
bent | /trajectory/segments/0/turn_rate_deg_per_s + 0.01 | joint
"#;

/// Name, change, and a word of an expected violation.
type Alteration = (&'static str, fn(&mut Value), &'static str);

/// Alterations that no table holds.
const OTHERS: [Alteration; 7] = [
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
        // path-time plans report it in other words
        let along_paths = document["path_time"].is_object();
        let caught = |document: &Value, what: &str, word: &str| {
            let word = if along_paths { "" } else { word };
            assert_word(document, &format!("{name}, {what}"), word);
        };
        for [what, edits, word] in rows(TABLE) {
            let mut document = document.clone();
            alter(&mut document, edits);
            caught(&document, what, word);
            altered += 1;
        }
        for (what, change, word) in OTHERS {
            let mut document = document.clone();
            change(&mut document);
            caught(&document, what, word);
        }
    }
    assert!(altered >= 11 * 15, "{altered}");
}

/// Tests a motion through the target in an otherwise consistent document: only the sets detect it.
#[test]
fn a_consistent_run_through_a_target_is_caught_by_her_set_and_her_hull() {
    let mut document = document(scenario("colregs/head-on.toml"));
    let straight = OTHERS.last().expect("the last");
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
    alter(
        &mut document,
        "/obstacles/0/initial_set/vertices_m/*/1 * 0.001",
    );
    let found = checked(&document);
    let small = |v: &Violation| v.what.contains("too small for the hull");
    assert!(found.violations.iter().any(small));
}

/// Tests a hull that is nearest during a turn on the spot, on a heading between two legs.
#[test]
fn a_closest_approach_in_a_turn_on_the_spot_passes() {
    let moored = r#"
        planner = { kind = "path-time" }
        targets = [{ name = "moored", position = { east_m = 1700, north_m = -100 }, course_deg = 0, speed_mps = 0, length_m = 60, beam_m = 12 }]
    "#;
    let corner = [[0.0, 0.0], [1000.0, 0.0], [1000.0, 1000.0]];
    let text = text("corner", 600.0, &corner, moored);
    let mut document = document(Scenario::parse(&text).expect("sound"));
    assert!(!is_caught(&document));
    let dcpa = document["encounters"][0]["dcpa_m"]
        .as_f64()
        .expect("a distance");
    *at(&mut document, "/encounters/0/dcpa_m") = json!(dcpa + 0.1);
    assert!(is_caught(&document));
}

/// The first straight segment of a plan in 40 pieces, every second one aside by `gap` metres.
fn in_pieces(plan: &mut Value, gap: f64) {
    let all = segments(plan);
    let straight = (all.iter())
        .position(|s| s["turn_rate_deg_per_s"] == 0.0 && number(s, "duration_s") > 20.0);
    let straight = straight.expect("a straight segment");
    let whole = all[straight].clone();
    let duration = number(&whole, "duration_s") / 40.0;
    let start = |key: &str| number(&whole["start"], key);
    let course = start("course_deg").to_radians();
    let pieces = (0..40).map(|k| {
        let mut piece = whole.clone();
        let sailed = number(&whole, "speed_mps") * duration * f64::from(k);
        let aside = gap * f64::from(k % 2);
        piece["duration_s"] = json!(duration);
        piece["start"]["t_s"] = json!(start("t_s") + duration * f64::from(k));
        piece["start"]["east_m"] =
            json!(start("east_m") + course.sin() * sailed + course.cos() * aside);
        piece["start"]["north_m"] =
            json!(start("north_m") + course.cos() * sailed - course.sin() * aside);
        piece
    });
    let pieces: Vec<Value> = pieces.collect();
    all.splice(straight..=straight, pieces);
}

fn number(value: &Value, key: &str) -> f64 {
    value[key].as_f64().expect("a number")
}

#[test]
fn gaps_that_are_each_allowed_are_not_allowed_together() {
    let sound = document(scenario("colregs/head-on.toml"));
    let altered = |change: &dyn Fn(&mut Value)| {
        let mut plan = sound.clone();
        change(&mut plan);
        format!("{:?}", checked(&plan).violations)
    };
    assert_eq!(altered(&|plan| in_pieces(plan, 0.0)), "[]");
    let found = altered(&|plan| in_pieces(plan, 9e-7));
    assert!(found.contains("position at all joints"), "{found}");
    // beside a segment of no time a gap is allowed nowhere
    let with_an_instant = |plan: &mut Value, gap: f64| {
        let mut instant = segments(plan)[1].clone();
        instant["duration_s"] = json!(0.0);
        instant["start"]["north_m"] = json!(number(&instant["start"], "north_m") + gap);
        segments(plan).insert(1, instant);
    };
    assert_eq!(altered(&|plan| with_an_instant(plan, 0.0)), "[]");
    let found = altered(&|plan| with_an_instant(plan, 4e-7));
    assert!(
        found.contains("position beside a segment of no time"),
        "{found}"
    );
}
