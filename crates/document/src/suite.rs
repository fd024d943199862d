//! Suite document, see docs/reference/documents.md.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::encounter::{EncounterDocument, breaks};
use super::parts::{
    CostDocument, PlanMethod, RelaxationDocument, SearchStatsDocument, TimingDocument,
};
use super::plan::PlanDocument;
use super::plan::departure::Departure;
use searoom_evaluation::{NOT_BY_THE_RULES, PlanOutcome};
use searoom_input::text::counted;

searoom_evaluation::outcomes! {
    /// How a run ended, or why there is none.
    SuiteOutcome from PlanOutcome default Unreadable {
        /// A file that is not a scenario.
        Unreadable => "unreadable",
        /// A run that ended in an internal fault.
        InternalFault => "internal-fault",
        /// A valid scenario that the requested planner or rules do not support.
        NotApplicable => "not-applicable",
    }
}

/// Many runs in one document.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct SuiteDocument {
    pub runs: Vec<SuiteRunDocument>,
    pub summary: SuiteSummaryDocument,
}

/// One run of a suite. Without a run, `outcome` is [`SuiteOutcome::Unreadable`] or
/// [`SuiteOutcome::InternalFault`] with an `error`, or [`SuiteOutcome::NotApplicable`] with a
/// `reason`. Keys without meaning are null.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct SuiteRunDocument {
    pub file: String,
    pub scenario: Option<String>,
    pub planner: Option<String>,
    /// Method that made the plan; null without one.
    #[serde(default)]
    pub method: Option<PlanMethod>,
    pub outcome: SuiteOutcome,
    pub verdict: String,
    pub error: Option<String>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub reason: Option<String>,
    pub relaxations: Vec<RelaxationDocument>,
    pub verified: bool,
    pub safe: bool,
    pub cost: Option<CostDocument>,
    /// The manoeuvre in brief; null without one.
    pub departure: Option<Departure>,
    pub encounters: Vec<EncounterDocument>,
    pub targets: Option<usize>,
    #[serde(default)]
    pub search_stats: Option<SearchStatsDocument>,
    pub timing: Option<TimingDocument>,
    /// Those of the plan.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub cautions: Vec<String>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub notes: Vec<String>,
}

/// Summary counts.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct SuiteSummaryDocument {
    pub scenarios: usize,
    pub solved: usize,
    pub relaxed: usize,
    pub not_by_the_rules: usize,
    pub infeasible: usize,
    pub deadline: usize,
    pub not_applicable: usize,
    pub unreadable: usize,
    pub internal_faults: usize,
    pub verified: usize,
    pub safe: usize,
    pub not_safe: usize,
    pub breaks_rules: usize,
}

impl SuiteDocument {
    /// Builds the document of these runs with a summary.
    pub fn of(runs: Vec<SuiteRunDocument>) -> Self {
        let count = |is: &dyn Fn(&SuiteRunDocument) -> bool| runs.iter().filter(|r| is(r)).count();
        let ended = |outcome: SuiteOutcome| count(&|run| run.outcome == outcome);
        let summary = SuiteSummaryDocument {
            scenarios: runs.len(),
            solved: ended(SuiteOutcome::Solved),
            relaxed: ended(SuiteOutcome::Relaxed),
            not_by_the_rules: count(&|run| run.verdict == NOT_BY_THE_RULES),
            infeasible: ended(SuiteOutcome::Infeasible),
            deadline: ended(SuiteOutcome::Deadline),
            not_applicable: ended(SuiteOutcome::NotApplicable),
            unreadable: ended(SuiteOutcome::Unreadable),
            internal_faults: ended(SuiteOutcome::InternalFault),
            verified: count(&|run| run.verified),
            safe: count(&|run| run.safe),
            not_safe: count(&|run| run.outcome == SuiteOutcome::Relaxed && !run.safe),
            breaks_rules: count(&|run| {
                breaks(&run.encounters).is_some_and(|broken| !broken.is_empty())
            }),
        };
        Self { runs, summary }
    }
}

impl std::fmt::Display for SuiteSummaryDocument {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let scenarios = counted(self.scenarios, "scenario");
        write!(f, "{scenarios}: {} solved", self.solved)?;
        for (count, name) in [
            (
                (self.relaxed).saturating_sub(self.not_safe + self.not_by_the_rules),
                "relaxed",
            ),
            (self.not_by_the_rules, NOT_BY_THE_RULES),
            (self.not_safe, "not safe"),
            (self.infeasible, "infeasible"),
            (self.deadline, "out of time"),
            (self.not_applicable, "not applicable"),
            (self.unreadable, SuiteOutcome::Unreadable.word()),
            (self.internal_faults, "failed inside"),
        ] {
            if count > 0 {
                write!(f, ", {count} {name}")?;
            }
        }
        write!(f, "; {} verified, {} safe", self.verified, self.safe)?;
        if self.breaks_rules > 0 {
            write!(f, ", {} with a rule broken", self.breaks_rules)?;
        }
        Ok(())
    }
}

impl SuiteRunDocument {
    /// Builds the entry of a plan. The notes list assumptions and unused parts of an imported file.
    pub fn of(file: String, plan: &PlanDocument, notes: Vec<String>) -> Self {
        Self {
            file,
            scenario: Some(plan.scenario.clone()),
            planner: Some(plan.planner.clone()),
            outcome: plan.outcome.into(),
            verdict: plan.verdict.clone(),
            error: None,
            reason: plan.reason.clone(),
            relaxations: plan.relaxations.clone(),
            verified: plan.verified,
            safe: plan.is_safe(),
            cost: plan.cost.clone(),
            departure: plan.departure_of_motion(),
            encounters: plan.encounters.clone(),
            targets: Some(plan.all_targets()),
            method: plan.method,
            search_stats: Some(plan.search_stats),
            timing: Some(plan.timing.clone()),
            cautions: plan.cautions.clone(),
            notes,
        }
    }

    /// Builds the entry of a valid scenario that is not supported as requested.
    pub fn not_applicable(file: String, title: String, reason: String) -> Self {
        Self {
            scenario: Some(title),
            error: None,
            reason: Some(reason),
            ..Self::failed(file, SuiteOutcome::NotApplicable, String::new())
        }
    }

    /// Builds the entry of a file that yields no run.
    pub fn failed(file: String, outcome: SuiteOutcome, error: String) -> Self {
        Self {
            file,
            outcome,
            verdict: outcome.word().replace('-', " "),
            error: Some(error),
            ..Self::default()
        }
    }
}
