//! The path-time planner over targets and legs. Every bench asserts the answer, then times it.

use std::hint::black_box;

use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use searoom::frame::{Pose, Vector, direction};
use searoom::geometry::{ConvexPolygon, outer_disc};
use searoom::obstacle::{Obstacle, PolytopeObstacle, SpaceTimeObstacle};
use searoom::planner::{Objective, Planned, Problem, path_time};
use searoom::trajectory::DesiredTrajectory;
use searoom::vessel::{Hull, OwnShip};

/// m/s.
const SPEED: f64 = 5.0;

/// Metres.
const LEG: f64 = 600.0;

struct Scene {
    own: OwnShip,
    desired: DesiredTrajectory,
    obstacles: Vec<Obstacle>,
    horizon: f64,
}

/// Ships that cross a path of `legs` legs, spread over it and over the time of twice the way.
fn scene(targets: usize, legs: usize) -> Scene {
    let mut points = vec![Vector::zeros()];
    for leg in 0..legs {
        let way = if leg % 2 == 0 { 0.35 } else { -0.35 };
        points.push(points[leg] + direction(way) * LEG);
    }
    let desired = DesiredTrajectory::new(&points, &vec![SPEED; legs]).expect("legs");
    let length = desired.length();
    let obstacles = (0..targets)
        .map(|i| {
            // as by the golden section, in place and in time
            let share = |step: f64| (0.31 + i as f64 * step) % 1.0;
            let met = desired.position_at(share(0.618_034) * length / SPEED);
            let time = 20.0 + share(0.754_878) * 1.9 * length / SPEED;
            let speed = 3.0 + (i % 5) as f64;
            let heading = 1.2 + 0.1 * (i % 7) as f64;
            let heading = if i % 2 == 0 { heading } else { -heading };
            let way = direction(heading);
            let start = met - way * (speed * time);
            let spread = direction(heading + 1.57) * 0.03;
            let fast = way * (speed + 0.05);
            let slow = way * (speed - 0.05);
            let velocity =
                ConvexPolygon::hull(&[fast + spread, fast - spread, slow]).expect("finite");
            let hull = Hull::new(40.0, 9.0).polygon(&Pose::new(start, heading));
            let initial = hull.minkowski_sum(&outer_disc(20.0, heading));
            PolytopeObstacle::new(format!("target {i}"), initial, velocity).into()
        })
        .collect();
    let first = points[1] - points[0];
    Scene {
        own: OwnShip {
            pose: Pose::new(points[0], first.y.atan2(first.x)),
            speed: SPEED,
            hull: Hull::new(20.0, 6.0),
            turning_radius: 50.0,
            speeds: vec![SPEED],
            safety_margin: 10.0,
            tracking_margin: 0.0,
        },
        desired,
        obstacles,
        horizon: 2.0 * length / SPEED,
    }
}

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
