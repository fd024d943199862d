//! What is odd about scenarios, for the eye.

use comfy_table::Cell;

use super::table::figures;
use crate::document::LintDocument;

/// Units below the names.
const HEADER: [&str; 7] = [
    "scenario",
    "target",
    "role",
    "dCPA\n[m]",
    "tCPA\n[s]",
    "to set\n[m]",
    "matters",
];

/// Columns with numbers.
const NUMBERS: std::ops::Range<usize> = 3..6;

/// A row per target, then every finding, and a summary.
pub fn lint_text(document: &LintDocument, colour: bool) -> String {
    let mut table = figures(&HEADER, NUMBERS, colour);
    let mut findings = Vec::new();
    let metres = |value: Option<f64>| value.map_or("–".to_owned(), |v| format!("{v:.1}"));
    for scenario in &document.scenarios {
        let name = scenario.scenario.as_deref().unwrap_or(&scenario.file);
        if let Some(error) = scenario.error.as_ref().and_then(|e| e.lines().next()) {
            findings.push(format!("{name}: unreadable: {error}"));
        }
        for (index, target) in scenario.targets.iter().enumerate() {
            let first = if index == 0 { name } else { "" };
            table.add_row([
                Cell::new(first),
                Cell::new(&target.name),
                Cell::new(&target.role),
                Cell::new(metres(target.undisturbed_dcpa_m)),
                Cell::new(metres(target.undisturbed_tcpa_s)),
                Cell::new(metres(target.to_set_m)),
                Cell::new(&target.matters),
            ]);
        }
        findings.extend(
            scenario
                .findings
                .iter()
                .map(|finding| format!("{name}: {finding}")),
        );
    }
    let summary = &document.summary;
    findings.push(format!(
        "{} scenarios, {} targets: {} findings, {} unreadable",
        summary.scenarios, summary.targets, summary.findings, summary.unreadable
    ));
    format!("{}\n{}", table.trim_fmt(), findings.join("\n"))
}
