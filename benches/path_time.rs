//! The path-time planner over targets and legs. Every bench asserts the answer, then times it.

use std::hint::black_box;

use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use searoom::obstacle::SpaceTimeObstacle;
use searoom::planner::{Objective, Planned, Problem, path_time};

#[path = "shared/path_network.rs"]
mod path_network;

use path_network::{SPEED, Scene, scene};

fn problem(scene: &Scene, objective: Objective) -> Problem<'_> {
    Problem {
        objective,
        ..Problem::new(&scene.own, &scene.desired, &scene.obstacles, scene.horizon)
    }
}

/// Asserts a plan that is clear and not earlier than full speed allows.
fn assert_planned(scene: &Scene, planned: &Planned, what: &str) {
    let plan = planned.outcome.plan();
    let plan = plan.unwrap_or_else(|| panic!("{what}: {:?}", planned.outcome));
    assert!(plan.trajectory.end_time() >= scene.desired.length() / SPEED - 1e-6);
    for segment in plan.trajectory.segments() {
        for obstacle in &scene.obstacles {
            assert!(
                obstacle.first_contact(segment, 1e-6).is_none(),
                "{what}: {}",
                obstacle.name()
            );
        }
    }
}

fn time(criterion: &mut Criterion, group: &str, targets: usize, legs: usize, objective: Objective) {
    let scene = scene(targets, legs);
    let problem = problem(&scene, objective);
    let planned = path_time::plan(&problem);
    let what = format!("{targets} targets, {legs} legs");
    assert_planned(&scene, &planned, &what);
    let mut group = criterion.benchmark_group(group);
    group.bench_function(BenchmarkId::from_parameter(what), |b| {
        b.iter(|| path_time::plan(black_box(&problem)))
    });
    group.finish();
}

fn least_time(criterion: &mut Criterion) {
    for (targets, legs) in [
        (0, 5),
        (1, 5),
        (3, 5),
        (10, 5),
        (30, 5),
        (100, 5),
        (300, 5),
        (3, 1),
        (3, 30),
        (3, 100),
        (3, 300),
        (300, 300),
    ] {
        time(criterion, "least time", targets, legs, Objective::Time);
    }
}

fn least_error(criterion: &mut Criterion) {
    for (targets, legs) in [(0, 5), (3, 5), (10, 5), (30, 5), (100, 5)] {
        time(
            criterion,
            "least space-time error",
            targets,
            legs,
            Objective::SpaceTimeError,
        );
    }
}

criterion_group!(benches, least_time, least_error);
criterion_main!(benches);
