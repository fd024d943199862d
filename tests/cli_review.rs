//! What a user does with results, run as a user runs it.

use std::fs;
use std::path::Path;

use assert_cmd::Command;
use assert_cmd::assert::Assert;
use predicates::prelude::PredicateBooleanExt;
use predicates::str::{contains, is_empty};
use serde_json::Value;

fn searoom(args: &[&str]) -> Assert {
    Command::new(env!("CARGO_BIN_EXE_searoom"))
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .args(args)
        .assert()
}

fn text(path: &Path) -> &str {
    path.to_str().expect("a path that is text")
}

fn stdout(assert: &Assert) -> String {
    String::from_utf8(assert.get_output().stdout.clone()).expect("text")
}

fn document(assert: &Assert) -> Value {
    serde_json::from_str(&stdout(assert)).expect("one JSON document")
}

#[test]
fn plans_that_a_suite_wrote_are_verified_and_altered_ones_rejected() {
    let folder = tempfile::tempdir().expect("a folder");
    let plans = text(folder.path()).to_owned();
    searoom(&["suite", "scenarios/colregs", "--plans", &plans]).success();
    let file = |name: &str| format!("{plans}/{name}.json");
    let four = ["give-way", "head-on", "overtaking", "stand-on"].map(file);
    let args: Vec<&str> = ["verify"]
        .into_iter()
        .chain(four.iter().map(String::as_str))
        .collect();
    searoom(&args)
        .success()
        .stderr(is_empty())
        .stdout(contains("Head-on: verified").and(contains("margin")));
    let altered = file("altered");
    let good = fs::read_to_string(&four[1]).expect("a plan");
    let from = "\"turning_radius_m\": 100.0";
    assert!(good.contains(from));
    fs::write(&altered, good.replace(from, "\"turning_radius_m\": 101.0")).expect("written");
    searoom(&["verify", &altered])
        .code(1)
        .stderr(is_empty())
        .stdout(contains("Head-on: REJECTED").and(contains("turning radius in segment")));
    // the highest status of all wins, and every file is answered
    let broken = file("broken");
    fs::write(&broken, &good[..good.len() / 2]).expect("written");
    let all = searoom(&[
        "verify",
        "--json",
        &broken,
        &altered,
        &four[0],
        "no-such.json",
    ])
    .code(2)
    .stderr(contains("broken.json: ").and(contains("no-such.json: cannot be read")));
    let found = document(&all);
    let verdicts: Vec<_> = found["plans"]
        .as_array()
        .expect("a list")
        .iter()
        .map(|p| &p["verified"])
        .collect();
    assert_eq!(verdicts, [false, false, true, false]);
    assert_eq!(found["verified"], 1);
    assert_eq!(found["plans"][2]["targets"][0]["target"], "target");
    searoom(&["verify"]).code(2).stderr(contains("PLAN.json"));
}

#[test]
fn every_planner_is_compared_on_the_same_scenarios() {
    let folder = tempfile::tempdir().expect("a folder");
    let csv = text(&folder.path().join("rows.csv")).to_owned();
    let figure = text(&folder.path().join("compared.svg")).to_owned();
    let table = searoom(&[
        "compare",
        "scenarios/colregs",
        "--csv",
        &csv,
        "--figure",
        &figure,
    ])
    .success()
    .stderr(is_empty());
    let shown = stdout(&table);
    for expected in [
        "Head-on\n",
        "space-time, Dijkstra, ellipsoids",
        "hold course",
        "collides",
        "optimal control does not apply: ",
    ] {
        assert!(shown.contains(expected), "{expected}: {shown}");
    }
    let rows = fs::read_to_string(&csv).expect("rows");
    assert_eq!(rows.lines().count(), 1 + 4 * 8);
    assert!(rows.starts_with("file,scenario,method,max_risk,"));
    let drawn = fs::read_to_string(&figure).expect("a figure");
    assert!(
        drawn.contains("Overtaking: ways")
            && drawn.contains("space-time, A*")
            && !drawn.contains("NaN")
    );
    // the same whatever runs at the same time, but for the times
    let json = |threads: &str| {
        let assert = Command::new(env!("CARGO_BIN_EXE_searoom"))
            .current_dir(env!("CARGO_MANIFEST_DIR"))
            .env("RAYON_NUM_THREADS", threads)
            .args([
                "compare",
                "scenarios/colregs/give-way.toml",
                "--max-risk",
                "0,0.2",
                "--json",
            ])
            .assert()
            .success();
        untimed(document(&assert))
    };
    let found = json("1");
    assert_eq!(found, json("4"));
    let entries = found["comparisons"][0]["entries"]
        .as_array()
        .expect("entries");
    assert_eq!(entries.len(), 7 * 2 + 1);
    assert_eq!(entries[1]["max_risk"], 0.2);
    assert_eq!(entries[12]["method"], "hold course");
    assert_eq!(entries[12]["verified"], false);
    assert!(
        entries
            .iter()
            .all(|e| e["track"].as_array().is_some_and(|t| t.len() > 10))
    );
}

#[test]
fn a_comparison_answers_every_file_and_says_what_is_wrong() {
    let folder = tempfile::tempdir().expect("a folder");
    let bad = text(&folder.path().join("bad.toml")).to_owned();
    fs::write(&bad, "title = 3").expect("written");
    let head_on = "scenarios/colregs/head-on.toml";
    searoom(&[
        "compare",
        &bad,
        head_on,
        "--planner",
        "space-time",
        "--search",
        "a-star",
    ])
    .code(2)
    .stderr(contains("bad.toml: "))
    .stdout(
        contains("Head-on")
            .and(contains("Dijkstra").not())
            .and(contains("path-time").not()),
    );
    // on the path alone nothing is clear
    searoom(&["compare", head_on, "--planner", "path-time"])
        .code(1)
        .stdout(contains("path-time: no motion along the path is clear"));
    for (args, expected) in [
        (["--max-risk", "0,1"], "allowed: a number from 0 to 0.999999"),
        (["--figure", "x.pdf"], "ends neither in .svg nor in .png"),
        (["--csv", "/no/such/folder/x.csv"], "/no/such/folder/x.csv"),
    ] {
        let args: Vec<&str> = ["compare", head_on].into_iter().chain(args).collect();
        searoom(&args).code(2).stderr(contains(expected));
    }
}

/// The document without its wall-clock figures.
fn untimed(mut document: Value) -> Value {
    fn strip(value: &mut Value) {
        match value {
            Value::Object(map) => {
                map.remove("timing");
                map.values_mut().for_each(strip);
            }
            Value::Array(list) => list.iter_mut().for_each(strip),
            _ => {}
        }
    }
    strip(&mut document);
    document
}
