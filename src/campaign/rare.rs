//! Contacts too rare for plain rows, by multilevel splitting of simulations.

use std::sync::atomic::AtomicBool;

use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;

use super::specification::{Specification, Stratum};
use super::splitting::{Effort, Process, Seeds, estimate};
use super::summary::CONFIDENCE;
use crate::document::{RARE_FORMAT, RareContactDocument, RareLevelDocument};
use crate::simulation::Simulation;

/// A simulation that is split by how near a contact is; `None` where none could be drawn.
#[derive(Clone)]
struct Sailing(Option<Box<Simulation>>);

impl Sailing {
    /// Draws a scenario of a stratum from a seed alone.
    fn of(stratum: &Stratum, seed: u64) -> Self {
        let drawn = stratum.draw(&mut ChaCha8Rng::seed_from_u64(seed));
        let simulation = drawn.and_then(|drawn| Simulation::new(drawn.scenario, false).ok());
        Self(simulation.map(Box::new))
    }
}

impl Process for Sailing {
    fn reseed(&mut self, seed: u64) {
        if let Some(simulation) = &mut self.0 {
            simulation.reseed(seed);
        }
    }

    fn step(&mut self) -> f64 {
        let Some(simulation) = &mut self.0 else {
            return 0.0;
        };
        let before = simulation.time();
        simulation.step();
        simulation.time() - before
    }

    fn distance(&self) -> f64 {
        let simulation = self.0.as_ref();
        simulation.map_or(f64::INFINITY, |s| s.distance_from_contact())
    }

    fn is_over(&self) -> bool {
        self.0.as_ref().is_none_or(|s| s.finished())
    }
}

/// Estimates the probability that hulls meet in a row of a stratum, by multilevel splitting. The same
/// on any number of threads. Where `stop` is set, from the replicas that had ended; `None` with fewer
/// than two.
pub fn rare_contacts(
    specification: &Specification,
    stratum: usize,
    effort: &Effort,
    stop: &AtomicBool,
    tick: &dyn Fn(),
) -> Option<RareContactDocument> {
    let (index, stratum) = (stratum, &specification.strata[stratum]);
    let seeds = Seeds {
        seed: specification.seed,
        stream: index as u32,
    };
    let new = |seed| Sailing::of(stratum, seed);
    let found = estimate(&new, seeds, effort, CONFIDENCE, stop, tick)?;
    let rows = found.probability * (1.0 - found.probability) / found.standard_error.powi(2);
    let level = |(distance_m, fraction): &(f64, Option<f64>)| RareLevelDocument {
        distance_m: *distance_m,
        fraction: *fraction,
    };
    Some(RareContactDocument {
        format: RARE_FORMAT.to_owned(),
        build: super::part::build(),
        campaign: specification.name.clone(),
        specification: specification.hash.clone(),
        stratum: stratum.name.clone(),
        trajectories: effort.trajectories,
        confidence: CONFIDENCE,
        contact: found.probability,
        interval: found.interval,
        standard_error: found.standard_error,
        replicas: found.replicas,
        levels: found.levels.iter().map(level).collect(),
        pilot_s: found.cost[0],
        replicas_s: found.cost[1],
        plain_rows: Some(rows).filter(|rows| rows.is_finite()),
        plain_s: Some(rows * found.whole_cost).filter(|seconds| seconds.is_finite()),
    })
}
