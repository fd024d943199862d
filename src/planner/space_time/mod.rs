//! The space-time planner: a graph of Dubins segments that hug the bodies' edges, searched for the
//! least space-time error, then refined.

mod graph;
mod hazard;
mod heuristic;
mod interception;
mod route;

use std::time::Instant;

use super::cost::space_time_error;
use super::{ExploredGraph, NoPlan, Outcome, Plan, Planned, Problem, SearchStats};
use crate::search::{Search, Stop};
use crate::trajectory::{Segment, Trajectory};
use graph::{Graph, State};
use hazard::{Hazard, TOUCH_M, first_contact};
use route::Route;

/// Expansions of one search at most: the bound on its memory. Typical searches need a hundredth.
const MAX_EXPANDED: usize = 20_000;

/// Plans one problem.
pub fn plan(problem: &Problem) -> Planned {
    let started = Instant::now();
    let refuse = |reason| Planned {
        outcome: Outcome::Infeasible(reason),
        stats: SearchStats::default(),
        explored: ExploredGraph::new(),
    };
    let own = problem.own;
    for o in problem.obstacles {
        let slack = o.slack(own.pose.position, 0.0).value;
        // negated on purpose: a NaN is inside
        if !(slack >= -TOUCH_M) {
            return refuse(NoPlan::StartInside {
                target: o.name().to_owned(),
                depth: -slack,
            });
        }
    }
    let Some(route) = Route::new(problem) else {
        return refuse(NoPlan::NoCandidate {
            closest: "no path joins the waypoints".to_owned(),
        });
    };
    let mut undisturbed = Vec::new();
    route.follow(0.0, 0.0, &mut undisturbed);
    let arrival = undisturbed.last().map_or(0.0, Segment::end_time);
    if !(arrival <= problem.horizon) {
        return refuse(NoPlan::HorizonTooShort {
            earliest: arrival,
            horizon: problem.horizon,
        });
    }
    let hazards: Vec<Hazard> = problem.obstacles.iter().map(Hazard::new).collect();
    let mut graph = Graph::new(problem, &hazards, &route, &undisturbed);
    let mut search = Search::new(graph.root());
    let out_of_time = || started.elapsed() >= problem.deadline;
    let mut seed = None;
    if let Stop::Goal(node) = search.next_goal(&mut graph, MAX_EXPANDED) {
        seed = Some(node);
    }
    let counts = search.counts();
    let stats = SearchStats {
        expanded: counts.expanded,
        generated: counts.generated,
        edges_checked: counts.tested,
    };
    let motion = |node: usize| -> Vec<Segment> {
        search
            .way_to(node)
            .iter()
            .flat_map(|i| search.nodes()[*i].state.motion.iter().copied())
            .collect()
    };
    let outcome = match seed.and_then(|n| Trajectory::new(motion(n)).ok().map(|t| (n, t))) {
        Some((node, trajectory)) => {
            let cost = search.nodes()[node].cost;
            Outcome::Solved(Plan {
                trajectory,
                cost,
                graph_cost: Some(cost),
            })
        }
        None => Outcome::Infeasible(NoPlan::NoCandidate {
            closest: String::new(),
        }),
    };
    let _ = (out_of_time, first_contact, space_time_error);
    Planned {
        outcome,
        stats,
        explored: Graph::explored(&search),
    }
}
