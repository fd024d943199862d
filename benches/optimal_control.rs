//! The optimal-control planner: cold and warm solves, random scenes, and what they are worth.
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
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use searoom::planner::optimal_control::solver::{Iterate, Workspace, solve};
use searoom::planner::optimal_control::{
    KeepOut, Measured, RecedingHorizon, Settings, SolverStatus, StartAttempt, attempt, family,
};
use searoom::vessel::StateVector;

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
        let start = RecedingHorizon::new(&task, &guess, Settings::default(), &|| true);
        assert!(start.plan().is_feasible());
        let off = StateVector::new(0.03, -0.03, 0.02, 0.01, -0.01, 0.005);
        let state = start.plan().profile.states[1] + off;
        c.bench_function(&format!("warm, N = {intervals}, 3 ellipsoids"), |b| {
            b.iter_batched(
                || start.clone(),
                |mut horizon| {
                    let measured = Measured {
                        state,
                        keep_outs: &keep_outs,
                    };
                    horizon.step(&task, measured, &|| true);
                    assert!(horizon.plan().is_feasible());
                    horizon
                },
                criterion::BatchSize::SmallInput,
            );
        });
    }
}

/// 200 scenes each: every one solved, and how a controller gets on from there.
fn random(_: &mut Criterion) {
    let wanted = std::env::args()
        .skip(1)
        .all(|a| a.starts_with('-') || a == "scenes");
    if !wanted {
        return;
    }
    let desired = scenes::desired();
    for count in [3, 6] {
        let (mut times, mut warm, mut failed) = (Vec::new(), Vec::new(), 0);
        let mut rng = ChaCha8Rng::seed_from_u64(99);
        for keep_outs in scenes::random_scenes(200, count) {
            let (found, took) = best(&keep_outs, 50);
            times.extend(took);
            let found = found.expect("every scene has a plan");
            let task = scenes::task(&desired, &keep_outs, 50);
            let mut horizon =
                RecedingHorizon::new(&task, &found.profile, Settings::default(), &|| true);
            let noise = StateVector::new(0.03, 0.03, 0.02, 0.01, 0.01, 0.005);
            let off = noise.map(|size| size * rng.random_range(-1.0..1.0));
            let measured = Measured {
                state: horizon.plan().profile.states[1] + off,
                keep_outs: &keep_outs,
            };
            let begun = Instant::now();
            horizon.step(&task, measured, &|| true);
            warm.push(begun.elapsed().as_secs_f64() * 1e3);
            failed += usize::from(!horizon.plan().is_feasible());
        }
        times.sort_by(f64::total_cmp);
        warm.sort_by(f64::total_cmp);
        let at = |v: &[f64], part: f64| v[((v.len() - 1) as f64 * part) as usize];
        println!(
            "{count} ellipsoids: 200 of 200 scenes have a plan, {} solves, ms median {:.1} p95 {:.1} most {:.1}; \
             warm ms median {:.2} p95 {:.2} most {:.2}, not clear {failed}",
            times.len(),
            at(&times, 0.5),
            at(&times, 0.95),
            at(&times, 1.0),
            at(&warm, 0.5),
            at(&warm, 0.95),
            at(&warm, 1.0),
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
