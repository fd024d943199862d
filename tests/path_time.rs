//! Tests of the path-time planner against a fine grid on random scenes: the least time is exact.
//!
//! `SEAROOM_PATH_TIME` is the number of scenes (300 if not set).

mod path_grid;
mod path_networks;

use std::time::Duration;

use path_grid::{Path, earliest, least_error};
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use searoom::frame::{Pose, Vector};
use searoom::geometry::ConvexPolygon;
use searoom::obstacle::{
    EllipsoidObstacle, LandObstacle, Obstacle, PolytopeObstacle, SpaceTimeObstacle,
};
use searoom::planner::{NoPlan, Objective, Outcome, Planned, Problem, SearchKind, path_time};
use searoom::target::{TimedVelocitySet, Uncertainty};
use searoom::trajectory::{DesiredTrajectory, PathNetwork, Segment};
use searoom::vessel::{Hull, OwnShip};

/// Kinds of obstacles in a scene.
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
            // the target meets a random point of the path at a random time
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
            // a grid would pass through an ellipse without interior
            let wide = initial.area() > 1.0;
            if kinds == Kinds::Ellipsoids && wide && rng.random_bool(0.9) {
                let polytope = PolytopeObstacle::new(name, initial, velocities);
                return EllipsoidObstacle::outer_of(&polytope).into();
            }
            if rng.random_bool(0.25) {
                let turned = Vector::new(velocity.y, velocity.x);
                let timed = vec![
                    TimedVelocitySet::new(time * 0.8 + 1.0, velocities.clone()),
                    TimedVelocitySet::new(f64::INFINITY, set(&mut rng, turned, spread)),
                ];
                let sets = Uncertainty::new(initial, timed);
                return Obstacle::new(name, sets).expect("increasing");
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
    plan_within(drawn, search, objective, Duration::from_secs(60))
}

fn plan_within(
    drawn: &Drawn,
    search: SearchKind,
    objective: Objective,
    deadline: Duration,
) -> Planned {
    let own = own(&drawn.path, drawn.speed);
    let legs = vec![drawn.speed * 0.8; drawn.path.points.len() - 1];
    let desired = DesiredTrajectory::new(&drawn.path.points, &legs).expect("valid");
    path_time::plan(&Problem {
        own: &own,
        desired: &desired,
        alternatives: &[],
        objective,
        obstacles: &drawn.obstacles,
        land_obstacle: LandObstacle::none(),
        horizon: drawn.horizon,
        time_weight: 25.0,
        search,
        deadline,
        first_turn: None,
        encountered: &[],
    })
}

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
    let planned = plan_within(
        &drawn,
        SearchKind::AStar,
        Objective::SpaceTimeError,
        Duration::ZERO,
    );
    assert!(matches!(planned.outcome, Outcome::Deadline(None)));
    let Planned {
        stats, explored, ..
    } = planned;
    assert!(stats.generated < 5_000, "{stats:?}");
    assert!(explored.node_count() <= 100, "{}", explored.node_count());
}

/// Checks that the plan is straight, follows the path in order, respects the speed limit, and is
/// clear of every set.
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

#[test]
fn the_least_space_time_error_is_about_that_of_a_fine_grid() {
    let count = scenes(300) / 3;
    let (mut ratios, mut expanded) = (Vec::new(), [0, 0]);
    for seed in 0..count {
        let drawn = draw(seed, Kinds::Exact);
        let planned = plan(&drawn, SearchKind::AStar, Objective::SpaceTimeError);
        let legs = vec![drawn.speed * 0.8; drawn.path.points.len() - 1];
        let desired = DesiredTrajectory::new(&drawn.path.points, &legs).expect("valid");
        let (path, obstacles) = (&drawn.path, &drawn.obstacles);
        let grid = least_error(
            path,
            obstacles,
            &desired,
            25.0,
            drawn.speed,
            drawn.horizon,
            400,
        );
        let Some(found) = planned.outcome.plan() else {
            assert_eq!(grid, None, "{seed}: {:?}", planned.outcome);
            continue;
        };
        assert_sound(&drawn, found.trajectory.segments(), seed);
        let dijkstra = plan(&drawn, SearchKind::Dijkstra, Objective::SpaceTimeError);
        let other = dijkstra.outcome.plan().expect("a plan too").cost;
        assert!(
            (other - found.cost).abs() <= 1e-8 * (1.0 + other),
            "{seed}: {}, Dijkstra {other}",
            found.cost
        );
        expanded[0] += planned.stats.expanded;
        expanded[1] += dijkstra.stats.expanded;
        if let Some(grid) = grid {
            // a grid cannot follow the schedule: subtract the cost of the resulting lag
            let piece = path.length() / 400.0;
            ratios.push((
                (found.cost + piece * piece) / (grid + piece * piece),
                seed,
                found.cost,
                grid,
            ));
        }
    }
    ratios.sort_by(|a, b| a.0.total_cmp(&b.0));
    let at = |share: f64| ratios[((ratios.len() - 1) as f64 * share) as usize].0;
    println!(
        "{} scenes: error over that of the grid: median {:.4}, 95 % {:.4}, worst {:?}",
        ratios.len(),
        at(0.5),
        at(0.95),
        &ratios[ratios.len() - 3..]
    );
    println!(
        "expanded: {} by A*, {} by Dijkstra",
        expanded[0], expanded[1]
    );
    assert!(expanded[0] < expanded[1], "{expanded:?}");
    assert!(
        ratios.len() * 2 > count as usize,
        "{} of {count} compared",
        ratios.len()
    );
    // on one leg the graph contains the best profile; across corners of the path it may not,
    // because the nearest leg changes
    assert!(
        at(0.5) < 1.0 && at(0.95) < 1.001 && at(1.0) < 1.1,
        "{:?}",
        ratios.last()
    );
}

/// Tests ellipsoids: positions outside the outer polygons are outside the ellipsoids.
#[test]
fn plans_keep_clear_of_ellipsoids() {
    let (mut solved, mut compared, mut later) = (0, 0, 0);
    for seed in 0..scenes(300) / 2 {
        let drawn = draw(seed, Kinds::Ellipsoids);
        let planned = plan(&drawn, SearchKind::AStar, Objective::Time);
        let Some(found) = planned.outcome.plan() else {
            continue;
        };
        solved += 1;
        assert_sound(&drawn, found.trajectory.segments(), seed);
        let grid = |shrunk| {
            earliest(
                &drawn.path,
                &drawn.obstacles,
                drawn.speed,
                drawn.horizon,
                150,
                shrunk,
            )
        };
        let step = drawn.path.length() / drawn.speed / 150.0;
        let arrival = found.trajectory.end_time();
        assert!(
            grid(true).is_some_and(|l| l <= arrival + step + 1e-6),
            "{seed}"
        );
        if let Some(upper) = grid(false) {
            compared += 1;
            later += usize::from(arrival > upper + 0.1);
        }
    }
    println!(
        "{solved} scenes with a plan: later than the grid among the ellipsoids themselves in {later} of {compared}"
    );
    assert!(
        solved > 50 && compared * 10 > solved * 9 && later * 50 <= compared,
        "{solved} {later} {compared}"
    );
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
    let corners = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
    let corners = corners.map(|(x, y)| center + Vector::new(x, y) * half);
    let initial = ConvexPolygon::hull(&corners).expect("finite");
    PolytopeObstacle::new(name, initial, ConvexPolygon::point(velocity)).into()
}

#[test]
fn a_start_that_is_swept_later_is_left_in_time() {
    // over the start from 10 s to 18 s
    let sweeping = square(
        "sweeper",
        Vector::new(0.0, -70.0),
        20.0,
        Vector::new(0.0, 5.0),
    );
    // a gate on the path that opens at 40 s
    let gate = square(
        "gate",
        Vector::new(100.0, 0.0),
        30.0,
        Vector::new(0.0, 0.75),
    );
    let drawn = one_leg(vec![sweeping, gate], 200.0);
    let planned = plan(&drawn, SearchKind::AStar, Objective::Time);
    let found = planned.outcome.plan().expect("a plan");
    assert_sound(&drawn, found.trajectory.segments(), 0);
    // full speed from the end of the gate
    assert!(
        (found.trajectory.end_time() - (40.0 + 200.0 / 5.0 + 30.0 / 5.0)).abs() < 1e-6
            || found.trajectory.end_time() < 86.0 + 1e-6
    );
    assert!(found.trajectory.pose_at(10.0).position.x >= 20.0 - 1e-6);
}

#[test]
fn who_bars_the_way_is_named_and_until_when() {
    let reason = |obstacles: Vec<Obstacle>| match plan(
        &one_leg(obstacles, 200.0),
        SearchKind::AStar,
        Objective::Time,
    )
    .outcome
    {
        Outcome::Infeasible(reason) => reason.to_string(),
        other => panic!("{other:?}"),
    };
    let still = Vector::zeros();
    let at = |x: f64, y: f64| Vector::new(x, y);
    let found = reason(vec![square("anchored", at(5.0, 0.0), 15.0, still)]);
    assert!(
        found.contains("starts inside the set of 'anchored', 10.0 m deep"),
        "{found}"
    );
    assert!(found.contains("up to the horizon"), "{found}");
    let found = reason(vec![square("leaving", at(5.0, 0.0), 15.0, at(0.0, 0.5))]);
    assert!(
        found.contains("'leaving'") && found.contains("until 30.0 s"),
        "{found}"
    );
    let found = reason(vec![square("wreck", at(200.0, 0.0), 15.0, still)]);
    assert!(
        found.contains("115 m before its end") && found.contains("'wreck' after 37.0 s"),
        "{found}"
    );
    assert!(
        found.contains("is there or ahead up to the horizon"),
        "{found}"
    );
    // the target approaches along the path and leaves no way past it
    let found = reason(vec![square(
        "oncoming",
        at(290.0, 0.0),
        15.0,
        at(-5.0, 0.0),
    )]);
    assert!(
        found.contains("'oncoming'") && found.contains("until"),
        "{found}"
    );
    // the target moves ahead on the path, slower than required
    let found = reason(vec![square("slower", at(60.0, 0.0), 15.0, at(1.0, 0.0))]);
    assert!(
        found.contains("'slower'") && found.contains("is there or ahead up to the horizon"),
        "{found}"
    );
    let long = plan(
        &one_leg(Vec::new(), 59.0),
        SearchKind::AStar,
        Objective::Time,
    )
    .outcome;
    assert!(matches!(
        long,
        Outcome::Infeasible(NoPlan::PathTooLong { .. })
    ));
    assert!(
        plan(
            &one_leg(Vec::new(), 60.0),
            SearchKind::AStar,
            Objective::Time
        )
        .outcome
        .plan()
        .is_some()
    );
}

/// Lists every route through a network that uses no leg twice, as waypoints.
fn ways(network: &PathNetwork) -> Vec<Vec<Vector>> {
    fn follow(
        n: &PathNetwork,
        at: usize,
        used: &mut Vec<usize>,
        way: &mut Vec<Vector>,
        out: &mut Vec<Vec<Vector>>,
    ) {
        if !used.is_empty() && n.is_end(at) {
            out.push(way.clone());
            return;
        }
        for &leg in n.onward(at) {
            if !used.contains(&leg) {
                used.push(leg);
                let l = &n.legs()[leg];
                way.push(l.start + l.direction * l.length);
                follow(n, l.ends[1], used, way, out);
                way.pop();
                used.pop();
            }
        }
    }
    let mut out = Vec::new();
    let first = network.legs()[0].start;
    follow(
        network,
        network.start(),
        &mut Vec::new(),
        &mut vec![first],
        &mut out,
    );
    out
}

/// Tests that one search over all paths equals the best result of the single routes.
#[test]
fn alternatives_are_as_good_as_the_best_way_through_them() {
    let (mut switched, mut solved) = (0, 0);
    for seed in 0..scenes(300) / 2 {
        let mut rng = ChaCha8Rng::seed_from_u64(seed + 9000);
        let mut drawn = draw(seed, Kinds::Exact);
        drawn.path.points = [(0.0, 0.0), (150.0, 0.0), (300.0, 60.0), (450.0, 0.0)]
            .map(|(x, y)| Vector::new(x, y))
            .to_vec();
        // targets also meet alternative paths for which they were not drawn
        let mut aside = |x: f64| Vector::new(x, rng.random_range(-140.0..140.0));
        let main = drawn.path.points.clone();
        let alternatives = vec![
            vec![main[0], aside(70.0), main[1], aside(220.0), main[2]],
            vec![main[1], aside(260.0), aside(340.0), main[3]],
        ];
        drawn.horizon = 500.0 / drawn.speed * rng.random_range(1.1..2.5);
        let network = PathNetwork::new(&main, &alternatives).expect("sound");
        for objective in [Objective::Time, Objective::Length] {
            let measure = |planned: &Planned| {
                let trajectory = &planned.outcome.plan()?.trajectory;
                Some(match objective {
                    Objective::Time => trajectory.end_time(),
                    _ => trajectory.length(),
                })
            };
            let best = ways(&network)
                .into_iter()
                .filter_map(|way| {
                    let alone = Drawn {
                        path: Path { points: way },
                        obstacles: drawn.obstacles.clone(),
                        ..drawn
                    };
                    measure(&plan(&alone, SearchKind::AStar, objective))
                })
                .min_by(f64::total_cmp);
            let own = own(&drawn.path, drawn.speed);
            let desired = DesiredTrajectory::new(&main, &[drawn.speed; 3]).expect("valid");
            let planned = path_time::plan(&Problem {
                first_turn: None,
                encountered: &[],
                land_obstacle: LandObstacle::none(),
                own: &own,
                desired: &desired,
                alternatives: &alternatives,
                objective,
                obstacles: &drawn.obstacles,
                horizon: drawn.horizon,
                time_weight: 25.0,
                search: SearchKind::AStar,
                deadline: Duration::from_secs(60),
            });
            match (best, measure(&planned)) {
                (Some(best), Some(found)) => {
                    assert!(
                        (best - found).abs() < 1e-6,
                        "{seed} {objective:?}: {best} {found}"
                    );
                    solved += 1;
                    let legs = &planned.path_time.as_ref().expect("a diagram").legs;
                    switched += usize::from(legs.iter().any(|l| l.path != legs[0].path));
                }
                (best, found) => assert_eq!(best, found, "{seed} {objective:?}"),
            }
        }
    }
    println!("{solved} plans, {switched} of them on several paths");
    assert!(solved > 100 && switched > 30, "{solved} {switched}");
}

/// A short path past a ship that may cross it, and a long path around.
#[test]
fn risk_is_weighed_against_length() {
    let points = [(0.0, 0.0), (300.0, 0.0)].map(|(x, y)| Vector::new(x, y));
    let detour = vec![
        [(0.0, 0.0), (150.0, 100.0), (300.0, 0.0)]
            .map(|(x, y)| Vector::new(x, y))
            .to_vec(),
    ];
    let longer = 2.0 * 150.0_f64.hypot(100.0) - 300.0;
    // covers the short path permanently at every velocity except those near the middle
    let initial = ConvexPolygon::hull(&[Vector::new(140.0, -40.0), Vector::new(160.0, -40.0)]);
    let velocity = ConvexPolygon::hull(&[Vector::new(0.0, -1.0), Vector::new(0.0, 2.0)]);
    let wanderer: Obstacle = PolytopeObstacle::new(
        "wanderer",
        initial.expect("finite"),
        velocity.expect("finite"),
    )
    .into();
    let obstacles = [wanderer];
    let path = Path {
        points: points.to_vec(),
    };
    let own = own(&path, 5.0);
    let desired = DesiredTrajectory::new(&points, &[5.0]).expect("valid");
    let problem = Problem {
        first_turn: None,
        encountered: &[],
        land_obstacle: LandObstacle::none(),
        own: &own,
        desired: &desired,
        alternatives: &detour,
        objective: Objective::Length,
        obstacles: &obstacles,
        horizon: 90.0,
        time_weight: 25.0,
        search: SearchKind::AStar,
        deadline: Duration::from_secs(60),
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
