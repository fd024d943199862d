//! The remainder of the plan that own ship follows, as a candidate beside the new plan.

use std::cmp::Ordering;

use super::relaxation::Attempt;
use super::rules;
use crate::obstacle::{Obstacle, SpaceTimeObstacle};
use crate::planner::{Minimises, Outcome, Plan, PlanMethod, Planned, PlannedManoeuvre, Problem};
use crate::scenario::{Compliance, Scenario};
use crate::tolerance;
use crate::trajectory::Segment;

/// A new plan replaces the remainder where it costs less than this fraction of it.
const WORTH_A_CHANGE: f64 = 0.98;

/// Largest ratio of costs at which a new plan that breaks fewer rules replaces the remainder: five
/// times the distance, as costs are squares.
const WORTH_A_RULE: f64 = 25.0;

/// A remainder that is kept.
pub(super) struct Remainder {
    pub planned: Planned,
    /// Number of rules that it breaks.
    pub broken: usize,
}

/// Returns the remainder where it is better than the new plan of an attempt. It is better where
/// there is no new plan, or the new plan breaks more rules, is hardly cheaper, or breaks fewer rules
/// at many times the cost. It is also better where a target that matters is outside the sets that
/// were assumed, and where own ship returns to its route after a manoeuvre. The remainder has to be
/// clear of the same sets, to arrive in time, and to start at own pose.
pub(super) fn better_remainder(
    scenario: &Scenario,
    problem: &Problem,
    attempt: &Attempt,
) -> Option<Remainder> {
    // motions under forces are not of lines and arcs
    if matches!(scenario.planner.facts().minimises, Minimises::Own(_)) {
        return None;
    }
    let plan = remainder(scenario, problem, &attempt.obstacles)?;
    let breaks = |plan: &Plan| match scenario.compliance {
        Compliance::Rules => rules::breaks(scenario, &plan.trajectory),
        _ => 0,
    };
    let memory = &scenario.memory;
    let returns = |m: &PlannedManoeuvre| m.returns <= 0.0 && m.joins > 0.0;
    let outside = (scenario.targets.iter().zip(&memory.targets))
        .any(|(target, known)| known.role.is_some() && memory.is_outside(&target.name));
    let settled = outside
        || begins_another(scenario, &attempt.planned)
        || memory.manoeuvres.iter().any(returns);
    let broken = breaks(&plan);
    let keep = match attempt.planned.outcome.plan() {
        None => true,
        Some(new) => {
            let kept_if_equal = settled || new.cost >= WORTH_A_CHANGE * plan.cost;
            // the new plan need not be judged where it cannot break fewer rules
            kept_if_equal && broken == 0
                || match broken.cmp(&breaks(new)) {
                    Ordering::Less => true,
                    Ordering::Greater => new.cost > WORTH_A_RULE * plan.cost,
                    Ordering::Equal => kept_if_equal,
                }
        }
    };
    let planned = Planned {
        // an escape is named where it is needed
        escape: match attempt.planned.outcome {
            Outcome::Infeasible(_) => memory.escape,
            _ => memory.escape.filter(|_| attempt.planned.escape.is_some()),
        },
        manoeuvres: memory.manoeuvres.clone(),
        ..Planned::of(Outcome::Solved(plan))
    };
    keep.then_some(Remainder { planned, broken })
}

/// True where another manoeuvre would begin before the one under way is finished.
pub(super) fn begins_another(scenario: &Scenario, planned: &Planned) -> bool {
    scenario.memory.under_way.is_some_and(|begun| {
        let goes_on = |m: &PlannedManoeuvre| m.begins == begun.begins;
        !planned.manoeuvres.first().is_some_and(goes_on)
    })
}

fn remainder(scenario: &Scenario, problem: &Problem, obstacles: &[Obstacle]) -> Option<Plan> {
    let mut motion = scenario.memory.remainder.clone();
    let (own, first) = (&scenario.own_ship, motion.first_mut()?);
    if first.start != own.pose {
        return None;
    }
    first.start_time = 0.0;
    let last = motion.last()?;
    let arrives = (last.end().position - problem.desired.end()).norm() <= tolerance::ARRIVAL_M;
    let enters = |set: &Obstacle| set.is_entered(&motion, tolerance::TOUCH_M);
    let land = |s: &Segment| problem.land_obstacle.meets(s, tolerance::TOUCH_M);
    let is_own = |s: &Segment| {
        let listed = |u: &f64| (u - s.speed).abs() <= tolerance::FIGURE * s.speed;
        let turns = s.turn_rate.abs() * own.turning_radius <= s.speed * (1.0 + tolerance::FIGURE);
        own.speeds.iter().any(listed) && turns
    };
    let fits = arrives
        && motion.iter().all(is_own)
        && last.end_time() <= problem.horizon
        && !obstacles.iter().any(enters)
        && !motion.iter().any(land);
    fits.then(|| Plan::measured(problem, motion, PlanMethod::Remainder))
        .flatten()
}
