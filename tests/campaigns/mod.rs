//! Large runs over random scenes: scenes, judges, tables and bounds.
//!
//! The tests run each with few scenes; `examples/campaign.rs` with as many as asked for.
#![allow(dead_code, reason = "the tests and the program use a part each")]

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

    /// Panics if a bound was missed.
    pub fn assert_met(&self) {
        assert!(self.missed.is_empty(), "{:#?}", self.missed);
    }
}
