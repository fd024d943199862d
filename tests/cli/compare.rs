//! `searoom compare` as a user runs it.

use std::fs;

use super::program::{Folder, document, json, list, number, run, says, searoom, stdout, untimed};
use assert_cmd::Command;
use predicates::prelude::PredicateBooleanExt;
use predicates::str::contains;

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
    let methods =
        "space-time, A* and Dijkstra, ellipsoids | hold course | COLLIDES | optimal control";
    says(&shown, &format!("Head-on\n | {methods}"));
    let rows = fs::read_to_string(&csv).expect("rows");
    assert_eq!(rows.lines().count(), 1 + 4 * 9);
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
    assert_eq!(entries.len(), 8 * 2 + 1);
    assert_eq!(entries[1]["max_risk"], 0.2);
    assert_eq!(entries[0]["departure"]["kind"], "course");
    assert!(entries[14]["departure"].is_null());
    assert_eq!(entries[14]["method"], "hold course");
    assert_eq!(entries[14]["verified"], false);
    // the first contact, before the centres would meet at 150 s
    assert_eq!(entries[14]["collision"]["with"], "target");
    let contact = number(&entries[14]["collision"]["t_s"]);
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
    let unwritten = run(&format!("compare {head_on} --csv /no/such/folder/x.csv")).code(2);
    unwritten.stderr(contains("/no/such/folder/x.csv"));
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
