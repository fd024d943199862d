//! Tests of the whole pipeline with ellipsoids, consecutive velocity sets, turning ships and
//! accepted risk.

use std::time::Duration;

use rayon::prelude::*;
use searoom::frame::{Vector, radians_from_deg};
use searoom::geometry::Ellipse;
use searoom::obstacle::{LandObstacle, Obstacle, SpaceTimeObstacle};
use searoom::pipeline::{self, Relaxation, Run};
use searoom::planner::{Problem, SearchKind, space_time};
use searoom::scenario::{Compliance, Scenario};
use searoom::target::{Motion, Representation};
use searoom::tolerance;

use crate::encounter_generator::{EncounterKind, Placement, random_encounter, random_traffic};

/// Named change of a scenario.
type Change = (&'static str, fn(&mut Scenario));

fn turning(scenario: &mut Scenario) {
    for target in &mut scenario.targets {
        if let Motion::Ship(ship) = &mut target.motion {
            ship.turn_rate = radians_from_deg(0.04);
        }
    }
}

fn ellipsoids(scenario: &mut Scenario) {
    for target in &mut scenario.targets {
        target.representation = Representation::Ellipsoid;
    }
}

const CHANGES: [Change; 6] = [
    ("ellipsoid", ellipsoids),
    ("turning", turning),
    ("risk", |s| s.max_risk = 0.4),
    ("ellipsoid at risk", |s| {
        ellipsoids(s);
        s.max_risk = 0.4;
    }),
    ("turning at risk", |s| {
        turning(s);
        s.max_risk = 0.4;
    }),
    ("hard ellipsoid", |s| {
        ellipsoids(s);
        s.compliance = Compliance::None;
    }),
];

fn scenarios(each: u64) -> Vec<Scenario> {
    let encounters = EncounterKind::with_seeds(0..each)
        .map(|(kind, seed)| random_encounter(kind, seed, Placement::Random));
    let traffic = (0..each).map(|seed| random_traffic(3, seed, Placement::Random));
    encounters
        .chain(traffic)
        .map(|drawn| {
            let mut scenario = drawn.expect("drawn").scenario;
            scenario.deadline = 60.0;
            scenario
        })
        .collect()
}

/// Whole sets of which the obstacles of a run are the level sets.
fn whole_sets(run: &Run) -> Vec<&Obstacle> {
    run.targets.iter().map(|t| &t.whole).collect()
}

/// Checks the claims of a plan by the obstacles' own queries at samples. This is weaker than the
/// independent checker.
fn assert_claims(name: &str, run: &Run) {
    let Some(plan) = run.planned.outcome.plan() else {
        return;
    };
    let evaluation = run.evaluation.as_ref().expect("judged");
    assert!(
        evaluation.verified(),
        "{name}, {}: {:?}",
        run.scenario.title,
        evaluation.violations
    );
    let whole = whole_sets(run);
    let times: Vec<f64> = (0..=400)
        .map(|i| plan.trajectory.end_time() * f64::from(i) / 400.0)
        .collect();
    for (i, set) in run.obstacles().enumerate() {
        let mut largest = 0.0_f64;
        for &time in &times {
            let position = plan.trajectory.pose_at(time).position;
            let apart = set.signed_distance(position, time).distance;
            assert!(apart > -tolerance::DEPTH_M, "{name}: {apart} at {time}");
            if whole[i].signed_distance(position, time).distance < -tolerance::DEPTH_M {
                largest = largest.max(whole[i].risk(position, time));
            }
        }
        let peak = run.targets[i].peak.expect("a plan");
        assert!(
            peak.risk >= largest - 1e-9,
            "{name}: {peak:?} below {largest}"
        );
        assert!(peak.risk <= run.max_risk + 1e-6, "{name}: {peak:?}");
        let entered = run.relaxations.iter().any(|r| {
            matches!(r, Relaxation::Risk { target, amount, until: None } if target == set.name() && *amount == peak.risk)
        });
        assert_eq!(entered, peak.risk > 0.0, "{name}");
    }
}

#[test]
fn every_plan_is_clear_of_its_sets_and_takes_no_more_risk_than_it_may() {
    let scenarios = scenarios(5);
    for (name, change) in CHANGES {
        let solved: Vec<bool> = scenarios
            .par_iter()
            .map(|scenario| {
                let mut changed = scenario.clone();
                change(&mut changed);
                let run = pipeline::run(changed);
                assert_claims(name, &run);
                run.planned.outcome.plan().is_some()
            })
            .collect();
        let count = solved.iter().filter(|s| **s).count();
        println!("{name}: {count} of {} solved", solved.len());
        assert!(5 * count >= 4 * solved.len(), "{name}: {count} solved");
    }
}

/// Largest cost of the graph's plan found, relative to the optimum, for several targets under a
/// weighted search: 1.51.
const HASTE: f64 = 1.52;

/// Tests that the bound is admissible for all kinds of sets.
#[test]
fn a_star_finds_the_cost_of_dijkstra() {
    let scenarios = scenarios(3);
    for (name, change) in CHANGES {
        let compared: usize = scenarios
            .par_iter()
            .map(|scenario| {
                let mut changed = scenario.clone();
                change(&mut changed);
                let obstacles: Vec<Obstacle> = pipeline::sets(&changed)
                    .iter()
                    .map(|s| s.hard.at_risk(changed.max_risk))
                    .collect();
                let graph_cost = |search| {
                    let planned = space_time::plan(&Problem {
                        search,
                        deadline: Duration::from_secs(120),
                        ..pipeline::problem(&changed, &obstacles, LandObstacle::none())
                    });
                    planned.outcome.plan().and_then(|p| p.graph_cost)
                };
                let best = graph_cost(SearchKind::AStar);
                let exhaustive = graph_cost(SearchKind::Dijkstra);
                match (best, exhaustive) {
                    (Some(a), Some(b)) => {
                        let most = if obstacles.len() > 1 { HASTE } else { 1.0 };
                        let rounding = 1e-9 * b.max(1.0);
                        assert!(
                            a >= b - rounding && a <= most * b + rounding,
                            "{name}: {a} {b}"
                        );
                        1
                    }
                    (None, None) => 0,
                    // Dijkstra may exceed its expansions first
                    (Some(_), None) => 0,
                    (None, Some(b)) => panic!("{name}: A* found nothing, Dijkstra {b}"),
                }
            })
            .sum();
        assert!(compared * 2 > scenarios.len(), "{name}: {compared}");
    }
}

/// Tests a slab obstacle with constant velocities, split in two: it equals the polytope. The cost
/// is equal in nearly all scenes. In a few, the refinement starts from other manoeuvres and ends in
/// another local minimum.
#[test]
fn cutting_time_hardly_changes_what_a_plan_costs() {
    use searoom::target::{TimedVelocitySet, Uncertainty};
    let mut changes = Vec::new();
    for scenario in scenarios(2) {
        let whole: Vec<Obstacle> = pipeline::sets(&scenario)
            .into_iter()
            .map(|s| s.hard)
            .collect();
        let cut: Vec<Obstacle> = whole
            .iter()
            .map(|o| {
                let o = o.as_polytope().expect("a polytope");
                let timed = |until| TimedVelocitySet::new(until, o.velocity().clone());
                let timed = vec![timed(60.0), timed(f64::INFINITY)];
                let sets = Uncertainty::new(o.initial().clone(), timed);
                Obstacle::new(o.name(), sets).expect("in order")
            })
            .collect();
        let cost = |obstacles: &[Obstacle]| {
            let planned = space_time::plan(&pipeline::problem(
                &scenario,
                obstacles,
                LandObstacle::none(),
            ));
            planned.outcome.plan().map(|p| p.cost)
        };
        if let (Some(a), Some(b)) = (cost(&whole), cost(&cut)) {
            changes.push((a / b).ln().abs());
        }
    }
    changes.sort_by(f64::total_cmp);
    assert!(changes.len() > 5, "{changes:?}");
    // measured: 0.2 % in the median, 10 % at most
    let (middle, most) = (changes[changes.len() / 2], changes[changes.len() - 1]);
    assert!(middle < 0.01 && most < 0.15, "{changes:?}");
}

/// Tests sets in increasing order: level sets by decreasing risk, then the whole set.
#[test]
fn a_plan_that_may_take_more_risk_costs_no_more() {
    let scenario = random_encounter(EncounterKind::HeadOn, 1, Placement::Origin)
        .expect("drawn")
        .scenario;
    for change in [|_: &mut Scenario| {}, ellipsoids, turning] {
        let cost = |max_risk: f64| {
            let mut changed = scenario.clone();
            change(&mut changed);
            changed.max_risk = max_risk;
            let run = pipeline::run(changed);
            assert_claims("sweep", &run);
            run.planned.outcome.plan().expect("a plan").cost
        };
        let costs = [0.0, 0.2, 0.5, 0.9].map(cost);
        assert!(
            costs.windows(2).all(|c| c[1] < c[0] * 1.02),
            "not decreasing: {costs:?}"
        );
    }
}

/// Tests flat ellipses, a point that grows to a segment, and a needle: no panic, and plans are
/// verified.
#[test]
fn degenerate_explicit_ellipses_are_planned_around() {
    let axes = |a: (f64, f64), b: (f64, f64)| [Vector::new(a.0, a.1), Vector::new(b.0, b.1)];
    let still = axes((0.0, 0.0), (0.0, 0.0));
    let along = axes((30.0, 0.0), (0.0, 0.0));
    let across = axes((0.0, 40.0), (0.0, 0.0));
    let slow = axes((0.0, 0.1), (0.0, 0.0));
    let ahead = axes((0.1, 0.0), (0.0, 0.0));
    let round = axes((0.1, 0.0), (0.0, 0.1));
    let needle = axes((0.0, 60.0), (1e-6, 0.0));
    let drawn = random_encounter(EncounterKind::HeadOn, 0, Placement::Origin).expect("drawn");
    let matrix = |axes: [Vector; 2]| axes[0] * axes[0].transpose() + axes[1] * axes[1].transpose();
    for initial in [still, along, across, needle] {
        for velocity in [still, slow, ahead, round] {
            let mut scenario = drawn.scenario.clone();
            let middle = scenario.desired.position_at(100.0);
            let ellipse = |center, axes| Ellipse::new(center, matrix(axes)).expect("a shape");
            scenario.targets[0].motion = Motion::Sets(searoom::target::Uncertainty::constant(
                ellipse(middle, initial),
                ellipse(Vector::new(-0.5, 0.0), velocity),
            ));
            scenario.targets[0].representation = Representation::Ellipsoid;
            let run = pipeline::run(scenario);
            assert!(
                run.planned.outcome.plan().is_some(),
                "{initial:?} {velocity:?}"
            );
            assert_claims("degenerate", &run);
        }
    }
}
