//! The words of the contract for what the program computes.

use crate::planner::SearchKind;

/// The only kind of planner that exists.
pub(super) const PLANNER: &str = "space-time";

/// What it minimises.
pub(super) const OBJECTIVE: &str = "space-time-error";

pub(super) fn search(kind: SearchKind) -> &'static str {
    match kind {
        SearchKind::AStar => "a-star",
        SearchKind::Dijkstra => "dijkstra",
    }
}
