//! Sequential conflict resolution: conflicts that are far apart are resolved one after another.
//!
//! A plan leaves the route once and comes back once. Here the plan for the first conflict ignores
//! later ones and ends back on the route. The next conflict is resolved from there.

use crate::obstacle::Obstacle;
use crate::planner::Problem;
use crate::planner::clock::Clock;
use crate::planner::space_time::motion::{pose_at, until as motion_until};
use crate::planner::space_time::piece::pieces;
use crate::planner::space_time::plan_in_one_manoeuvre;
use crate::planner::space_time::proxy::{Proxy, first_contact, within_reach};
use crate::planner::space_time::refinement::trial::Context;
use crate::planner::space_time::selection::initial_guess::Conflict;
use crate::trajectory::Segment;
use crate::vessel::OwnShip;

/// Seconds. Conflicts that all begin within this time are left to one manoeuvre.
const APART_S: f64 = 120.0;

/// Largest lead of a departure before a conflict, seconds.
const LEAD_S: f64 = 200.0;

/// Seconds after the beginning of a conflict until which its plan is clear of all sets. Sets that
/// are met later are the next conflict.
const CLEAR_S: f64 = 300.0;

/// Largest number of conflicts.
const MAX_STAGES: usize = 30;

/// True when conflicts, ordered by start, do not all begin together.
pub(crate) fn are_several(conflicts: &[Conflict]) -> bool {
    let ends = conflicts.first().zip(conflicts.last());
    ends.is_some_and(|(first, last)| last.from > first.from + APART_S)
}

/// Motion to the last waypoint that is clear of every proxy and of land, from a nominal one that is
/// not. `None` when a conflict has no solution, or a later one begins no later.
pub(crate) fn resolve_sequentially(
    context: &Context,
    nominal_motion: &[Segment],
    clock: Clock,
) -> Option<Vec<Segment>> {
    let mut motion = nominal_motion.to_vec();
    let mut last_contact = f64::NEG_INFINITY;
    let mut first_turn = context.problem.first_turn;
    for _ in 0..MAX_STAGES {
        let Some(contact) = context.first_conflict(&motion) else {
            return Some(motion);
        };
        // negated on purpose: a NaN is no progress
        if !(contact > last_contact) || clock.is_up() {
            return None;
        }
        last_contact = contact;
        let leaves = (contact - LEAD_S).max(0.0);
        let problem = Problem {
            first_turn: first_turn.take(),
            encountered: &[],
            under_way: None,
            ..*context.problem
        };
        let rest = planned_from(&problem, context.proxies, &motion, leaves, contact, clock)?;
        motion = motion_until(&motion, leaves);
        motion.extend(rest);
    }
    None
}

/// Plans from `leaves` on around the first set that the motion meets at `contact`. Each set that
/// the plan meets until [`CLEAR_S`] later is added, and the plan made again.
fn planned_from(
    problem: &Problem,
    proxies: &[Proxy],
    motion: &[Segment],
    leaves: f64,
    contact: f64,
    clock: Clock,
) -> Option<Vec<Segment>> {
    let own = OwnShip {
        pose: pose_at(motion, leaves)?,
        ..problem.own.clone()
    };
    let desired = problem.desired.remaining(leaves);
    let first_set_met = |motion: &[Segment]| {
        let soon = motion_until(motion, contact + CLEAR_S);
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
        let plan = plan_in_one_manoeuvre(&stage, &near, clock)
            .outcome
            .into_plan()?;
        let rest: Vec<Segment> = plan
            .trajectory
            .segments()
            .iter()
            .map(|s| later(s, leaves))
            .collect();
        match first_set_met(&rest) {
            Some(other) if !around.contains(&other) => around.push(other),
            // planned around, and met all the same: rounding of its sets at `leaves`
            Some(_) => return None,
            None => return Some(rest),
        }
    }
}

fn later(s: &Segment, seconds: f64) -> Segment {
    Segment {
        start_time: s.start_time + seconds,
        ..*s
    }
}
