//! The independent judgement of a motion.

use super::ladder::Attempt;
use crate::evaluation::{
    Evaluation, Freedom, Request, SetShape, SpaceTimeSet, Steering, evaluate, evaluate_steered,
};
use crate::obstacle::{Obstacle, SpaceTimeObstacle};
use crate::planner::PlannerKind;
use crate::scenario::Scenario;
use crate::target::VelocitySpell;
use crate::trajectory::Trajectory;

/// The independent judgement of a trajectory against the obstacles that it was planned against.
pub fn judge(scenario: &Scenario, obstacles: &[Obstacle], trajectory: &Trajectory) -> Evaluation {
    let kept = Claims {
        obstacles,
        released: &[],
        risk: scenario.max_risk,
    };
    judge_plan(scenario, &kept, trajectory, true)
}

/// The same of an answer: at the risk that it takes, and of sets that it enters from when it has left them.
pub(super) fn judge_kept(
    scenario: &Scenario,
    answer: &Attempt,
    trajectory: &Trajectory,
) -> Evaluation {
    let kept = Claims {
        obstacles: &answer.obstacles,
        released: &answer.released,
        risk: answer.risk,
    };
    let plan = answer.planned.outcome.plan();
    let arrives = plan.is_none_or(|plan| plan.to_go == 0.0);
    judge_plan(scenario, &kept, trajectory, arrives)
}

fn judge_plan(
    scenario: &Scenario,
    claims: &Claims,
    trajectory: &Trajectory,
    arrives: bool,
) -> Evaluation {
    let mut paths = vec![scenario.desired.waypoints()];
    paths.extend_from_slice(&scenario.alternatives);
    let freedom = match scenario.planner {
        PlannerKind::SpaceTime | PlannerKind::OptimalControl => Freedom::Limits,
        PlannerKind::PathTime if arrives => Freedom::Paths(&paths),
        PlannerKind::PathTime => Freedom::PathsToHorizon(&paths),
    };
    judged(scenario, claims, trajectory, freedom)
}

/// The same for what is no plan: its start, every set, every hull, the land and the figures, whatever own ship's limits are and
/// whether it arrives or not.
pub fn judge_free(
    scenario: &Scenario,
    obstacles: &[Obstacle],
    trajectory: &Trajectory,
) -> Evaluation {
    let kept = Claims {
        obstacles,
        released: &[],
        risk: scenario.max_risk,
    };
    judged(scenario, &kept, trajectory, Freedom::Any)
}

/// What a trajectory is said to be clear of: sets, per set from when on where it enters her, and the risk of which they are the
/// level sets.
struct Claims<'a> {
    obstacles: &'a [Obstacle],
    released: &'a [Option<f64>],
    risk: f64,
}

fn judged(
    scenario: &Scenario,
    claims: &Claims,
    trajectory: &Trajectory,
    freedom: Freedom,
) -> Evaluation {
    let shape = |o: &Obstacle| match o {
        Obstacle::Polytope(o) => SetShape::Polygons {
            initial: o.initial().clone(),
            spells: vec![VelocitySpell {
                until: f64::INFINITY,
                velocities: o.velocity().clone(),
            }],
        },
        Obstacle::Ellipsoid(o) => SetShape::Ellipses {
            initial: *o.initial(),
            velocity: *o.velocity(),
        },
        Obstacle::Slabs(o) => SetShape::Polygons {
            initial: o.initial().clone(),
            spells: o.spells().to_vec(),
        },
    };
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
                shape: shape(&o.remainder(from)),
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
            let control = &scenario.control;
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
