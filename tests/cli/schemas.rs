//! The documents that the program prints fit the schemas that it prints.

use std::collections::BTreeSet;
use std::fs;

use jsonschema::Validator;
use serde_json::Value;

use super::program::{Folder, HEAD_ON, document, run, stdout};

/// Schema of a document, as the program prints it.
pub struct Schema {
    kind: &'static str,
    validator: Validator,
}

impl Schema {
    pub fn of(kind: &'static str) -> Self {
        let schema: Value = document(&run(&format!("schema {kind}")).success());
        let validator = jsonschema::validator_for(&schema).expect("a schema");
        Self { kind, validator }
    }

    pub fn assert_holds(&self, document: &Value, name: &str) {
        let faults = self.validator.iter_errors(document);
        let faults: Vec<String> = faults
            .map(|fault| format!("{}: {fault:.200}", fault.instance_path()))
            .collect();
        assert!(faults.is_empty(), "{} {name}: {faults:#?}", self.kind);
        // and not everything does
        let keys = document.as_object().expect("a document").keys();
        let mut lesser = document.clone();
        let first = keys.into_iter().next().expect("a key");
        lesser.as_object_mut().expect("a document").remove(first);
        assert!(
            !self.validator.is_valid(&lesser),
            "{} without {first}",
            self.kind
        );
    }
}

/// Plans of every planner, with land, sets and forces, with a memory, and without a plan.
#[test]
fn plan_documents_fit_their_schema() {
    let schema = Schema::of("plan");
    let folder = Folder::new();
    let mut outcomes = BTreeSet::new();
    for (index, scenarios) in [
        "scenarios/colregs",
        "scenarios/harbour",
        "scenarios/uncertainty",
        "scenarios/forces scenarios/paper",
        "tests/faults/infeasible-at-goal.toml tests/faults/least-harm-to-hulls.toml",
    ]
    .into_iter()
    .enumerate()
    {
        run(&format!(
            "suite {scenarios} --plans {folder}/{index} --quiet"
        ));
        for name in folder.names(&index.to_string()) {
            let text = fs::read_to_string(folder.path().join(format!("{index}/{name}")));
            let plan: Value = serde_json::from_str(&text.expect("written")).expect("JSON");
            schema.assert_holds(&plan, &name);
            outcomes.insert(plan["outcome"].as_str().expect("a word").to_owned());
        }
    }
    assert!(outcomes.len() >= 2, "{outcomes:?}");
    let previous = format!("{folder}/0/head-on.json");
    let later = "--no-return --json --previous";
    let plan = run(&format!(
        "plan scenarios/colregs/head-on.toml {later} {previous}"
    ));
    let plan = document(&plan.success());
    assert!(plan["memory"].is_object());
    schema.assert_holds(&plan, "after another");
}

/// The file in the docs, and one that lacks what it needs.
#[test]
fn a_file_of_thresholds_fits_its_schema() {
    let schema = Schema::of("thresholds");
    let page = include_str!("../../docs/reference/rules.md");
    let file = page.split("```text\nname").nth(1).expect("a file");
    let file = format!("name{}", file.split("```").next().expect("its end"));
    let value: Value = toml::from_str(&file).expect("TOML");
    assert!(schema.validator.is_valid(&value), "{value}");
    for (old, new) in [
        ("like", "#"),
        ("6.0", "181"),
        ("apparent_deg", "apparant_deg"),
    ] {
        let wrong: Value = toml::from_str(&file.replacen(old, new, 1)).expect("TOML");
        assert!(!schema.validator.is_valid(&wrong), "{new}");
    }
    let folder = Folder::new();
    let file = folder.write("mine.toml", file);
    run(&format!(
        "plan scenarios/colregs/give-way.toml --thresholds {file}"
    ))
    .success();
}

/// The contents of recordings of every kind.
#[cfg(feature = "recording")]
#[test]
fn contents_of_recordings_fit_their_schema() {
    let schema = Schema::of("inspect");
    let folder = Folder::new();
    let file = folder.at("a.rrd");
    for words in [
        "plan scenarios/colregs/stand-on.toml",
        "compare scenarios/colregs/stand-on.toml --planner space-time",
        "simulate scenarios/colregs/stand-on.toml --duration-s 20",
    ] {
        run(&format!("{words} --rrd {file} --quiet"));
        let contents = document(&run(&format!("inspect {file} --json")).success());
        schema.assert_holds(&contents, words);
    }
}

/// Every other document, with what is wrong in it.
#[test]
fn other_documents_fit_their_schemas() {
    let folder = Folder::new();
    let bad = folder.write("bad.toml", HEAD_ON.replace("course_deg", "course"));
    let plan = folder.at("plan.json");
    let sailed = folder.at("sailed.json");
    let spoilt = folder.write("spoilt.json", "{}");
    let keep = |file: &str, words: &str| {
        let text = stdout(&run(words).success());
        fs::write(file, text).expect("written");
    };
    keep(&plan, "plan scenarios/colregs/head-on.toml --json");
    let radar = "scenarios/closed-loop/head-on-radar.toml";
    keep(&sailed, &format!("simulate {radar} --duration-s 60 --json"));
    let rows = crate::campaign::SPECIFICATION.replace("rows = 40", "rows = 3");
    let rows = folder.write("campaign.toml", rows);
    folder.write("head-on.toml", HEAD_ON);
    let sailed_campaign = folder.at("campaign");
    run(&format!("campaign run {rows} --out {sailed_campaign}")).success();
    let land = "scenarios/closed-loop/harbour-ferries.toml";
    let others = "scenarios/imazu scenarios/dnv/traffic_situation_01.json";
    for (kind, words) in [
        (
            "suite",
            format!("suite {bad} scenarios/colregs {others} --json"),
        ),
        (
            "suite",
            format!("suite {land} --planner path-time --compliance rules --json"),
        ),
        (
            "lint",
            format!("suite --lint {bad} scenarios/colregs scenarios/uncertainty --json"),
        ),
        (
            "compare",
            format!("compare {bad} scenarios/colregs scenarios/forces --json"),
        ),
        (
            "simulate",
            format!("simulate {land} --duration-s 60 --json"),
        ),
        (
            "simulate",
            format!("simulate {bad} {radar} {land} --duration-s 20 --json"),
        ),
        (
            "campaign",
            format!("campaign summarise {sailed_campaign} --json"),
        ),
        (
            "campaign-rare",
            format!(
                "campaign rare {rows} --stratum crossing --trajectories 10 --replicas 5 --json"
            ),
        ),
        (
            "assess",
            "assess scenarios/uncertainty/changing-ellipses.toml --json".to_owned(),
        ),
        (
            "assess",
            "assess scenarios/colregs/give-way.toml --at 0,0,9 --velocity 1,0 --section 60 --json"
                .to_owned(),
        ),
        ("check", format!("check {bad} {others} --json")),
        ("verify", format!("verify {plan} {sailed} {spoilt} --json")),
    ] {
        Schema::of(kind).assert_holds(&document(&run(&words)), &words);
    }
}
