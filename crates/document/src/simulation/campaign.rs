//! Summary document of a campaign, see docs/guide/campaigns.md.

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Format name of the summary.
pub const CAMPAIGN_FORMAT: &str = "searoom-campaign-summary/1";

/// Summary of the rows that a campaign has so far.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct CampaignDocument {
    pub format: String,
    pub build: String,
    pub campaign: String,
    /// Hash of the specification.
    pub specification: String,
    /// Rows of the specification, and those that are there.
    pub rows: u64,
    pub rows_there: u64,
    /// Confidence of every interval.
    pub confidence: f64,
    pub all: GroupDocument,
    /// Over the strata of each class.
    pub classes: Vec<GroupDocument>,
    pub strata: Vec<GroupDocument>,
    /// The rows with the least clearance, the least first.
    pub worst: Vec<WorstRowDocument>,
    /// Of the rows that break each rule or monitor, the few with the least clearance, the least first.
    pub worst_breaks: BTreeMap<String, Vec<u64>>,
    pub timing: CampaignTimingDocument,
}

/// Processor time of all rows.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct CampaignTimingDocument {
    pub cpu_s: f64,
}

/// Counts over some rows.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct GroupDocument {
    pub name: String,
    /// Class of the rows; null where they are of several. Not an enum: it is the text in the
    /// index of the campaign's folder.
    pub class: Option<String>,
    /// Rows that were sailed: the trials of every share.
    pub rows: u64,
    /// Rows at which the program failed.
    pub faults: u64,
    /// Rows with a contact.
    pub contact: ShareDocument,
    /// Rows with a cycle without a plan.
    pub no_plan: ShareDocument,
    /// Rows with a plan that is not safe.
    pub unsafe_plan: ShareDocument,
    /// Rows with a target outside the sets of a plan, in truth or as it was measured.
    pub outside_sets: ShareDocument,
    /// Rows with a target that was measured outside the sets of the plan before.
    pub measured_outside: ShareDocument,
    /// Rows with a broken rule or a violated monitor.
    pub rule_broken: ShareDocument,
    /// Rows that break each rule or monitor.
    pub breaks: BTreeMap<String, u64>,
    /// Least distance of the hulls in each row; null without a target.
    pub clearance_m: Option<QuantilesDocument>,
    pub timing: GroupTimingDocument,
}

/// Figures that depend on the machine.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct GroupTimingDocument {
    /// Rows with a plan that took longer than the delay.
    pub late: ShareDocument,
}

/// How many rows, and bounds on their probability.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ShareDocument {
    pub count: u64,
    /// Clopper-Pearson interval, for a number of rows that was fixed beforehand.
    pub exact: [f64; 2],
    /// Interval that holds at all numbers of rows at once: a run may be watched and stopped.
    pub anytime: [f64; 2],
}

/// Quantiles over rows.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct QuantilesDocument {
    pub least: f64,
    pub percent_1: f64,
    pub percent_5: f64,
    pub median: f64,
}

/// A row to look at.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct WorstRowDocument {
    pub row: u64,
    pub stratum: String,
    pub clearance_m: f64,
    pub contact: bool,
}

/// Format name of an estimate of rare contacts.
pub const RARE_FORMAT: &str = "searoom-campaign-rare/1";

/// Probability of a contact in a stratum, by multilevel splitting.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct RareContactDocument {
    pub format: String,
    pub build: String,
    pub campaign: String,
    /// Hash of the specification.
    pub specification: String,
    pub stratum: String,
    /// Trajectories that begin at each level of a replica.
    pub trajectories: usize,
    /// Confidence of the interval.
    pub confidence: f64,
    /// Probability that hulls meet in a row: the mean of the replicas.
    pub contact: f64,
    pub interval: [f64; 2],
    pub standard_error: f64,
    /// Independent estimates.
    pub replicas: Vec<f64>,
    /// The levels in their order; the last is a contact.
    pub levels: Vec<RareLevelDocument>,
    /// Simulated seconds of the run that fixes the levels.
    pub pilot_s: f64,
    /// Simulated seconds of all replicas.
    pub replicas_s: f64,
    /// Plain rows for the same standard error; null without a contact.
    pub plain_rows: Option<f64>,
    /// Simulated seconds of these.
    pub plain_s: Option<f64>,
}

/// A level of multilevel splitting.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct RareLevelDocument {
    /// Distance from a contact, metres.
    pub distance_m: f64,
    /// Fraction of the trajectories from the level before that reach it; null where none began.
    pub fraction: Option<f64>,
}
