//! Foreign files through the program.

use std::fs::{self, File};
use std::time::Instant;

use super::program::{HEAD_ON, document, searoom, stderr, text, write};
use predicates::str::contains;

const IMAZU: &str = include_str!("../../benchmarks/imazu/imazu.json");
const DNV: &str = include_str!("../../benchmarks/dnv/traffic_situation_01.json");

/// Three formats and every kind of fault in one folder: an error each, with file and place, and the rest runs.
#[test]
fn a_folder_may_mix_formats_and_faults() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = |name: &str, contents: &str| write(folder.path(), name, contents);
    at("a/head-on.toml", HEAD_ON);
    at("b/dnv.json", DNV);
    at("c/none.json", "{\"answer\": 42}");
    at("d/degrees.json", &DNV.replacen("58.763449", "4000000", 1));
    at("e/cut.json", &DNV[..DNV.len() / 2]);
    at("f/plan.json", "{\"format\": \"searoom-plan/1\"}");
    let cases: Vec<&str> = IMAZU.split("\"id\": ").collect();
    let two = format!("{}\"id\": {}\"id\": {}", cases[0], cases[1], cases[2]);
    let two = format!(
        "{}]}}",
        two.trim_end().trim_end_matches(['{', ',', ' ', '\n'])
    );
    at(
        "g/two.json",
        &two.replacen("\"course_deg\": 270.0", "\"course_deg\": 999", 1),
    );
    // no more of it is read than is allowed
    let large = folder.path().join("h.json");
    let begun = Instant::now();
    File::create(&large)
        .and_then(|f| f.set_len(1 << 30))
        .expect("made");
    let plans = folder.path().join("plans.out/");
    let assert = searoom(&[
        "suite",
        text(folder.path()),
        "--json",
        "--plans",
        text(&plans),
    ])
    .code(2);
    assert!(begun.elapsed().as_secs() < 60);
    let suite = document(&assert);
    assert_eq!(suite["summary"]["scenarios"], 8);
    assert_eq!(suite["summary"]["unreadable"], 5);
    assert_eq!(suite["summary"]["verified"], 3);
    let said = stderr(&assert);
    for part in [
        "none.json: 1 fault\n",
        "JSON with the keys answer",
        "degrees.json: 1 fault\n",
        "ownShip.waypoints[0].position.lat: found 4000000",
        "cut.json: 1 fault\n",
        "plan.json: a result document, left out",
        "cases[1].targets[0].course_deg: found 999",
        "more than 16 MiB",
    ] {
        assert!(said.contains(part), "{part}: {said}");
    }
    let mut written: Vec<String> = fs::read_dir(&plans)
        .expect("a folder")
        .map(|entry| {
            entry
                .expect("an entry")
                .file_name()
                .to_string_lossy()
                .into()
        })
        .collect();
    written.sort();
    assert_eq!(
        written,
        ["a__head-on.json", "b__dnv.json", "g__imazu-01.json"]
    );
}

#[test]
fn options_say_what_foreign_files_do_not() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = write(folder.path(), "dnv.json", DNV);
    let of =
        |args: &[&str]| document(&searoom(&[&["plan", &file, "--json"], args].concat()).success());
    let usual = of(&[]);
    assert_eq!(usual["own_ship"]["safety_margin_m"], 122.0);
    assert_eq!(usual["targets"][0]["ship"]["speed_spread_mps"], 0.5);
    let asked = of(&[
        "--margin-m",
        "300",
        "--speed-spread-mps",
        "0.25",
        "--course-spread-deg",
        "3",
    ]);
    assert_eq!(asked["own_ship"]["safety_margin_m"], 300.0);
    assert_eq!(asked["targets"][0]["ship"]["speed_spread_mps"], 0.25);
    let spread = asked["targets"][0]["ship"]["course_spread_deg"]
        .as_f64()
        .expect("degrees");
    assert!((spread - 3.0).abs() < 1e-9);
    searoom(&["plan", &file, "--speed-spread-mps=-1"])
        .code(2)
        .stderr(contains("allowed: a number from 0 to 100"));
}

#[test]
fn one_plan_is_of_one_situation() {
    searoom(&["plan", "benchmarks/imazu/imazu.json"])
        .code(2)
        .stderr(contains("22 situations; `searoom suite` runs them"));
    searoom(&["check", "benchmarks/imazu/imazu.json", "--variants"])
        .success()
        .stdout(contains("imazu.json: imazu-12-mixed: ok"))
        .stderr(contains(
            "own ship, target 1, target 2, target 3: no size in the file, 100 × 20 m taken",
        ));
}

#[test]
fn a_format_is_told_by_what_is_in_the_file() {
    let folder = tempfile::tempdir().expect("a folder");
    let dnv = write(folder.path(), "named.toml", DNV);
    let toml = write(folder.path(), "named.json", HEAD_ON);
    searoom(&["check", &dnv, &toml]).success();
}
