//! The independent evaluation of a motion.

use super::relaxation::Attempt;
use crate::evaluation::{
    Evaluation, Freedom, Request, SpaceTimeSet, Steering, evaluate, evaluate_steered,
};
use crate::obstacle::{Obstacle, SpaceTimeObstacle};
use crate::planner::Plan;
use crate::scenario::Scenario;
use crate::trajectory::Trajectory;

/// Evaluates a trajectory against the obstacles that it was planned against.
pub fn judge(scenario: &Scenario, obstacles: &[Obstacle], trajectory: &Trajectory) -> Evaluation {
    let risk = scenario.max_risk;
    judge_plan(scenario, obstacles, &[], risk, trajectory, true)
}

/// Evaluates an answer at its accepted risk; sets that it enters count from when they are left.
pub(super) fn judge_answer(
    scenario: &Scenario,
    answer: &Attempt,
    trajectory: &Trajectory,
) -> Evaluation {
    let (obstacles, released) = (&answer.obstacles, &answer.released);
    let plan = answer.planned.outcome.plan();
    let arrives = plan.is_none_or(Plan::arrives);
    judge_plan(
        scenario,
        obstacles,
        released,
        answer.risk,
        trajectory,
        arrives,
    )
}

fn judge_plan(
    scenario: &Scenario,
    obstacles: &[Obstacle],
    released: &[Option<f64>],
    risk: f64,
    trajectory: &Trajectory,
    arrives: bool,
) -> Evaluation {
    let mut paths = vec![scenario.desired.waypoints()];
    paths.extend_from_slice(&scenario.alternatives);
    let freedom = match scenario.planner.facts().follows_paths {
        false if arrives => Freedom::Limits,
        false => Freedom::LimitsWithoutArrival,
        true if arrives => Freedom::Paths(&paths),
        true => Freedom::PathsToHorizon(&paths),
    };
    judged(scenario, obstacles, released, risk, trajectory, freedom)
}

/// Evaluates a motion that is not a plan: start, sets, hulls, land and figures, without own ship's
/// limits and without arrival.
pub fn judge_free(
    scenario: &Scenario,
    obstacles: &[Obstacle],
    trajectory: &Trajectory,
) -> Evaluation {
    let risk = scenario.max_risk;
    judged(scenario, obstacles, &[], risk, trajectory, Freedom::Any)
}

/// `released` holds per set the time in seconds from which it counts, where the trajectory enters
/// it. The obstacles are the level sets of `risk`.
fn judged(
    scenario: &Scenario,
    obstacles: &[Obstacle],
    released: &[Option<f64>],
    risk: f64,
    trajectory: &Trajectory,
    freedom: Freedom,
) -> Evaluation {
    let released = released.iter().copied().chain(std::iter::repeat(None));
    let sets: Vec<SpaceTimeSet> = (obstacles.iter().zip(released))
        .map(|(o, released)| {
            let from = released.unwrap_or(0.0);
            SpaceTimeSet {
                name: o.name().to_owned(),
                from,
                sets: o.remaining_sets(from),
            }
        })
        .collect();
    let request = Request {
        freedom,
        segments: trajectory.segments(),
        own: &scenario.own_ship,
        desired: &scenario.desired,
        targets: &scenario.targets,
        sets: &sets,
        land: scenario.land.as_ref().map_or(&[], |l| l.map.polygons()),
        land_margin: scenario.land.as_ref().map_or(0.0, |l| l.margin),
        horizon: scenario.horizon,
        arrival_hold: scenario.arrival_hold,
        time_weight: scenario.time_weight,
        max_risk: risk,
    };
    match trajectory.steered() {
        Some(motion) => {
            let control = &scenario.settings.optimal_control;
            let vessel = control.vessel.exact(control.length);
            let steering = Steering {
                motion,
                vessel: vessel.as_ref(),
                force_limits: control.force_limits,
                start_velocity: match &scenario.memory.warm_start {
                    Some(warm) => [3, 4, 5].map(|i| warm.state[i]),
                    None => [scenario.own_ship.speed, 0.0, 0.0],
                },
            };
            evaluate_steered(&request, &steering)
        }
        None => evaluate(&request),
    }
}
