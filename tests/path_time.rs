//! The path-time planner against a fine grid, on random scenes: the least time is exact.
//!
//! `SEAROOM_PATH_TIME` is the number of scenes (300 if not set).

mod path_grid;

use std::time::Duration;

use path_grid::{Path, earliest};
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use searoom::frame::{Pose, Vector};
use searoom::geometry::ConvexPolygon;
use searoom::obstacle::{
    Coast, EllipsoidObstacle, Obstacle, PolytopeObstacle, SlabObstacle, SpaceTimeObstacle,
};
use searoom::planner::{Objective, Outcome, Planned, Problem, SearchKind, path_time};
use searoom::target::VelocitySpell;
use searoom::trajectory::{DesiredTrajectory, Segment};
use searoom::vessel::{Hull, OwnShip};

/// Kinds of obstacles that a scene may hold.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Kinds {
    Exact,
    Ellipsoids,
}

struct Drawn {
    path: Path,
    obstacles: Vec<Obstacle>,
    speed: f64,
    horizon: f64,
}

fn set(rng: &mut ChaCha8Rng, center: Vector, extent: f64) -> ConvexPolygon {
    let count = rng.random_range(1..7);
    let grid = rng.random_bool(0.3);
    let points: Vec<Vector> = (0..count)
        .map(|_| {
            let p = Vector::new(rng.random_range(-1.0..1.0), rng.random_range(-1.0..1.0));
            center + if grid { p.map(f64::round) } else { p } * extent
        })
        .collect();
    ConvexPolygon::hull(&points).expect("finite")
}

fn draw(seed: u64, kinds: Kinds) -> Drawn {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let mut points = vec![Vector::zeros()];
    for _ in 0..rng.random_range(1..5) {
        let from = points[points.len() - 1];
        let heading: f64 = rng.random_range(-2.0..2.0);
        let way = rng.random_range(60.0..400.0);
        let grid = rng.random_bool(0.3);
        let heading = if grid {
            (heading / 0.8).round() * std::f64::consts::FRAC_PI_4
        } else {
            heading
        };
        points.push(from + Vector::new(heading.cos(), heading.sin()) * way);
    }
    let path = Path { points };
    let (speed, length) = (rng.random_range(2.0..8.0), path.length());
    let horizon = length / speed * rng.random_range(1.05..3.0);
    let count = rng.random_range(1..7);
    let obstacles = (0..count)
        .map(|i| {
            // met somewhere on the path, some time on
            let meeting = path.at(length * rng.random_range(0.05..1.0)).1;
            let time = horizon * rng.random_range(0.0..0.7);
            let fast = rng.random_range(0.0..8.0);
            let course: f64 = rng.random_range(-4.0..4.0);
            let velocity = Vector::new(course.cos(), course.sin()) * fast;
            let extent = rng.random_range(5.0..70.0);
            let initial = set(&mut rng, meeting - velocity * time, extent);
            let spread = if rng.random_bool(0.3) {
                0.0
            } else {
                rng.random_range(0.0..0.8)
            };
            let velocities = set(&mut rng, velocity, spread);
            let name = format!("target {i}");
            if kinds == Kinds::Ellipsoids && rng.random_bool(0.7) {
                let polytope = PolytopeObstacle::new(name, initial, velocities);
                return EllipsoidObstacle::outer_of(&polytope).into();
            }
            if rng.random_bool(0.25) {
                let turned = Vector::new(velocity.y, velocity.x);
                let spells = vec![
                    VelocitySpell {
                        until: time * 0.8 + 1.0,
                        velocities: velocities.clone(),
                    },
                    VelocitySpell {
                        until: f64::INFINITY,
                        velocities: set(&mut rng, turned, spread),
                    },
                ];
                return SlabObstacle::new(name, initial, spells)
                    .expect("increasing")
                    .into();
            }
            PolytopeObstacle::new(name, initial, velocities).into()
        })
        .collect();
    Drawn {
        path,
        obstacles,
        speed,
        horizon,
    }
}

fn own(path: &Path, speed: f64) -> OwnShip {
    let first = path.points[1] - path.points[0];
    OwnShip {
        pose: Pose::new(path.points[0], first.y.atan2(first.x)),
        speed,
        hull: Hull {
            length: 10.0,
            beam: 3.0,
        },
        turning_radius: 50.0,
        speeds: vec![speed],
        safety_margin: 5.0,
    }
}

fn plan(drawn: &Drawn, search: SearchKind, objective: Objective) -> Planned {
    let own = own(&drawn.path, drawn.speed);
    let legs = vec![drawn.speed * 0.8; drawn.path.points.len() - 1];
    let desired = DesiredTrajectory::new(&drawn.path.points, &legs).expect("valid");
    path_time::plan(&Problem {
        own: &own,
        desired: &desired,
        alternatives: &[],
        objective,
        obstacles: &drawn.obstacles,
        horizon: drawn.horizon,
        time_weight: 25.0,
        search,
        deadline: Duration::from_secs(60),
        first_turn: None,
        coast: Coast::none(),
    })
}

/// Straight, along the path in order, not too fast, clear of every set.
fn assert_sound(drawn: &Drawn, segments: &[Segment], seed: u64) {
    let mut run = 0.0;
    let mut time = 0.0;
    for s in segments {
        assert!(
            s.turn_rate == 0.0 && s.speed <= drawn.speed * (1.0 + 1e-9),
            "{seed}: {s:?}"
        );
        assert!((s.start_time - time).abs() < 1e-9, "{seed}");
        assert!(
            (s.start.position - drawn.path.at(run).1).norm() < 1e-6,
            "{seed}: {run} {s:?}"
        );
        run += s.length();
        time = s.end_time();
        assert!(
            (s.end().position - drawn.path.at(run).1).norm() < 1e-6,
            "{seed}: {run} {s:?}"
        );
        for o in &drawn.obstacles {
            assert!(
                o.first_contact(s, 1e-6).is_none(),
                "{seed}: {} {s:?}",
                o.name()
            );
        }
    }
    assert!(
        (run - drawn.path.length()).abs() < 1e-6 && time <= drawn.horizon + 1e-9,
        "{seed}"
    );
}

fn scenes(default: u64) -> u64 {
    std::env::var("SEAROOM_PATH_TIME")
        .ok()
        .and_then(|n| n.parse().ok())
        .unwrap_or(default)
}

#[test]
fn the_least_time_is_that_of_a_fine_grid() {
    let (mut solved, mut waited, mut gap) = (0, 0, 0.0);
    let count = scenes(300);
    for seed in 0..count {
        let drawn = draw(seed, Kinds::Exact);
        let planned = plan(&drawn, SearchKind::AStar, Objective::Time);
        let cells = if seed % 10 == 0 { 600 } else { 150 };
        let grid = |shrunk| {
            earliest(
                &drawn.path,
                &drawn.obstacles,
                drawn.speed,
                drawn.horizon,
                cells,
                shrunk,
            )
        };
        let step = drawn.path.length() / drawn.speed / cells as f64;
        let Some(found) = planned.outcome.plan() else {
            assert!(matches!(planned.outcome, Outcome::Infeasible(_)));
            assert_eq!(grid(false), None, "{seed}: {:?}", planned.outcome);
            continue;
        };
        solved += 1;
        let arrival = found.trajectory.end_time();
        assert!((found.cost - arrival).abs() < 1e-9);
        assert_sound(&drawn, found.trajectory.segments(), seed);
        let free = drawn.path.length() / drawn.speed;
        assert!(arrival >= free - 1e-9);
        waited += usize::from(arrival > free + 1e-6);
        if let Some(upper) = grid(false) {
            assert!(arrival <= upper + 1e-6, "{seed}: {arrival}, grid {upper}");
            gap += (upper - arrival) / step;
        }
        let lower = grid(true);
        assert!(
            lower.is_some_and(|l| l <= arrival + step + 1e-6),
            "{seed}: {arrival} {lower:?}"
        );
        let dijkstra = plan(&drawn, SearchKind::Dijkstra, Objective::Time);
        let other = dijkstra
            .outcome
            .plan()
            .expect("a plan too")
            .trajectory
            .end_time();
        assert!(
            (other - arrival).abs() < 1e-9,
            "{seed}: {arrival}, Dijkstra {other}"
        );
        assert!(dijkstra.stats.expanded >= planned.stats.expanded, "{seed}");
    }
    println!(
        "{count} scenes: {solved} with a plan, {waited} of them late; the grid arrives {:.2} of its steps later on the mean",
        gap / solved as f64
    );
    assert!(
        solved * 2 > count as usize && waited * 5 > solved,
        "{solved} {waited}"
    );
}
