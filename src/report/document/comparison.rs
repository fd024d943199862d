//! The comparison document: contenders of every scenario side by side.

use serde::{Deserialize, Serialize};

use super::parts::{CostDocument, PositionDocument, SearchStatsDocument, TimingDocument};
use super::plan::{cost_of, finite, position, stats, timing};
use crate::comparison::{Entry, Inapplicable, Sailed};
use crate::report::comparison::ComparisonRow;
use crate::report::words;

/// Seconds between two positions of a track.
const TRACK_STEP: f64 = 5.0;

/// Every scenario that was compared, in order.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[expect(missing_docs, reason = "the names say it")]
pub struct ComparisonDocument {
    pub comparisons: Vec<ScenarioComparisonDocument>,
}

/// One scenario. Where it could not be read `error` says why, and the rest is empty.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[expect(missing_docs, reason = "docs/compare.md says what each key means")]
pub struct ScenarioComparisonDocument {
    pub file: String,
    pub scenario: Option<String>,
    pub error: Option<String>,
    pub entries: Vec<EntryDocument>,
    pub inapplicable: Vec<InapplicableDocument>,
}

/// One contender.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[expect(missing_docs, reason = "docs/compare.md says what each key means")]
pub struct EntryDocument {
    pub method: String,
    pub max_risk: f64,
    /// Of a planner; null for a baseline.
    pub objective: Option<String>,
    pub outcome: String,
    pub reason: Option<String>,
    /// Of a baseline: clear of sets, hulls and land.
    pub verified: bool,
    pub cost: Option<CostDocument>,
    /// Positive.
    pub largest_turn_deg: Option<f64>,
    pub largest_turn_side: Option<String>,
    pub search_stats: Option<SearchStatsDocument>,
    pub timing: Option<TimingDocument>,
    /// Every five seconds, and at the end.
    pub track: Vec<TrackPointDocument>,
}

/// A place at a time.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[expect(missing_docs, reason = "the names are the units")]
pub struct TrackPointDocument {
    pub t_s: f64,
    #[serde(flatten)]
    pub position: PositionDocument,
}

/// A method that the scenario has no use for.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[expect(missing_docs, reason = "the names say it")]
pub struct InapplicableDocument {
    pub method: String,
    pub reason: String,
}

impl ScenarioComparisonDocument {
    /// The entry of a scenario that was compared; `rows` are those of the entries.
    pub fn of(
        file: String,
        title: &str,
        entries: &[Entry],
        rows: &[ComparisonRow],
        inapplicable: &[Inapplicable],
    ) -> Self {
        Self {
            file,
            scenario: Some(title.to_owned()),
            error: None,
            entries: (entries.iter().zip(rows))
                .map(|(entry, row)| EntryDocument::of(entry, row))
                .collect(),
            inapplicable: (inapplicable.iter())
                .map(|other| InapplicableDocument {
                    method: other.method.to_string(),
                    reason: other.reason.clone(),
                })
                .collect(),
        }
    }

    /// The entry of a file that gave no comparison.
    pub fn failed(file: String, error: String) -> Self {
        Self {
            file,
            scenario: None,
            error: Some(error),
            entries: Vec::new(),
            inapplicable: Vec::new(),
        }
    }
}

impl EntryDocument {
    fn of(entry: &Entry, row: &ComparisonRow) -> Self {
        let run = match &entry.result {
            Sailed::Planned(run) => Some(run),
            Sailed::Baseline(_) | Sailed::Nothing(_) => None,
        };
        let objective = run
            .and_then(|run| run.planned.outcome.plan())
            .map(|plan| plan.cost);
        Self {
            method: row.method.to_string(),
            max_risk: row.max_risk,
            objective: run.map(|run| words::objective(&run.scenario).to_owned()),
            outcome: row.outcome.to_owned(),
            reason: row.reason.clone(),
            verified: row.verified == Some(true),
            cost: entry.evaluation().map(|evaluation| {
                // a baseline minimises nothing else
                let objective = objective.unwrap_or(evaluation.space_time_error);
                let mut cost = cost_of(evaluation, objective, row.arrived, entry.risks());
                cost.delay_s = row.delay;
                cost
            }),
            largest_turn_deg: row.largest_turn.map(|turn| turn.degrees),
            largest_turn_side: row.largest_turn.map(|turn| turn.side.to_string()),
            search_stats: run.map(|run| stats(run)),
            timing: run.map(|run| timing(run)),
            track: track(entry),
        }
    }
}

fn track(entry: &Entry) -> Vec<TrackPointDocument> {
    let Some(trajectory) = entry.trajectory() else {
        return Vec::new();
    };
    let end = trajectory.end_time();
    let steps = (end / TRACK_STEP).ceil().max(1.0) as usize;
    (0..=steps)
        .map(|k| (k as f64 * TRACK_STEP).min(end))
        .filter_map(|time| Some((finite(time)?, entry.position_at(time)?)))
        .map(|(t_s, at)| TrackPointDocument {
            t_s,
            position: position(at),
        })
        .collect()
}
