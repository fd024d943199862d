//! A plan that goes on from the previous one.

use crate::program::{Folder, HEAD_ON, document, json, list, number, rows, searoom, stdout};
use predicates::str::{contains, is_empty};
use serde_json::Value;

/// The head-on scene some whole seconds later, own ship metres beside its plan.
fn later_on(plan: &Value, seconds: u32, beside: f64) -> String {
    let samples = list(&plan["trajectory"]["samples"]);
    let elapsed = f64::from(seconds) - plan["time_s"].as_f64().unwrap_or(0.0);
    let now = samples.iter().find(|s| s["t_s"] == elapsed);
    let now = now.expect("a sample");
    let place = "position = { east_m = 0.0, north_m = 0.0 }\ncourse_deg = 90.0";
    let there = format!(
        "position = {{ east_m = {}, north_m = {} }}\ncourse_deg = {}",
        number(&now["east_m"]) + beside,
        now["north_m"],
        now["course_deg"]
    );
    let target = format!("position = {{ east_m = {}.0", 1500 - 5 * seconds);
    let later = HEAD_ON
        .replace("horizon_s", &format!("time_s = {seconds}.0\nhorizon_s"))
        .replace(place, &there)
        .replace("[mission]", "[mission]\nstart_s = 0.0")
        .replace("position = { east_m = 1500.0", &target);
    assert!(later.contains(&there));
    later
}

/// The velocities of before are kept for the same set, given about the course that the target has
/// now, and not for one of equal width to another side.
#[test]
fn velocities_are_kept_only_for_a_target_that_may_do_no_more() {
    let folder = Folder::new();
    let target = "course_deg = 270.0                   # westwards, straight at own ship";
    let with = |text: &str, course: f64, spread: f64, turn: f64| {
        let turned = format!("starboard_turn_deg = {turn:?}\ncourse_deg = {course:?}");
        let spread = format!("course_spread_deg = {spread:?}");
        text.replace(target, &turned)
            .replace("course_spread_deg = 5.0", &spread)
    };
    for (before, after, kept) in [
        ([270.0, 5.0, 10.0], [278.0, 7.0, -6.0], true),
        ([270.0, 5.0, 0.0], [270.0, 0.0, 10.0], false),
    ] {
        let scene = |text: &str, [course, spread, turn]: [f64; 3]| with(text, course, spread, turn);
        let file = folder.write("first.toml", scene(HEAD_ON, before));
        let first = json(&format!("plan {file} --json"));
        let previous = folder.write("first.json", first.to_string());
        let file = folder.write("later.toml", scene(&later_on(&first, 20, 0.0), after));
        let later =
            document(&searoom(&["plan", &file, "--previous", &previous, "--json"]).success());
        let velocities = &later["targets"][0]["ship"]["kept_velocities"];
        assert_eq!(velocities.is_object(), kept, "{after:?}: {velocities}");
    }
}

#[test]
fn a_plan_goes_on_from_the_previous_one() {
    let folder = Folder::new();
    let first = json("plan scenarios/colregs/head-on.toml --json");
    let previous = folder.write("first.json", first.to_string());
    let later = later_on(&first, 60, 0.0);
    let file = folder.write("later.toml", later.clone());
    let go_on = |file: &str| searoom(&["plan", file, "--previous", &previous, "--json"]);
    let second = document(&go_on(&file).success());
    // the same manoeuvre, not a turn back
    let begins = |plan: &Value| number(&plan["manoeuvres"][0]["begins_s"]);
    assert!((begins(&first) - 60.0 - begins(&second)).abs() < 1e-9);
    assert_eq!(second["encounters"][0]["roles"][0]["from_s"], -60.0);
    assert_eq!(second["encounters"][0]["violations"], Value::Array(vec![]));
    // no phase begins again: it is out, as the first plan has it by then
    let phases = |plan: &Value| {
        let phases = list(&plan["phases"]).iter();
        let covers = phases.clone().zip(phases.clone().skip(1));
        assert!(
            covers
                .into_iter()
                .all(|(p, next)| p["until_s"] == next["from_s"])
        );
        let word = |p: &Value| p["phase"].as_str().expect("a word").to_owned();
        phases.map(word).collect::<Vec<_>>()
    };
    let first_phases = ["free", "out", "parallel", "back", "free"];
    assert_eq!(phases(&first), first_phases);
    assert_eq!(phases(&second), first_phases[1..]);
    // without the previous plan own ship turns back at once
    let anew = json(&format!("plan {file} --json"));
    let segments = list(&anew["trajectory"]["segments"]).iter();
    let mut rates = segments.map(|s| number(&s["turn_rate_deg_per_s"]));
    let rate = rates.find(|rate| *rate != 0.0);
    assert!(rate.is_some_and(|rate| rate < 0.0), "to port");
    assert_ne!(anew["encounters"][0]["violations"], Value::Array(vec![]));
    let verified = folder.write("second.json", second.to_string());
    searoom(&["verify", &verified]).success();

    // a metre beside the plan its remainder is of no use, but the manoeuvre goes on
    let beside = folder.write("beside.toml", later_on(&first, 60, 1.0));
    let third = document(&go_on(&beside).success());
    assert!((begins(&first) - 60.0 - begins(&third)).abs() < 1e-9);
    assert_eq!(third["memory"]["keeps_plan"], false);
    assert_eq!(third["encounters"][0]["violations"], Value::Array(vec![]));

    // within its tracking margin own ship goes on from the plan
    let first_ship = |margin: &str, beside| {
        let text = later_on(&first, 60, beside);
        let own = format!("[own_ship]\ntracking_margin_m = {margin}");
        let text = text.replace("[own_ship]", &own);
        folder.write("near.toml", text)
    };
    let near = document(&go_on(&first_ship("1.5", 1.0)).success());
    assert_eq!(near["own_ship"]["position"], second["own_ship"]["position"]);
    assert_eq!(near["trajectory"], second["trajectory"]);
    assert_eq!(near["memory"]["off_plan_m"], 1.0);
    let far = document(&go_on(&first_ship("1.5", 1.6)).success());
    assert!((number(&far["memory"]["off_plan_m"]) - 1.6).abs() < 1e-9);
    assert_eq!(far["memory"]["keeps_plan"], false);
    let said = searoom(&["plan", &first_ship("1.5", 1.6), "--previous", &previous]);
    let beyond = "1.6 m from the previous plan, more than its tracking margin of 1.5 m: the rest of \
                  that plan is not used";
    said.success().stdout(contains(beyond));
    let refused = searoom(&["check", &first_ship("31.0", 1.0)]).code(2);
    let fault = "own_ship.tracking_margin_m: found 31 m; allowed: at most 20 m";
    refused.stderr(contains(fault));

    // on the way back a little beside the plan, it sails no circle
    let times = (160..=224).step_by(4);
    for (seconds, beside) in times.flat_map(|s| [3e-4, -4e-4, 0.01].map(|beside| (s, beside))) {
        let file = later_on(&second, seconds, beside);
        let file = folder.write("back.toml", file);
        let back = searoom(&["plan", &file, "--previous", &verified, "--json"]).success();
        let delay = document(&back)["cost"]["delay_s"].as_f64();
        let soon = delay.is_some_and(|delay| delay < 10.0);
        assert!(soon, "{seconds} {beside}: {delay:?}");
    }

    // a target that moved within its spread keeps to the velocities of both plans
    let moved = later.replace("course_deg = 270.0", "course_deg = 274.0");
    let moved = document(&go_on(&folder.write("moved.toml", moved)).success());
    assert!(moved["targets"][0]["ship"]["kept_velocities"].is_object());
    let moved = folder.write("moved.json", moved.to_string());
    searoom(&["verify", &moved]).success();

    // so does one that is measured less well; one that may do more does not
    for (more, kept) in [("speed_std_mps = 0.2\n", true), ("", false)] {
        let spread = if kept { "0.5" } else { "0.6" };
        let wider = format!("{more}speed_spread_mps = {spread}");
        let moved = later.replace("speed_spread_mps = 0.5", &wider);
        assert!(moved.contains(&wider));
        let moved = document(&go_on(&folder.write("wider.toml", moved)).success());
        let velocities = &moved["targets"][0]["ship"]["kept_velocities"];
        assert_eq!(velocities.is_object(), kept, "{wider}");
        let moved = folder.write("wider.json", moved.to_string());
        searoom(&["verify", &moved]).success();
    }

    // a remainder at a speed that is no longer own ship's is not kept
    let slower = later.replace("[2.5, 5.0, 6.0]", "[2.5, 6.0]");
    assert_ne!(slower, later);
    let slower = document(&go_on(&folder.write("slower.toml", slower)).success());
    assert_eq!(slower["memory"]["keeps_plan"], false);

    let turned = later.replace("course_deg = 270.0", "course_deg = 250.0");
    let turned = folder.write("turned.toml", turned);
    let turned = document(&go_on(&turned).success());
    let outside = &turned["memory"]["outside_velocities"];
    assert_eq!(*outside, serde_json::json!(["target"]));
    assert_eq!(turned["targets"][0]["ship"]["kept_velocities"], Value::Null);

    let renamed = later.replace("name = \"target\"", "name = \"other\"");
    let renamed = folder.write("renamed.toml", renamed);
    let renamed = searoom(&["plan", &renamed, "--previous", &previous]);
    let unknown = "'target' of the previous plan is not in this file";
    renamed.stdout(contains(unknown));
}

/// A text of the scenario, what replaces it, and why the previous plan does not fit.
const UNFIT_PREVIOUS: &str = r#"
time_s = 60.0 | time_s = 600.0 | time_s: found a plan from 0 s to
title = "Head-on" | title = "Other" | allowed: a plan of "Other"
course_deg = 1 | course_deg = 2 | allowed: at most 30 m, own length, and 20 degrees
"#;

#[test]
fn a_previous_plan_that_does_not_fit_is_named() {
    let folder = Folder::new();
    let first = json("plan scenarios/colregs/head-on.toml --json");
    let previous = folder.write("first.json", first.to_string());
    let mut altered = first.clone();
    altered["own_ship"]["length_m"] = 31.0.into();
    let altered = folder.write("altered.json", altered.to_string());
    let later = later_on(&first, 60, 0.0);
    for [old, new, message] in rows(UNFIT_PREVIOUS) {
        let changed = later.replace(&old, &new);
        assert_ne!(changed, later);
        let file = folder.write("changed.toml", changed);
        let refused = searoom(&["plan", &file, "--previous", &previous]).code(2);
        refused.stdout(is_empty()).stderr(contains(message));
        let ignored = ["plan", &file, "--previous", &previous, "--ignore-previous"];
        searoom(&ignored).stderr(contains("ignored"));
    }
    let file = folder.write("later.toml", later);
    let refused = searoom(&["plan", &file, "--previous", &altered]).code(2);
    refused.stderr(contains("not a plan that verifies"));
    searoom(&["plan", &file, "--previous", "none.json"]).code(2);
}

#[test]
fn a_document_without_a_plan_is_no_previous_plan() {
    let folder = Folder::new();
    let head_on = "scenarios/colregs/head-on.toml";
    let refused = |name: &str, words: &str, said: &str| {
        let words: Vec<&str> = words.split(' ').chain([head_on, "--json"]).collect();
        let file = folder.write(name, stdout(&searoom(&words)));
        let refused = searoom(&["plan", head_on, "--previous", &file]).code(2);
        refused.stderr(contains(said));
    };
    refused(
        "a.json",
        "simulate --duration-s 20",
        "found the document of `simulate`; allowed: that",
    );
    refused(
        "b.json",
        "compare --planner path-time",
        "found the document of `compare`; allowed: ",
    );
    refused(
        "c.json",
        "suite",
        "found the document of `suite`; allowed: that of a plan, as",
    );
    let short = HEAD_ON.replace("horizon_s = 400.0", "horizon_s = 40.0");
    let short = folder.write("short.toml", short);
    let none = folder.write("none.json", stdout(&searoom(&["plan", &short, "--json"])));
    let said =
        "trajectory.segments: found no trajectory: the outcome is infeasible; allowed: lines";
    let refused = searoom(&["plan", head_on, "--previous", &none]).code(2);
    refused.stderr(contains(said));
}
