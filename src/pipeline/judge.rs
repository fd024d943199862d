//! The independent evaluation of a motion.

use super::relaxation::Attempt;
use crate::evaluation::{
    Evaluation, Freedom, Request, SpaceTimeSet, Steering, evaluate, evaluate_steered,
};
use crate::obstacle::{Obstacle, SpaceTimeObstacle};
use crate::scenario::Scenario;
use crate::trajectory::Trajectory;

/// Evaluates a trajectory against the obstacles that it was planned against.
pub fn judge(scenario: &Scenario, obstacles: &[Obstacle], trajectory: &Trajectory) -> Evaluation {
    let claims = Claims {
        obstacles,
        released: &[],
        risk: scenario.max_risk,
    };
    judge_plan(scenario, &claims, trajectory, true)
}

/// Evaluates an answer at its accepted risk; sets that it enters count from when they are left.
pub(super) fn judge_answer(
    scenario: &Scenario,
    answer: &Attempt,
    trajectory: &Trajectory,
) -> Evaluation {
    let claims = Claims {
        obstacles: &answer.obstacles,
        released: &answer.released,
        risk: answer.risk,
    };
    let plan = answer.planned.outcome.plan();
    let arrives = plan.is_none_or(|plan| plan.to_go == 0.0);
    judge_plan(scenario, &claims, trajectory, arrives)
}

fn judge_plan(
    scenario: &Scenario,
    claims: &Claims,
    trajectory: &Trajectory,
    arrives: bool,
) -> Evaluation {
    let mut paths = vec![scenario.desired.waypoints()];
    paths.extend_from_slice(&scenario.alternatives);
    let freedom = match scenario.planner.facts().follows_paths {
        false => Freedom::Limits,
        true if arrives => Freedom::Paths(&paths),
        true => Freedom::PathsToHorizon(&paths),
    };
    judged(scenario, claims, trajectory, freedom)
}

/// Evaluates a motion that is not a plan: start, sets, hulls, land and figures, without own ship's
/// limits and without arrival.
pub fn judge_free(
    scenario: &Scenario,
    obstacles: &[Obstacle],
    trajectory: &Trajectory,
) -> Evaluation {
    let claims = Claims {
        obstacles,
        released: &[],
        risk: scenario.max_risk,
    };
    judged(scenario, &claims, trajectory, Freedom::Any)
}

/// Sets that a trajectory is claimed to be clear of.
struct Claims<'a> {
    obstacles: &'a [Obstacle],
    /// Seconds, per set: the time from which it counts, where the trajectory enters it.
    released: &'a [Option<f64>],
    /// The risk of which the obstacles are the level sets.
    risk: f64,
}

fn judged(
    scenario: &Scenario,
    claims: &Claims,
    trajectory: &Trajectory,
    freedom: Freedom,
) -> Evaluation {
    let released = claims
        .released
        .iter()
        .copied()
        .chain(std::iter::repeat(None));
    let sets: Vec<SpaceTimeSet> = (claims.obstacles.iter())
        .zip(released)
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
        max_risk: claims.risk,
    };
    match trajectory.steered() {
        Some(motion) => {
            let control = &scenario.settings.optimal_control;
            let vessel = control.vessel.exact(control.length);
            let steering = Steering {
                motion,
                vessel: vessel.as_ref(),
                force_limits: control.force_limits,
            };
            evaluate_steered(&request, &steering)
        }
        None => evaluate(&request),
    }
}
