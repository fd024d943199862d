//! Large runs over random scenes: scenes, judges, tables and bounds.
//!
//! The tests run each with few scenes; `examples/campaign.rs` with as many as asked for.
#![allow(dead_code, reason = "the tests and the program use a part each")]

pub mod behaviour;
pub mod compliance;
pub mod control;
pub mod control_scenes;
pub mod dense_search;
pub mod documents;
pub mod encounters;
pub mod harbour;
pub mod invariance;
pub mod mutations;
pub mod passing;
pub mod path_grid;
pub mod path_time;
pub mod replanning;
pub mod simulation;
pub mod statistics;
pub mod wild;

/// Seeds of the scenes of a campaign.
pub type Seeds = std::ops::Range<u64>;

/// Bounds that a campaign has missed, in words.
#[derive(Debug, Default)]
pub struct Report {
    pub missed: Vec<String>,
}

impl Report {
    pub fn require(&mut self, holds: bool, otherwise: impl FnOnce() -> String) {
        if !holds {
            self.missed.push(otherwise());
        }
    }

    /// Prints in how many of `all` scenes something fails, with the 95 % upper bound and the first
    /// seeds, and requires at most this share of them.
    pub fn at_most(&mut self, name: &str, what: &str, share: f64, failing: &[u64], all: usize) {
        let bound = 100.0 * statistics::failure_bound(failing.len(), all);
        let few = &failing[..failing.len().min(8)];
        println!(
            "  {what:36} {}/{all} (< {bound:.2} %) {few:?}",
            failing.len()
        );
        self.require(failing.len() as f64 <= share * all as f64, || {
            format!("{name}: {what}: {failing:?} of {all}")
        });
    }

    /// Panics if a bound was missed.
    pub fn assert_met(&self) {
        assert!(self.missed.is_empty(), "{:#?}", self.missed);
    }
}
