//! Outcome, safety, rules broken and J of every shipped scenario, against the reviewed snapshot.
//!
//! Where a change is meant, `INSTA_UPDATE=always` before the test's command writes it anew, and
//! `cargo insta review` shows it first.

use insta::Settings;
use insta::Snapshot;
use insta::comparator::Comparator;
use insta::internals::SnapshotContents;
use serde_json::Value;

use super::program::{document, list, searoom};

const HEADER: &str = "file\tscenario\toutcome\tsafe\tbreaks\tJ";

/// Fraction of J that may differ from one machine to another, and a negligible cost in m².
const ALIKE: f64 = 1e-3;
const NOTHING: f64 = 0.01;

/// Cells of a run, J last.
fn cells(run: &Value) -> Vec<String> {
    let word = |value: &Value| value.as_str().unwrap_or("–").to_owned();
    let safe = run["safe"].as_bool();
    let error = run["cost"]["space_time_error_m2"].as_f64();
    let mut breaks = Vec::new();
    for encounter in run["encounters"].as_array().into_iter().flatten() {
        let list = |key: &str| encounter[key].as_array().cloned().unwrap_or_default();
        breaks.extend(list("violations").iter().map(|b| word(&b["rule"])));
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

/// Compares tables whose last cells are numbers that may differ a little.
#[derive(Clone)]
struct NearlyAlike;

impl Comparator for NearlyAlike {
    fn matches(&self, reference: &Snapshot, test: &Snapshot) -> bool {
        let [kept, found] = [reference, test].map(|snapshot| match snapshot.contents() {
            SnapshotContents::Text(text) => text.to_string(),
            SnapshotContents::Binary(_) => String::new(),
        });
        let same_lines = kept.lines().count() == found.lines().count();
        same_lines && kept.lines().zip(found.lines()).all(|(a, b)| is_alike(a, b))
    }

    fn dyn_clone(&self) -> Box<dyn Comparator> {
        Box::new(self.clone())
    }
}

fn is_alike(kept: &str, found: &str) -> bool {
    let [Some(kept), Some(found)] = [kept, found].map(|line| line.rsplit_once('\t')) else {
        return kept == found;
    };
    let near = match (kept.1.parse::<f64>(), found.1.parse::<f64>()) {
        (Ok(a), Ok(b)) => (a - b).abs() <= NOTHING + ALIKE * a.abs(),
        _ => kept.1 == found.1,
    };
    kept.0 == found.0 && near
}

#[test]
fn the_shipped_scenarios_give_what_the_kept_table_says() {
    let suite = document(&searoom(&["suite", "scenarios", "--json"]));
    let runs = list(&suite["runs"]);
    let rows = runs.iter().map(|run| cells(run).join("\t"));
    let table: Vec<String> = [HEADER.to_owned()].into_iter().chain(rows).collect();
    let mut settings = Settings::clone_current();
    settings.set_comparator(Box::new(NearlyAlike));
    settings.set_snapshot_path("../golden");
    settings.set_prepend_module_to_snapshot(false);
    settings.set_omit_expression(true);
    settings.bind(|| insta::assert_snapshot!("scenarios", table.join("\n")));
}

#[test]
fn a_table_is_alike_up_to_small_differences_of_cost() {
    let row = |safe: &str, cost: &str| format!("a.toml\tA\tsolved\t{safe}\t–\t{cost}");
    let kept = row("yes", "1000.0");
    assert!(is_alike(&kept, &row("yes", "1000.9")) && is_alike(HEADER, HEADER));
    for other in [
        row("NO", "1000.0"),
        row("yes", "1002.0"),
        row("yes", "–"),
        row("yes", "NaN"),
    ] {
        assert!(!is_alike(&kept, &other), "{other}");
    }
}
