//! The arrows in one place: Scenario → obstacles → Plan → Evaluation = Run.

mod conduct;
mod duty;
mod inside;
mod judge;
mod ladder;
mod no_return;
mod relaxation;
mod risk;
mod rung;
mod sets;
mod shares;
mod shore;
mod verdict;

pub use judge::{judge, judge_free};
pub use ladder::RISK_STEP;
pub use no_return::{NO_RETURN_STEP_S, NoReturn};
pub use relaxation::Relaxation;
pub use risk::peak_risk;
pub use rung::Rung;
pub use sets::{TargetSets, sets};
pub use shore::{coast, land_within_reach};
pub use verdict::Verdict;

use duty::rules_given_up;
use judge::judge_kept;
use ladder::{Attempt, Ladder};

use std::time::{Duration, Instant};

use crate::evaluation::Evaluation;
use crate::geometry::ConvexPolygon;
use crate::obstacle::{Coast, Obstacle, PeakRisk, SpaceTimeObstacle};
use crate::planner::optimal_control::ControlReport;
use crate::planner::{NoPlan, Outcome, Planned, PlannerKind, Problem};
use crate::scenario::{Compliance, Scenario};

/// One scenario, planned and judged.
#[derive(Debug, Clone)]
pub struct Run {
    /// What was asked.
    pub scenario: Scenario,
    /// The sets, in the order of the scenario's targets.
    pub sets: Vec<TargetSets>,
    /// How much of what was asked the plan keeps.
    pub rung: Rung,
    /// The whole sets that the plan keeps clear of, in the same order: hard ones with what is kept of the shapes.
    /// [`Run::risks`] are against these.
    pub whole: Vec<Obstacle>,
    /// The obstacles that the plan was made against, in the same order: the level sets `O_alpha` of `whole`,
    /// `alpha = 1 - max_risk`.
    pub obstacles: Vec<Obstacle>,
    /// The risk that was accepted in the end, in `[0, 1)`: the scenario's, or more where there was no plan at that.
    pub max_risk: f64,
    /// Seconds, per target in the same order: the plan enters the set and is clear of it from then on; `None` where it is clear
    /// all along.
    pub released: Vec<Option<f64>>,
    /// The convex pieces of land that the plan was made against: all that own ship could reach.
    pub land: Vec<ConvexPolygon>,
    /// The planner's answer.
    pub planned: Planned,
    /// Why no plan keeps all that was asked; `None` where one does, and where there is no plan.
    pub why: Option<NoPlan>,
    /// How the optimal-control planner found it; `None` for another planner.
    pub control: Option<ControlReport>,
    /// Targets whose obstacles are ellipsoids around sets of another kind.
    pub enclosed: Vec<String>,
    /// What had to be given up, most important first; empty when nothing.
    pub relaxations: Vec<Relaxation>,
    /// The largest risk along the plan, per target in the same order, against the sets of which `obstacles` are the
    /// level sets; empty when there is no plan.
    pub risks: Vec<PeakRisk>,
    /// The independent judgement of the plan; `None` when there is no plan.
    pub evaluation: Option<Evaluation>,
    /// Wall-clock time of planning alone.
    pub plan_time: Duration,
}

impl Run {
    /// True where something of the shapes is kept.
    pub fn is_shaped(&self) -> bool {
        let mut both = self.whole.iter().zip(&self.sets);
        both.any(|(kept, sets)| *kept != sets.hard)
    }

    /// Why there is no plan, or none that was finished or keeps all that was asked; `None` with a plan that does.
    pub fn reason(&self) -> Option<String> {
        match &self.planned.outcome {
            Outcome::Infeasible(reason) => Some(reason.to_string()),
            Outcome::Deadline(_) => Some(format!(
                "the budget of {} s ran out",
                self.scenario.deadline
            )),
            Outcome::Solved(_) => self.why.as_ref().map(ToString::to_string),
        }
    }
}

/// What a scenario asks of a planner, against the given obstacles and the land.
pub fn problem<'a>(
    scenario: &'a Scenario,
    obstacles: &'a [Obstacle],
    coast: &'a Coast,
) -> Problem<'a> {
    Problem {
        own: &scenario.own_ship,
        desired: &scenario.desired,
        alternatives: &scenario.alternatives,
        objective: scenario.objective,
        obstacles,
        coast,
        horizon: scenario.horizon,
        time_weight: scenario.time_weight,
        search: scenario.search,
        deadline: deadline(scenario),
        first_turn: None,
        encountered: &[],
    }
}

fn deadline(scenario: &Scenario) -> Duration {
    Duration::try_from_secs_f64(scenario.deadline).unwrap_or(Duration::MAX)
}

/// Plans a scenario and judges the plan. Where no plan keeps all that was asked, less is asked, rung by rung, and what was given
/// up is said. The clock is read around planning alone and enters no result but `plan_time`, unless the deadline ends
/// the search.
pub fn run(scenario: Scenario) -> Run {
    let sets = sets(&scenario);
    let begun = Instant::now();
    let land = land_within_reach(&scenario);
    let shore;
    let coast: &Coast = match scenario.planner {
        PlannerKind::SpaceTime | PlannerKind::OptimalControl => {
            shore = coast(&scenario, &land);
            &shore
        }
        // the paths are kept off land when the scenario is read
        PlannerKind::PathTime => Coast::none(),
    };
    let ladder = Ladder {
        scenario: &scenario,
        sets: &sets,
        coast,
        begun,
    };
    let answer = ladder.answer();
    let plan_time = begun.elapsed();
    let risks: Vec<PeakRisk> = answer.trajectory().map_or_else(Vec::new, |trajectory| {
        let whole = answer.whole.iter();
        whole
            .map(|set| peak_risk(&set.outer_where_flat(), trajectory, answer.risk))
            .collect()
    });
    let mut relaxations = relaxation::relaxations(
        &sets,
        &answer.cuts,
        &risks,
        &answer.released,
        not_arrived(&answer),
    );
    if scenario.compliance == Compliance::Rules && answer.rung > Rung::Rules {
        relaxations.extend(rules_given_up(&scenario, &sets));
    }
    let forces = scenario.planner == PlannerKind::OptimalControl;
    let is_ellipsoid = |set: &&Obstacle| matches!(set, Obstacle::Ellipsoid(_));
    let enclosed = answer.whole.iter().filter(|s| forces && !is_ellipsoid(s));
    let enclosed = enclosed.map(|s| s.name().to_owned()).collect();
    let evaluation = answer
        .trajectory()
        .map(|trajectory| judge_kept(&scenario, &answer, trajectory));
    Run {
        rung: answer.rung,
        whole: answer.whole,
        obstacles: answer.obstacles,
        max_risk: answer.risk,
        released: answer.released,
        planned: answer.planned,
        why: answer.why,
        control: answer.control,
        scenario,
        sets,
        land,
        enclosed,
        relaxations,
        risks,
        evaluation,
        plan_time,
    }
}

/// The arrival that a plan gives up, and for whom: who bars the way, else whose set is entered.
fn not_arrived(answer: &Attempt) -> Option<Relaxation> {
    let to_go = answer.planned.outcome.plan()?.to_go;
    let barring = match answer.why.as_ref() {
        Some(
            NoPlan::Barred { target, .. }
            | NoPlan::OutOfTime { target, .. }
            | NoPlan::StartCovered { target, .. },
        ) => Some(target.as_str()),
        _ => None,
    };
    let entered = answer.whole.iter().zip(&answer.released);
    let mut names = barring.into_iter().chain(
        entered
            .filter(|(_, released)| released.is_some())
            .chain(answer.whole.iter().zip(&answer.released))
            .map(|(set, _)| set.name()),
    );
    (to_go > 0.0).then(|| Relaxation::Arrival {
        target: names.next().unwrap_or_default().to_owned(),
        amount: to_go,
    })
}

#[cfg(test)]
mod tests;
