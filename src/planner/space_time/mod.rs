//! The space-time planner: a graph of Dubins segments that hug the bodies' edges, searched for the
//! least space-time error, then refined.

mod heuristic;
mod interception;
mod route;

use super::{ExploredGraph, NoPlan, Outcome, Planned, Problem, SearchStats};

/// Plans one problem.
pub fn plan(problem: &Problem) -> Planned {
    let _ = problem;
    Planned {
        outcome: Outcome::Infeasible(NoPlan::NoCandidate {
            closest: String::new(),
        }),
        stats: SearchStats::default(),
        explored: ExploredGraph::new(),
    }
}
