//! `searoom campaign` as a user runs it: shards, damage, bounds, replay.

use std::fs;
use std::path::Path;

use searoom::campaign::{COLUMNS, Cell, Part, untimed};

use crate::program::{Folder, command, document, json, run, says, searoom, stderr, stdout};

const ROWS: u64 = 40;

/// Two classes, of which one is seen by a sensor with noise, and a scenario.
pub const SPECIFICATION: &str = r#"
name = "small"
seed = 5
rows = 40
horizon_s = 600
path_length_m = 1500

[own_ship]
speed_mps = 5
length_m = 30
beam_m = 8
turning_radius_m = 100
speeds_mps = [2.5, 5, 6]
safety_margin_m = 20

[simulation]
duration_s = 200

[[strata]]
name = "crossing"
class = "give-way"
share = 2
tcpa_s = { from = 110, to = 150 }
cpa_m = 10
behaviour = { kind = "extremes", factor = 1.5 }

[[strata]]
name = "seen by AIS"
class = "head-on"
speed_mps = 6
simulation = { duration_s = 100, sensor = { kind = "ais" } }

[[strata]]
name = "a file"
scenario = "head-on.toml"
simulation = { duration_s = 60, sensor = { kind = "radar" } }
"#;

fn folder() -> Folder {
    let folder = Folder::new();
    folder.write("spec.toml", SPECIFICATION);
    folder.write("head-on.toml", crate::program::HEAD_ON);
    folder
}

/// Sails shards of the specification into a folder below.
fn sail(folder: &Folder, out: &str, shards: u64, threads: u64) {
    for shard in 1..=shards {
        run(&format!(
            "campaign run {folder}/spec.toml --shard {shard}/{shards} --threads {threads} \
             --out {folder}/{out} --quiet"
        ))
        .success();
    }
}

fn parts(folder: &Folder, out: &str) -> Vec<Part> {
    let names = folder.names(&format!("{out}/parts"));
    let files = names.iter().filter(|name| name.ends_with(".parquet"));
    let read = |name: &String| {
        let file = folder.path().join(out).join("parts").join(name);
        Part::read(&file).expect("a whole part")
    };
    files.map(read).collect()
}

/// Every cell that does not depend on the machine, to the last bit.
fn rows(folder: &Folder, out: &str) -> Vec<String> {
    let parts = parts(folder, out);
    let rows = parts.iter().flat_map(|part| &part.rows);
    let exact = |cell: &Cell| match cell {
        Cell::Number(number) => format!("{:?}", number.map(f64::to_bits)),
        other => format!("{other:?}"),
    };
    rows.map(|row| untimed(row).iter().map(exact).collect())
        .collect()
}

fn column(name: &str) -> usize {
    let found = COLUMNS.iter().position(|column| column.name == name);
    found.expect(name)
}

#[test]
fn rows_and_figures_are_the_same_for_any_number_of_shards_and_threads() {
    let folder = folder();
    let mut all = Vec::new();
    for (out, shards, threads) in [("one", 1, 2), ("seven", 7, 1), ("many", 64, 1)] {
        sail(&folder, out, shards, threads);
        let mut summary = json(&format!("campaign summarise {folder}/{out} --json"));
        // the sum depends on the order
        summary = crate::program::untimed(summary);
        run(&format!("campaign merge {folder}/{out}")).success();
        all.push((rows(&folder, out), summary));
        assert!(folder.path().join(out).join("campaign.parquet").is_file());
    }
    let (first, others) = all.split_first().expect("several");
    assert_eq!(first.0.len() as u64, ROWS);
    assert!(others.iter().all(|other| other == first));
    // strata take turns, and rows differ
    let parts = parts(&folder, "one");
    let strata = ["crossing", "crossing", "seen by AIS", "a file"];
    for (row, stratum) in parts[0].rows.iter().zip(strata.iter().cycle()) {
        assert_eq!(row[1], Cell::Word(Some((*stratum).to_owned())));
        assert_eq!(
            row[column("outcome")],
            Cell::Word(Some("sailed".to_owned()))
        );
    }
    let clearances: Vec<&Cell> = (parts[0].rows.iter().step_by(4))
        .map(|row| &row[column("clearance_m")])
        .collect();
    assert!(clearances.windows(2).all(|pair| pair[0] != pair[1]));
    // what was asked for
    for row in parts[0].rows.iter().step_by(4) {
        let number = |name| match row[column(name)] {
            Cell::Number(Some(number)) => number,
            _ => panic!("{name}"),
        };
        assert!((110.0 - 1e-6..=150.0 + 1e-6).contains(&number("tcpa_s")));
        assert!((number("dcpa_m") - 10.0).abs() < 1e-6);
        assert!((5.9..=112.6).contains(&number("bearing_deg")));
        assert!(number("duration_s") <= 200.0);
    }
    let outside = parts[0]
        .rows
        .iter()
        .step_by(4)
        .map(|row| &row[column("outside_sets")]);
    let left = outside
        .filter(|cell| **cell != Cell::Count(Some(0)))
        .count();
    assert!(left > 5, "a factor of 1.5 leaves the sets: {left}");
}

/// A specification beside scenarios is no scenario with faults.
#[test]
fn a_specification_in_a_folder_is_left_out_by_check() {
    let folder = folder();
    let checked = run(&format!("check {folder}")).success();
    says(&stdout(&checked), "head-on.toml: ok");
    says(
        &stderr(&checked),
        "spec.toml: the specification of a campaign, which `searoom campaign run` reads, left out",
    );
    let alone = run(&format!("check {folder}/spec.toml")).code(2);
    says(
        &stderr(&alone),
        "`searoom campaign run` reads; no scenario in it",
    );
}

#[test]
fn what_is_damaged_or_missing_is_sailed_again_and_nothing_else() {
    let folder = folder();
    sail(&folder, "whole", 1, 2);
    sail(&folder, "hurt", 4, 2);
    let run_hurt = || {
        run(&format!(
            "campaign run {folder}/spec.toml --out {folder}/hurt"
        ))
    };
    let names = folder.names("hurt/parts");
    assert_eq!(names.len(), 4);
    says(
        &stdout(&run_hurt().success()),
        "small, shard 1/1: 0 rows sailed, 40 were there",
    );
    let part = |index: usize| folder.path().join("hurt/parts").join(&names[index]);
    // killed in the middle of a write, by which the name was not changed yet
    let bytes = fs::read(part(0)).expect("there");
    let left_over = folder.write("hurt/parts/.searoom-killed", &bytes[..bytes.len() / 2]);
    fs::remove_file(part(0)).expect("removed");
    // cut short on a disk that lost its end, and altered in a page of values
    fs::write(part(1), &bytes[..bytes.len() / 2]).expect("cut");
    let mut altered = fs::read(part(2)).expect("there");
    let middle = altered.len() / 3;
    altered[middle] ^= 0x10;
    fs::write(part(2), altered).expect("altered");
    let refused = stderr(&run(&format!("campaign merge {folder}/hurt")).code(2));
    says(
        &refused,
        "2 faults | not a whole Parquet file | `campaign run` sails its rows again",
    );
    let again = run_hurt().success();
    says(&stdout(&again), "30 rows sailed, 10 were there");
    says(&stderr(&again), "its rows are sailed again");
    assert!(!Path::new(&left_over).exists());
    let aside = folder.names("hurt/parts");
    assert_eq!(aside.iter().filter(|n| n.ends_with(".damaged")).count(), 2);
    assert_eq!(rows(&folder, "hurt"), rows(&folder, "whole"));
    run(&format!("campaign merge {folder}/hurt")).success();
}

/// Every byte of a part counts: a change is found, or changes no row.
#[test]
fn an_altered_byte_is_found_or_changes_nothing() {
    let folder = folder();
    sail(&folder, "one", 1, 2);
    let name = &folder.names("one/parts")[0];
    let file = folder.path().join("one/parts").join(name);
    let whole = Part::read(&file).expect("whole");
    let bytes = fs::read(&file).expect("there");
    let hurt = folder.path().join("hurt.parquet");
    let mut found = 0;
    for at in (0..bytes.len()).step_by(97) {
        let mut altered = bytes.clone();
        altered[at] ^= 0x04;
        fs::write(&hurt, &altered).expect("written");
        match Part::read(&hurt) {
            Ok(part) => assert_eq!(part, whole, "byte {at}"),
            Err(_) => found += 1,
        }
    }
    assert!(found > bytes.len() / 97 / 4, "{found}");
}

#[test]
fn foreign_missing_and_double_rows_are_named() {
    let folder = folder();
    sail(&folder, "out", 4, 2);
    let merge = format!("campaign merge {folder}/out");
    let said = |code| stderr(&run(&merge).code(code));
    let names = folder.names("out/parts");
    let part = |name: &str| folder.path().join("out/parts").join(name);
    // missing
    let kept = fs::read(part(&names[1])).expect("there");
    fs::remove_file(part(&names[1])).expect("removed");
    says(&said(2), "found no rows 10 to 19 | every row once");
    let summary = json(&format!("campaign summarise {folder}/out --json"));
    assert_eq!(summary["rows_there"], 30);
    fs::write(part(&names[1]), kept).expect("put back");
    // double
    let mut double = Part::read(&part(&names[0])).expect("whole");
    double.rows.truncate(3);
    double.header.rows.end = 3;
    let file = part("rows-twice.parquet");
    double.write(&file, "1/1").expect("written");
    says(
        &said(2),
        "rows 0 to 2 in | and in | every row once; delete one",
    );
    let sail = format!("campaign run {folder}/spec.toml --out {folder}/out");
    says(
        &stderr(&run(&sail).code(2)),
        "rows 0 to 2 in | and in | every row once; delete one",
    );
    fs::remove_file(&file).expect("removed");
    // of another build of the same version
    let mut other = Part::read(&part(&names[2])).expect("whole");
    let version = format!("{}+", env!("CARGO_PKG_VERSION"));
    assert!(other.header.build.starts_with(&version));
    let build = std::mem::replace(&mut other.header.build, format!("{version}0123"));
    let of_other = format!("rows of searoom {version}0123");
    other.write(&part(&names[2]), "1/1").expect("written");
    says(&said(2), &format!("{of_other} | --allow-other-builds"));
    says(&stderr(&run(&sail).code(2)), &of_other);
    run(&format!("{merge} --allow-other-builds")).success();
    // of another specification
    other.header.build = build;
    other.header.hash = "0123456789abcdef".to_owned();
    other.write(&part(&names[2]), "1/1").expect("written");
    says(&said(2), "rows of the specification 0123456789ab");
    // a changed specification does not go on in the folder of the old one
    folder.write("spec.toml", SPECIFICATION.replace("seed = 5", "seed = 6"));
    says(
        &stderr(&run(&sail).code(2)),
        "campaign.json | the campaign \"small\" of the specification | another folder for --out",
    );
    let nothing = stderr(&run(&format!("campaign merge {folder}/nothing")).code(2));
    // the text of a cause is not said twice
    assert_eq!(nothing.matches("os error 2").count(), 1, "{nothing}");
}

#[test]
fn a_changed_index_is_refused() {
    let folder = folder();
    sail(&folder, "out", 1, 20);
    let file = folder.path().join("out/campaign.json");
    let whole = fs::read_to_string(&file).expect("an index");
    run(&format!("campaign summarise {folder}/out")).success();
    let index: serde_json::Value = serde_json::from_str(&whole).expect("JSON");
    let text = index["specification"].as_str().expect("text").to_owned();
    for (key, value) in [
        ("hash", "0123456789abcdef".into()),
        ("specification", text.replace("seed = 5", "seed = 6").into()),
        ("rows", 41.into()),
    ] {
        let mut changed = index.clone();
        changed[key] = value;
        fs::write(&file, changed.to_string()).expect("written");
        for command in ["summarise", "merge", "replay --row 0"] {
            let (name, options) = command.split_once(' ').unwrap_or((command, ""));
            let refused = run(format!("campaign {name} {folder}/out {options}").trim()).code(2);
            says(
                &stderr(&refused),
                "campaign.json: 1 fault | that has changed since the campaign began | allowed: \
                 the index of | put it back",
            );
        }
    }
    // a folder of an earlier version has no digest: the specification in it is compared
    let mut old = index;
    let keys = old.as_object_mut().expect("an object");
    keys.remove("digest");
    fs::write(&file, old.to_string()).expect("written");
    run(&format!("campaign summarise {folder}/out")).success();
    let mut strata = old["strata"].clone();
    strata[0][1] = "overtaken".into();
    for digest in [None, Some(serde_json::Value::Null)] {
        if let Some(digest) = digest {
            old["digest"] = digest;
        }
        for (key, value, said) in [
            (
                "hash",
                "0123456789abcdef".into(),
                "that have changed since the campaign",
            ),
            (
                "specification",
                text.replace("seed = 5", "seed = 6").into(),
                "that have changed since the campaign",
            ),
            (
                "name",
                "other".into(),
                "no digest, and `name` | put it back",
            ),
            ("rows", 41.into(), "no digest, and `rows` | put it back"),
            (
                "strata",
                strata.clone(),
                "no digest, and `strata` | put it back",
            ),
        ] {
            let mut changed = old.clone();
            changed[key] = value;
            fs::write(&file, changed.to_string()).expect("written");
            let refused = run(&format!("campaign summarise {folder}/out")).code(2);
            says(&stderr(&refused), said);
        }
    }
    old["strata"][0][1] = "sideways".into();
    fs::write(&file, old.to_string()).expect("written");
    let refused = run(&format!("campaign summarise {folder}/out")).code(2);
    let said = "found 'sideways'; allowed: head-on, give-way, stand-on | overtaken, scenario";
    says(&stderr(&refused), said);
}

#[test]
fn a_replayed_row_has_the_numbers_of_its_part() {
    let folder = folder();
    sail(&folder, "out", 1, 2);
    let parts = parts(&folder, "out");
    for row in 0..4 {
        let file = folder.at("row.json");
        let again = command(&["campaign", "replay", &folder.at("out"), "--json", &file])
            .args(["--row", &row.to_string()])
            .assert();
        says(
            &stderr(&again),
            &format!("row {row} is as it was in the campaign"),
        );
        let text = fs::read_to_string(&file).expect("written");
        let sailed: serde_json::Value = serde_json::from_str(&text).expect("a document");
        let kept = &parts[0].rows[row];
        let is = |name: &str, value: &serde_json::Value| {
            let same = match &kept[column(name)] {
                Cell::Count(count) => count.map(|c| c as f64) == value.as_f64(),
                Cell::Number(number) => *number == value.as_f64(),
                Cell::Truth(truth) => *truth == value.as_bool(),
                Cell::Word(word) => word.as_deref() == value.as_str(),
            };
            assert!(same, "{name}: {:?} {value}", kept[column(name)]);
        };
        is("contact", &sailed["contact"]);
        is("clearance_m", &sailed["targets"][0]["least_clearance_m"]);
        is("sailed_cost_m2", &sailed["conduct"]["cost_m2"]);
        is("turns", &sailed["conduct"]["turns"]);
        is("seed", &sailed["settings"]["seed"]);
        is("outside_sets", &sailed["targets"][0]["outside_sets"]);
    }
    // a row that is not as it was
    let name = &folder.names("out/parts")[0];
    let file = folder.path().join("out/parts").join(name);
    let mut other = Part::read(&file).expect("whole");
    other.rows[2][column("turns")] = Cell::Count(Some(77));
    other.write(&file, "1/1").expect("written");
    let replay = |row: &str| run(&format!("campaign replay {folder}/out --row {row}"));
    let differs = stderr(&replay("2").code(3));
    says(&differs, "row 2 is not as it was in the campaign | : turns");
    says(
        &stderr(&replay("40").code(2)),
        "--row: found 40; allowed: a row from 0 to 39",
    );
    // what the specification names has changed
    let changed = crate::program::HEAD_ON.replace("speed_mps = 5.0", "speed_mps = 5.5");
    folder.write("head-on.toml", changed);
    says(
        &stderr(&replay("2").code(2)),
        "that have changed since the campaign",
    );
}

/// The specification of the guide gives the summary that is printed there.
#[test]
fn the_summary_of_the_guide_is_what_the_program_prints() {
    let guide = include_str!("../../docs/guide/campaigns.md");
    let columns = include_str!("../../docs/reference/campaign-files.md");
    let block = |kind: &str| {
        let after = guide.split_once(&format!("```{kind}\n")).expect(kind).1;
        after.split_once("\n```").expect("an end").0
    };
    let folder = Folder::new();
    folder.write("spec.toml", block("toml"));
    let sail = format!("campaign run {folder}/spec.toml --shard 1/1000 --out {folder}/sailed");
    run(&sail).success();
    let shown = stdout(&run(&format!("campaign summarise {folder}/sailed")).success());
    let timeless = |text: &str| {
        let (first, rest) = text.split_once('\n').expect("lines");
        let first = first.rsplit_once(", ").expect("a time").0;
        format!("{first}\n{}", rest.trim_end())
    };
    assert_eq!(timeless(&shown), timeless(block("text")), "{shown}");
    // every column is explained
    for column in COLUMNS {
        assert!(
            columns.contains(&format!("`{}`", column.name)),
            "{}",
            column.name
        );
    }
}

/// A document that was altered or deleted, until `replay` writes it again, and a part with the name
/// of other rows.
#[test]
fn altered_documents_and_renamed_parts_are_refused() {
    let folder = folder();
    folder.write(
        "spec.toml",
        SPECIFICATION.replace("factor = 1.5", "factor = 8"),
    );
    sail(&folder, "out", 1, 2);
    let name = folder.names("out/rows").remove(0);
    let row = name.trim_matches(|c: char| !c.is_ascii_digit());
    let row: u64 = row.parse().expect("a number");
    let file = folder.path().join("out/rows").join(&name);
    let refused = |what: &str| {
        for command in ["merge", "summarise"] {
            let refused = run(&format!("campaign {command} {folder}/out")).code(2);
            says(&stderr(&refused), what);
        }
    };
    let replay = format!("campaign replay {folder}/out --row {row}");
    let kept = fs::read_to_string(&file).expect("a document");
    let mut altered: serde_json::Value = serde_json::from_str(&kept).expect("JSON");
    altered["conduct"]["cost_m2"] = 1.0.into();
    fs::write(&file, altered.to_string()).expect("written");
    refused("found another document | writes it again");
    says(&stderr(&run(&replay).code(3)), "found another document");
    fs::remove_file(&file).expect("removed");
    refused("found nothing | writes it again");
    run(&format!("{replay} --json {}", file.display()));
    run(&format!("campaign merge {folder}/out")).success();
    let parts = folder.path().join("out/parts");
    let part = &folder.names("out/parts")[0];
    let renamed = parts.join("rows-0000000100-0000000139.parquet");
    fs::rename(parts.join(part), renamed).expect("renamed");
    refused(&format!(
        "rows 0 to 39 in | rows-0000000100 | allowed: {part}"
    ));
    run(&format!(
        "campaign run {folder}/spec.toml --out {folder}/out"
    ))
    .code(2);
    let as_it_was = format!("row {row} is as it was in the campaign");
    says(&stderr(&run(&replay)), &as_it_was);
}

/// Rows that somebody has to look at leave their documents.
#[test]
fn documents_of_rows_with_a_fault_are_kept() {
    let folder = folder();
    let ram = SPECIFICATION.replace("factor = 1.5", "factor = 8");
    folder.write("spec.toml", ram);
    sail(&folder, "out", 1, 2);
    let parts = parts(&folder, "out");
    let yes = |row: &&Vec<Cell>, name: &str| match row[column(name)] {
        Cell::Truth(Some(truth)) => truth,
        Cell::Count(Some(count)) => count > 0,
        _ => false,
    };
    let looked_at: Vec<String> = (parts[0].rows.iter().enumerate())
        .filter(|(_, row)| {
            ["contact", "no_plan", "unsafe_plans", "broken", "late"]
                .iter()
                .any(|name| yes(row, name))
        })
        .map(|(row, _)| format!("row-{row:010}.json"))
        .collect();
    assert!(!looked_at.is_empty());
    assert_eq!(folder.names("out/rows"), looked_at);
    let summary = json(&format!("campaign summarise {folder}/out --json"));
    let sum = |name: &str| parts[0].rows.iter().filter(|row| yes(row, name)).count();
    assert_eq!(summary["all"]["rule_broken"]["count"], sum("broken"));
    assert_eq!(summary["all"]["contact"]["count"], sum("contact"));
    let outside = |row: &&Vec<Cell>| {
        let names = ["outside_velocities", "outside_places"];
        names.iter().any(|name| yes(row, name))
    };
    let outside = parts[0].rows.iter().filter(outside).count();
    assert!(outside > 0);
    assert_eq!(summary["all"]["measured_outside"]["count"], outside);
    let late = &summary["all"]["timing"]["late"];
    assert_eq!(late["count"], sum("late"));
    assert_eq!(summary["strata"][0]["rows"], 20);
    assert_eq!(summary["classes"][2]["name"], "scenario");
    let text = stdout(&run(&format!("campaign summarise {folder}/out")).success());
    says(
        &text,
        "small: 40 of 40 rows | crossing | seen by AIS | anytime | Least clearance",
    );
}

/// A ship too slow to plan is refused when its row is drawn, which is late.
#[test]
fn rows_that_cannot_be_sailed_are_faults_that_are_named() {
    let folder = folder();
    let slow = SPECIFICATION
        .replace(
            "speed_mps = 6\n",
            "speed_mps = { from = 0.05, to = 0.25 }\n",
        )
        .replace(
            "class = \"head-on\"",
            "class = \"overtaking\"\nbehaviour = { kind = \"mutual\" }",
        );
    folder.write("spec.toml", slow);
    let words = format!("campaign run {folder}/spec.toml --out {folder}/out");
    let text = stdout(&run(&words).code(3));
    let parts = parts(&folder, "out");
    let is_fault = |row: &&Vec<Cell>| row[column("outcome")] == Cell::Word(Some("fault".into()));
    let faults: Vec<&Vec<Cell>> = parts[0].rows.iter().filter(is_fault).collect();
    assert!(!faults.is_empty() && faults.len() < 10, "{}", faults.len());
    says(
        &text,
        &format!("40 rows sailed | failed at {} of them", faults.len()),
    );
    let summary = stdout(&run(&format!("campaign summarise {folder}/out")).success());
    says(&summary, &format!("NOT COUNTED: {} row", faults.len()));
    let Cell::Count(Some(row)) = faults[0][0] else {
        panic!("a row has a number");
    };
    let replay = run(&format!("campaign replay {folder}/out --row {row}"));
    let why = format!("row {row}: targets[0].behaviour: found | allowed: a speed of at least");
    says(&stderr(&replay.code(2)), &why);
}

#[test]
fn a_report_has_distributions_and_the_command_of_each_worst_row() {
    let folder = folder();
    sail(&folder, "out", 1, 2);
    let words = format!("campaign summarise {folder}/out --report {folder}/page --json");
    let summary = json(&words);
    let figures = (1..=3).map(|n| format!("campaign-{n}.svg"));
    let files: Vec<String> = figures.chain(["index.html".to_owned()]).collect();
    assert_eq!(folder.names("page"), files);
    let page = fs::read_to_string(folder.path().join("page/index.html")).expect("written");
    for row in summary["worst"].as_array().expect("rows") {
        let command = format!("campaign replay {folder}/out --row {} --rrd", row["row"]);
        says(&page, &command);
    }
    let again = fs::read(folder.path().join("page/campaign-1.svg")).expect("written");
    run(&words).success();
    let drawn = fs::read(folder.path().join("page/campaign-1.svg")).expect("written");
    assert!(again == drawn && String::from_utf8_lossy(&drawn).contains("crossing"));
}

#[test]
fn rare_contacts_are_estimated_alike_each_time() {
    let folder = folder();
    let ram = SPECIFICATION.replace("factor = 1.5", "factor = 8, every_s = 10");
    folder.write("spec.toml", ram);
    let rare = format!("campaign rare {folder}/spec.toml");
    let words = format!("{rare} --stratum crossing --trajectories 10 --replicas 5");
    let found = json(&format!("{words} --json"));
    assert_eq!(found, json(&format!("{words} --json")));
    let number = |key: &str| found[key].as_f64().expect("a number");
    assert!(number("replicas_s") > 0.0 && number("contact") <= 1.0);
    let levels = found["levels"].as_array().expect("levels");
    let distances = levels
        .iter()
        .map(|l| l["distance_m"].as_f64().expect("metres"));
    let distances: Vec<f64> = distances.collect();
    assert!(
        distances.windows(2).all(|pair| pair[0] > pair[1]),
        "{distances:?}"
    );
    assert_eq!(distances.last(), Some(&0.0));
    let text = stdout(&run(&words).success());
    says(
        &text,
        "small, crossing: P(contact) = | distance [m] | 5 replicas of 10 trajectories",
    );
    let names = "--stratum: found | allowed: one of [\"crossing\", \"seen by AIS\", \"a file\"]";
    says(&stderr(&run(&rare).code(2)), names);
    says(
        &stderr(&run(&format!("{rare} --stratum other")).code(2)),
        names,
    );
}

/// What a command prints on both streams that gets Ctrl-C after two seconds.
#[cfg(unix)]
fn interrupted(words: &str) -> (String, String) {
    let working = std::process::Command::new(env!("CARGO_BIN_EXE_searoom"))
        .args(words.split_whitespace())
        .stdout(std::process::Stdio::piped())
        .stderr(std::process::Stdio::piped())
        .spawn()
        .expect("started");
    std::thread::sleep(std::time::Duration::from_secs(2));
    let kill = std::process::Command::new("kill")
        .args(["-INT", &working.id().to_string()])
        .status();
    assert!(kill.expect("kill").success());
    let ended = working.wait_with_output().expect("ended");
    assert_eq!(ended.status.code(), Some(130));
    let text = |bytes| String::from_utf8(bytes).expect("text");
    (text(ended.stdout), text(ended.stderr))
}

#[cfg(unix)]
#[test]
fn an_interrupted_estimate_says_how_many_replicas_it_has() {
    let folder = folder();
    let rare =
        format!("campaign rare {folder}/spec.toml --stratum crossing --replicas 9999 --json");
    let (none, said) = interrupted(&format!("{rare} --trajectories 9999"));
    says(&said, "interrupted before two replicas had ended");
    assert_eq!(none, "");
    let (found, said) = interrupted(&format!("{rare} --trajectories 10"));
    // a slow machine has none either, and says so
    if found.is_empty() {
        says(&said, "interrupted before two replicas had ended");
    } else {
        let found: serde_json::Value = serde_json::from_str(&found).expect("a document");
        let ended = found["replicas"].as_array().expect("a list").len();
        says(
            &said,
            &format!("interrupted; the estimate is that of {ended} of 9999"),
        );
    }
}

/// Files that cannot be written, as on a full disk, are named; nothing is half there.
#[cfg(unix)]
#[test]
fn a_part_that_cannot_be_written_is_named_and_sailed_again() {
    let folder = folder();
    sail(&folder, "whole", 1, 2);
    let words = format!("campaign run {folder}/spec.toml --out {folder}/out");
    // no file above 8 KiB, and an error instead of the signal
    let limited = format!(
        "trap '' XFSZ; ulimit -f 8; exec {} {words}",
        env!("CARGO_BIN_EXE_searoom")
    );
    let ended = std::process::Command::new("bash")
        .args(["-c", &limited])
        .output()
        .expect("started");
    assert_eq!(ended.status.code(), Some(2), "{ended:?}");
    let said = String::from_utf8_lossy(&ended.stderr);
    says(&said, "out/ | File too large");
    assert!(parts(&folder, "out").is_empty());
    says(
        &stdout(&run(&words).success()),
        "40 rows sailed, 0 were there",
    );
    assert_eq!(rows(&folder, "out"), rows(&folder, "whole"));
}

/// Ctrl-C ends the run with the rows that were begun; the same command goes on.
#[cfg(unix)]
#[test]
fn an_interrupted_run_keeps_its_rows() {
    let folder = folder();
    let long = SPECIFICATION.replace("rows = 40", "rows = 4000");
    folder.write("spec.toml", long);
    let (said, _) = interrupted(&format!(
        "campaign run {folder}/spec.toml --out {folder}/out"
    ));
    says(&said, "interrupted, the same command goes on");
    let kept = rows(&folder, "out").len();
    assert!((1..4000).contains(&kept), "{kept}");
    let summary = document(&searoom(&[
        "campaign",
        "summarise",
        &folder.at("out"),
        "--json",
    ]));
    assert_eq!(summary["rows_there"], kept);
}

#[test]
fn every_fault_of_a_specification_is_named() {
    let folder = folder();
    let bad = r#"
name = "bad"
seed = -1
rows = 0
horizons = 600
path_length_m = 1500
[own_ship]
position = { east_m = 0, north_m = 0 }
speed_mps = 5
length_m = 30
beam_m = 8
turning_radius_m = 100
[planner]
deadline_s = 1
[simulation]
replan_s = "often"
[[strata]]
name = "a"
class = "headon"
tcpa_s = { from = 200, to = 100 }
[[strata]]
name = "a"
scenario = "nowhere.toml"
class = "head-on"
[[strata]]
clas = "give-way"
"#;
    folder.write("bad.toml", bad);
    let sail = |name: &str| {
        let run = run(&format!("campaign run {folder}/{name} --out {folder}/out"));
        let said = stderr(&run.code(2));
        assert!(!folder.path().join("out").exists());
        said
    };
    says(
        &sail("bad.toml"),
        "line 3: seed: found -1 | line 4: rows: found 0; allowed: a whole number from 1 to \
         1000000000 | line 5: horizons: found an unknown key, perhaps for 'horizon_s' | \
         line 8: own_ship.position | line 14: planner.deadline_s | line 16: simulation.replan_s | \
         line 19: strata[0].class: found the text \"headon\"; allowed: \"head-on\", \"give-way\" | \
         line 20: strata[0].tcpa_s: found from = 200, which is above to = 100 | \
         line 22: strata[1].name: found the text \"a\"; allowed: a name that no other stratum has | \
         nowhere.toml, which cannot be read | line 24: strata[1].class | strata[2].name: found \
         nothing | line 26: strata[2].clas: found an unknown key, perhaps for 'class'",
    );
    // distributions that the class excludes, and settings that no row could have
    let impossible = SPECIFICATION.replace("tcpa_s = {", "bearing_deg = -90\ntcpa_s = {");
    folder.write("impossible.toml", impossible);
    says(
        &sail("impossible.toml"),
        "strata[0].class: found 0 of 1000 draws of this class",
    );
    let slow = SPECIFICATION.replace("[simulation]", "[simulation]\ndelay_s = 30");
    folder.write("slow.toml", slow);
    says(
        &sail("slow.toml"),
        "line 17: simulation.delay_s: found 30; allowed: at most 20",
    );
    let far = SPECIFICATION.replace("duration_s = 100", "replan_s = 10, delay_s = 11");
    folder.write("far.toml", far);
    says(
        &sail("far.toml"),
        "strata[1].simulation.delay_s: found 11; allowed: at most 10",
    );
    let wrong = crate::program::HEAD_ON.replace("horizon_s", "horizon");
    folder.write("head-on.toml", wrong);
    says(
        &sail("spec.toml"),
        "strata[2].scenario: found | head-on.toml: line",
    );
    for shard in ["0/4", "5/4", "1", "a/b"] {
        let args = format!("campaign run {folder}/spec.toml --out {folder}/out --shard {shard}");
        says(&stderr(&run(&args).code(2)), "K/N with K from 1 to N");
    }
}
