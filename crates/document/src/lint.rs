//! Document of `suite --lint`, see docs/reference/formats.md.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use searoom_colregs::Role;

/// Findings for many scenarios, without planning.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct LintDocument {
    pub scenarios: Vec<LintScenarioDocument>,
    pub summary: LintSummaryDocument,
}

/// Findings for one scenario. For an unreadable file, `error` gives the reason.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct LintScenarioDocument {
    pub file: String,
    pub scenario: Option<String>,
    pub error: Option<String>,
    pub targets: Vec<LintTargetDocument>,
    pub findings: Vec<String>,
    pub notes: Vec<String>,
}

searoom_geometry::words! {
    /// Whether a target concerns own ship.
    pub enum Matters {
        /// On the desired trajectory, own ship enters the hard set of the target.
        Meets => "meets",
        /// It does not, and may enter the set on another way.
        Clear => "clear",
        /// Own ship cannot enter the set at any of its speeds on any course.
        Never => "never",
    }
}

/// One target on its nominal motion.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct LintTargetDocument {
    pub name: String,
    pub role: Role,
    pub undisturbed_dcpa_m: Option<f64>,
    pub undisturbed_tcpa_s: Option<f64>,
    pub to_set_m: Option<f64>,
    pub matters: Matters,
}

/// Summary counts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct LintSummaryDocument {
    pub scenarios: usize,
    pub targets: usize,
    pub findings: usize,
    pub unreadable: usize,
}

impl LintDocument {
    /// Builds the document and its counts.
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
    /// Builds the entry of a file without a scenario.
    pub fn failed(file: String, error: String) -> Self {
        Self {
            file,
            error: Some(error),
            ..Self::default()
        }
    }
}
