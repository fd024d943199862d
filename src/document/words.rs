//! The words of the documents for what the program computes.

use crate::frame::{Side, clockwise_deg};
use crate::planner::path_time::PathTimeDiagram;
use crate::planner::{Escape, PlannerKind, SearchKind};
use crate::scenario::Scenario;

/// What the planner minimises.
pub(crate) fn objective(scenario: &Scenario) -> &'static str {
    match scenario.planner {
        PlannerKind::OptimalControl => "stage-cost",
        PlannerKind::SpaceTime | PlannerKind::PathTime => scenario.objective.word(),
    }
}

pub(crate) fn search(kind: SearchKind) -> &'static str {
    match kind {
        SearchKind::AStar => "a-star",
        SearchKind::Dijkstra => "dijkstra",
    }
}

/// Until when course and speed are held, and what then.
pub(crate) fn stand_on(escape: &Escape) -> String {
    let until = format!(
        "course and speed are held until {:.1} s, the latest time at which an escape is known to be clear: ",
        escape.latest
    );
    let then = match Side::of_turn(escape.turn) {
        Some(to) => format!(
            "a turn of {:.0}° to {} at {:.2} m/s",
            clockwise_deg(escape.turn).abs(),
            side(to),
            escape.speed
        ),
        None => format!("{:.2} m/s", escape.speed),
    };
    until + &then
}

/// What a path is called: 0 is the main one.
pub(crate) fn path(index: usize) -> String {
    match index {
        0 => "main".to_owned(),
        index => format!("alternative {index}"),
    }
}

/// The paths that are sailed, in their order.
pub(crate) fn paths(diagram: &PathTimeDiagram) -> String {
    let mut sailed: Vec<usize> = diagram.legs.iter().map(|leg| leg.path).collect();
    sailed.dedup();
    let names: Vec<String> = sailed.into_iter().map(path).collect();
    names.join(", ")
}
pub(crate) fn side(side: Side) -> &'static str {
    match side {
        Side::Port => "port",
        Side::Starboard => "starboard",
    }
}
