//! The document of `suite --lint`, `docs/formats.md`.

use serde::{Deserialize, Serialize};

use super::plan::finite;
use crate::lint::Lint;

/// Many scenarios, looked at without planning.
///
/// # Examples
///
/// ```
/// use searoom::lint::lint;
/// use searoom::report::document::{LintDocument, LintScenarioDocument};
/// use searoom::scenario::import::Declared;
/// use searoom::scenario::Scenario;
///
/// let scenario = Scenario::read("scenarios/colregs/give-way.toml".as_ref())?;
/// let looked = lint(&scenario, &Declared::default());
/// let one = LintScenarioDocument::of("give-way.toml".to_owned(), scenario.title.clone(), &looked, Vec::new());
/// let document = LintDocument::of(vec![one]);
/// assert_eq!((document.summary.targets, document.summary.findings), (1, 0));
/// # Ok::<(), searoom::scenario::ScenarioError>(())
/// ```
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[expect(missing_docs, reason = "docs/formats.md says what each key means")]
pub struct LintDocument {
    pub scenarios: Vec<LintScenarioDocument>,
    pub summary: LintSummaryDocument,
}

/// One of them; of an unreadable file `error` says why.
///
/// # Examples
///
/// ```
/// use searoom::report::document::LintScenarioDocument;
///
/// let failed = LintScenarioDocument::failed("a.toml".to_owned(), "title: missing".to_owned());
/// assert!(failed.targets.is_empty() && failed.error.as_deref() == Some("title: missing"));
/// ```
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
///
/// # Examples
///
/// ```
/// use searoom::report::document::LintTargetDocument;
///
/// let text = r#"{ "name": "ferry", "role": "give-way", "undisturbed_dcpa_m": -21.0, "undisturbed_tcpa_s": 150.0, "to_set_m": -110.0, "matters": "meets" }"#;
/// let read: LintTargetDocument = serde_json::from_str(text)?;
/// assert_eq!((read.matters.as_str(), read.undisturbed_tcpa_s), ("meets", Some(150.0)));
/// # Ok::<(), serde_json::Error>(())
/// ```
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
///
/// # Examples
///
/// ```
/// use searoom::report::document::LintSummaryDocument;
///
/// let text = r#"{ "scenarios": 22, "targets": 50, "findings": 4, "unreadable": 0 }"#;
/// let read: LintSummaryDocument = serde_json::from_str(text)?;
/// assert_eq!(read.targets, 50);
/// # Ok::<(), serde_json::Error>(())
/// ```
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
