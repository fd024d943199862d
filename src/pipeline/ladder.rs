//! The ladder: what is given up, step by step, so that there is always an answer.
//!
//! ```text
//! compliant ─► the rules, shapes drawn back ─► shapes, but not the rules ─► shapes drawn back ─► along paths: arrival ─► hard sets at the least risk ─► a set entered, and left as soon as may be
//! ```
//!
//! Each rung is tried when those above gave no plan. A planner may find a way out of a larger set that it misses for the
//! smaller one, so a rung takes over what keeps clear of more than it asks.

use std::time::{Duration, Instant};

use super::duty::{encountered, first_turn};
use super::inside;
use super::rung::Rung;
use super::sets::TargetSets;
use super::shares::HALF;
use crate::obstacle::{Coast, Obstacle, SpaceTimeObstacle};
use crate::planner::optimal_control::{self, ControlReport, Controlled};
use crate::planner::{
    NoPlan, Objective, Outcome, Planned, PlannerKind, Problem, path_time, space_time,
};
use crate::scenario::{Compliance, Scenario};
use crate::trajectory::Trajectory;

/// Shares of the shapes that are tried by the rules where no plan was found for the whole.
const BY_THE_RULES: [f64; 2] = [HALF, 0.0];

/// Dimensionless. The least risk is sought to this, and no plan is asked for at a greater one than 1 less this.
pub const RISK_STEP: f64 = 1.0 / 64.0;

/// Metres. A plan may touch what it is said to keep clear of; deeper than this it meets it. A tenth of what a checker
/// rejects.
pub(super) const TOUCH_M: f64 = 0.1 * crate::tolerance::DEPTH_M;

/// An answer of a planner, and to what.
#[derive(Debug, Clone)]
pub(super) struct Attempt {
    pub rung: Rung,
    /// The sets that were kept, in the order of the targets.
    pub whole: Vec<Obstacle>,
    /// Metres that each shape was drawn back.
    pub cuts: Vec<f64>,
    /// The level sets of them that were planned against.
    pub obstacles: Vec<Obstacle>,
    /// The accepted risk.
    pub risk: f64,
    /// Seconds, per target: before, nothing is claimed of her set.
    pub released: Vec<Option<f64>>,
    pub planned: Planned,
    pub control: Option<ControlReport>,
    /// Why the rungs above have no plan.
    pub why: Option<NoPlan>,
}

impl Attempt {
    pub fn trajectory(&self) -> Option<&Trajectory> {
        self.planned.outcome.plan().map(|plan| &plan.trajectory)
    }
}

/// What is asked of the planner at most, and how long it may take.
pub(super) struct Ladder<'a> {
    pub scenario: &'a Scenario,
    pub sets: &'a [TargetSets],
    pub coast: &'a Coast,
    pub begun: Instant,
}

impl Ladder<'_> {
    /// The answer of the highest rung that has one. Without any, that of the first.
    pub fn answer(&self) -> Attempt {
        let shaped = self.scenario.compliance.shapes();
        let top = if shaped { 1.0 } else { 0.0 };
        let first = self.attempt(Rung::Compliant, &self.shares(top), self.scenario.max_risk);
        if self.scenario.planner == PlannerKind::OptimalControl {
            return self.under_forces(first, shaped);
        }
        let why = match &first.planned.outcome {
            Outcome::Solved(_) | Outcome::Deadline(Some(_)) => return first,
            Outcome::Deadline(None) => return self.at_worst(first),
            Outcome::Infeasible(reason) => reason.clone(),
        };
        let lower = self.lower_than(first, &why, shaped);
        let why = (lower.rung > Rung::Compliant).then_some(why);
        Attempt { why, ..lower }
    }

    /// The answer of the highest rung below the first that has one.
    fn lower_than(&self, first: Attempt, why: &NoPlan, shaped: bool) -> Attempt {
        if matches!(
            why,
            NoPlan::StartInside { .. } | NoPlan::StartCovered { .. }
        ) {
            return self.at_worst(first);
        }
        if !why.is_for_the_sets() {
            return first;
        }
        let lower = [
            Self::by_the_rules,
            Self::clear_of_shapes,
            Self::clear_of_hard_sets,
            Self::around_hard_sets,
            Self::clear_of_half_the_shapes,
            Self::waiting,
            Self::at_least_risk,
        ];
        for rung in lower {
            if let Some(found) = rung(self, shaped) {
                return match found.planned.outcome {
                    Outcome::Deadline(None) => self.at_worst(found),
                    _ => found,
                };
            }
        }
        self.at_worst(first)
    }

    fn left(&self) -> Duration {
        let budget = Duration::try_from_secs_f64(self.scenario.deadline);
        budget
            .unwrap_or(Duration::MAX)
            .saturating_sub(self.begun.elapsed())
    }

    /// What is asked of the planner, against these sets.
    pub(super) fn problem<'b>(&'b self, obstacles: &'b [Obstacle]) -> Problem<'b> {
        let shaped = self.scenario.compliance.shapes();
        Problem {
            deadline: self.left(),
            first_turn: shaped.then(|| first_turn(self.sets)).flatten(),
            ..super::problem(self.scenario, obstacles, self.coast)
        }
    }

    /// Plans against so much of each shape at a risk.
    pub(super) fn attempt(&self, rung: Rung, shares: &[f64], risk: f64) -> Attempt {
        let (whole, cuts) = self.kept(shares);
        let obstacles = level_sets(&whole, risk);
        let forces = self.scenario.planner == PlannerKind::OptimalControl;
        let obstacles = if forces {
            optimal_control::outer_sets(&obstacles)
        } else {
            obstacles
        };
        let mut problem = self.problem(&obstacles);
        let asking = match (rung, self.scenario.compliance) {
            (Rung::Compliant | Rung::Rules, Compliance::Rules) => {
                encountered(self.scenario, self.sets)
            }
            _ => Vec::new(),
        };
        problem.encountered = &asking;
        let mut control = None;
        let planned = match (self.scenario.planner, self.scenario.objective) {
            (PlannerKind::SpaceTime, _) => space_time::plan(&problem),
            (PlannerKind::PathTime, _) if rung == Rung::Waiting => {
                path_time::stay_clear(&problem, risk)
            }
            (PlannerKind::PathTime, Objective::LengthRisk { weight }) => {
                let problem = Problem {
                    obstacles: &whole,
                    ..problem
                };
                path_time::plan_weighing_risk(&problem, weight, risk)
            }
            (PlannerKind::PathTime, _) => path_time::plan(&problem),
            (PlannerKind::OptimalControl, _) => {
                let Controlled { planned, report } =
                    optimal_control::plan(&problem, &self.scenario.control);
                control = Some(report);
                planned
            }
        };
        Attempt {
            rung,
            released: vec![None; whole.len()],
            whole,
            // shapes that nobody asked for are not given up
            cuts: match self.scenario.compliance {
                Compliance::Shape | Compliance::Rules => cuts,
                Compliance::None => vec![0.0; self.sets.len()],
            },
            obstacles,
            risk,
            planned,
            control,
            why: None,
        }
    }

    /// True where the rules ask something of own ship.
    fn are_rules_asked(&self) -> bool {
        self.scenario.compliance == Compliance::Rules
            && !encountered(self.scenario, self.sets).is_empty()
    }

    /// A plan by the rules that is clear of the hard sets, and of as much of the shapes as it happens to be. `None` where none was
    /// found.
    fn by_the_rules(&self, _: bool) -> Option<Attempt> {
        if !self.are_rules_asked() || !self.sets.iter().any(TargetSets::has_shape) {
            return None;
        }
        let risk = self.scenario.max_risk;
        BY_THE_RULES.into_iter().find_map(|share| {
            let found = self.attempt(Rung::Rules, &self.shares(share), risk);
            let kept = self.kept_along(found.trajectory()?, risk);
            Some(self.clear_of(&found, &kept, Rung::Rules))
        })
    }

    /// A plan that is clear of the shapes, where the rules were asked for as well. `None` where none was found; an attempt
    /// without a plan where the time ran out.
    fn clear_of_shapes(&self, _: bool) -> Option<Attempt> {
        if !self.are_rules_asked() {
            return None;
        }
        let found = self.attempt(Rung::Shapes, &self.shares(1.0), self.scenario.max_risk);
        match found.planned.outcome {
            Outcome::Solved(_) | Outcome::Deadline(_) => Some(found),
            Outcome::Infeasible(_) => None,
        }
    }

    /// A wide way around the hard sets: the planner proper stays near the path. `None` where none was found.
    fn around_hard_sets(&self, shaped: bool) -> Option<Attempt> {
        if self.scenario.planner != PlannerKind::SpaceTime {
            return None;
        }
        let risk = self.scenario.max_risk;
        let whole: Vec<Obstacle> = self.sets.iter().map(|s| s.hard.clone()).collect();
        let obstacles = level_sets(&whole, risk);
        let wide = space_time::hybrid_a_star(&self.problem(&obstacles))?;
        let refined = space_time::warm_started(&self.problem(&obstacles), &wide.trajectory).outcome;
        let plan = match refined.plan() {
            Some(refined) if refined.cost < wide.cost => refined.clone(),
            _ => wide,
        };
        let outcome = match refined {
            Outcome::Deadline(_) => Outcome::Deadline(Some(plan)),
            _ => Outcome::Solved(plan),
        };
        let rung = if shaped {
            Rung::Domains
        } else {
            Rung::Compliant
        };
        let found = Attempt {
            rung,
            cuts: vec![0.0; whole.len()],
            released: vec![None; whole.len()],
            whole,
            obstacles,
            risk,
            planned: Planned::of(outcome),
            control: None,
            why: None,
        };
        if !shaped {
            return Some(self.clear_of(&found, &self.shares(0.0), rung));
        }
        let kept = self.kept_along(found.trajectory()?, risk);
        Some(self.with_more_kept(self.clear_of(&found, &kept, rung), &kept))
    }

    /// A motion along paths that does not arrive in time, but is clear of the hard sets and of as much of the shapes as was found up to
    /// the horizon. `None` where there is none.
    fn waiting(&self, shaped: bool) -> Option<Attempt> {
        if self.scenario.planner != PlannerKind::PathTime {
            return None;
        }
        let risk = self.scenario.max_risk;
        let at = |share: f64| {
            let found = self.attempt(Rung::Waiting, &self.shares(share), risk);
            let is_none = matches!(found.planned.outcome, Outcome::Infeasible(_));
            (!is_none).then_some(found)
        };
        if shaped && let Some(found) = at(1.0) {
            return Some(found);
        }
        let found = at(0.0)?;
        match found.trajectory() {
            Some(trajectory) if shaped => {
                let kept = self.kept_along(trajectory, risk);
                Some(self.clear_of(&found, &kept, Rung::Waiting))
            }
            _ => Some(found),
        }
    }

    /// The plan of an attempt refined for another risk; `None` where that is none.
    fn drawn_to(&self, attempt: &Attempt, risk: f64) -> Option<Attempt> {
        if self.scenario.planner != PlannerKind::SpaceTime {
            return None;
        }
        let obstacles = level_sets(&attempt.whole, risk);
        let outcome =
            space_time::warm_started(&self.problem(&obstacles), attempt.trajectory()?).outcome;
        let mut drawn = Attempt {
            obstacles,
            risk,
            ..attempt.clone()
        };
        drawn.planned.outcome = outcome;
        matches!(drawn.planned.outcome, Outcome::Solved(_)).then_some(drawn)
    }

    /// The plan at the least risk that was found to leave a way, to [`RISK_STEP`]. Along paths a motion that does not arrive counts
    /// as one, too.
    fn at_least_risk(&self, _: bool) -> Option<Attempt> {
        let none = self.shares(0.0);
        let at = |risk: f64| {
            let found = self.attempt(Rung::Risk, &none, risk);
            let along = self.scenario.planner == PlannerKind::PathTime;
            if along && matches!(found.planned.outcome, Outcome::Infeasible(_)) {
                return Attempt {
                    rung: Rung::Risk,
                    ..self.attempt(Rung::Waiting, &none, risk)
                };
            }
            found
        };
        let mut low = self.scenario.max_risk;
        let mut high = 1.0 - RISK_STEP;
        if low >= high {
            return None;
        }
        let mut best = at(high);
        if best.trajectory().is_none() {
            let timed_out = matches!(best.planned.outcome, Outcome::Deadline(_));
            return timed_out.then_some(best);
        }
        while high - low > RISK_STEP {
            let risk = 0.5 * (low + high);
            let tried = self.drawn_to(&best, risk).unwrap_or_else(|| at(risk));
            match tried.planned.outcome {
                Outcome::Infeasible(_) => low = risk,
                Outcome::Deadline(None) => return Some(out_of_time(best)),
                Outcome::Solved(_) | Outcome::Deadline(Some(_)) => {
                    best = tried;
                    high = risk;
                }
            }
        }
        Some(best)
    }

    /// The motion that leaves every set soonest for good, or holds on where none was found, or that does least harm along paths;
    /// without a motion the attempt as it is.
    fn at_worst(&self, attempt: Attempt) -> Attempt {
        let hard: Vec<Obstacle> = self.sets.iter().map(|s| s.hard.clone()).collect();
        let problem = self.problem(&hard);
        let Some(planned) = inside::motion(self.scenario, &problem) else {
            return attempt;
        };
        let Some(plan) = planned.outcome.plan() else {
            return attempt;
        };
        let is_up = || self.left().is_zero();
        let left = |set| {
            let left = inside::left_for_good(set, &plan.trajectory, is_up)?;
            // of a ship that has arrived nothing is claimed at all
            Some(if left > 0.0 { left } else { problem.horizon })
        };
        let released = hard.iter().map(left).collect();
        let timed_out =
            matches!(attempt.planned.outcome, Outcome::Deadline(_)) || self.left().is_zero();
        let outcome = if timed_out {
            Outcome::Deadline(Some(plan.clone()))
        } else {
            planned.outcome
        };
        let cuts = match self.scenario.compliance {
            Compliance::Shape | Compliance::Rules => {
                self.sets.iter().map(|s| s.shape_reach).collect()
            }
            Compliance::None => attempt.cuts,
        };
        Attempt {
            rung: Rung::Inside,
            obstacles: hard.clone(),
            whole: hard,
            cuts,
            risk: 0.0,
            released,
            planned: Planned {
                outcome,
                path_time: planned.path_time,
                ..attempt.planned
            },
            control: None,
            why: attempt.why,
        }
    }

    /// Under forces there are two rungs: the shapes, and none of them.
    fn under_forces(&self, mut first: Attempt, shaped: bool) -> Attempt {
        let stuck = match &first.planned.outcome {
            // the ellipse around a shape may hold own ship where the shape does not
            Outcome::Infeasible(NoPlan::StartInside { .. }) => true,
            Outcome::Infeasible(reason) => reason.is_for_the_sets(),
            Outcome::Solved(_) | Outcome::Deadline(_) => false,
        };
        if !(shaped && stuck && self.sets.iter().any(|s| s.shape_reach > 0.0)) {
            return first;
        }
        let again = self.attempt(Rung::Domains, &self.shares(0.0), self.scenario.max_risk);
        // starts and sets are those of the pass that ended so
        if !matches!(again.planned.outcome, Outcome::Infeasible(_)) {
            first = again;
        }
        first
    }
}

/// The level sets of a risk.
pub(super) fn level_sets(whole: &[Obstacle], risk: f64) -> Vec<Obstacle> {
    if risk > 0.0 {
        whole.iter().map(|set| set.at_risk(risk)).collect()
    } else {
        whole.to_vec()
    }
}

/// A plan that might have become better.
pub(super) fn out_of_time(mut attempt: Attempt) -> Attempt {
    attempt.planned.outcome = match attempt.planned.outcome {
        Outcome::Solved(plan) => Outcome::Deadline(Some(plan)),
        other => other,
    };
    attempt
}
