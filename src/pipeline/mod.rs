//! Runs a scenario: scenario → obstacles → plan → evaluation, collected in a [`Run`].

mod entered;
mod judge;
mod land;
mod no_return;
mod outcome;
mod relaxation;
mod remainder;
mod risk;
mod rules;
mod sets;
mod stay;
mod thorough;

pub use judge::{judge, judge_free};
pub use land::{NearLand, land_obstacle, land_within_reach};
pub use no_return::{NO_RETURN_STEP_S, NoReturn};
pub use outcome::Relaxation;
pub use relaxation::{RISK_STEP, RelaxationLevel};
pub use risk::peak_risk;
pub use sets::{TargetSets, sets};

use judge::judge_answer;
use relaxation::{Attempt, Relaxer};
use rules::relaxed_rules;

use std::cell::Cell;
use std::time::{Duration, Instant};

use crate::evaluation::Evaluation;
use crate::obstacle::{LandObstacle, Obstacle, PeakRisk, SpaceTimeObstacle};
use crate::parallel;
use crate::planner::{NoPlan, Outcome, Plan, Planned, Problem};
use crate::scenario::{Compliance, Scenario};

/// A scenario with its plan and the evaluation of that plan.
#[derive(Debug, Clone)]
pub struct Run {
    /// The request.
    pub scenario: Scenario,
    /// One per target, in the order of the scenario.
    pub targets: Vec<TargetOutcome>,
    /// How much of the request the plan satisfies.
    pub level: RelaxationLevel,
    /// The accepted risk, in `[0, 1)`: the scenario's, or more where there was no plan at that.
    pub max_risk: f64,
    /// The land that was planned against: all that own ship could reach.
    pub land: NearLand,
    /// The planner's answer.
    pub planned: Planned,
    /// Why no plan satisfies the whole request; `None` where one does, or where there is no plan.
    pub why: Option<NoPlan>,
    /// Requirements that were given up, most important first.
    pub relaxations: Vec<Relaxation>,
    /// The independent evaluation of the plan; `None` without a plan.
    pub evaluation: Option<Evaluation>,
    /// Wall-clock time of planning alone.
    pub plan_time: Duration,
}

/// The obstacles of one target, and what a plan does to them.
#[derive(Debug, Clone)]
pub struct TargetOutcome {
    /// The hard set, the one with a ship domain, and the encounter.
    pub sets: TargetSets,
    /// The whole set that the plan keeps clear of: the hard set with the retained part of the ship
    /// domain.
    pub whole: Obstacle,
    /// The obstacle that was planned against: the level set `O_alpha` of `whole`,
    /// `alpha = 1 - max_risk`.
    pub obstacle: Obstacle,
    /// Seconds: the plan enters the set and is clear of it from then on. `None` where it is always
    /// clear.
    pub released: Option<f64>,
    /// The largest risk along the plan in the set `whole`; `None` without a plan.
    pub peak: Option<PeakRisk>,
}

impl Run {
    /// The obstacles that were planned against, in the order of the targets.
    pub fn obstacles(&self) -> impl ExactSizeIterator<Item = &Obstacle> {
        self.targets.iter().map(|target| &target.obstacle)
    }

    /// The largest risk along the plan of each target; empty without a plan.
    pub fn risks(&self) -> Vec<PeakRisk> {
        self.targets
            .iter()
            .filter_map(|target| target.peak)
            .collect()
    }

    /// True where the plan enters the set of a target.
    pub fn enters(&self) -> bool {
        self.targets.iter().any(|target| target.released.is_some())
    }

    /// True where no plan keeps to the rules, and one without them is given.
    pub fn gives_up_rules(&self) -> bool {
        let mut relaxations = self.relaxations.iter();
        relaxations.any(|r| matches!(r, Relaxation::Compliance { .. }))
    }

    /// True where the plan ends at the last waypoint. Motions under forces end at the horizon.
    pub fn arrives(&self) -> bool {
        let plan = self.planned.outcome.plan();
        self.planned.control.is_none() && plan.is_some_and(Plan::arrives)
    }

    /// Why there is no plan, or only an unfinished or relaxed one; `None` for a plan that satisfies
    /// the whole request.
    pub fn reason(&self) -> Option<String> {
        match &self.planned.outcome {
            Outcome::Infeasible(reason) => Some(reason.to_string()),
            Outcome::Deadline(_) => {
                let budget = self.scenario.deadline;
                let part = match self.plan_time < deadline(&self.scenario) {
                    true => " for a part of the search, which has a share of it",
                    false => "",
                };
                Some(format!("the budget of {budget} s ran out{part}"))
            }
            Outcome::Solved(_) => self.why.as_ref().map(ToString::to_string),
        }
    }
}

/// The planning problem of a scenario, for the given obstacles and land.
pub fn problem<'a>(
    scenario: &'a Scenario,
    obstacles: &'a [Obstacle],
    land_obstacle: &'a LandObstacle,
) -> Problem<'a> {
    Problem {
        own: &scenario.own_ship,
        desired: &scenario.desired,
        alternatives: &scenario.alternatives,
        objective: scenario.objective,
        thresholds: &scenario.limits,
        obstacles,
        land_obstacle,
        horizon: scenario.horizon,
        time_weight: scenario.time_weight,
        search: scenario.search,
        deadline: deadline(scenario),
        first_turn: None,
        encountered: &[],
        under_way: None,
        tidy: scenario.tidiness(),
        warm_start: scenario.memory.warm_start.as_ref(),
        settings: scenario.settings.space_time,
    }
}

fn deadline(scenario: &Scenario) -> Duration {
    Duration::try_from_secs_f64(scenario.deadline).unwrap_or(Duration::MAX)
}

/// [`sets()`] as [`run`] plans against them at first: with the risks of collision that sets alone give.
pub fn planned_sets(scenario: &Scenario) -> Vec<TargetSets> {
    let found = sets(scenario);
    let with_risk = rules::with_risk_of_sets(scenario, &found);
    with_risk.map_or(found, |scenario| sets(&scenario))
}

/// Plans a scenario and evaluates the plan.
///
/// Where no plan satisfies the whole request, requirements are given up level by level
/// (`docs/reference/relaxation.md`), and the run reports which. The clock is read around planning
/// alone. It enters no result but `plan_time` and the improvements, unless the deadline ends the
/// search.
///
/// Under the rules the run's scenario has a risk of collision with every ship whose set own ship
/// alters for, and with those toward which the first plan would break rules, where a plan with these
/// roles relaxes no more and breaks fewer ([`ShipTrack::risk_distance`](crate::target::ShipTrack::risk_distance)).
pub fn run(mut scenario: Scenario) -> Run {
    let mut sets = sets(&scenario);
    let mut without = None;
    if let Some(with_risk) = rules::with_risk_of_sets(&scenario, &sets) {
        let sets_with_risk = self::sets(&with_risk);
        without = Some((
            std::mem::replace(&mut scenario, with_risk),
            std::mem::replace(&mut sets, sets_with_risk),
        ));
    }
    let begun = Instant::now();
    let land = land_within_reach(&scenario);
    let around_land;
    // reading a scenario checks that its paths are clear of land
    let land_obstacle = if scenario.planner.facts().follows_paths {
        LandObstacle::none()
    } else {
        around_land = land_obstacle(&scenario, &land.pieces);
        &around_land
    };
    let is_cut_short = Cell::new(false);
    let relaxer = Relaxer {
        scenario: &scenario,
        sets: &sets,
        land_obstacle,
        begun,
        is_cut_short: &is_cut_short,
    };
    let mut answer = relaxer.answer();
    if let Some((scenario, others)) = &without
        && let Some(other) = relaxer.lawful_answer(scenario, others, &answer)
    {
        answer = other;
        let mut others = others.clone();
        for (other, with_risk) in others.iter_mut().zip(&sets) {
            other.encounter = with_risk.encounter;
        }
        sets = others;
    } else if let Some((with_risk, with_sets, other)) = relaxer.answer_with_roles_of(&answer) {
        (scenario, sets, answer) = (with_risk, with_sets, other);
    }
    let relaxer = Relaxer {
        scenario: &scenario,
        sets: &sets,
        land_obstacle,
        begun,
        is_cut_short: &is_cut_short,
    };
    let answer = relaxer.with_stay(answer);
    let plan_time = begun.elapsed();
    let risks: Vec<PeakRisk> = answer.trajectory().map_or_else(Vec::new, |trajectory| {
        parallel::map(&answer.whole, |index, set| {
            match answer.released[index] {
                // the set that the plan has left then
                Some(_) => peak_risk(&set.outer_with_interior(), trajectory, answer.risk),
                None => peak_risk(&set.outer_where_flat(), trajectory, answer.risk),
            }
        })
    });
    let mut relaxations = Vec::new();
    if let Some(plan) = answer.trajectory() {
        relaxations = outcome::relaxations(
            &sets,
            &answer.reductions,
            &risks,
            &answer.released,
            not_arrived(&answer),
        );
        let is_by_rules =
            answer.level <= RelaxationLevel::Rules || rules::breaks(&scenario, plan) == 0;
        if scenario.compliance == Compliance::Rules && !is_by_rules {
            relaxations.extend(relaxed_rules(&scenario, &sets));
        }
    }
    let evaluation = answer
        .trajectory()
        .map(|trajectory| judge_answer(&scenario, &answer, &land, trajectory));
    let mut peaks = risks.into_iter();
    let avoided = answer.whole.into_iter().zip(answer.obstacles);
    let targets = (sets.into_iter().zip(avoided).zip(answer.released))
        .map(|((sets, (whole, obstacle)), released)| TargetOutcome {
            sets,
            whole,
            obstacle,
            released,
            peak: peaks.next(),
        })
        .collect();
    Run {
        targets,
        level: answer.level,
        max_risk: answer.risk,
        planned: answer.planned,
        why: answer.why.filter(|_| !relaxations.is_empty()),
        scenario,
        land,
        relaxations,
        evaluation,
        plan_time,
    }
}

/// The arrival that a plan gives up, and the target that prevents it: one that blocks the way, or
/// else one whose set is entered.
fn not_arrived(answer: &Attempt) -> Option<Relaxation> {
    let plan = answer
        .planned
        .outcome
        .plan()
        .filter(|plan| !plan.arrives())?;
    let barring = match answer.why.as_ref() {
        Some(
            NoPlan::Barred { target, .. }
            | NoPlan::StayCovered { target, .. }
            | NoPlan::OutOfTime { target, .. }
            | NoPlan::StartCovered { target, .. }
            | NoPlan::EndCovered { target, .. }
            | NoPlan::NoCandidate { target, .. }
            | NoPlan::NoneComplies { target, .. },
        ) => Some(target.as_str()),
        _ => None,
    };
    // land may be met first
    let barring = barring.filter(|name| answer.whole.iter().any(|set| set.name() == *name));
    let entered = answer.whole.iter().zip(&answer.released);
    let mut names = barring.into_iter().chain(
        entered
            .filter(|(_, released)| released.is_some())
            .chain(answer.whole.iter().zip(&answer.released))
            .map(|(set, _)| set.name()),
    );
    Some(Relaxation::Arrival {
        target: names.next().unwrap_or_default().to_owned(),
        amount: plan.to_go,
    })
}

#[cfg(test)]
mod tests;
