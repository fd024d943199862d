//! The document of `suite --lint`, `docs/formats.md`.

use serde::{Deserialize, Serialize};

use super::plan::finite;
use crate::study::lint::Lint;

/// Many scenarios, looked at without planning.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[expect(missing_docs, reason = "docs/formats.md says what each key means")]
pub struct LintDocument {
    pub scenarios: Vec<LintScenarioDocument>,
    pub summary: LintSummaryDocument,
}

/// One of them; of an unreadable file `error` says why.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[expect(missing_docs, reason = "docs/formats.md says what each key means")]
pub struct LintScenarioDocument {
    pub file: String,
    pub scenario: Option<String>,
    pub error: Option<String>,
    pub targets: Vec<LintTargetDocument>,
    pub findings: Vec<String>,
    pub notes: Vec<String>,
}

/// One target, undisturbed.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[expect(missing_docs, reason = "docs/formats.md says what each key means")]
pub struct LintTargetDocument {
    pub name: String,
    pub role: String,
    pub undisturbed_dcpa_m: Option<f64>,
    pub undisturbed_tcpa_s: Option<f64>,
    pub to_set_m: Option<f64>,
    pub matters: String,
}

/// How many of which.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[expect(missing_docs, reason = "docs/formats.md says what each key means")]
pub struct LintSummaryDocument {
    pub scenarios: usize,
    pub targets: usize,
    pub findings: usize,
    pub unreadable: usize,
}

impl LintDocument {
    /// With the counts.
    pub fn of(scenarios: Vec<LintScenarioDocument>) -> Self {
        let summary = LintSummaryDocument {
            scenarios: scenarios.len(),
            targets: scenarios.iter().map(|s| s.targets.len()).sum(),
            findings: scenarios.iter().map(|s| s.findings.len()).sum(),
            unreadable: scenarios.iter().filter(|s| s.error.is_some()).count(),
        };
        Self { scenarios, summary }
    }
}

impl LintScenarioDocument {
    /// Of a scenario that was read.
    pub fn of(file: String, scenario: String, lint: &Lint, notes: Vec<String>) -> Self {
        let targets = lint.targets.iter().map(|target| LintTargetDocument {
            name: target.name.clone(),
            role: target.role.name().to_owned(),
            undisturbed_dcpa_m: finite(target.dcpa),
            undisturbed_tcpa_s: finite(target.tcpa),
            to_set_m: finite(target.to_set),
            matters: target.weight.word().to_owned(),
        });
        Self {
            file,
            scenario: Some(scenario),
            error: None,
            targets: targets.collect(),
            findings: lint.findings.clone(),
            notes,
        }
    }

    /// Of a file that gave none.
    pub fn failed(file: String, error: String) -> Self {
        Self {
            file,
            scenario: None,
            error: Some(error),
            targets: Vec::new(),
            findings: Vec::new(),
            notes: Vec::new(),
        }
    }
}
