//! The independent evaluation of a motion.

use super::land::NearLand;
use super::relaxation::Attempt;
use crate::evaluation::{
    Evaluation, Freedom, Request, SpaceTimeSet, Steering, evaluate, evaluate_steered,
};
use crate::geometry::Polygon;
use crate::obstacle::{Obstacle, SpaceTimeObstacle};
use crate::planner::Plan;
use crate::scenario::Scenario;
use crate::trajectory::Trajectory;

/// Evaluates a trajectory against the obstacles that it was planned against.
pub fn judge(scenario: &Scenario, obstacles: &[Obstacle], trajectory: &Trajectory) -> Evaluation {
    let risk = scenario.max_risk;
    let sets = (obstacles, &[][..], risk);
    judge_plan(scenario, sets, polygons(scenario), trajectory, true)
}

/// Evaluates an answer at its accepted risk; sets that it enters count from when they are left.
/// Where the land is simplified, the plan is compared with the larger pieces, as it claims.
pub(super) fn judge_answer(
    scenario: &Scenario,
    answer: &Attempt,
    land: &NearLand,
    trajectory: &Trajectory,
) -> Evaluation {
    let sets = (&answer.obstacles[..], &answer.released[..], answer.risk);
    let plan = answer.planned.outcome.plan();
    let arrives = plan.is_none_or(Plan::arrives);
    let simplified = land.polygons();
    let land = simplified.as_deref().unwrap_or_else(|| polygons(scenario));
    judge_plan(scenario, sets, land, trajectory, arrives)
}

/// The land of the map.
fn polygons(scenario: &Scenario) -> &[Polygon] {
    scenario.land.as_ref().map_or(&[], |l| l.map.polygons())
}

/// Level sets, from when each counts, and their risk.
type Avoided<'a> = (&'a [Obstacle], &'a [Option<f64>], f64);

fn judge_plan(
    scenario: &Scenario,
    avoided: Avoided,
    land: &[Polygon],
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
    judged(scenario, avoided, land, trajectory, freedom)
}

/// Evaluates a motion that is not a plan: start, sets, hulls, land and figures, without own ship's
/// limits and without arrival.
pub fn judge_free(
    scenario: &Scenario,
    obstacles: &[Obstacle],
    trajectory: &Trajectory,
) -> Evaluation {
    let sets = (obstacles, &[][..], scenario.max_risk);
    let land = polygons(scenario);
    judged(scenario, sets, land, trajectory, Freedom::Any)
}

/// The second part of `avoided` holds per set the time in seconds from which it counts, where the
/// trajectory enters it.
fn judged(
    scenario: &Scenario,
    (obstacles, released, risk): Avoided,
    land: &[Polygon],
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
        land,
        land_margin: scenario.land.as_ref().map_or(0.0, |l| l.margin),
        horizon: scenario.horizon,
        arrival_hold: scenario.arrival_hold,
        stay: scenario.stay,
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
