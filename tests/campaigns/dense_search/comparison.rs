//! Costs of plans over those of the dense search.

use rayon::prelude::*;
use searoom::obstacle::{LandObstacle, Obstacle};
use searoom::pipeline::{self, problem};
use searoom::planner::{Problem, SearchKind, space_time};

use super::{Answer, DenseSearch, recheck};
use crate::campaigns::encounter_generator::{
    EncounterKind, Placement, random_encounter, random_traffic,
};
use crate::campaigns::plans::encounters::planned;
use crate::campaigns::statistics::quantile;
use crate::campaigns::{Report, Seeds};

/// Cost difference in m² below which small costs are equal.
const TINY: f64 = 5.0;

/// Cost in m² above which the search finds no alternative where the planner has no plan.
const WORTH_FINDING: f64 = 200_000.0;

/// Maximum ratio of J to that of the dense search.
const WORST_RATIO: f64 = 1.10;

/// Multiple of the cost below which the dense search looks. Where it looks at everything and finds
/// nothing, its cost counts as that.
const SEARCHED_FACTOR: f64 = 1.25;

/// Maximum ratios among several targets, of A* and of the thorough search: 90th percentile, worst.
/// With 60 scenes of four targets: 0.98 and 1.17, and 0.97 and 1.14.
const AMONG_SEVERAL: [[f64; 2]; 2] = [[1.03, 1.25], [1.02, 1.2]];

/// Runs the coarse search, then the fine search below its cost; the fine one takes ten times as
/// long.
fn searched(problem: &Problem, cost: f64, thorough: bool) -> Answer {
    let coarse = DenseSearch::coarse(cost).cheaper_than(problem, cost);
    if !thorough {
        return coarse;
    }
    let below = coarse.cheaper.as_ref().map_or(cost, |f| f.cost);
    let fine = DenseSearch::default().cheaper_than(problem, below);
    Answer {
        cheaper: fine.cheaper.or(coarse.cheaper),
        ..fine
    }
}

/// Cost of the dense search below `most`, which counts where nothing was found; `None` where it was
/// cut short before.
fn dense_cost(answer: &Answer, most: f64) -> Option<f64> {
    let found = answer.cheaper.as_ref().map(|found| found.cost);
    found.or(answer.complete.then_some(most))
}

/// Plans of A* and of the thorough search among several targets; of the latter the cheaper of the
/// two is kept, as the pipeline does. The coarse search alone is run, below
/// [`SEARCHED_FACTOR`] times the cost.
pub fn run_among(targets: usize, seeds: Seeds) -> Report {
    let seeds: Vec<u64> = seeds.collect();
    let compared = seeds.par_iter().filter_map(|&seed| {
        let drawn = random_traffic(targets, seed, Placement::Origin).expect("drawn");
        let obstacles: Vec<Obstacle> = (pipeline::sets(&drawn.scenario).into_iter())
            .map(|sets| sets.with_domain)
            .collect();
        let problem = Problem {
            tidy: None,
            ..problem(&drawn.scenario, &obstacles, LandObstacle::none())
        };
        let cost = |search| {
            let planned = space_time::plan(&Problem { search, ..problem });
            planned.outcome.plan().map(|plan| plan.cost)
        };
        let quick = cost(SearchKind::AStar)?;
        let thorough = cost(SearchKind::Thorough).map_or(quick, |cost| cost.min(quick));
        let most = SEARCHED_FACTOR * (quick + TINY);
        let answer = DenseSearch::coarse(thorough).cheaper_than(&problem, most);
        Some((
            seed,
            [quick, thorough],
            dense_cost(&answer, most),
            answer.complete,
        ))
    });
    let mut compared: Vec<_> = compared.collect();
    compared.sort_by_key(|(seed, ..)| *seed);
    let mut report = Report::default();
    for (seed, [quick, thorough], dense, _) in &compared {
        let dense = dense.map_or("cut short".to_owned(), |dense| format!("{dense:.0} m²"));
        println!(
            "{targets} targets {seed}: a-star {quick:.0} m², thorough {thorough:.0} m², dense search {dense}"
        );
    }
    for (k, name) in ["a-star", "thorough"].into_iter().enumerate() {
        let over = |(_, costs, dense, _): &(u64, [f64; 2], Option<f64>, bool)| {
            Some((costs[k] + TINY) / ((*dense)? + TINY))
        };
        let ratios: Vec<f64> = compared.iter().filter_map(over).collect();
        let [half, most, worst] = [0.5, 0.9, 1.0].map(|share| quantile(&ratios, share));
        println!(
            "{name}: J over that of the dense search: median {half:.3}, 90 % {most:.3}, worst {worst:.3}"
        );
        let [most_allowed, worst_allowed] = AMONG_SEVERAL[k];
        report.require(most <= most_allowed && worst <= worst_allowed, || {
            format!("{name}: {ratios:?}")
        });
    }
    let short = compared.iter().filter(|c| !c.3).count();
    let (all, found) = (seeds.len(), compared.len());
    println!("{found} scenes with a plan; {short} searches cut short");
    report.require(20 * found >= 19 * all, || {
        format!("{found} of {all} have a plan")
    });
    report.require(2 * short <= found, || {
        format!("{short} of {found} searches cut short")
    });
    report
}

/// Encounters with one target: `seeds` of each kind. With more than two of each, the fine search
/// follows the coarse one.
pub fn run(seeds: Seeds) -> Report {
    let thorough = seeds.clone().count() > 2;
    let scenes: Vec<(EncounterKind, u64)> = EncounterKind::with_seeds(seeds).collect();
    let compared: Vec<_> = scenes
        .par_iter()
        .map(|&(kind, seed)| {
            let mut drawn = random_encounter(kind, seed, Placement::Origin).expect("drawn");
            drawn.scenario.settings.tidy = Some(false);
            let record = planned(seed, drawn);
            let scenario = &record.drawn.scenario;
            let problem = problem(scenario, &record.obstacles, LandObstacle::none());
            let cost = record.plan.map_or(f64::INFINITY, |p| p.1);
            let thorough = thorough && cost.is_finite();
            let most = (SEARCHED_FACTOR * (cost + TINY)).min(WORTH_FINDING);
            let answer = searched(&problem, most, thorough);
            if let Some(found) = &answer.cheaper {
                recheck(&problem, found);
            }
            (kind, seed, cost, most, answer)
        })
        .collect();
    let mut report = Report::default();
    let (mut ratios, mut cut_short) = (Vec::new(), 0);
    for (kind, seed, cost, most, answer) in &compared {
        let name = format!("{} {seed}", kind.name());
        let found = answer.cheaper.as_ref().map(|f| f.cost);
        if cost.is_infinite() {
            let short = if answer.complete { "" } else { ", cut short" };
            println!("{name}: no plan; dense search below {WORTH_FINDING:.0} m²: {found:?}{short}");
            report.require(found.is_none(), || {
                format!("{name}: no plan, {found:?} m² found")
            });
            continue;
        }
        cut_short += usize::from(!answer.complete);
        let Some(dense) = dense_cost(answer, *most) else {
            continue;
        };
        let ratio = (cost + TINY) / (dense + TINY);
        ratios.push(ratio);
        if ratio > 1.0 || !thorough {
            println!(
                "{name}: J {cost:.0} m², ratio {ratio:.3}, {} states",
                answer.states
            );
        }
        report.require(ratio <= WORST_RATIO, || {
            format!("{name}: {cost:.1} m², {dense:.1} m² found")
        });
    }
    let [half, most, worst] = [0.5, 0.95, 1.0].map(|share| quantile(&ratios, share));
    println!(
        "J over that of the dense search: {} scenes, median {half:.3}, 95 % {most:.3}, \
         worst {worst:.3}; {} above 1.05; {cut_short} searches cut short",
        ratios.len(),
        ratios.iter().filter(|r| **r > 1.05).count(),
    );
    let all = compared.len();
    let planned = compared.iter().filter(|c| c.2.is_finite()).count();
    report.require(20 * planned >= 19 * all, || {
        format!("{planned} of {all} have a plan")
    });
    report.require(most <= 1.05, || format!("{ratios:?}"));
    report.require(2 * cut_short <= all, || {
        format!("{cut_short} of {all} cut short")
    });
    report
}
