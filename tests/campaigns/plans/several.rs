//! Plans among several targets, by default under `compliance = "rules"`, counted by both judges from the
//! trajectories alone.

use std::path::Path;

use rayon::prelude::*;
use searoom::colregs::Thresholds;
use searoom::colregs::compliance::{ComplianceReport, EncounterSamples};
use searoom::pipeline::{self, Run};
use searoom::scenario::{Compliance, Scenario};

use crate::campaigns::encounter_generator::{Placement, random_sequence, random_traffic};
use crate::campaigns::statistics::{quantiles, share_cells};
use crate::campaigns::{Report, Seeds, scene_file};

/// Least share of plans under the rules with which both judges are content. Measured with 300 scenes each: 98
/// and 98 % of two and three targets one after another, 98 and 96 % about the same time.
const CONTENT: f64 = 0.9;

/// Observations of one plan; of a scene without one only the outcome.
struct Seen {
    solved: bool,
    safe: bool,
    verified: bool,
    /// Rules and monitors that are broken.
    broken: Vec<&'static str>,
    cost: f64,
    manoeuvres: usize,
    nodes: usize,
    milliseconds: f64,
}

/// The rules and monitors that a plan breaks toward the ships among its targets.
pub fn broken(run: &Run) -> Vec<&'static str> {
    let Some(plan) = run.planned.outcome.plan() else {
        return Vec::new();
    };
    let own = &run.scenario.own_ship;
    let ships = run.scenario.targets.iter().filter_map(|t| t.ship());
    let along = |ship| EncounterSamples::along(&plan.trajectory, own, ship);
    let samples: Vec<EncounterSamples> = ships.map(along).collect();
    let reports = ComplianceReport::of_all(samples.iter(), Thresholds::standard());
    reports.iter().flat_map(|report| report.broken()).collect()
}

fn seen(run: &Run) -> Seen {
    let plan = run.planned.outcome.plan();
    Seen {
        solved: plan.is_some() && run.relaxations.is_empty(),
        safe: run.evaluation.as_ref().is_some_and(|e| e.safe()),
        verified: run.evaluation.as_ref().is_none_or(|e| e.verified()),
        broken: broken(run),
        cost: plan.map_or(f64::INFINITY, |plan| plan.cost),
        manoeuvres: run.planned.manoeuvres.len(),
        nodes: run.planned.stats.map_or(0, |stats| stats.expanded),
        milliseconds: run.plan_time.as_secs_f64() * 1e3,
    }
}

/// Which scenes are planned.
#[derive(Debug, Clone, Copy)]
pub struct Which {
    pub targets: usize,
    /// True for targets that are met one after another, up to three.
    pub apart: bool,
    pub compliance: Compliance,
}

impl Which {
    /// Under the rules.
    pub const fn by_the_rules(targets: usize, apart: bool) -> Self {
        Self {
            targets,
            apart,
            compliance: Compliance::Rules,
        }
    }

    /// `None` where there is no such scene.
    pub fn scene(&self, seed: u64) -> Option<Scenario> {
        let draw = if self.apart {
            random_sequence
        } else {
            random_traffic
        };
        let drawn = draw(self.targets, seed, Placement::Random)?;
        Some(Scenario {
            compliance: self.compliance,
            ..drawn.scenario
        })
    }
}

/// Plans scenes. The plans go to `rows` too, where that is a file: a line of CSV each; the scenes to a
/// `folder`, where that is given.
pub fn run(seeds: Seeds, which: &Which, rows: Option<&Path>, folder: Option<&Path>) -> Report {
    let mut report = Report::default();
    if let Some(folder) = folder {
        for scene in seeds.clone().filter_map(|seed| which.scene(seed)) {
            let name = format!("{}.toml", scene.title.replace(' ', "-"));
            report.written(scene_file::write(folder, &name, &scene), folder);
        }
    }
    let play = |seed| Some((seed, seen(&pipeline::run(which.scene(seed)?))));
    let all: Vec<(u64, Seen)> = seeds.clone().into_par_iter().filter_map(play).collect();
    let mut lines = String::from("seed,solved,cost_m2,manoeuvres,nodes,milliseconds,broken\n");
    for (seed, s) in &all {
        let (solved, cost, ms, broken) = (s.solved, s.cost, s.milliseconds, s.broken.join(" "));
        let (manoeuvres, nodes) = (s.manoeuvres, s.nodes);
        lines.push_str(&format!(
            "{seed},{solved},{cost},{manoeuvres},{nodes},{ms},{broken}\n"
        ));
    }
    if let Some(file) = rows {
        report.written(std::fs::write(file, lines), file);
    }
    let how = if which.apart {
        "one after another"
    } else {
        "at about the same time"
    };
    println!("{} targets {how}, seeds {seeds:?}\n", which.targets);
    println!(
        "| both judges | at least | unrelaxed | J 50/90 %, m² | manoeuvres 50/95 %/most | nodes 50/95 % | \
         plan 50/99 %, ms |"
    );
    println!("|{}", " --- |".repeat(7));
    let number = |holds: &dyn Fn(&Seen) -> bool| all.iter().filter(|(_, s)| holds(s)).count();
    let values =
        |of: &dyn Fn(&Seen) -> f64| -> Vec<f64> { all.iter().map(|(_, s)| of(s)).collect() };
    let content = number(&|s| s.broken.is_empty() && s.safe);
    let cells = [
        share_cells(content, all.len()),
        number(&|s| s.solved).to_string(),
        quantiles(&values(&|s| s.cost), [0.5, 0.9], 0),
        quantiles(&values(&|s| s.manoeuvres as f64), [0.5, 0.95, 1.0], 0),
        quantiles(&values(&|s| s.nodes as f64), [0.5, 0.95], 0),
        quantiles(&values(&|s| s.milliseconds), [0.5, 0.99], 1),
    ];
    println!("| {} |\n", cells.join(" | "));
    let broken = (all.iter()).flat_map(|(seed, s)| s.broken.iter().map(|rule| (*rule, *seed)));
    Report::print_seeds("broken", broken);
    if which.compliance == Compliance::Rules {
        report.content("several", CONTENT, content, all.len());
    }
    let drawn = seeds.end - seeds.start == all.len() as u64;
    report.require(drawn, || "scenes that cannot be drawn".to_owned());
    let unverified = all.len() - number(&|s| s.verified);
    report.require(unverified == 0, || format!("{unverified} not verified"));
    report
}
