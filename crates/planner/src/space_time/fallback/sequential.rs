//! Sequential conflict resolution: conflicts that are far apart are resolved one after another.
//!
//! A plan leaves the route once and comes back once. Here the plan for the first conflict ignores
//! later ones and ends back on the route. The next conflict is resolved from there. Where that
//! fails, the earlier ones are passed in another way (depth-first branch and bound).

use std::collections::VecDeque;

use crate::Problem;
use crate::clock::Clock;
use crate::space_time::context::Context;
use crate::space_time::manoeuvre::conflict::{Conflict, far_apart};
use crate::space_time::manoeuvre::motion::{pose_at, shifted, until as motion_until};
use crate::space_time::piece::pieces;
use crate::space_time::proxy::{Proxy, first_contact, within_reach};
use crate::space_time::selection::{Selection, is_same_way};
use crate::space_time::settings::{ConflictSettings, SearchBudget};
use crate::space_time::ways_in_one_manoeuvre;
use searoom_model::trajectory::Segment;
use searoom_model::vessel::OwnShip;
use searoom_sets::Obstacle;

/// True when conflicts, ordered by start, do not all begin together.
pub(crate) fn are_several(conflicts: &[Conflict], settings: &ConflictSettings) -> bool {
    far_apart(conflicts, settings.apart_s) > 1
}

/// Motion to the last waypoint whose conflicts before `resolved_until` are resolved.
struct Node {
    motion: Vec<Segment>,
    cost: f64,
    resolved_until: f64,
}

/// The cheapest motion found to the last waypoint that is clear of every proxy and of land, from a
/// nominal one that is not clear. It is cheaper than the `selection`'s candidate. `None` where none
/// is found. With it true where ways were left out to leave time for others.
pub(crate) fn resolve_sequentially(
    context: &Context,
    nominal_motion: &[Segment],
    selection: &Selection,
    budget: &SearchBudget,
    clock: Clock,
) -> (Option<Vec<Segment>>, bool) {
    let mut is_cut_short = false;
    let mut least = selection.least_cost();
    let (mut dead_ends, mut more) = (budget.dead_ends, usize::MAX);
    // half of the time is left to others after a dead end
    let reserve = clock.left() / 2;
    let mut best = None;
    let mut open = vec![Node {
        motion: nominal_motion.to_vec(),
        cost: 0.0,
        resolved_until: f64::NEG_INFINITY,
    }];
    while let Some(node) = open.pop() {
        // negated on purpose: a NaN is too dear
        if !(node.cost < least) {
            continue;
        }
        let Some(contact) = context.first_conflict(&node.motion) else {
            if best.is_none() {
                more = budget.more_conflicts;
            }
            least = node.cost;
            best = Some(node.motion);
            continue;
        };
        let is_late = dead_ends < budget.dead_ends && clock.left() < reserve;
        is_cut_short |= is_late && dead_ends > 0 && more > 0;
        if dead_ends == 0 || more == 0 || is_late || clock.is_up() {
            continue;
        }
        more -= 1;
        // negated on purpose: a NaN is no progress
        let goes_on = contact > node.resolved_until;
        let mut children = match goes_on {
            true => children(context, &node, contact, selection, clock),
            false => Vec::new(),
        };
        dead_ends -= usize::from(children.is_empty());
        // the first is taken next
        children.reverse();
        open.extend(children);
    }
    (best, is_cut_short)
}

/// A motion for each way past the first sets that the node's motion meets, at `contact`: first the
/// plan around all of them, then the others, the cheapest first.
fn children(
    context: &Context,
    node: &Node,
    contact: f64,
    selection: &Selection,
    clock: Clock,
) -> Vec<Node> {
    let settings = context.problem.settings;
    let leaves = (contact - settings.conflicts.lead_s).max(0.0);
    let begins = node.resolved_until == f64::NEG_INFINITY;
    let problem = Problem {
        first_turn: context.problem.first_turn.filter(|_| begins),
        encountered: &[],
        under_way: None,
        ..*context.problem
    };
    let (proxies, motion) = (context.proxies, &node.motion);
    let ways = ways_from(&problem, proxies, motion, leaves, contact, clock);
    let mut children: Vec<Node> = Vec::new();
    for rest in ways {
        let mut motion = motion_until(motion, leaves);
        motion.extend(rest);
        let cost = selection.cost_of(&motion);
        let is_same = |other: &Node| {
            let same = settings.guesses.same_way;
            is_same_way((&other.motion, other.cost), (&motion, cost), same)
        };
        if !children.iter().any(is_same) {
            children.push(Node {
                motion,
                cost,
                resolved_until: contact,
            });
        }
    }
    if let [_, others @ ..] = &mut children[..] {
        others.sort_by(|a, b| a.cost.total_cmp(&b.cost));
    }
    children
}

/// Ways from `leaves` on around the first set that the motion meets at `contact`, clear of all sets
/// until `clear_s` later. Each set that the plan meets until then is added, and planned again. The
/// last plan is the first of the ways.
fn ways_from(
    problem: &Problem,
    proxies: &[Proxy],
    motion: &[Segment],
    leaves: f64,
    contact: f64,
    clock: Clock,
) -> VecDeque<Vec<Segment>> {
    let mut clear = VecDeque::new();
    let Some(pose) = pose_at(motion, leaves) else {
        return clear;
    };
    let own = OwnShip {
        pose,
        ..problem.own.clone()
    };
    let desired = problem.desired.remaining(leaves);
    let first_set_met = |motion: &[Segment]| {
        let soon = motion_until(motion, contact + problem.settings.conflicts.clear_s);
        first_contact(proxies, &soon).map(|(obstacle, _)| obstacle)
    };
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
        let ways = ways_in_one_manoeuvre(&stage, &near, clock);
        let mut ways = ways.into_iter().map(|way| shifted(&way, leaves));
        let Some(plan) = ways.next() else {
            return clear;
        };
        clear.extend(ways.filter(|way| first_set_met(way).is_none()));
        match first_set_met(&plan) {
            None => {
                clear.push_front(plan);
                return clear;
            }
            Some(other) if !around.contains(&other) => around.push(other),
            // planned around, and met all the same: rounding of its sets at `leaves`
            Some(_) => return clear,
        }
    }
}
