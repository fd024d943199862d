//! Foreign files through the program.

use std::fs::{self, File};
use std::time::Instant;

use super::program::{
    Folder, HEAD_ON, document, json, list, number, run, searoom, stderr, text, untimed,
};
use predicates::str::contains;
use serde_json::Value;

const IMAZU: &str = include_str!("../../scenarios/imazu/imazu.json");
const DNV: &str = include_str!("../../scenarios/dnv/traffic_situation_01.json");

/// Three formats and every kind of fault in one folder: an error each, with file and place, and the
/// rest runs.
#[test]
fn a_folder_may_mix_formats_and_faults() {
    let folder = Folder::new();
    let at = |name: &str, contents: &str| folder.write(name, contents);
    at("a/head-on.toml", HEAD_ON);
    // neither of these is looked at
    at(".hidden/x.toml", "");
    at("notes.txt", "");
    at("b/dnv.json", DNV);
    at("c/none.json", "{\"answer\": 42}");
    at("d/degrees.json", &DNV.replacen("58.763449", "4000000", 1));
    at("e/cut.json", &DNV[..DNV.len() / 2]);
    at(
        "f/plan.json",
        "{\"format\": \"searoom-plan/1\", \"own_ship\": {}}",
    );
    let cases: Vec<&str> = IMAZU.split("\"id\": ").collect();
    let two = cases[..3].join("\"id\": ");
    let two = two.trim_end().trim_end_matches(['{', ',', ' ', '\n']);
    let two = two.replacen("\"course_deg\": 270.0", "\"course_deg\": 999", 1);
    at("g/two.json", &format!("{two}]}}"));
    // no more of it is read than is allowed
    let begun = Instant::now();
    let large = File::create(folder.at("h.json"));
    large.and_then(|f| f.set_len(1 << 30)).expect("made");
    let assert = run(&format!(
        "suite {folder} --json --plans {folder}/plans.out/"
    ))
    .code(2);
    assert!(begun.elapsed().as_secs() < 60);
    let suite = document(&assert);
    let summary = [
        ("scenarios", 8),
        ("unreadable", 5),
        ("solved", 3),
        ("verified", 3),
    ];
    for (key, count) in summary {
        assert_eq!(suite["summary"][key], count, "{key}");
    }
    let runs = list(&suite["runs"]).iter();
    let read = runs.map(|run| (run["file"].as_str(), run["outcome"] == "unreadable"));
    let bad = ["c/none.json", "d/degrees.json", "e/cut.json"].map(|name| folder.at(name));
    let read: Vec<_> = read.collect();
    assert!(read.is_sorted_by_key(|(file, _)| *file), "{read:?}");
    for file in &bad {
        assert!(read.contains(&(Some(file), true)), "{file}: {read:?}");
    }
    let said = stderr(&assert);
    for part in [
        "none.json: 1 fault\n",
        "JSON with the keys answer",
        "degrees.json: 1 fault\n",
        "ownShip.waypoints[0].position.lat: found 4000000",
        "cut.json: 1 fault\n",
        "plan.json: a plan document, which `searoom verify` checks, left out",
        "cases[1].targets[0].course_deg: found 999",
        "more than 16 MiB",
    ] {
        assert!(said.contains(part), "{part}: {said}");
    }
    let written = ["a__head-on.json", "b__dnv.json", "g__imazu-01.json"];
    assert_eq!(folder.names("plans.out"), written);
}

#[test]
fn options_say_what_foreign_files_do_not() {
    let folder = Folder::new();
    let file = folder.write("dnv.json", DNV);
    let of = |options: &str| json(&format!("plan {file} --json {options}"));
    let usual = of("");
    assert_eq!(usual["own_ship"]["safety_margin_m"], 122.0);
    assert_eq!(usual["targets"][0]["ship"]["speed_spread_mps"], 0.5);
    let asked = of("--margin-m 300 --speed-spread-mps 0.25 --course-spread-deg 3");
    assert_eq!(asked["own_ship"]["safety_margin_m"], 300.0);
    assert_eq!(asked["targets"][0]["ship"]["speed_spread_mps"], 0.25);
    let spread = number(&asked["targets"][0]["ship"]["course_spread_deg"]);
    assert!((spread - 3.0).abs() < 1e-9);
    searoom(&["plan", &file, "--speed-spread-mps=-1"])
        .code(2)
        .stderr(contains("allowed: a number from 0 to 100"));
}

#[test]
fn one_plan_is_of_one_situation() {
    searoom(&["plan", "scenarios/imazu/imazu.json"])
        .code(2)
        .stderr(contains("22 situations; `searoom suite` runs them"));
    searoom(&["check", "scenarios/imazu/imazu.json", "--variants"])
        .success()
        .stdout(contains("imazu.json: imazu-12-mixed: ok"))
        .stderr(contains(
            "own ship, target 1, target 2, target 3: no size in the file, 100 × 20 m taken",
        ));
}

#[test]
fn a_format_is_told_by_what_is_in_the_file() {
    let folder = Folder::new();
    let dnv = folder.write("named.toml", DNV);
    let toml = folder.write("named.json", HEAD_ON);
    searoom(&["check", &dnv, &toml]).success();
}

/// Every command reads every format.
#[test]
fn foreign_files_are_compared_and_assessed() {
    let folder = Folder::new();
    folder.write("a.toml", HEAD_ON);
    folder.write("b.json", DNV);
    let asked = "--planner space-time --search a-star --margin-m 300 --json";
    let compared = json(&format!("compare {folder} {asked}"));
    let compared = list(&compared["comparisons"]).iter();
    let titles: Vec<&Value> = compared.map(|c| &c["scenario"]).collect();
    assert_eq!(titles, ["Head-on", "HO"]);
    run(&format!("assess {folder}/b.json --margin-m 300"))
        .success()
        .stdout(contains("HO: 1 target"));
    run("assess scenarios/imazu/imazu.json")
        .code(2)
        .stderr(contains("22 situations; `searoom suite` runs them"));
}

/// An imported file and its original give equal documents, except for file name, clock and notes.
#[test]
fn imported_files_run_as_their_originals() {
    let folder = Folder::new();
    let out = folder.at("scenarios");
    let sources = ["scenarios/imazu/imazu.json", "scenarios/commonocean"];
    let options = ["--safety-margin-m", "300", "--course-spread-deg", "3"];
    let assert = searoom(&[&["import"], &sources[..], &options, &["--out", &out]].concat());
    assert.success().stdout(contains("imazu-22.toml"));
    let head = fs::read_to_string(format!("{out}/imazu-05.toml")).expect("there");
    let said = "# own ship, target 1, target 2: no size in the file";
    assert!(head.starts_with(said), "{head}");
    let bare = |args: &[&str]| {
        let mut suite = untimed(document(&searoom(args)));
        let mut runs = suite["runs"].as_array_mut().expect("runs").clone();
        for run in runs.iter_mut().filter_map(Value::as_object_mut) {
            run.retain(|key, _| key != "file" && key != "notes");
        }
        runs.sort_by_key(|run| run["scenario"].to_string());
        runs
    };
    let original = bare(&[&["suite", "--json"], &sources[..], &options].concat());
    let again = bare(&["suite", "--json", &out]);
    assert_eq!(original.len(), 24);
    assert_eq!(original, again);
    // a scenario file is left out, and an unreadable file is reported
    run(&format!("import {out} no.json --out {folder}"))
        .code(2)
        .stderr(contains("imazu-01.toml: a scenario file already, left out"))
        .stderr(contains("no.json: cannot be read"));
}

fn lint(path: &str) -> Value {
    document(&searoom(&["suite", "--lint", "--json", path]).success())
}

fn findings(document: &Value, scenario: &str) -> Vec<String> {
    let all = list(&document["scenarios"]);
    let one = all.iter().find(|s| s["scenario"] == scenario);
    let findings = list(&one.expect("there")["findings"]).iter();
    findings
        .map(|f| f.as_str().expect("a text").to_owned())
        .collect()
}

#[test]
fn a_lint_says_what_is_odd_about_the_published_cases() {
    let imazu = lint("scenarios/imazu/imazu.json");
    assert_eq!(imazu["summary"]["scenarios"], 22);
    assert_eq!(imazu["summary"]["targets"], 50);
    let missing = "ships are missing: 3 declared, 2 found";
    assert_eq!(findings(&imazu, "imazu-12")[0], missing);
    // six times the ship ahead comes to where own ship has arrived
    assert_eq!(imazu["summary"]["findings"], 7);
    let ahead = "target 1: meets own ship at 4348 s where it lies";
    for case in ["03", "07", "15", "17", "20", "22"] {
        let found = findings(&imazu, &format!("imazu-{case}"));
        assert!(found.len() == 1 && found[0].starts_with(ahead), "{found:?}");
    }
    for scenario in list(&imazu["scenarios"]) {
        for target in list(&scenario["targets"]) {
            let [dcpa, tcpa] =
                ["undisturbed_dcpa_m", "undisturbed_tcpa_s"].map(|k| number(&target[k]));
            assert!(dcpa <= 0.0 && (1700.0..1900.0).contains(&tcpa), "{target}");
            assert_eq!(target["matters"], "meets");
        }
    }
    let dnv = lint("scenarios/dnv");
    assert_eq!(dnv["summary"]["targets"], 71);
    for scenario in list(&dnv["scenarios"]) {
        for finding in list(&scenario["findings"]) {
            let finding = finding.as_str().expect("a text");
            let odd = finding.contains("missing") || finding.contains("mirrored?");
            assert!(!odd, "{finding}");
        }
    }
}

#[test]
fn a_lint_finds_mirrors_missing_ships_and_ships_that_never_matter() {
    let folder = Folder::new();
    let crossing = include_str!("../../scenarios/dnv/traffic_situation_03.json");
    folder.write("a.json", crossing);
    // port and starboard exchanged about own ship's meridian
    let mut mirror: Value = serde_json::from_str(crossing).expect("JSON");
    for place in mirror["targetShips"][0]["waypoints"]
        .as_array_mut()
        .expect("a list")
    {
        let lon = number(&place["position"]["lon"]);
        place["position"]["lon"] = (2.0 * 10.490654 - lon).into();
    }
    let heading = number(&mirror["targetShips"][0]["initial"]["heading"]);
    mirror["targetShips"][0]["initial"]["heading"] = (360.0 - heading).into();
    mirror["title"] = "CR-SO, HO".into();
    folder.write("b.json", mirror.to_string());
    let far = HEAD_ON.replace(
        "east_m = 1500.0, north_m = 0.0 }\ncourse",
        "east_m = 90000.0, north_m = 0.0 }\ncourse",
    );
    assert_ne!(far, HEAD_ON);
    folder.write("c.toml", far);
    folder.write("d.json", "{\"ownShip\": {}}");
    let assert = searoom(&["suite", "--lint", "--json", text(folder.path())]).code(2);
    let found = document(&assert);
    let said = findings(&found, "CR-SO, HO");
    assert_eq!(said[0], "ships are missing: 2 declared, 1 found");
    let mirrored = "declared to port, found to starboard: mirrored?";
    assert!(said[1].ends_with(mirrored), "{said:?}");
    let never = "never matters, out of reach within the horizon";
    assert!(findings(&found, "Head-on")[0].ends_with(never));
    assert_eq!(found["summary"]["unreadable"], 1);
    searoom(&["suite", "--lint", text(folder.path())])
        .code(2)
        .stdout(contains(
            "CR-SO, HO: ships are missing: 2 declared, 1 found",
        ))
        .stdout(contains("4 scenarios, 3 targets"));
    searoom(&["suite", "--lint", "--plans", "x", "scenarios"]).code(2);
}
