//! Tests of the path-time planner on small scenes of known answers.

use std::time::Duration;

use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use searoom::frame::Vector;
use searoom::geometry::ConvexPolygon;
use searoom::obstacle::{Obstacle, PolytopeObstacle, SpaceTimeObstacle};
use searoom::planner::{NoPlan, Objective, Outcome, Problem, SearchKind, path_time};
use searoom::trajectory::DesiredTrajectory;

use crate::campaigns::path_time::grid::Path;
use crate::campaigns::path_time::{Drawn, assert_sound, own, plan, plan_within, set};

/// Tests two hundred sets across a path of five legs with no time: only a few lines are tested and
/// reported.
#[test]
fn out_of_time_the_search_looks_at_few_lines() {
    let points: Vec<Vector> = (0..6)
        .map(|k| Vector::new(400.0 * f64::from(k), 0.0))
        .collect();
    let mut rng = ChaCha8Rng::seed_from_u64(8);
    let crossing = |k: u32, rng: &mut ChaCha8Rng| {
        let (time, side) = (2.0 * f64::from(k) + 20.0, rng.random_range(1.0..3.0));
        let at = Vector::new(rng.random_range(0.0..2000.0), -side * time);
        let velocity = ConvexPolygon::point(Vector::new(0.0, side));
        PolytopeObstacle::new(k.to_string(), set(rng, at, 8.0), velocity).into()
    };
    let drawn = Drawn {
        path: Path { points },
        obstacles: (0..200).map(|k| crossing(k, &mut rng)).collect(),
        speed: 6.0,
        horizon: 900.0,
    };
    let objective = Objective::SpaceTimeError;
    let planned = plan_within(&drawn, SearchKind::AStar, objective, Duration::ZERO);
    assert!(matches!(planned.outcome, Outcome::Deadline(None)));
    let generated = planned.stats.map(|stats| stats.generated);
    assert!(generated.is_some_and(|n| n < 5_000), "{generated:?}");
    let nodes = planned.explored.node_count();
    assert!(nodes <= 100, "{nodes}");
}

fn one_leg(obstacles: Vec<Obstacle>, horizon: f64) -> Drawn {
    let points = vec![Vector::zeros(), Vector::new(300.0, 0.0)];
    Drawn {
        path: Path { points },
        obstacles,
        speed: 5.0,
        horizon,
    }
}

fn square(name: &str, center: Vector, half: f64, velocity: Vector) -> Obstacle {
    let initial = ConvexPolygon::rectangle(center, half, half);
    PolytopeObstacle::new(name, initial, ConvexPolygon::point(velocity)).into()
}

#[test]
fn a_start_that_is_swept_later_is_left_in_time() {
    // over the start from 10 s to 18 s
    let at = Vector::new;
    let sweeping = square("sweeper", at(0.0, -70.0), 20.0, at(0.0, 5.0));
    // a gate on the path that opens at 40 s
    let gate = square("gate", at(100.0, 0.0), 30.0, at(0.0, 0.75));
    let drawn = one_leg(vec![sweeping, gate], 200.0);
    let planned = plan(&drawn, SearchKind::AStar, Objective::Time);
    let found = planned.outcome.plan().expect("a plan");
    assert_sound(&drawn, found.trajectory.segments(), 0);
    // no later than at full speed from the end of the gate
    assert!(found.trajectory.end_time() < 40.0 + 200.0 / 5.0 + 30.0 / 5.0 + 1e-6);
    assert!(found.trajectory.pose_at(10.0).position.x >= 20.0 - 1e-6);
}

#[test]
fn who_bars_the_way_is_named_and_until_when() {
    let outcome = |obstacles: Vec<Obstacle>, horizon: f64| {
        let drawn = one_leg(obstacles, horizon);
        plan(&drawn, SearchKind::AStar, Objective::Time).outcome
    };
    let ahead = "is there or ahead up to the horizon";
    let inside = "starts inside the set of 'anchored', 10.0 m deep";
    // where on the path, the velocity, and what is said of it
    for (name, along, velocity, said) in [
        ("anchored", 5.0, [0.0, 0.0], [inside, "up to the horizon"]),
        ("leaving", 5.0, [0.0, 0.5], ["'leaving'", "until 30.0 s"]),
        ("wreck", 200.0, [0.0, 0.0], ["115 m before its end", ahead]),
        ("wreck", 200.0, [0.0, 0.0], ["'wreck' after 37.0 s", ahead]),
        // along the path, with no way past it
        ("oncoming", 290.0, [-5.0, 0.0], ["'oncoming'", "until"]),
        ("slower", 60.0, [1.0, 0.0], ["'slower'", ahead]),
    ] {
        let set = square(name, Vector::new(along, 0.0), 15.0, velocity.into());
        let Outcome::Infeasible(reason) = outcome(vec![set], 200.0) else {
            panic!("{name}");
        };
        let reason = reason.to_string();
        assert!(said.iter().all(|part| reason.contains(part)), "{reason}");
    }
    let long = outcome(Vec::new(), 59.0);
    let too_long = matches!(long, Outcome::Infeasible(NoPlan::PathTooLong { .. }));
    assert!(too_long && outcome(Vec::new(), 60.0).plan().is_some());
}

/// A short path past a ship that may cross it, and a long path around.
#[test]
fn risk_is_weighed_against_length() {
    let [start, aside, end] =
        [(0.0, 0.0), (150.0, 100.0), (300.0, 0.0)].map(|(x, y)| Vector::new(x, y));
    let points = [start, end];
    let detour = [vec![start, aside, end]];
    let longer = 2.0 * 150.0_f64.hypot(100.0) - 300.0;
    // covers the short path permanently at every velocity except those near the middle
    let initial = ConvexPolygon::rectangle(Vector::new(150.0, -40.0), 10.0, 0.0);
    let velocity = ConvexPolygon::rectangle(Vector::new(0.0, 0.5), 0.0, 1.5);
    let obstacles = [PolytopeObstacle::new("wanderer", initial, velocity).into()];
    let path = Path {
        points: points.to_vec(),
    };
    let own = own(&path, 5.0);
    let desired = DesiredTrajectory::new(&points, &[5.0]).expect("valid");
    let problem = Problem {
        alternatives: &detour,
        objective: Objective::Length,
        ..Problem::new(&own, &desired, &obstacles, 90.0)
    };
    let at = |risk: f64| {
        let level = [obstacles[0].at_risk(risk)];
        let planned = path_time::plan(&Problem {
            obstacles: &level,
            ..problem.clone()
        });
        planned.outcome.plan().map(|p| p.trajectory.length())
    };
    for weight in [0.0, 30.0, 60.0, 90.0, 120.0, 150.0, 1000.0] {
        for max_risk in [0.0, 0.3, 0.9] {
            let scanned = (0..=900)
                .map(|i| f64::from(i) / 1000.0)
                .filter(|risk| *risk <= max_risk)
                .filter_map(|risk| Some(at(risk)? + weight * risk))
                .min_by(f64::total_cmp)
                .expect("the detour is always free");
            let planned = path_time::plan_weighing_risk(&problem, weight, max_risk);
            let plan = planned.outcome.plan().expect("a plan");
            assert!(
                plan.cost <= scanned + 1e-6 && plan.cost > scanned - 2e-3 * weight - 1e-6,
                "{weight} {max_risk}: {} {scanned}",
                plan.cost
            );
            let risk = obstacles[0].peak_risk_along(&plan.trajectory).risk;
            assert!(plan.trajectory.length() + weight * risk <= plan.cost + 1e-6);
            assert!(risk <= max_risk + 1e-9);
        }
    }
    assert!(at(0.0).expect("a way") > 300.0 + 0.9 * longer && at(0.9).expect("a way") < 300.1);
}
