//! Sequential conflict resolution: conflicts that are far apart are resolved one after another.
//!
//! The graph leaves the route once and comes back once. Here the graph's best plan for the first
//! conflict ignores later ones and ends back on the route. The next conflict is resolved from
//! there.

use crate::planner::clock::Clock;
use crate::planner::space_time::graph::Graph;
use crate::planner::space_time::graph::node;
use crate::planner::space_time::motion::{part, until as motion_until};
use crate::planner::space_time::refinement::trial::Context;
use crate::planner::space_time::selection::initial_guess::Conflict;
use crate::search::{Search, Stop};
use crate::trajectory::Segment;

/// Seconds. Conflicts that begin within this time of one another are resolved together.
pub(crate) const TOGETHER_S: f64 = 120.0;

/// Largest lead of a departure before a conflict, seconds.
const LEAD_S: f64 = 100.0;

/// Largest number of conflicts.
const MAX_STAGES: usize = 30;

/// Largest number of expansions for one conflict.
const MAX_EXPANDED: usize = 500;

/// True when conflicts, ordered by start, do not all begin together.
pub(crate) fn are_several(conflicts: &[Conflict]) -> bool {
    let ends = conflicts.first().zip(conflicts.last());
    ends.is_some_and(|(first, last)| last.from > first.from + TOGETHER_S)
}

/// Motion to the last waypoint that is clear of every proxy and of land, from a nominal one that is
/// not. `None` when a conflict has no solution, or a later one begins no later.
pub(crate) fn resolve_sequentially(
    context: &Context,
    nominal_motion: &[Segment],
    clock: Clock,
) -> Option<Vec<Segment>> {
    let mut motion = nominal_motion.to_vec();
    let mut before = f64::NEG_INFINITY;
    for _ in 0..MAX_STAGES {
        let Some(contact) = context.first_conflict(&motion) else {
            return Some(motion);
        };
        // negated on purpose: a NaN is no progress
        if !(contact > before) || clock.is_up() {
            return None;
        }
        before = contact;
        let leaves = (contact - LEAD_S).max(0.0);
        let rest = part(&motion, leaves, f64::INFINITY);
        let near = part(&motion, leaves, contact + 2.0 * TOGETHER_S);
        let mut graph = Graph::for_conflict(context, [&near, &rest], contact, clock);
        let mut search = Search::new(graph.root());
        let Stop::Goal(goal) = search.next_goal(&mut graph, MAX_EXPANDED) else {
            return None;
        };
        let mut next = motion_until(&motion, leaves);
        next.extend(node::motion_to(&search, goal));
        motion = next;
    }
    None
}

/// The part of a motion to the end that must be clear: until `until`, and for a while from its
/// start. Later contacts belong to the next conflict.
pub(crate) fn checked_part(path: &[Segment], until: f64) -> Vec<Segment> {
    let start = path.first().map_or(until, |s| s.start_time);
    let until = until.max(start + TOGETHER_S);
    motion_until(path, until)
}
