//! The JSON documents, docs/documents.md.
//!
//! A number that is not finite is written as null. Keys of what does not exist yet are absent.

mod alteration;
mod assessment;
mod comparison;
mod control;
mod encounter;
mod lint;
mod parts;
mod path_time;
mod plan;
mod suite;
mod targets;
mod verification;

pub use assessment::*;
pub use comparison::{
    ComparisonDocument, EntryDocument, InapplicableDocument, ScenarioComparisonDocument,
    TrackPointDocument,
};
pub use control::{
    ControlDocument, ForceLimitsDocument, HomotopyClassDocument, StartAttemptDocument,
};
pub use encounter::{
    BreachDocument, ConductDocument, EncounterDocument, MonitorDocument, RoleDocument,
};
pub use lint::{LintDocument, LintScenarioDocument, LintSummaryDocument, LintTargetDocument};
pub use parts::*;
pub(crate) use path_time::paths;
pub use path_time::{PathCornerDocument, PathLegDocument, PathObstacleDocument, PathTimeDocument};
pub use plan::{PLAN_FORMAT, PlanDocument};
pub use suite::{
    INTERNAL_FAULT, NOT_APPLICABLE, SuiteDocument, SuiteRunDocument, SuiteSummaryDocument,
    UNREADABLE,
};
pub use targets::{ShipDocument, SpellDocument, TargetDocument};
pub use verification::{MarginDocument, VerificationDocument, VerifiedPlanDocument};
