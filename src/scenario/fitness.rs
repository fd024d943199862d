//! What each planner asks of a scenario beyond what the fields say.

use super::{Fault, Scenario};
use crate::planner::{Objective, PlannerKind};
use crate::tolerance;
use crate::trajectory::{NetworkError, PathNetwork};

/// Every fault, by the paths of the fields.
pub(super) fn unfit(scenario: &Scenario) -> Vec<Fault> {
    match scenario.planner {
        PlannerKind::SpaceTime => for_space_time(scenario),
        PlannerKind::PathTime => for_path_time(scenario),
        PlannerKind::OptimalControl => for_optimal_control(scenario),
    }
}

fn fault(path: &str, found: String, allowed: &str) -> Fault {
    Fault {
        path: path.to_owned(),
        found,
        allowed: allowed.to_owned(),
        line: None,
    }
}

fn for_space_time(scenario: &Scenario) -> Vec<Fault> {
    let mut faults = Vec::new();
    if scenario.objective != Objective::SpaceTimeError {
        faults.push(fault(
            "planner.objective",
            format!(
                "\"{}\" for the space-time planner",
                scenario.objective.word()
            ),
            "\"space-time-error\", or the path-time planner",
        ));
    }
    if !scenario.alternatives.is_empty() {
        faults.push(fault(
            "mission.alternatives",
            "other paths for the space-time planner".to_owned(),
            "nothing: it chooses its way; or the path-time planner",
        ));
    }
    faults
}

fn for_optimal_control(scenario: &Scenario) -> Vec<Fault> {
    let mut faults = Vec::new();
    if scenario.objective != Objective::SpaceTimeError {
        faults.push(fault(
            "planner.objective",
            format!(
                "\"{}\" for the optimal-control planner",
                scenario.objective.word()
            ),
            "nothing: it minimises its own stage cost",
        ));
    }
    if !scenario.alternatives.is_empty() {
        faults.push(fault(
            "mission.alternatives",
            "other paths for the optimal-control planner".to_owned(),
            "nothing: it chooses its way; or the path-time planner",
        ));
    }
    if scenario.land.is_some() {
        faults.push(fault(
            "map",
            "land for the optimal-control planner".to_owned(),
            "nothing: it keeps off no land, this is not built yet",
        ));
    }
    faults
}

fn for_path_time(scenario: &Scenario) -> Vec<Fault> {
    let mut faults = Vec::new();
    let first = scenario.desired.legs()[0].start;
    let away = (scenario.own_ship.pose.position - first).norm();
    // negated on purpose: a NaN is away
    if !(away <= tolerance::JOINT_M) {
        faults.push(fault(
            "own_ship.position",
            format!("a start {away} m from the first waypoint"),
            "the first waypoint: the path-time planner keeps to the path",
        ));
    }
    let alternative = |index: usize| format!("mission.alternatives[{index}]");
    match PathNetwork::new(&scenario.desired.waypoints(), &scenario.alternatives) {
        Ok(_) => {}
        Err(NetworkError::NoSharedPoint { alternative: index }) => faults.push(fault(
            &alternative(index),
            "a path that shares no point with another one".to_owned(),
            "a path that leaves the mission's path, or another alternative, and comes back",
        )),
        Err(NetworkError::NoWayThrough { alternative: index }) => faults.push(fault(
            &alternative(index),
            "a path on no way from the first waypoint to the last".to_owned(),
            "a path that is met first where it can be reached, and later where another path goes on",
        )),
        Err(NetworkError::EmptyLeg { path, leg }) => faults.push(fault(
            &match path.checked_sub(1) {
                Some(index) => alternative(index),
                None => "mission.waypoints".to_owned(),
            },
            format!("no length of leg {leg}"),
            "legs of some length",
        )),
    }
    faults
}
