//! Published JSON documents, the single description of a result. Text, pages and `inspect` render
//! them, and `verify` checks a [`PlanDocument`] alone.
//!
//! Non-finite numbers are written as null.
#![expect(missing_docs, reason = "docs/documents.md says what each key means")]

mod assessment;
mod comparison;
mod encounter;
mod legs;
mod lines;
mod lint;
mod memory;
mod parts;
mod phases;
mod plan;
mod simulation;
mod suite;
mod targets;
mod verification;

pub use assessment::*;
pub use comparison::{
    ComparisonDocument, EntryDocument, InapplicableDocument, ScenarioComparisonDocument,
    TrackPointDocument,
};
pub use encounter::{
    ConductDocument, EncounterDocument, ManoeuvreDocument, MonitorDocument, RoleDocument,
    RuleViolationDocument, breaks, conduct_breaks,
};
pub use legs::PlannedLeg;
pub(crate) use lines::{TIME_LINE, headline, met, passing, plan_lines, turn, verdict_line};
pub use lint::{LintDocument, LintScenarioDocument, LintSummaryDocument, LintTargetDocument};
pub use memory::{
    KnownRoleDocument, MemoryDocument, PlannedManoeuvreDocument, StateDocument,
    TargetMemoryDocument,
};
pub(crate) use memory::{state_document, steady};
pub(crate) use parts::segment;
pub use parts::*;
pub use phases::{Phase, PhaseDocument};
pub use plan::control::{
    ControlDocument, ForceLimitsDocument, HomotopyClassDocument, StartAttemptDocument,
};
pub(crate) use plan::path_time::paths;
pub use plan::path_time::{
    PathCornerDocument, PathLegDocument, PathObstacleDocument, PathTimeDocument,
};
pub use plan::{PLAN_FORMAT, PLAN_MEBIBYTES, PlanDocument};
pub(crate) use plan::{
    cost_of, finite, minimised, objective, planner_names, position, segment_document, stats,
    timing, violations,
};
pub use simulation::*;
pub use suite::{
    INTERNAL_FAULT, NOT_APPLICABLE, SuiteDocument, SuiteRunDocument, SuiteSummaryDocument,
    UNREADABLE,
};
pub use targets::sets::{InitialSetDocument, VelocitySetDocument};
pub use targets::{ShipDocument, TargetDocument, TimedSetDocument};
pub use verification::{MarginDocument, VerificationDocument, VerifiedPlanDocument};

fn is_zero(value: &f64) -> bool {
    *value == 0.0
}

/// The JSON text of a document, indented, with a line end.
pub fn json(document: &impl serde::Serialize) -> serde_json::Result<String> {
    let mut text = serde_json::to_string_pretty(document)?;
    text.push('\n');
    Ok(text)
}
