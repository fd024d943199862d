//! Results after the deadline.

use std::time::Duration;

use super::super::defect::largest_defect;
use super::*;
use crate::obstacle::{LandObstacle, Obstacle};
use crate::pipeline;
use crate::scenario::Scenario;

const FIGURE_9: &str = include_str!("../../../../scenarios/paper/figure_9.toml");

#[test]
fn after_the_deadline_a_costlier_plan_on_a_fine_grid_is_returned() {
    let scenario = Scenario::parse(FIGURE_9).expect("valid");
    let sets = pipeline::sets(&scenario);
    let obstacles: Vec<Obstacle> = sets.into_iter().map(|s| s.hard).collect();
    let problem = Problem {
        deadline: Duration::ZERO,
        ..pipeline::problem(&scenario, &obstacles, LandObstacle::none())
    };
    let exact = CyberShip2::EXACT;
    let planner = Planning::new(
        &problem,
        &scenario.settings.optimal_control,
        CyberShip2::SMOOTH,
        exact,
    );
    let task = planner.task(planner.intervals);
    let attempts: Vec<StartAttempt> = family(&task)
        .into_iter()
        .map(|(_, guess)| attempt(&task, &guess, &Settings::default(), &|| true))
        .collect();
    let is_fine =
        |a: &StartAttempt| largest_defect(&exact, &a.profile, task.step()) <= tolerance::DEFECT;
    let ordered = cheapest_first(&attempts);
    assert!(!is_fine(ordered[0]));
    let fine = ordered.iter().find(|a| is_fine(a)).expect("one of many");
    let mut report = *planner.plan().control.expect("forces");
    let Outcome::Solved(plan) = planner.cheapest_on_fine_grid(&attempts, &mut report) else {
        panic!("no plan");
    };
    assert_eq!(plan.cost, fine.objective);
    assert!(report.intervals == planner.intervals && report.defect <= tolerance::DEFECT);
    // this one needs a finer grid, and there is no time
    let coarse: Vec<StartAttempt> = ordered.into_iter().take(1).cloned().collect();
    assert!(matches!(
        planner.cheapest_on_fine_grid(&coarse, &mut report),
        Outcome::Infeasible(NoPlan::Coarse { .. })
    ));
}
