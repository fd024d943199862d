//! Text of scenario faults.

use super::table::{Display, Grid, or_dash, plain};
use crate::document::LintDocument;
use crate::text::{counted, tenths};

/// Formats one row per target, then every finding and a summary.
pub fn lint_text(document: &LintDocument, display: Display) -> String {
    let header = "scenario, target, role, dCPA\n[m], tCPA\n[s], to set\n[m], matters";
    let mut grid = Grid::new(header, 3..6, []);
    let mut findings = Vec::new();
    for scenario in &document.scenarios {
        let name = scenario.scenario.as_deref().unwrap_or(&scenario.file);
        if let Some(error) = scenario.error.as_ref().and_then(|e| e.lines().next()) {
            findings.push(format!("{name}: unreadable: {error}"));
        }
        for (index, target) in scenario.targets.iter().enumerate() {
            grid.rows.push(vec![
                plain(if index == 0 { name } else { "" }),
                plain(&target.name),
                plain(target.role.word()),
                or_dash(target.undisturbed_dcpa_m.map(tenths)),
                or_dash(target.undisturbed_tcpa_s.map(tenths)),
                or_dash(target.to_set_m.map(tenths)),
                plain(target.matters.word()),
            ]);
        }
        findings.extend(scenario.findings.iter().map(|f| format!("{name}: {f}")));
    }
    let summary = &document.summary;
    findings.push(format!(
        "{}, {}: {}, {} unreadable",
        counted(summary.scenarios, "scenario"),
        counted(summary.targets, "target"),
        counted(summary.findings, "finding"),
        summary.unreadable
    ));
    format!("{}\n{}", grid.text(display), findings.join("\n"))
}
