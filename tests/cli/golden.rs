//! What comes of every scenario of the project, against a kept table. Where a change is meant,
//! write the table anew:
//!
//! ```text
//! SEAROOM_UPDATE_GOLDEN=1 cargo test --release --no-default-features --test cli the_shipped_scenarios
//! ```

use std::path::Path;

use serde_json::Value;

use super::program::{document, searoom};

const TABLE: &str = "tests/golden/scenarios.tsv";

const HEADER: [&str; 6] = ["file", "scenario", "outcome", "safe", "breaks", "J"];

/// Share of J that may differ from one machine to another, and m² that are nothing.
const ALIKE: f64 = 1e-3;
const NOTHING: f64 = 0.01;

/// The cells of a run, J last.
fn cells(run: &Value) -> Vec<String> {
    let word = |value: &Value| value.as_str().unwrap_or("–").to_owned();
    let safe = run["safe"].as_bool();
    let error = run["cost"]["space_time_error_m2"].as_f64();
    let mut breaks = Vec::new();
    for encounter in run["encounters"].as_array().into_iter().flatten() {
        let list = |key: &str| encounter[key].as_array().cloned().unwrap_or_default();
        breaks.extend(list("breaches").iter().map(|b| word(&b["rule"])));
        let monitors = list("monitors");
        let violated = monitors.iter().filter(|m| m["verdict"] == "violated");
        breaks.extend(violated.map(|m| word(&m["monitor"])));
    }
    vec![
        word(&run["file"]),
        word(&run["scenario"]),
        word(&run["outcome"]),
        safe.map_or("–", |safe| if safe { "yes" } else { "no" })
            .to_owned(),
        match breaks.is_empty() {
            true => "–".to_owned(),
            false => breaks.join(" "),
        },
        error.map_or("–".to_owned(), |error| format!("{error:.3}")),
    ]
}

fn is_alike(kept: &[&str], found: &[String]) -> bool {
    let words = |cells: &[String]| cells[..5].to_vec();
    let kept: Vec<String> = kept.iter().map(|cell| (*cell).to_owned()).collect();
    if kept.len() != found.len() || words(&kept) != words(found) {
        return false;
    }
    match (kept[5].parse::<f64>(), found[5].parse::<f64>()) {
        (Ok(a), Ok(b)) => (a - b).abs() <= NOTHING + ALIKE * a.abs(),
        _ => kept[5] == found[5],
    }
}

#[test]
fn the_shipped_scenarios_give_what_the_kept_table_says() {
    let suite = document(&searoom(&["suite", "scenarios", "--json"]));
    let runs = suite["runs"].as_array().expect("runs");
    let rows: Vec<Vec<String>> = runs.iter().map(cells).collect();
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join(TABLE);
    if std::env::var_os("SEAROOM_UPDATE_GOLDEN").is_some() {
        let header = HEADER.map(str::to_owned).to_vec();
        let lines = [&header].into_iter().chain(&rows).map(|row| row.join("\t"));
        let text: String = lines.map(|line| line + "\n").collect();
        std::fs::write(file, text).expect("written");
        return;
    }
    let text = std::fs::read_to_string(file).expect("the table");
    let kept: Vec<Vec<&str>> = text.lines().map(|l| l.split('\t').collect()).collect();
    assert_eq!(kept[0], HEADER);
    let kept = &kept[1..];
    assert_eq!(kept.len(), rows.len(), "scenarios were added or taken away");
    let pairs = kept.iter().zip(&rows);
    let other: Vec<_> = pairs.filter(|(kept, row)| !is_alike(kept, row)).collect();
    assert!(
        other.is_empty(),
        "kept, and found; where it is meant: SEAROOM_UPDATE_GOLDEN=1 cargo test --release --no-default-features \
         --test cli the_shipped_scenarios\n{other:#?}"
    );
}
