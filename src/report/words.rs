//! The words of the contract for what the program computes.

use crate::frame::Side;
use crate::planner::{PlannerKind, SearchKind};

/// What a planner minimises.
pub(super) fn objective(kind: &PlannerKind) -> &'static str {
    match kind {
        PlannerKind::SpaceTime => "space-time-error",
        PlannerKind::OptimalControl(_) => "stage-cost",
    }
}

pub(super) fn search(kind: SearchKind) -> &'static str {
    match kind {
        SearchKind::AStar => "a-star",
        SearchKind::Dijkstra => "dijkstra",
    }
}

pub(super) fn side(side: Side) -> &'static str {
    match side {
        Side::Port => "port",
        Side::Starboard => "starboard",
    }
}
