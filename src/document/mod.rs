//! Published JSON documents, the single description of a result. Text, pages and `inspect` render
//! them, and `verify` checks a [`PlanDocument`] alone.
//!
//! Non-finite numbers are written as null.
#![expect(missing_docs, reason = "docs/documents.md says what each key means")]

mod assessment;
mod check;
mod comparison;
mod encounter;
mod lines;
mod lint;
mod memory;
mod parts;
mod plan;
mod simulation;
mod suite;
mod targets;
mod verification;

use schemars::generate::SchemaSettings;
use schemars::{JsonSchema, Schema};

pub use assessment::*;
pub use check::*;
pub use comparison::*;
pub use encounter::*;
pub(crate) use lines::{
    TIME_LINE, headline, in_brackets, met, passing, plan_lines, turn, verdict_line, verdict_parts,
};
pub use lint::*;
pub use memory::*;
pub use parts::*;
pub use plan::control::*;
pub use plan::legs::PlannedLeg;
pub use plan::path_time::*;
pub use plan::phases::*;
pub use plan::*;
pub use simulation::*;
pub use suite::*;
pub use targets::sets::{InitialSetDocument, VelocitySetDocument};
pub use targets::*;
pub use verification::*;

/// Makes the JSON schema of a document.
pub type MakeSchema = fn() -> Schema;

/// The JSON schemas of the documents, by the command that prints each with `--json`.
pub const SCHEMAS: [(&str, MakeSchema); 9] = [
    ("plan", schema::<PlanDocument>),
    ("suite", schema::<SuiteDocument>),
    ("lint", schema::<LintDocument>),
    ("compare", schema::<ComparisonDocument>),
    ("simulate", schema::<SimulatedDocument>),
    ("assess", schema::<AssessmentDocument>),
    ("check", schema::<CheckDocument>),
    ("verify", schema::<VerificationDocument>),
    ("inspect", schema::<InspectionDocument>),
];

fn schema<T: JsonSchema>() -> Schema {
    // of what is written: a reader also accepts documents without later keys
    let settings = SchemaSettings::draft2020_12().for_serialize();
    settings.into_generator().into_root_schema_for::<T>()
}

fn is_zero(value: &f64) -> bool {
    *value == 0.0
}

/// The JSON text of a document, indented, with a line end.
pub fn json(document: &impl serde::Serialize) -> serde_json::Result<String> {
    let mut text = serde_json::to_string_pretty(document)?;
    text.push('\n');
    Ok(text)
}
