//! Sequential conflict resolution: conflicts that are far apart are resolved one after another.
//!
//! A plan leaves the route once and comes back once. Here the plan for the first conflict ignores
//! later ones and ends back on the route. The next conflict is resolved from there. Where that
//! fails, the earlier ones are passed in another way (depth-first branch and bound).

use crate::obstacle::Obstacle;
use crate::planner::Problem;
use crate::planner::clock::Clock;
use crate::planner::space_time::motion::{pose_at, until as motion_until};
use crate::planner::space_time::piece::pieces;
use crate::planner::space_time::proxy::{Proxy, first_contact, within_reach};
use crate::planner::space_time::refinement::trial::Context;
use crate::planner::space_time::selection::budget::SearchBudget;
use crate::planner::space_time::selection::initial_guess::Conflict;
use crate::planner::space_time::ways_in_one_manoeuvre;
use crate::trajectory::Segment;
use crate::vessel::OwnShip;

/// Seconds. Conflicts that all begin within this time are left to one manoeuvre.
const APART_S: f64 = 120.0;

/// Largest lead of a departure before a conflict, seconds.
const LEAD_S: f64 = 200.0;

/// Seconds after the beginning of a conflict until which its plan is clear of all sets. Sets that
/// are met later are the next conflict.
const CLEAR_S: f64 = 300.0;

/// True when conflicts, ordered by start, do not all begin together.
pub(crate) fn are_several(conflicts: &[Conflict]) -> bool {
    let ends = conflicts.first().zip(conflicts.last());
    ends.is_some_and(|(first, last)| last.from > first.from + APART_S)
}

/// Motion to the last waypoint that is clear of every set before `until`.
struct Node {
    motion: Vec<Segment>,
    cost: f64,
    until: f64,
}

/// The cheapest motion found to the last waypoint that is clear of every proxy and of land, and
/// costs less than `least` (m²), from a nominal one that is not clear. `None` where none is found.
pub(crate) fn resolve_sequentially(
    context: &Context,
    nominal_motion: &[Segment],
    mut least: f64,
    budget: &SearchBudget,
    clock: Clock,
) -> Option<Vec<Segment>> {
    let (mut left, then) = budget.conflict_plans;
    let mut best = None;
    let mut open = vec![Node {
        motion: nominal_motion.to_vec(),
        cost: 0.0,
        until: f64::NEG_INFINITY,
    }];
    while let Some(node) = open.pop() {
        // negated on purpose: a NaN is too dear
        if !(node.cost < least) {
            continue;
        }
        let Some(contact) = context.first_conflict(&node.motion) else {
            if best.is_none() {
                left = then;
            }
            least = node.cost;
            best = Some(node.motion);
            continue;
        };
        // negated on purpose: a NaN is no progress
        if left == 0 || clock.is_up() || !(contact > node.until) {
            continue;
        }
        left -= 1;
        let mut children = children(context, &node, contact, clock);
        // the cheapest is taken first
        children.sort_by(|a, b| b.cost.total_cmp(&a.cost));
        open.extend(children);
    }
    best
}

/// A motion for each way past the first sets that the node's motion meets, at `contact`.
fn children(context: &Context, node: &Node, contact: f64, clock: Clock) -> Vec<Node> {
    let leaves = (contact - LEAD_S).max(0.0);
    let is_first = node.until == f64::NEG_INFINITY;
    let problem = Problem {
        first_turn: context.problem.first_turn.filter(|_| is_first),
        encountered: &[],
        under_way: None,
        ..*context.problem
    };
    let (proxies, motion) = (context.proxies, &node.motion);
    ways_from(&problem, proxies, motion, leaves, contact, clock)
        .into_iter()
        .map(|rest| {
            let mut motion = motion_until(motion, leaves);
            motion.extend(rest);
            Node {
                cost: problem.error_to_end(&motion),
                motion,
                until: contact,
            }
        })
        .collect()
}

/// Ways from `leaves` on around the first set that the motion meets at `contact`, clear of all sets
/// until [`CLEAR_S`] later. Each set that the cheapest way meets until then is added, and the ways
/// are planned again.
fn ways_from(
    problem: &Problem,
    proxies: &[Proxy],
    motion: &[Segment],
    leaves: f64,
    contact: f64,
    clock: Clock,
) -> Vec<Vec<Segment>> {
    let Some(pose) = pose_at(motion, leaves) else {
        return Vec::new();
    };
    let own = OwnShip {
        pose,
        ..problem.own.clone()
    };
    let desired = problem.desired.remaining(leaves);
    let first_set_met = |motion: &[Segment]| {
        let soon = motion_until(motion, contact + CLEAR_S);
        first_contact(proxies, &soon).map(|(obstacle, _)| obstacle)
    };
    let mut clear = Vec::new();
    // none is met where the contact is with land
    let mut around: Vec<usize> = first_set_met(motion).into_iter().collect();
    loop {
        let sets = around.iter().map(|index| &problem.obstacles[*index]);
        let obstacles: Vec<Obstacle> = sets.map(|set| set.remainder(leaves)).collect();
        let stage = Problem {
            own: &own,
            desired: &desired,
            obstacles: &obstacles,
            horizon: problem.horizon - leaves,
            ..*problem
        };
        let pieces = pieces(stage.obstacles, stage.horizon);
        let near = within_reach(&stage, &pieces);
        let mut met = None;
        let ways = ways_in_one_manoeuvre(&stage, &near, clock);
        for (rank, way) in ways.iter().enumerate() {
            let rest: Vec<Segment> = way.iter().map(|s| later(s, leaves)).collect();
            let other = first_set_met(&rest);
            if other.is_none() {
                clear.push(rest);
            } else if rank == 0 {
                met = other;
            }
        }
        match met {
            // else planned around, and met all the same: rounding of its sets at `leaves`
            Some(other) if !around.contains(&other) => around.push(other),
            _ => return clear,
        }
    }
}

fn later(s: &Segment, seconds: f64) -> Segment {
    Segment {
        start_time: s.start_time + seconds,
        ..*s
    }
}
