//! docs/documents.md names every key of the documents.

use std::collections::BTreeSet;

use assert_cmd::Command;
use serde_json::Value;

const PAGE: &str = include_str!("../docs/documents.md");

fn keys(value: &Value, found: &mut BTreeSet<String>) {
    match value {
        Value::Object(map) => {
            for (key, inner) in map {
                found.insert(key.clone());
                // pages of their own have what is in these
                if key != "optimal_control" && !(key == "targets" && inner.is_array()) {
                    keys(inner, found);
                }
            }
        }
        Value::Array(list) => list.iter().for_each(|inner| keys(inner, found)),
        _ => {}
    }
}

fn keys_of(args: &[&str]) -> BTreeSet<String> {
    let output = Command::new(env!("CARGO_BIN_EXE_searoom"))
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .args(args)
        .output()
        .expect("runs");
    let document: Value = serde_json::from_slice(&output.stdout).expect("one document");
    let mut found = BTreeSet::new();
    keys(&document, &mut found);
    found
}

#[test]
fn every_key_is_on_the_page() {
    let mut all = keys_of(&["suite", "scenarios/colregs", "--json"]);
    for scenario in [
        "scenarios/colregs/head-on.toml",
        "scenarios/paper/figure_9.toml",
        "scenarios/harbour/alternative-path.toml",
    ] {
        all.extend(keys_of(&["plan", scenario, "--json"]));
    }
    assert!(all.len() > 90, "{all:?}");
    let missing: Vec<_> = all
        .iter()
        .filter(|key| !PAGE.contains(&format!("`{key}`")))
        .collect();
    assert!(missing.is_empty(), "{missing:?}");
}
