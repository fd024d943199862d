//! Comparison document: the candidates of every scenario.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::parts::{
    CostDocument, LowerBoundDocument, PositionDocument, SearchStatsDocument, TimingDocument,
};
use super::plan::departure::Departure;
use searoom_evaluation::CandidateOutcome;
use searoom_model::ObjectiveKind;

/// All compared scenarios, in order.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ComparisonDocument {
    pub comparisons: Vec<ScenarioComparisonDocument>,
}

/// One scenario. For an unreadable file, `error` gives the reason and the rest is empty.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ScenarioComparisonDocument {
    pub file: String,
    pub scenario: Option<String>,
    pub error: Option<String>,
    pub entries: Vec<EntryDocument>,
    pub inapplicable: Vec<InapplicableDocument>,
}

/// Result of one candidate.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct EntryDocument {
    /// Not an enum: the label of any planner, with its search and what made the plan.
    pub method: String,
    pub max_risk: f64,
    pub objective: Option<ObjectiveKind>,
    pub outcome: CandidateOutcome,
    pub verdict: String,
    pub reason: Option<String>,
    pub verified: bool,
    pub safe: bool,
    pub cost: Option<CostDocument>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub lower_bound: Option<LowerBoundDocument>,
    /// The manoeuvre in brief; null without one.
    pub departure: Option<Departure>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub velocity: Option<HeldVelocityDocument>,
    /// Words of [`Paragraph`](searoom_colregs::Paragraph) and
    /// [`Monitor`](searoom_colregs::compliance::Monitor).
    pub breaks: Option<Vec<String>>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub collision: Option<CollisionDocument>,
    pub search_stats: Option<SearchStatsDocument>,
    pub timing: Option<TimingDocument>,
    pub track: Vec<TrackPointDocument>,
}

/// The velocity that a baseline holds.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct HeldVelocityDocument {
    pub course_deg: f64,
    pub speed_mps: f64,
}

/// The first contact of a motion that collides, to a second.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct CollisionDocument {
    pub with: String,
    pub t_s: f64,
}

/// Position at a time.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct TrackPointDocument {
    pub t_s: f64,
    #[serde(flatten)]
    pub position: PositionDocument,
}

/// Method that does not apply to the scenario.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct InapplicableDocument {
    pub method: String,
    pub reason: String,
}

/// A scenario on which candidates of the type `E` are compared, beside the methods `I` that do not
/// apply to it.
pub trait Compared<E, I> {
    /// Title of the scenario.
    fn title(&self) -> String;
    /// The result of one candidate.
    fn entry(&self, entry: &E) -> EntryDocument;
    /// A method that does not apply.
    fn inapplicable(&self, method: &I) -> InapplicableDocument;
}

impl ScenarioComparisonDocument {
    /// Builds the document of a compared scenario.
    pub fn of<E, I>(
        file: String,
        scenario: &impl Compared<E, I>,
        entries: &[E],
        inapplicable: &[I],
    ) -> Self {
        Self {
            file,
            scenario: Some(scenario.title()),
            error: None,
            entries: (entries.iter())
                .map(|entry| scenario.entry(entry))
                .collect(),
            inapplicable: (inapplicable.iter())
                .map(|method| scenario.inapplicable(method))
                .collect(),
        }
    }

    /// Builds the entry of a file that yields no comparison.
    pub fn failed(file: String, error: String) -> Self {
        Self {
            file,
            error: Some(error),
            ..Self::default()
        }
    }
}
