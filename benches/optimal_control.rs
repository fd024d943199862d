//! The optimal-control planner: solves, random scenes, and what they are worth.
//!
//! ```text
//! cargo bench --no-default-features --bench optimal_control
//! ```
//!
//! Asserts what it times. The random scenes run once; `scenes` in the name of a filter runs them
//! alone.

#[path = "../tests/campaigns/forces/scenes.rs"]
mod scenes;

use std::hint::black_box;
use std::time::Instant;

use criterion::{Criterion, criterion_group, criterion_main};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use searoom::planner::optimal_control::solver::{Iterate, Workspace, solve};
use searoom::planner::optimal_control::{
    KeepOut, Settings, SolverStatus, StartAttempt, attempt, family,
};

/// The best of the starts that need no other planner.
fn best(keep_outs: &[KeepOut], intervals: usize) -> (Option<StartAttempt>, Vec<f64>) {
    let desired = scenes::desired();
    let task = scenes::task(&desired, keep_outs, intervals);
    let mut times = Vec::new();
    let mut best: Option<StartAttempt> = None;
    for (_, guess) in family(&task) {
        let begun = Instant::now();
        let found = attempt(&task, &guess, &Settings::default(), &|| true);
        times.push(begun.elapsed().as_secs_f64() * 1e3);
        let better = best.as_ref().is_none_or(|b| found.objective < b.objective);
        if found.is_feasible() && better {
            best = Some(found);
        }
    }
    (best, times)
}

fn solves(c: &mut Criterion) {
    let desired = scenes::desired();
    let keep_outs = scenes::figure_9();
    for intervals in [50, 100] {
        let task = scenes::task(&desired, &keep_outs, intervals);
        let guess = scenes::straight(&task);
        // the problem with rows at nodes and midpoints alone
        let problem = task.transcription();
        let cold = Iterate::guess(guess.states.clone(), guess.forces.clone());
        let mut work = Workspace::new(&problem);
        c.bench_function(&format!("one solve, N = {intervals}, 3 ellipsoids"), |b| {
            b.iter(|| {
                let mut at = cold.clone();
                let report = solve(&problem, &mut at, &mut work, &Settings::default(), &|| true);
                assert_eq!(report.status, SolverStatus::Solved);
                report.objective
            });
        });
        c.bench_function(
            &format!("clear at all times, N = {intervals}, 3 ellipsoids"),
            |b| {
                b.iter(|| {
                    let found = attempt(&task, black_box(&guess), &Settings::default(), &|| true);
                    assert!(found.is_feasible());
                    found.objective
                });
            },
        );
    }
}

/// 200 scenes each: every one solved.
fn random(_: &mut Criterion) {
    let wanted = std::env::args()
        .skip(1)
        .all(|a| a.starts_with('-') || a == "scenes");
    if !wanted {
        return;
    }
    let desired = scenes::desired();
    for count in [3, 6] {
        let mut times = Vec::new();
        for keep_outs in scenes::random_scenes(200, count) {
            let (found, took) = best(&keep_outs, 50);
            times.extend(took);
            found.expect("every scene has a plan");
        }
        times.sort_by(f64::total_cmp);
        let at = |v: &[f64], part: f64| v[((v.len() - 1) as f64 * part) as usize];
        println!(
            "{count} ellipsoids: 200 of 200 scenes have a plan, {} solves, ms median {:.1} p95 {:.1} most {:.1}",
            times.len(),
            at(&times, 0.5),
            at(&times, 0.95),
            at(&times, 1.0),
        );
    }
    // the best of 40 wandering starts is not better than the plan
    let keep_outs = scenes::figure_9();
    let (plan, _) = best(&keep_outs, 50);
    let plan = plan.expect("figure 9 has a plan").objective;
    let task = scenes::task(&desired, &keep_outs, 50);
    let mut rng = ChaCha8Rng::seed_from_u64(40);
    let random = (0..40)
        .map(|_| {
            attempt(
                &task,
                &scenes::wandering(&task, &mut rng),
                &Settings::default(),
                &|| true,
            )
        })
        .filter(StartAttempt::is_feasible)
        .map(|found| found.objective)
        .fold(f64::INFINITY, f64::min);
    println!("figure 9: stage cost {plan:.6}, the best of 40 wandering starts {random:.6}");
    assert!(plan <= random * (1.0 + 1e-3));
}

criterion_group! {
    name = benches;
    config = Criterion::default().sample_size(20);
    targets = solves, random
}
criterion_main!(benches);
