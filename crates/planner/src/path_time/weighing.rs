//! Trade-off between path length and accepted risk.

use super::plan;
use crate::clock::Clock;
use crate::{Objective, Outcome, Planned, Problem};
use searoom_sets::level_sets;

/// Resolution of the accepted risk, dimensionless.
const RISK_STEP: f64 = 1e-4;

/// Risk level, its plan, and the path length in metres.
struct Level {
    risk: f64,
    planned: Planned,
    length: Option<f64>,
}

impl Level {
    fn cost(&self, weight: f64) -> f64 {
        self.length
            .map_or(f64::INFINITY, |length| length + weight * self.risk)
    }
}

/// Minimises length plus `weight` metres times the accepted risk, over risks from 0 to `max_risk`.
/// The obstacles of `problem` are the whole sets. Level sets shrink as the risk grows, so the
/// shortest length is non-increasing in the risk and takes few values. Bisection locates each step
/// to 1e-4. Without a path at `max_risk`, the result is that of `max_risk`.
pub fn plan_weighing_risk(problem: &Problem, weight: f64, max_risk: f64) -> Planned {
    let clock = Clock::new(problem.deadline);
    let at = |risk: f64| {
        let planned = plan(&Problem {
            objective: Objective::Length,
            obstacles: &level_sets(problem.obstacles, risk),
            deadline: clock.left(),
            ..problem.clone()
        });
        let length = planned.outcome.plan().map(|plan| plan.trajectory.length());
        Level {
            risk,
            planned,
            length,
        }
    };
    let mut best = at(0.0);
    let mut steps: Vec<(f64, Option<f64>, f64, f64)> = Vec::new();
    let mut timed_out = false;
    if max_risk > 0.0 {
        let greatest = at(max_risk);
        if let Some(length) = greatest.length {
            steps.push((0.0, best.length, max_risk, length));
        }
        if best.length.is_none() || greatest.cost(weight) < best.cost(weight) {
            best = greatest;
        }
    }
    // intervals of risk in which the path shortens
    while let Some((low, before, high, after)) = steps.pop() {
        let shortens = before.is_none_or(|before| before > after + 1e-6);
        if !shortens || high - low <= RISK_STEP || after + weight * low >= best.cost(weight) {
            continue;
        }
        if clock.is_up() {
            timed_out = true;
            break;
        }
        let middle = at(0.5 * (low + high));
        let risk = middle.risk;
        if let Some(length) = middle.length {
            steps.push((low, before, risk, length));
        }
        steps.push((risk, middle.length, high, after));
        if middle.cost(weight) < best.cost(weight) {
            best = middle;
        }
    }
    let cost = best.cost(weight);
    let mut planned = best.planned;
    if let Some(plan) = planned.outcome.plan_mut() {
        plan.cost = cost;
        plan.graph_cost = Some(cost);
    }
    if timed_out {
        planned.outcome = Outcome::Deadline(planned.outcome.into_plan());
    }
    planned
}
