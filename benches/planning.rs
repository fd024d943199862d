//! One plan, from sets to verdict. Every bench asserts the answer, then times it.

use std::hint::black_box;
use std::time::Instant;

use criterion::{Criterion, criterion_group, criterion_main};
use searoom::obstacle::{LandObstacle, Obstacle};
use searoom::pipeline::{self, problem};
use searoom::planner::{Outcome, Problem, SearchKind, space_time};
use searoom::scenario::Scenario;

use encounter_generator::{EncounterKind, Placement, random_encounter, random_traffic};

#[path = "../tests/campaigns/encounter_generator.rs"]
mod encounter_generator;
#[path = "shared/new_york.rs"]
mod new_york;

/// Random encounters of each kind, random traffic of each size, and runs of each scene.
const ENCOUNTERS: u64 = 250;
const TRAFFIC: u64 = 50;
const RUNS: usize = 2;

fn with_domain(scenario: &Scenario) -> Vec<Obstacle> {
    pipeline::sets(scenario)
        .into_iter()
        .map(|s| s.with_domain)
        .collect()
}

/// Asserts that a plan is found and passes the independent check.
fn assert_planned(scenario: &Scenario) {
    let run = pipeline::run(scenario.clone());
    assert!(
        matches!(run.planned.outcome, Outcome::Solved(_)),
        "{}: no plan",
        scenario.title
    );
    assert!(
        run.evaluation.is_some_and(|e| e.verified()),
        "{}: not verified",
        scenario.title
    );
}

fn time_plan(criterion: &mut Criterion, id: &str, scenario: &Scenario) {
    assert_planned(scenario);
    let obstacles = with_domain(scenario);
    let problem = problem(scenario, &obstacles, LandObstacle::none());
    criterion.bench_function(id, |b| b.iter(|| space_time::plan(black_box(&problem))));
}

/// The first random encounter of each kind.
fn one_target(criterion: &mut Criterion) {
    for kind in EncounterKind::ALL {
        let drawn = random_encounter(kind, 0, Placement::Origin).expect("drawn");
        let id = format!("plan/one target/{}", kind.name());
        time_plan(criterion, &id, &drawn.scenario);
    }
}

/// Dijkstra over the same graph: its graph plan must cost what that of A* costs.
fn dijkstra(criterion: &mut Criterion) {
    let drawn = random_encounter(EncounterKind::HeadOn, 0, Placement::Origin).expect("drawn");
    let obstacles = with_domain(&drawn.scenario);
    let a_star = problem(&drawn.scenario, &obstacles, LandObstacle::none());
    let dijkstra = Problem {
        search: SearchKind::Dijkstra,
        ..a_star.clone()
    };
    let graph_cost = |p: &Problem| {
        space_time::plan(p)
            .outcome
            .plan()
            .and_then(|plan| plan.graph_cost)
            .expect("a plan")
    };
    let (a, d) = (graph_cost(&a_star), graph_cost(&dijkstra));
    assert!((a - d).abs() <= 1e-9 * a, "A* {a}, Dijkstra {d}");
    criterion.bench_function("plan/one target/head-on, Dijkstra", |b| {
        b.iter(|| space_time::plan(black_box(&dijkstra)))
    });
}

/// The first random traffic of each size that has a plan.
fn many_targets(criterion: &mut Criterion) {
    for count in [2, 4, 10] {
        let scenario = (0..100)
            .map(|seed| {
                random_traffic(count, seed, Placement::Origin)
                    .expect("drawn")
                    .scenario
            })
            .find(|s| {
                pipeline::run(s.clone())
                    .evaluation
                    .is_some_and(|e| e.verified())
            })
            .expect("a plan among a hundred");
        time_plan(criterion, &format!("plan/{count} targets"), &scenario);
    }
}

/// Milliseconds of each scene's plan, the least of several runs, sorted.
fn times(scenes: impl Iterator<Item = Scenario>) -> Vec<f64> {
    let mut times: Vec<f64> = scenes
        .map(|scenario| {
            let obstacles = with_domain(&scenario);
            let problem = problem(&scenario, &obstacles, LandObstacle::none());
            (0..RUNS)
                .map(|_| {
                    let start = Instant::now();
                    black_box(space_time::plan(black_box(&problem)));
                    start.elapsed().as_secs_f64() * 1e3
                })
                .fold(f64::INFINITY, f64::min)
        })
        .collect();
    times.sort_by(f64::total_cmp);
    times
}

fn print_times(name: &str, times: &[f64]) {
    let at = |share: f64| times[((times.len() - 1) as f64 * share) as usize];
    println!(
        "{name}: {} scenes, ms: median {:.2}, 95 % {:.2}, worst {:.2}",
        times.len(),
        at(0.5),
        at(0.95),
        at(1.0)
    );
}

/// Not one scene many times but many scenes, printed: what a scene takes varies more than the
/// clock.
fn random_scenes(_: &mut Criterion) {
    let mut all = Vec::new();
    for kind in EncounterKind::ALL {
        let scenes = (0..ENCOUNTERS).map(|seed| random_encounter(kind, seed, Placement::Origin));
        let found = times(scenes.map(|drawn| drawn.expect("drawn").scenario));
        print_times(&format!("random/{}", kind.name()), &found);
        all.extend(found);
    }
    all.sort_by(f64::total_cmp);
    print_times("random/one target", &all);
    for count in [4, 10] {
        let scenes = (0..TRAFFIC).map(|seed| random_traffic(count, seed, Placement::Origin));
        let found = times(scenes.map(|drawn| drawn.expect("drawn").scenario));
        print_times(&format!("random/{count} targets"), &found);
    }
}

/// Each vessel under way in New York harbour among all others: all relaxation levels, without sets
/// and verdict. With the same traffic again nine times, beyond anybody's reach, the plans are the
/// same.
fn new_york_harbour(_: &mut Criterion) {
    let scenes = new_york::scenes().expect("the data");
    let planned = |scenes: &[Scenario]| {
        let mut times = Vec::new();
        let mut costs = Vec::new();
        for scene in scenes {
            let runs: Vec<pipeline::Run> =
                (0..RUNS).map(|_| pipeline::run(scene.clone())).collect();
            assert!(runs[0].evaluation.as_ref().is_some_and(|e| e.verified()));
            let milliseconds = runs.iter().map(|run| run.plan_time.as_secs_f64() * 1e3);
            times.push(milliseconds.fold(f64::INFINITY, f64::min));
            costs.push(runs[0].planned.outcome.plan().map(|plan| plan.cost));
        }
        times.sort_by(f64::total_cmp);
        (times, costs)
    };
    let (times, costs) = planned(&scenes);
    let targets = scenes[0].targets.len();
    print_times(&format!("New York/{targets} targets"), &times);
    let crowded: Vec<Scenario> = scenes.iter().map(new_york::with_more_far_away).collect();
    let (more, same) = planned(&crowded);
    let targets = crowded[0].targets.len();
    print_times(&format!("New York/{targets} targets"), &more);
    assert_eq!(costs, same);
}

/// Sets, plan and verdict together.
fn whole_run(criterion: &mut Criterion) {
    let drawn = random_encounter(EncounterKind::HeadOn, 0, Placement::Origin).expect("drawn");
    assert_planned(&drawn.scenario);
    criterion.bench_function("run/one target/head-on", |b| {
        b.iter(|| pipeline::run(black_box(&drawn.scenario).clone()))
    });
}

criterion_group!(
    benches,
    one_target,
    dijkstra,
    many_targets,
    whole_run,
    random_scenes,
    new_york_harbour
);
criterion_main!(benches);
