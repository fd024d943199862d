//! Recordings, written and read by the default features alone.

use std::fs;

use super::docs::documents;
use super::program::{
    Folder, HEAD_ON, document, json, list, number, run, says, searoom, stderr, stdout, text,
};
use predicates::prelude::PredicateBooleanExt;
use predicates::str::{contains, is_empty};
use serde_json::Value;
use std::path::PathBuf;

const HEAD_ON_FILE: &str = "scenarios/colregs/head-on.toml";
const GIVE_WAY: &str = "scenarios/colregs/give-way.toml";

fn recorded(folder: &Folder, name: &str, scenario: &str) -> (String, String) {
    let file = folder.at(name);
    let plan = searoom(&["plan", scenario, "--json", "--rrd", &file]).success();
    (file, stdout(&plan))
}

#[test]
fn a_recording_gives_back_what_it_was_made_from() {
    let folder = Folder::new();
    let (file, plan) = recorded(&folder, "head-on.rrd", HEAD_ON_FILE);
    searoom(&["verify", &file])
        .success()
        .stdout(contains(": verified"));
    let said = stdout(&searoom(&["inspect", &file]).success());
    says(
        &said,
        "Head-on: solved (verified, safe) | space-time, by the rules | 'target': own ship is head-on | sim_time 0 to 300 s | /curves/clearance_m",
    );
    let found = document(&searoom(&["inspect", "--json", &file]).success());
    let plan: Value = serde_json::from_str(&plan).expect("a plan");
    for key in ["scenario", "cost"] {
        assert_eq!(found[key], plan[key]);
    }
    let last = number(&found["timelines"][0]["last"]);
    let arrival = number(&plan["cost"]["duration_s"]);
    assert!((last - arrival).abs() < 1e-6, "{last} {arrival}");
}

/// Roles over time, scores, every broken rule with its moment, and how long a ship that stands
/// on holds.
#[test]
fn inspect_tells_what_the_rules_say() {
    let folder = Folder::new();
    let file = folder.at("rules.rrd");
    let plan = |compliance: &str| {
        let asked = format!("plan scenarios/colregs/stand-on.toml --compliance {compliance}");
        run(&format!("{asked} --rrd {file}")).success();
        let said = stdout(&run(&format!("inspect {file}")).success());
        let lanes = run(&format!("inspect --csv roles {file}")).success();
        [said, stdout(&lanes)]
    };
    let [said, lanes] = plan("shape");
    says(
        &said,
        "stand-on from 0 to | breaks 17(c) at | scores: rule 17 ",
    );
    says(
        &lanes,
        "stand-on: own ship to target | 17(c) broken by own ship toward target",
    );
    let [said, lanes] = plan("rules");
    says(&said, "stands on    course and speed are held until ");
    says(
        &lanes,
        "own ship holds course and speed | own ship escapes: ",
    );
    let whole = json(&format!("inspect --json {file}"));
    assert!(whole["escape"]["held_until_s"].is_f64(), "{whole}");
}

/// The recording contains the key that `--no-return` adds to the document.
#[test]
fn the_time_of_no_return_is_recorded() {
    let folder = Folder::new();
    let file = folder.at("a.rrd");
    let scenario = "scenarios/colregs/give-way.toml";
    let asked = ["plan", scenario, "--no-return", "--json", "--rrd", &file];
    let plan = stdout(&searoom(&asked).success());
    says(&plan, "\"time_of_no_return_s\": ");
    let back = searoom(&["inspect", "--plan", &file]).success();
    assert_eq!(stdout(&back), plan);
    // times are shown to the millisecond
    let said = stdout(&searoom(&["inspect", &file]).success());
    let times = said.lines().find(|line| line.starts_with("Timelines: "));
    let words = times.expect("a line").split(' ');
    let mut decimals = words.filter_map(|word| word.split_once('.'));
    assert!(decimals.all(|(_, digits)| digits.len() <= 3), "{said}");
}

/// Largest recording with its document, bytes.
const MOST: u64 = 2_000_000;

#[test]
fn recordings_of_the_scenarios_are_small() {
    let folder = Folder::new();
    let all = fs::read_dir("scenarios").expect("a folder").flatten();
    let folders = all.map(|entry| entry.path()).filter(|path| path.is_dir());
    let files = folders.flat_map(|path| fs::read_dir(path).expect("a folder").flatten());
    let is_ours = |path: &PathBuf| path.extension().is_some_and(|e| e == "toml");
    let scenarios: Vec<PathBuf> = files.map(|e| e.path()).filter(is_ours).collect();
    assert!(scenarios.len() >= 15, "{scenarios:?}");
    for scenario in scenarios {
        let (file, plan) = recorded(&folder, "a.rrd", text(&scenario));
        let size = fs::metadata(&file).expect("written").len();
        assert!(size < MOST, "{}: {size} bytes", scenario.display());
        let back = searoom(&["inspect", "--plan", &file]).success();
        assert_eq!(stdout(&back), plan, "{}", scenario.display());
    }
}

#[test]
fn curves_and_lines_come_out_as_columns() {
    let folder = Folder::new();
    let (file, plan) = recorded(&folder, "a.rrd", HEAD_ON_FILE);
    let curve = stdout(&searoom(&["inspect", "--csv", "curves/clearance_m", &file]).success());
    let mut lines = curve.lines();
    assert_eq!(lines.next(), Some("sim_time_s,target,safety margin"));
    let row = |line: &str| {
        line.split(',')
            .map(|c| c.parse().expect("a number"))
            .collect()
    };
    let rows: Vec<Vec<f64>> = lines.map(row).collect();
    assert!(rows.len() > 20 && rows.is_sorted_by(|a, b| a[0] <= b[0]));
    assert!(rows.iter().all(|row| row.len() == 3 && row[2] == 20.0));
    // The curve is sampled: it never goes below the plan's least distance, and comes near it.
    let least = rows.iter().map(|row| row[1]).fold(f64::INFINITY, f64::min);
    let plan: Value = serde_json::from_str(&plan).expect("a plan document");
    let dcpa_m = number(&plan["encounters"][0]["dcpa_m"]);
    assert!((-1e-6..0.5).contains(&(least - dcpa_m)), "{least} {dcpa_m}");
    let line = stdout(&searoom(&["inspect", "--csv", "/chart/map/planned", &file]).success());
    assert!(line.starts_with("colors,radii,strips\n"), "{line}");
    says(&line, "[[[0.0,0.0],");
    searoom(&["inspect", "--csv", "curves/clearence", &file])
        .code(2)
        .stderr(contains(
            "no entity /curves/clearence; the nearest names: /curves/clearance_m",
        ));
}

#[test]
fn a_comparison_is_recorded_scenario_by_scenario_and_read_again() {
    let folder = Folder::new();
    let recordings = folder.at("new");
    let asked = "compare scenarios/colregs --search a-star --json --rrd";
    let document = json(&format!("{asked} {recordings}"));
    assert_eq!(folder.names("new").len(), 4);
    let file = format!("{recordings}/head-on.rrd");
    let contents = json(&format!("inspect {file} --json"));
    let read = list(&contents["comparison"]["entries"]);
    let written = list(&document["comparisons"][1]["entries"]);
    assert_eq!(read.len(), written.len());
    for (read, written) in read.iter().zip(written) {
        for key in "method outcome verdict search_stats verified safe".split(' ') {
            assert_eq!(read[key], written[key], "{key}");
        }
        assert_eq!(read["timing"].is_null(), written["timing"].is_null());
        assert!(read["timing"].is_null() || read["timing"]["plan_s"].is_number());
    }
    searoom(&["inspect", &file])
        .success()
        .stdout(contains("Head-on"))
        .stdout(contains("hold course").and(contains("COLLIDES")));
    searoom(&["inspect", "--plan", &file])
        .code(2)
        .stderr(contains("the recording of a comparison"));
    searoom(&["verify", &file])
        .code(2)
        .stderr(contains("`searoom inspect --json` prints its own"));
    searoom(&["compare", "scenarios/colregs", "--rrd", &file])
        .code(2)
        .stderr(contains("name a folder"));
}

#[test]
fn what_is_no_whole_recording_is_said_to_be_so() {
    let folder = Folder::new();
    let (file, _) = recorded(&folder, "a.rrd", HEAD_ON_FILE);
    let bytes = fs::read(&file).expect("a recording");
    let broken = folder.at("b.rrd");
    let refused = |contents: &[u8], expected: &str| {
        fs::write(&broken, contents).expect("written");
        for command in ["inspect", "verify"] {
            searoom(&[command, &broken])
                .code(2)
                .stdout(is_empty())
                .stderr(contains(expected).and(contains("panicked").not()));
        }
    };
    refused(b"", "an empty file");
    refused(b"a text", "no Rerun recording");
    let cut_or_changed = "its checksum is missing or wrong";
    for part in 1..8 {
        let at = bytes.len() * part / 8;
        refused(&bytes[..at], cut_or_changed);
        let mut damaged = bytes.clone();
        damaged[at] ^= 0x55;
        refused(&damaged, cut_or_changed);
    }
    // a second one behind the first
    let (other, _) = recorded(&folder, "c.rrd", GIVE_WAY);
    let other = fs::read(other).expect("a recording");
    refused(&[&bytes[..], &other].concat(), cut_or_changed);
    searoom(&["inspect", "no-such.rrd"]).code(2).stderr(
        contains("No such file")
            .count(1)
            .and(contains("no-such.rrd: cannot be read")),
    );
}

/// As `rerun rrd filter` writes it: the messages of the recording alone, in other bytes.
#[test]
fn a_recording_that_another_program_wrote_again_is_read_with_a_note() {
    use rerun::external::re_log_encoding::{DecoderApp, Encoder};
    let folder = Folder::new();
    let (file, plan) = recorded(&folder, "a.rrd", HEAD_ON_FILE);
    let said = stdout(&searoom(&["inspect", &file]).success());
    says(&said, "checksum valid");
    assert_eq!(json(&format!("inspect --json {file}"))["checksum"], "valid");
    let bytes = fs::read(&file).expect("a recording");
    let messages = DecoderApp::decode_eager(&bytes[..]).expect("decodes");
    let messages = messages.map(|message| message.expect("decodes"));
    let kept = messages.filter(|message| message.store_id().is_recording());
    let again = folder.at("again.rrd");
    fs::write(&again, Encoder::encode(kept.map(Ok)).expect("encodes")).expect("written");
    let note = "its checksum is gone";
    let inspected = searoom(&["inspect", &again])
        .success()
        .stderr(contains(note));
    says(&stdout(&inspected), "checksum gone | Head-on: solved");
    assert_eq!(json(&format!("inspect --json {again}"))["checksum"], "gone");
    let printed = searoom(&["inspect", "--plan", &again]).success();
    assert_eq!(stdout(&printed.stderr(contains(note))), plan);
    let verified = searoom(&["verify", &again])
        .success()
        .stderr(contains(note));
    says(&stdout(&verified), "Head-on: verified, safe");
    let whole = searoom(&["verify", &file]).success();
    whole.stderr(is_empty());
}

#[test]
fn recordings_are_named_after_their_scenarios() {
    let folder = Folder::new();
    // the parent of the folder named is where names begin
    folder.write("scenes/colregs/head-on.toml", HEAD_ON);
    let below = folder.at("scenes");
    searoom(&["suite", &below, "--rrd", text(folder.path())]).success();
    let recording = folder.path().join("colregs__head-on.rrd");
    assert!(fs::metadata(recording).expect("a recording").len() > 1000);
    let file = folder.at("one.rrd");
    run(&format!("plan scenarios/colregs/head-on.toml --rrd {file}")).success();
    assert!(fs::metadata(&file).expect("a recording").is_file());
    searoom(&["suite", "scenarios/colregs", "--rrd", &file])
        .code(2)
        .stderr(contains("4 scenarios"));
}

/// The note says how a recording is opened, and with which viewer: that of the library here.
#[test]
fn it_is_said_how_a_recording_is_opened() {
    let folder = Folder::new();
    let manifest = include_str!("../../Cargo.toml");
    let version = manifest.split("rerun = { version = \"").nth(1);
    let version = version
        .and_then(|rest| rest.split('"').next())
        .expect("a version");
    let viewer = format!("(Rerun {version} or later: pip install rerun-sdk)");
    let all = run(&format!("suite scenarios/colregs --rrd {folder}"));
    let first = folder.at("give-way.rrd");
    all.stderr(contains(format!(
        "wrote {folder}; to open one: rerun {first} {viewer}"
    )));
    let one = run(&format!(
        "plan scenarios/colregs/head-on.toml --rrd {first}"
    ));
    one.stderr(contains(format!(
        "wrote {first}; to open it: rerun {first} {viewer}"
    )));
}

#[test]
fn a_recording_tells_what_simulate_tells() {
    let folder = Folder::new();
    let file = folder.at("sailed.rrd");
    let sailed = stdout(&searoom(&["simulate", HEAD_ON_FILE, "--rrd", &file]).success());
    let inspected = stdout(&searoom(&["inspect", &file]).success());
    assert!(inspected.contains(sailed.trim_end()), "{inspected}");
    let found = document(&searoom(&["inspect", "--json", &file]).success());
    assert_eq!(found["scenario"], "Head-on");
    assert_eq!(found["simulation"]["format"], "searoom-simulation/1");
    for command in [&["inspect", "--plan", &file][..], &["verify", &file]] {
        let refused = stderr(&searoom(command).code(2));
        says(&refused, "the recording of a simulation");
    }
    searoom(&["simulate", "scenarios/colregs", "--rrd", &file])
        .code(2)
        .stderr(contains("4 scenarios; name a folder"));
}

#[test]
fn every_key_of_a_recording_is_on_the_page() {
    let folder = Folder::new();
    let file = folder.path().join("a.rrd");
    let file = file.to_str().expect("text");
    searoom(&["plan", "scenarios/colregs/head-on.toml", "--rrd", file]).success();
    documents::named(
        documents::PAGE,
        &documents::keys_of(&["inspect", "--json", file]),
    );
}
