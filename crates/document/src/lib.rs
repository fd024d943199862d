#![doc = include_str!("../README.md")]
#![forbid(unsafe_code)]
#![expect(
    missing_docs,
    reason = "docs/reference/documents.md says what each key means"
)]

mod assessment;
mod check;
mod comparison;
mod encounter;
mod lint;
mod memory;
mod out_of_reach;
mod parts;
mod plan;
mod simulation;
mod suite;
mod targets;
mod verification;
mod watch;

use std::io::{self, Write};

use schemars::generate::SchemaSettings;
use schemars::{JsonSchema, Schema};
use serde_json::Serializer;
use serde_json::ser::{Formatter, PrettyFormatter};

pub use assessment::*;
pub use check::*;
pub use comparison::*;
pub use encounter::*;
pub use lint::*;
pub use memory::*;
pub use out_of_reach::*;
pub use parts::*;
pub use plan::control::*;
pub use plan::departure::{
    Departure, LEAST_DEG as LEAST_DEPARTURE_DEG, SailedManoeuvreDocument, departure, manoeuvres,
    until as departure_until,
};
pub use plan::motions::{PlannedLeg, STILL_MPS, is_same_motion};
pub use plan::path_time::*;
pub use plan::phases::*;
pub use plan::*;
pub use searoom_evaluation::{CandidateOutcome, PlanOutcome};
pub use simulation::*;
pub use suite::*;
pub use targets::sets::{InitialSetDocument, VelocitySetDocument, vertices};
pub use targets::*;
pub use verification::*;
pub use watch::*;

/// Makes the JSON schema of a document.
pub type MakeSchema = fn() -> Schema;

/// The JSON schemas of the documents, by the command that prints each with `--json`.
pub const SCHEMAS: [(&str, MakeSchema); 12] = [
    ("plan", schema::<PlanDocument>),
    ("suite", schema::<SuiteDocument>),
    ("lint", schema::<LintDocument>),
    ("compare", schema::<ComparisonDocument>),
    ("simulate", schema::<SimulatedDocument>),
    ("campaign", schema::<CampaignDocument>),
    ("campaign-rare", schema::<RareContactDocument>),
    ("assess", schema::<AssessmentDocument>),
    ("check", schema::<CheckDocument>),
    ("verify", schema::<VerificationDocument>),
    ("inspect", schema::<InspectionDocument>),
    ("watch", schema::<WatchDocument>),
];

fn schema<T: JsonSchema>() -> Schema {
    // of what is written: a reader also accepts documents without later keys
    let settings = SchemaSettings::draft2020_12().for_serialize();
    settings.into_generator().into_root_schema_for::<T>()
}

fn is_zero(value: &f64) -> bool {
    *value == 0.0
}

/// The JSON text of a document, indented, with a line end. An array within an array, such as a
/// corner of a polygon, is on one line.
pub fn json(document: &impl serde::Serialize) -> serde_json::Result<String> {
    let mut text = Vec::new();
    document.serialize(&mut Serializer::with_formatter(&mut text, Rows::default()))?;
    text.push(b'\n');
    String::from_utf8(text).map_err(serde::ser::Error::custom)
}

/// Writes indented JSON with the inner of two arrays on one line.
#[derive(Default)]
struct Rows {
    pretty: PrettyFormatter<'static>,
    /// The arrays and objects that are open, the innermost last: true for arrays.
    arrays: Vec<bool>,
}

impl Rows {
    fn in_row(&self) -> bool {
        self.arrays.ends_with(&[true, true])
    }
}

impl Formatter for Rows {
    fn begin_array<W: ?Sized + Write>(&mut self, to: &mut W) -> io::Result<()> {
        self.arrays.push(true);
        match self.in_row() {
            true => to.write_all(b"["),
            false => self.pretty.begin_array(to),
        }
    }

    fn end_array<W: ?Sized + Write>(&mut self, to: &mut W) -> io::Result<()> {
        let in_row = self.in_row();
        self.arrays.pop();
        match in_row {
            true => to.write_all(b"]"),
            false => self.pretty.end_array(to),
        }
    }

    fn begin_array_value<W: ?Sized + Write>(&mut self, to: &mut W, first: bool) -> io::Result<()> {
        match (self.in_row(), first) {
            (true, true) => Ok(()),
            (true, false) => to.write_all(b", "),
            (false, _) => self.pretty.begin_array_value(to, first),
        }
    }

    fn end_array_value<W: ?Sized + Write>(&mut self, to: &mut W) -> io::Result<()> {
        match self.in_row() {
            true => Ok(()),
            false => self.pretty.end_array_value(to),
        }
    }

    fn begin_object<W: ?Sized + Write>(&mut self, to: &mut W) -> io::Result<()> {
        self.arrays.push(false);
        self.pretty.begin_object(to)
    }

    fn end_object<W: ?Sized + Write>(&mut self, to: &mut W) -> io::Result<()> {
        self.arrays.pop();
        self.pretty.end_object(to)
    }

    fn begin_object_key<W: ?Sized + Write>(&mut self, to: &mut W, first: bool) -> io::Result<()> {
        self.pretty.begin_object_key(to, first)
    }

    fn begin_object_value<W: ?Sized + Write>(&mut self, to: &mut W) -> io::Result<()> {
        self.pretty.begin_object_value(to)
    }

    fn end_object_value<W: ?Sized + Write>(&mut self, to: &mut W) -> io::Result<()> {
        self.pretty.end_object_value(to)
    }
}

#[cfg(test)]
mod tests {
    use super::{SCHEMAS, json};

    /// The words that the schema of a document lists for a type.
    fn words(document: &str, kind: &str) -> String {
        let (_, make) = SCHEMAS
            .iter()
            .find(|(name, _)| *name == document)
            .expect(document);
        let schema = make().to_value();
        let each = schema["$defs"][kind]["oneOf"]
            .as_array()
            .expect(kind)
            .iter();
        let each = each.map(|word| word["const"].as_str().expect("a word"));
        each.collect::<Vec<_>>().join(", ")
    }

    #[test]
    fn schemas_list_the_words() {
        for (document, kind, expected) in [
            (
                "plan",
                "PlanOutcome",
                "solved, relaxed, infeasible, deadline",
            ),
            ("plan", "SearchKind", "a-star, dijkstra, thorough"),
            (
                "plan",
                "RelaxationKind",
                "compliance, domain, risk, arrival",
            ),
            ("plan", "Measure", "m, deg, s"),
            (
                "compare",
                "CandidateOutcome",
                "solved, relaxed, infeasible, deadline, clear, collides",
            ),
            ("simulate", "SensorType", "exact, ais, radar"),
            ("lint", "Matters", "meets, clear, never"),
            ("assess", "AssessedSets", "hard, domains"),
            ("inspect", "Checksum", "valid, gone"),
        ] {
            assert_eq!(words(document, kind), expected, "{document}");
        }
        let plan = (SCHEMAS[0].1)().to_value();
        assert_eq!(plan["properties"]["outcome"]["$ref"], "#/$defs/PlanOutcome");
        let about = &plan["$defs"]["PlanOutcome"]["oneOf"][0]["description"];
        assert_eq!(about, "A plan that satisfies the whole request.");
    }

    #[test]
    fn inner_arrays_are_on_one_line() {
        let value =
            serde_json::json!({ "a": [[1, 2.5], [], [{ "b": [null] }]], "c": [], "d": [3] });
        let text = json(&value).expect("JSON");
        assert!(text.contains("\n    [1, 2.5],\n    [],\n"), "{text}");
        let read: serde_json::Value = serde_json::from_str(&text).expect("JSON");
        assert_eq!(read, value);
    }
}
