//! The motion along the main path as if nobody else were there.

use super::main_path;
use super::scene::Scene;
use crate::obstacle::PathTime;
use crate::planner::cost::space_time_error;
use crate::planner::{Objective, Outcome, Plan, Planned, Problem};
use crate::trajectory::PathNetwork;

/// Along the main path, each leg at its desired speed, or own ship's greatest where that is less or where `hurrying`. `None` where the
/// paths are none, or the end is not reached before the horizon. Clear of nothing.
pub fn undisturbed(problem: &Problem, hurrying: bool) -> Option<Planned> {
    let network = PathNetwork::new(&problem.desired.waypoints(), problem.alternatives).ok()?;
    let scene = Scene::new(
        &Problem {
            obstacles: &[],
            ..problem.clone()
        },
        &network,
    );
    let main = main_path(&scene);
    let mut profile = super::Profile::new();
    let mut time = 0.0;
    let point = |distance: f64, time: f64| PathTime { distance, time };
    for (leg, desired) in main.legs.iter().zip(problem.desired.legs()) {
        let wanted = if hurrying {
            f64::INFINITY
        } else {
            desired.speed
        };
        let length = scene.tracks[*leg].length;
        let end = time + length / wanted.min(scene.max_speed);
        profile.sail(&scene, *leg, point(0.0, time), point(length, end));
        time = end;
    }
    // negated on purpose: a NaN is too late
    if !(time <= problem.horizon) {
        return None;
    }
    let trajectory = profile.trajectory(&scene, problem.own.pose)?;
    let error = |s| space_time_error(problem.desired, s, problem.time_weight);
    let cost = match problem.objective {
        Objective::SpaceTimeError => trajectory.segments().iter().map(error).sum(),
        Objective::Time => trajectory.end_time(),
        Objective::Length => trajectory.length(),
        // all of the risk is taken
        Objective::LengthRisk { weight } => trajectory.length() + weight,
    };
    // the diagram has the sets that this motion is not clear of
    let barred = Scene::new(problem, &network);
    let outcome = Outcome::Solved(Plan {
        trajectory,
        cost,
        graph_cost: None,
    });
    Some(Planned {
        path_time: Some(Box::new(profile.diagram(&barred, problem.own.pose))),
        ..Planned::of(outcome)
    })
}
