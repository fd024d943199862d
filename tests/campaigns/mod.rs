//! Large runs over random scenes: scenes, judges, tables and bounds.
//!
//! The tests run each with few scenes; `cargo campaign` with as many as asked for.
#![allow(dead_code, reason = "the tests and the program use a part each")]

pub mod ablation;
pub mod behaviour;
pub mod closed_loop;
pub mod dense_search;
pub mod documents;
pub mod encounter_generator;
pub mod forces;
pub mod path_time;
pub mod plans;
pub mod scene_file;
pub mod statistics;
pub mod stopping;
pub mod wild;

use std::collections::BTreeMap;

use rayon::prelude::*;
use searoom::scenario::{Compliance, Scenario};

use encounter_generator::{EncounterKind, Meeting, Placement, random_meeting};

/// Seeds of the scenes of a campaign.
pub type Seeds = std::ops::Range<u64>;

/// A random meeting under the rules.
pub fn meeting(kind: EncounterKind, seed: u64, meeting: &Meeting) -> Scenario {
    let drawn = random_meeting(kind, seed, Placement::Random, meeting).expect("drawn");
    Scenario {
        compliance: Compliance::Rules,
        ..drawn.scenario
    }
}

/// Plays random meetings under the rules, each with its seed.
pub fn meetings<T: Send>(
    kind: EncounterKind,
    seeds: Seeds,
    which: &Meeting,
    play: impl Fn(Scenario, u64) -> T + Sync,
) -> Vec<(u64, T)> {
    (seeds.into_par_iter())
        .map(|seed| (seed, play(meeting(kind, seed, which), seed)))
        .collect()
}

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

    /// Requires that a file was written.
    pub fn written(&mut self, result: std::io::Result<()>, file: &std::path::Path) {
        let file = file.display();
        self.require(result.is_ok(), || {
            format!("cannot write {file}: {result:?}")
        });
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

    /// Prints the seeds of each name, and how many there are.
    pub fn print_seeds<'s>(kind: &str, named: impl Iterator<Item = (&'s str, u64)>) {
        let mut seeds: BTreeMap<&str, Vec<u64>> = BTreeMap::new();
        for (name, seed) in named {
            seeds.entry(name).or_default().push(seed);
        }
        for (name, seeds) in seeds {
            let few = &seeds[..seeds.len().min(8)];
            println!("  {kind}: {name}: {}, seeds {few:?}", seeds.len());
        }
    }

    /// Requires that both judges are content with this share of all motions.
    pub fn content(&mut self, kind: &str, share: f64, content: usize, all: usize) {
        self.require(content as f64 >= share * all as f64, || {
            format!("{kind}: both judges content with {content} of {all}")
        });
    }

    /// Panics if a bound was missed.
    pub fn assert_met(&self) {
        assert!(self.missed.is_empty(), "{:#?}", self.missed);
    }
}
