//! Checks that docs/reference/documents.md names every key of the documents, and
//! docs/reference/verify.md those of a verification.

use std::collections::BTreeSet;

use crate::program::{Folder, document, searoom, stdout};
use serde_json::Value;

pub const PAGE: &str = include_str!("../../../docs/reference/documents.md");
const VERIFICATION: &str = include_str!("../../../docs/reference/verify.md");

fn keys(value: &Value, found: &mut BTreeSet<String>) {
    match value {
        Value::Object(map) => {
            for (key, inner) in map {
                found.insert(key.clone());
                // its content has a separate page
                if key != "optimal_control" {
                    keys(inner, found);
                }
            }
        }
        Value::Array(list) => list.iter().for_each(|inner| keys(inner, found)),
        _ => {}
    }
}

pub fn keys_of(args: &[&str]) -> BTreeSet<String> {
    let mut found = BTreeSet::new();
    keys(&document(&searoom(args)), &mut found);
    found
}

#[test]
fn every_key_is_on_the_page() {
    let mut all = keys_of(&["suite", "scenarios/colregs", "--json"]);
    for scenario in [
        "scenarios/colregs/head-on.toml",
        "scenarios/paper/figure_9.toml",
        "scenarios/harbour/alternative-path.toml",
        "scenarios/uncertainty/changing-velocities.toml",
    ] {
        all.extend(keys_of(&["plan", scenario, "--json"]));
    }
    all.extend(keys_of(&["compare", "scenarios/colregs", "--json"]));
    all.extend(keys_of(&["simulate", "scenarios/colregs", "--json"]));
    all.extend(keys_of(&[
        "check",
        "--json",
        "tests/faults",
        "scenarios/colregs",
    ]));
    all.extend(keys_of(&["check", "--json", "Cargo.toml"]));
    assert!(all.len() > 90, "{all:?}");
    named(PAGE, &all);
}

#[test]
fn every_key_of_a_verification_is_on_its_page() {
    let folder = Folder::new();
    let plan = searoom(&["plan", "scenarios/harbour/munkholmen.toml", "--json"]);
    let plan = folder.write("plan.json", stdout(&plan));
    named(VERIFICATION, &keys_of(&["verify", &plan, "--json"]));
}

pub fn named(page: &str, keys: &BTreeSet<String>) {
    let missing: Vec<_> = keys
        .iter()
        .filter(|key| !page.contains(&format!("`{key}`")))
        .collect();
    assert!(missing.is_empty(), "{missing:?}");
}
