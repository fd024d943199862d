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
