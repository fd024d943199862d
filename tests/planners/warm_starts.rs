//! Plans from a plan against other sets.

use std::time::Duration;

use crate::campaigns::encounter_generator::{
    EncounterKind, Placement, random_encounter, random_traffic,
};
use searoom::geometry::outer_disc;
use searoom::obstacle::{LandObstacle, Obstacle, PolytopeObstacle};
use searoom::pipeline;
use searoom::planner::space_time::{plan, warm_started};
use searoom::planner::{Problem, SearchKind};
use searoom::trajectory::Trajectory;

/// Runs a check on the problems of random encounters and traffic with their plans.
fn at_plans(check: impl Fn(&Problem, &Trajectory, f64)) {
    let encounters = EncounterKind::ALL
        .into_iter()
        .flat_map(|kind| (0..6).map(move |guess| random_encounter(kind, guess, Placement::Random)));
    let traffic = (0..6).map(|guess| random_traffic(3, guess, Placement::Random));
    for drawn in encounters.chain(traffic) {
        let scenario = drawn.expect("drawn").scenario;
        let sets = pipeline::sets(&scenario);
        let obstacles: Vec<Obstacle> = sets.into_iter().map(|s| s.with_domain).collect();
        let problem = Problem {
            search: SearchKind::AStar,
            deadline: Duration::from_secs(60),
            tidy: None,
            ..pipeline::problem(&scenario, &obstacles, LandObstacle::none())
        };
        if let Some(found) = plan(&problem).outcome.plan() {
            check(&problem, &found.trajectory, found.cost);
        }
    }
}

/// Warm starts for the same sets and for larger ones, checked independently of the planner's
/// contact test.
#[test]
fn warm_starts_are_clear_and_for_the_same_sets_no_costlier() {
    let (drawn, larger) = (std::cell::Cell::new(0), std::cell::Cell::new(0));
    at_plans(|problem, trajectory, cost| {
        if let Some(again) = warm_started(problem, trajectory).outcome.plan() {
            assert!(again.cost <= 1.01 * cost, "{} {cost}", again.cost);
            drawn.set(drawn.get() + 1);
        }
        let grown: Vec<Obstacle> = problem
            .obstacles
            .iter()
            .map(|o| match o.as_polytope() {
                Some(o) => PolytopeObstacle::new(
                    "",
                    o.initial().minkowski_sum(&outer_disc(15.0, 0.0)),
                    o.velocity().clone(),
                )
                .into(),
                None => o.clone(),
            })
            .collect();
        let problem = Problem {
            obstacles: &grown,
            ..problem.clone()
        };
        if let Some(plan) = warm_started(&problem, trajectory).outcome.plan() {
            larger.set(larger.get() + 1);
            let end = plan.trajectory.end_time();
            for k in 0..=2000 {
                let time = end * f64::from(k) / 2000.0;
                let place = plan.trajectory.pose_at(time).position;
                let inside = |o: &Obstacle| {
                    (o.as_polytope()).is_some_and(|o| o.slack(place, time).value < -1e-6)
                };
                assert!(!grown.iter().any(inside), "inside at {time} s");
            }
        }
    });
    assert!(
        drawn.get() > 20 && larger.get() > 15,
        "{} {}",
        drawn.get(),
        larger.get()
    );
}
