//! `searoom inspect`: contents of a recording.

use std::path::Path;

use anyhow::{Context, anyhow, bail};
use searoom::document::{
    InspectionDocument, PlanDocument, ScenarioComparisonDocument, SimulationDocument,
};
use searoom::recording::{Checksum, EntityTable, ReadError, Recorded};
use searoom::report::{
    Display, comparison_table, entities_table, plan_document_text, simulation_text, timelines_text,
};
use serde_json::Value;

use super::args::InspectArgs;
use super::output::{Output, csv};
use super::runner::guarded;
use super::status::ExitStatus;
use super::verify::RecordedPlans;

/// Maximum number of similar entity names suggested for a missing one.
const OFFERED: usize = 3;

pub fn inspect(args: &InspectArgs, output: &Output) -> anyhow::Result<ExitStatus> {
    let recorded = read(&args.recording, Recorded::read)?;
    if recorded.checksum == Checksum::Gone {
        output.note(&format_args!("{}: {GONE}", args.recording.display()));
    }
    if args.plan {
        let document = document_of(&recorded, &args.recording)?;
        return Ok(output.print(document.trim_end()));
    }
    if let Some(entity) = &args.csv {
        let table = table(&recorded, entity, &args.recording)?;
        let text = String::from_utf8(csv(table.csv_rows())?)?;
        return Ok(output.print(text.trim_end()));
    }
    let contents = Contents::of(&args.recording, &recorded);
    Ok(output.show(args.json, &contents.document, || {
        contents.text(output.display)
    }))
}

/// Note about a recording that another program wrote again.
const GONE: &str =
    "another program wrote the recording again: its checksum is gone, and no byte is checked";

/// Reads a recording. A panic of the decoder counts as an invalid file.
fn read<T>(path: &Path, read: fn(&Path) -> Result<T, ReadError>) -> anyhow::Result<T> {
    match guarded(|| read(path)) {
        // the message already includes its cause
        Ok(read) => read.map_err(|error| anyhow!("{error}")),
        Err(fault) => bail!("{}: damaged: its decoder gave up ({fault})", path.display()),
    }
}

/// The plan documents of the recordings of a file.
pub fn plan_documents(path: &Path) -> anyhow::Result<RecordedPlans> {
    let all = read(path, Recorded::read_all)?;
    let is_gone = all
        .iter()
        .any(|recorded| recorded.checksum == Checksum::Gone);
    let texts = match all.iter().find_map(other_kind) {
        Some(other) => Err(other),
        None => {
            let texts = all.iter().map(|recorded| document_of(recorded, path));
            Ok(texts.collect::<anyhow::Result<_>>()?)
        }
    };
    Ok(RecordedPlans {
        texts,
        note: is_gone.then_some(GONE),
    })
}

fn other_kind(recorded: &Recorded) -> Option<&'static str> {
    match (recorded.comparison(), recorded.simulation()) {
        (Some(_), _) => Some("the recording of a comparison, which holds no plan document"),
        (_, Some(_)) => Some("the recording of a simulation, which holds no plan document"),
        (None, None) => None,
    }
}

fn document_of(recorded: &Recorded, path: &Path) -> anyhow::Result<String> {
    if let Some(other) = other_kind(recorded) {
        bail!(
            "{}: {other}; `searoom inspect --json` prints its own",
            path.display()
        );
    }
    recorded.document().with_context(|| {
        format!(
            "{}: holds no plan document: it was written without one",
            path.display()
        )
    })
}

fn table(recorded: &Recorded, entity: &str, file: &Path) -> anyhow::Result<EntityTable> {
    if let Some(table) = recorded.table(entity) {
        return Ok(table);
    }
    let wanted = format!("/{}", entity.trim_start_matches('/'));
    let mut all: Vec<(f64, String)> = recorded
        .entities()
        .into_iter()
        .map(|e| (strsim::jaro_winkler(&wanted, &e.path), e.path))
        .collect();
    all.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
    let near: Vec<String> = all
        .into_iter()
        .take(OFFERED)
        .map(|(_, path)| path)
        .collect();
    bail!(
        "{}: no entity {wanted}; the nearest names: {}",
        file.display(),
        near.join(", ")
    )
}

/// The document, and what its text is made of.
struct Contents {
    document: InspectionDocument,
    plan: Option<PlanDocument>,
    compared: Option<ScenarioComparisonDocument>,
    sailed: Option<SimulationDocument>,
}

/// A timeline with its range, to the millisecond.
impl Contents {
    fn of(file: &Path, recorded: &Recorded) -> Self {
        let parsed = |text: Option<String>| -> Value {
            text.and_then(|text| serde_json::from_str(&text).ok())
                .unwrap_or_default()
        };
        let document = parsed(recorded.document());
        let comparison = parsed(recorded.comparison())
            .pointer_mut("/comparisons/0")
            .map(Value::take)
            .unwrap_or_default();
        let simulation = parsed(recorded.simulation());
        let scenario = [&document, &comparison, &simulation]
            .into_iter()
            .find_map(|d| d.get("scenario"))
            .cloned();
        let field = |key: &str| document.get(key).cloned().unwrap_or_default();
        let names = document["encounters"].as_array().into_iter().flatten();
        let inspection = InspectionDocument {
            file: file.display().to_string(),
            bytes: recorded.bytes,
            application: "searoom",
            rerun_version: recorded.version.clone(),
            checksum: recorded.checksum,
            scenario: scenario.unwrap_or_default(),
            planner: field("planner"),
            search: field("search"),
            outcome: field("outcome"),
            verified: field("verified"),
            safe: field("safe"),
            cost: field("cost"),
            method: field("method"),
            search_stats: field("search_stats"),
            escape: field("escape"),
            targets: names.cloned().collect(),
            comparison: comparison.clone(),
            simulation: simulation.clone(),
            timelines: recorded.timelines(),
            entities: recorded.entities(),
        };
        Self {
            document: inspection,
            plan: serde_json::from_value(document).ok(),
            compared: serde_json::from_value(comparison).ok(),
            sailed: serde_json::from_value(simulation).ok(),
        }
    }

    fn text(&self, display: Display) -> String {
        let mut lines = vec![format!(
            "{}: {:.0} kB, recorded by {} with Rerun {}, checksum {}",
            self.document.file,
            self.document.bytes as f64 / 1e3,
            self.document.application,
            self.document
                .rerun_version
                .as_deref()
                .unwrap_or("of an unknown version"),
            self.document.checksum
        )];
        lines.push(match (&self.plan, &self.compared, &self.sailed) {
            (Some(plan), _, _) => plan_document_text(plan, display),
            (None, Some(compared), _) => comparison_table(compared).text(display),
            (None, None, Some(sailed)) => simulation_text(sailed, display),
            (None, None, None) => "no plan document in it".to_owned(),
        });
        lines.push(String::new());
        let timelines = timelines_text(&self.document.timelines, "none");
        lines.push(format!("Timelines: {timelines}"));
        lines.push(format!("Entities: {}", self.document.entities.len()));
        lines.push(entities_table(&self.document.entities, display));
        lines.join("\n")
    }
}
