//! Random traffic in the harbour of Trondheim: every plan keeps off land and targets, A* finds what Dijkstra finds.
//!
//! `SEAROOM_HARBOUR` is the number of scenes (30 if not set).

mod statistics;

use std::path::Path;
use std::sync::Arc;

use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use searoom::frame::{Geographic, Georeference, Pose, Vector, direction};
use searoom::map::Map;
use searoom::obstacle::Obstacle;
use searoom::pipeline;
use searoom::planner::{Objective, Outcome, PlannerKind, Problem, SearchKind, space_time};
use searoom::scenario::{Compliance, Land, Scenario};
use searoom::target::{DomainKind, Motion, Representation, ShipTrack, Target};
use searoom::trajectory::DesiredTrajectory;
use searoom::vessel::{Hull, OwnShip};
use statistics::quantile;

const TARGETS: usize = 3;

/// Median, 90th percentile, largest.
fn spread(values: &[f64]) -> String {
    let [half, most, all] = [0.5, 0.9, 1.0].map(|p| quantile(values, p));
    format!("median {half:.1}, 90 % {most:.1}, largest {all:.1}")
}

fn harbour() -> Arc<Map> {
    let origin = Geographic {
        lat_deg: 63.444,
        lon_deg: 10.39,
    };
    let earth = Georeference::new(origin).expect("valid");
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("maps/trondheim-harbour.geojson");
    Arc::new(Map::read(&file, &earth).expect("a map"))
}

/// A path of two or three legs on water, not far from land, and targets that are near it at some time.
fn scene(map: &Arc<Map>, seed: u64) -> Scenario {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let land = Land {
        map: Arc::clone(map),
        margin: 10.0,
    };
    let hull = Hull {
        length: 20.0,
        beam: 6.0,
    };
    let path = loop {
        let start = Vector::new(
            rng.random_range(-1500.0..2500.0),
            rng.random_range(-900.0..1500.0),
        );
        let mut path = vec![start];
        let mut heading = rng.random_range(-3.1..3.1);
        for _ in 0..rng.random_range(2..4) {
            let from = path[path.len() - 1];
            path.push(from + direction(heading) * rng.random_range(250.0..700.0));
            heading += rng.random_range(-1.2..1.2);
        }
        let off = |p: &Vector| map.signed_distance(*p);
        let near = path.iter().map(off).fold(f64::INFINITY, f64::min) < 250.0;
        let ends_free = off(&path[0]) > 40.0 && off(&path[path.len() - 1]) > 40.0;
        if near && ends_free && land.crossings(&hull, &path).is_empty() {
            break path;
        }
    };
    let speed = 4.0;
    let desired = DesiredTrajectory::new(&path, &vec![speed; path.len() - 1]).expect("a path");
    let duration = desired.duration();
    let targets = (0..TARGETS)
        .map(|k| {
            let meeting = rng.random_range(0.2..0.9) * duration;
            let course = rng.random_range(-3.1..3.1);
            let pace = rng.random_range(2.0..6.0);
            let aside = Vector::new(rng.random_range(-60.0..60.0), rng.random_range(-60.0..60.0));
            let place = desired.position_at(meeting) + aside - direction(course) * (pace * meeting);
            Target {
                name: format!("target {k}"),
                motion: Motion::Ship(ShipTrack {
                    pose: Pose::new(place, course),
                    speed: pace,
                    hull: Hull {
                        length: 25.0,
                        beam: 8.0,
                    },
                    position_std: 0.0,
                    speed_spread: 0.2,
                    course_spread: 0.03,
                    turn_rate: 0.0,
                    domain: DomainKind::Hull,
                }),
                representation: Representation::Polytope,
            }
        })
        .collect();
    let first = desired.legs()[0];
    Scenario {
        title: format!("harbour {seed}"),
        horizon: 2.0 * duration,
        own_ship: OwnShip {
            pose: Pose::new(first.start, searoom::frame::heading_of(first.direction)),
            speed,
            hull,
            turning_radius: 40.0,
            speeds: vec![2.0, 4.0, 5.0],
            safety_margin: 20.0,
        },
        desired,
        alternatives: Vec::new(),
        planner: PlannerKind::SpaceTime,
        objective: Objective::SpaceTimeError,
        targets,
        search: SearchKind::AStar,
        compliance: Compliance::Shape,
        time_weight: speed * speed,
        max_risk: 0.0,
        deadline: 60.0,
        earth: None,
        land: Some(land),
    }
}

fn scenes() -> Vec<Scenario> {
    let asked = std::env::var("SEAROOM_HARBOUR").ok();
    let count = asked.and_then(|n| n.parse().ok()).unwrap_or(30);
    let map = harbour();
    (0..count).map(|seed| scene(&map, seed)).collect()
}

#[test]
fn every_plan_keeps_off_land_and_targets() {
    let (mut solved, mut conflicts, mut touched) = (0, 0, 0);
    let mut milliseconds = Vec::new();
    let mut costs = Vec::new();
    let scenes = scenes();
    for scenario in &scenes {
        let run = pipeline::run(scenario.clone());
        milliseconds.push(run.plan_time.as_secs_f64() * 1e3);
        if std::env::var("SEAROOM_VERBOSE").is_ok() {
            println!(
                "{}: {:.1} ms, expanded {}+{}, land pieces {}, {:?}, J {:?}, land {:?}",
                scenario.title,
                run.plan_time.as_secs_f64() * 1e3,
                run.planned.stats.expanded,
                run.planned.stats.further_expanded,
                run.land.len(),
                match &run.planned.outcome {
                    Outcome::Solved(_) => "solved".to_owned(),
                    Outcome::Infeasible(why) => why.to_string(),
                    Outcome::Deadline(_) => "deadline".to_owned(),
                },
                run.evaluation.as_ref().map(|e| e.space_time_error),
                run.evaluation.as_ref().map(|e| e.min_land_distance),
            );
        }
        let Outcome::Solved(plan) = &run.planned.outcome else {
            continue;
        };
        solved += 1;
        let evaluation = run.evaluation.expect("judged");
        assert!(
            evaluation.verified(),
            "{}: {:?}",
            scenario.title,
            evaluation.violations
        );
        assert!(evaluation.min_land_distance >= 10.0 - 1e-6);
        conflicts += usize::from(plan.cost > 20.0);
        touched += usize::from(evaluation.min_land_distance < 20.0);
        costs.push(plan.cost);
    }
    let all = scenes.len();
    println!(
        "solved                      {solved} of {all}, {conflicts} with a conflict, {touched} within 20 m of land"
    );
    println!("planning, ms                {}", spread(&milliseconds));
    println!("space-time error, m²        {}", spread(&costs));
    assert!(10 * solved >= 9 * all, "{solved} of {all}");
}

/// The same graph without the bound.
#[test]
fn a_star_costs_what_dijkstra_costs_among_land() {
    let mut compared = 0;
    for scenario in scenes().iter().take(12) {
        let obstacles: Vec<Obstacle> = pipeline::sets(scenario)
            .into_iter()
            .map(|s| s.hard)
            .collect();
        let land = pipeline::land_within_reach(scenario);
        let coast = pipeline::coast(scenario, &land);
        let asked = pipeline::problem(scenario, &obstacles, &coast);
        let graph_cost = |search| {
            let planned = space_time::plan(&Problem {
                search,
                ..asked.clone()
            });
            planned.outcome.plan().and_then(|p| p.graph_cost)
        };
        let (a, d) = (
            graph_cost(SearchKind::AStar),
            graph_cost(SearchKind::Dijkstra),
        );
        if let (Some(a), Some(d)) = (a, d) {
            assert!(
                (a - d).abs() <= 1e-9 * (1.0 + d),
                "{}: {a} {d}",
                scenario.title
            );
            compared += 1;
        }
    }
    assert!(compared > 5, "{compared}");
}
