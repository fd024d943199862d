//! Sequential conflict resolution: conflicts that are far apart are resolved one after another.
//!
//! A plan leaves the route once and comes back once. Here the plan for the first conflict ignores
//! later ones and ends back on the route. The next conflict is resolved from there.

use crate::planner::Problem;
use crate::planner::clock::Clock;
use crate::planner::space_time::motion::{pose_at, until as motion_until};
use crate::planner::space_time::piece::pieces;
use crate::planner::space_time::plan_together;
use crate::planner::space_time::proxy::{first_contact, within_reach};
use crate::planner::space_time::refinement::trial::Context;
use crate::planner::space_time::selection::initial_guess::Conflict;
use crate::trajectory::Segment;
use crate::vessel::OwnShip;

/// Seconds. Conflicts that begin within this time of one another are resolved together.
const TOGETHER_S: f64 = 120.0;

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
    let mut before = 0.0;
    for _ in 0..MAX_STAGES {
        let Some(contact) = context.first_conflict(&motion) else {
            return Some(motion);
        };
        // negated on purpose: a NaN is no progress
        if !(contact > before) || clock.is_up() {
            return None;
        }
        let leaves = (contact - LEAD_S).max(before);
        let rest = resolved(context, &motion, leaves, contact, clock)?;
        motion = motion_until(&motion, leaves);
        motion.extend(rest);
        before = contact;
    }
    None
}

/// The motion from `leaves` on, planned anew around the sets that it meets until shortly after
/// `contact`, and around those that each plan for them meets before.
fn resolved(
    context: &Context,
    motion: &[Segment],
    leaves: f64,
    contact: f64,
    clock: Clock,
) -> Option<Vec<Segment>> {
    let whole = context.problem;
    let own = OwnShip {
        pose: pose_at(motion, leaves)?,
        ..whole.own.clone()
    };
    let desired = whole.desired.remaining(leaves);
    let meets_soon = |motion: &[Segment]| {
        let found = first_contact(context.proxies, &motion_until(motion, contact + CLEAR_S));
        found.map(|(obstacle, _)| obstacle)
    };
    let mut met: Vec<usize> = meets_soon(motion).into_iter().collect();
    loop {
        let sets = met
            .iter()
            .map(|index| whole.obstacles[*index].remainder(leaves));
        let obstacles: Vec<_> = sets.collect();
        let problem = Problem {
            own: &own,
            desired: &desired,
            obstacles: &obstacles,
            horizon: whole.horizon - leaves,
            ..*whole
        };
        let pieces = pieces(problem.obstacles, problem.horizon);
        let proxies = within_reach(&problem, &pieces);
        let plan = plan_together(&problem, &proxies, clock)
            .outcome
            .into_plan()?;
        let segments = plan.trajectory.segments().iter();
        let rest: Vec<Segment> = segments
            .map(|s| Segment {
                start_time: s.start_time + leaves,
                ..*s
            })
            .collect();
        match meets_soon(&rest) {
            Some(other) if !met.contains(&other) => met.push(other),
            // the set is met after all: a gap of rounding
            Some(_) => return None,
            None => return Some(rest),
        }
    }
}
