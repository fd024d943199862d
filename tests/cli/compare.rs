//! `searoom compare` as a user runs it.

use std::fs;

use super::program::{Folder, document, json, list, number, run, says, searoom, stdout, untimed};
use assert_cmd::Command;
use predicates::prelude::PredicateBooleanExt;
use predicates::str::contains;
use serde_json::Value;

#[test]
fn every_planner_is_compared_on_the_same_scenarios() {
    // an option that is refused is not offered
    run("compare --help")
        .success()
        .stdout(contains("--times").and(contains("--panels").not()));
    let folder = Folder::new();
    let csv = folder.at("rows.csv");
    let figure = folder.at("compared.svg");
    let asked = format!("compare scenarios/colregs --csv {csv} --figure {figure}");
    let written = format!("note: wrote {csv}\nnote: wrote {figure}\n");
    let shown = stdout(&run(&asked).success().stderr(written));
    let methods = "space-time, by the rules, ellipsoids | hold course | COLLIDES | optimal control";
    says(&shown, &format!("Head-on\n | {methods}"));
    let rows = fs::read_to_string(&csv).expect("rows");
    assert_eq!(rows.lines().count(), 1 + 4 * 7);
    assert!(rows.starts_with("file,scenario,method,max_risk,"));
    let drawn = fs::read_to_string(&figure).expect("a figure");
    // who rams is told, and of nobody else anything
    says(&drawn, "Overtaking: trajectories | hold course: COLLIDES");
    assert!(!drawn.contains("A*: ") && !drawn.contains("NaN"));
    says(
        &shown,
        "S: the hulls touch; R1: holds a collision course until the hulls meet; R3: in a crossing, alters too little or too late",
    );
    says(
        &shown,
        "hold course: collides with 'target' at 146 s, when the hulls first touch on its expected motion",
    );
    // the same whatever runs at the same time, but for the times
    let json = |threads: &str| {
        let assert = Command::new(env!("CARGO_BIN_EXE_searoom"))
            .current_dir(env!("CARGO_MANIFEST_DIR"))
            .env("RAYON_NUM_THREADS", threads)
            .args("compare scenarios/colregs/give-way.toml --max-risk 0,0.2 --json".split(' '))
            .assert()
            .success();
        untimed(document(&assert))
    };
    let found = json("1");
    assert_eq!(found, json("4"));
    let entries = list(&found["comparisons"][0]["entries"]);
    assert_eq!(entries.len(), 6 * 2 + 1);
    assert_eq!(entries[1]["max_risk"], 0.2);
    assert_eq!(entries[0]["departure"]["kind"], "course");
    assert!(entries[10]["departure"].is_null());
    assert_eq!(entries[10]["method"], "hold course");
    assert_eq!(entries[10]["verified"], false);
    // the first contact, before the centres would meet at 150 s
    assert_eq!(entries[10]["collision"]["with"], "target");
    let contact = number(&entries[10]["collision"]["t_s"]);
    assert!((145.0..150.0).contains(&contact), "{contact}");
    assert!(entries[0].get("collision").is_none());
    assert!(entries.iter().all(|e| list(&e["track"]).len() > 10));
}

#[test]
fn a_comparison_answers_every_file_and_says_what_is_wrong() {
    let folder = Folder::new();
    let bad = folder.write("bad.toml", "title = 3");
    let head_on = "scenarios/colregs/head-on.toml";
    run(&format!(
        "compare {bad} {head_on} --planner space-time --search a-star"
    ))
    .code(2)
    .stderr(contains("bad.toml: "))
    .stdout(contains("Head-on"))
    .stdout(contains("Dijkstra").not().and(contains("path-time").not()));
    // on the path alone nothing is clear
    searoom(&["compare", head_on, "--planner", "path-time"])
        .code(1)
        .stdout(contains("COLLIDES").and(contains("relaxed").not()));
    Folder::new().refuses(
        "
        compare scenarios/colregs/head-on.toml --max-risk 0,1 | allowed: a number from 0 to 0.999999
        compare scenarios/colregs/head-on.toml --figure x.eps | ends in none of .svg, .png and .pdf
        ",
    );
}

/// Who enters a whole set within the accepted risk is relaxed, whether a planner chose it or not.
#[test]
fn a_baseline_that_takes_an_accepted_risk_is_relaxed() {
    let compared = json(
        "compare scenarios/colregs/give-way.toml --planner space-time --max-risk 0,0.4 --json",
    );
    let entries = compared["comparisons"][0]["entries"].as_array();
    let outcomes: Vec<(&str, f64)> = (entries.expect("a list").iter())
        .filter(|entry| entry["method"] == "constant velocity")
        .map(|entry| {
            assert_eq!(entry["verified"], true);
            let risk = number(&entry["cost"]["max_risk"]);
            (entry["outcome"].as_str().expect("a word"), risk)
        })
        .collect();
    let [("clear", without), ("relaxed", with)] = outcomes[..] else {
        panic!("{outcomes:?}");
    };
    assert!(without == 0.0 && with > 0.3, "{without}, {with}");
}

/// Ellipsoids are compared for the targets that may have them; a turning one keeps its polytopes.
#[test]
fn a_turning_target_is_no_ellipsoid_beside_others() {
    let file = "tests/faults/turning-beside-ellipsoid.toml";
    searoom(&["compare", file, "--planner", "path-time"])
        .code(1)
        .stdout(contains("path-time, ellipsoids"));
}

#[test]
fn a_plan_costs_at_least_its_bound() {
    let asked = "compare scenarios/colregs/head-on.toml --planner space-time --search a-star \
                 --compliance none --bound";
    let found = document(&run(&format!("{asked} --json")).success());
    let entries = list(&found["comparisons"][0]["entries"]);
    let bounded = entries.iter().filter(|e| e["lower_bound"].is_object());
    let mut shares = Vec::new();
    for entry in bounded {
        let bound = number(&entry["lower_bound"]["space_time_error_m2"]);
        shares.push(bound / number(&entry["cost"]["space_time_error_m2"]));
    }
    // the plans around polytopes and around ellipsoids; the baselines have none
    assert_eq!(shares.len(), 2);
    assert!(shares.iter().all(|s| (0.6..=1.0).contains(s)), "{shares:?}");
    says(
        &stdout(&run(asked).success()),
        "bound | bound: no motion of a point",
    );
}

/// Where no graph is searched, the search that is asked for changes nothing: one row, no node.
#[test]
fn a_search_that_did_not_run_has_no_row() {
    let file = "scenarios/colregs/stand-on.toml";
    let compared = |options: &str| {
        let compared = json(&format!("compare {file} --json {options}"));
        list(&compared["comparisons"][0]["entries"]).to_vec()
    };
    let names = |entries: &[Value]| -> Vec<String> {
        let names = entries.iter().filter_map(|e| e["method"].as_str());
        let space_time = names.filter(|name| name.starts_with("space-time"));
        space_time.map(str::to_owned).collect()
    };
    let rules = [
        "space-time, by the rules",
        "space-time, by the rules, ellipsoids",
    ];
    for options in ["", "--search dijkstra", "--search a-star"] {
        let entries = compared(options);
        assert_eq!(names(&entries), rules, "{options}");
        assert!(number(&entries[0]["search_stats"]["expanded"]) > 0.0);
    }
    let searched = compared("--compliance shape");
    let all = "space-time, A*; space-time, Dijkstra; space-time, A*, ellipsoids; space-time, \
               Dijkstra, ellipsoids";
    assert_eq!(names(&searched).join("; "), all);
    assert!(number(&searched[0]["search_stats"]["expanded"]) > 0.0);
    let table = stdout(&run(&format!("compare {file}")).success());
    says(&table, "space-time, by the rules");
    assert!(
        !table.contains("A*") && !table.contains("Dijkstra"),
        "{table}"
    );
}

/// J of one plan is one number.
#[test]
fn a_plan_costs_the_same_in_every_command() {
    for name in [
        "colregs/stand-on",
        "forces/give-way",
        "harbour/alternative-path",
    ] {
        let file = format!("scenarios/{name}.toml");
        let plan = json(&format!("plan {file} --json"));
        let planner = plan["planner"].as_str().expect("a planner");
        let compared = json(&format!(
            "compare {file} --planner {planner} --search a-star --json"
        ));
        let of_planner = planner.replace('-', " ");
        let entries = list(&compared["comparisons"][0]["entries"]).iter();
        let mut entries = entries.filter(|e| {
            let method = e["method"].as_str().unwrap_or_default().replace('-', " ");
            method.starts_with(&of_planner)
        });
        let entry = entries
            .next()
            .unwrap_or_else(|| panic!("{name}: {compared}"));
        for key in ["space_time_error_m2", "space_time_error_until_s"] {
            assert_eq!(entry["cost"][key], plan["cost"][key], "{name} {key}");
        }
    }
}

/// A velocity has a speed.
#[test]
fn a_baseline_that_turns_says_its_speed() {
    let mut slower = 0;
    for name in ["give-way", "head-on", "overtaking", "stand-on"] {
        let file = format!("scenarios/colregs/{name}.toml");
        let compared = document(&run(&format!("compare {file} --planner path-time --json")));
        let entries = list(&compared["comparisons"][0]["entries"]);
        let held = entries.iter().find(|e| e["method"] == "constant velocity");
        let held = held.expect("one");
        if held["departure"]["kind"] != "course" {
            continue;
        }
        let speed = number(&held["velocity"]["speed_mps"]) * 3600.0 / 1852.0;
        let table = stdout(&run(&format!("compare {file} --planner path-time")));
        let row = table
            .lines()
            .find(|line| line.starts_with("constant velocity"));
        let row = row.expect("a row");
        assert!(row.contains(&format!(" at {speed:.1} kn")), "{row}");
        slower += 1;
    }
    assert!(slower > 0);
}
