//! Relaxation levels: which requirements are given up, in order, so that there is always an answer.
//!
//! A level is tried when the levels above it gave no plan, or one that costs many times as much as a lawful
//! plan of a level below. A planner may find a way around a larger
//! set and miss it for a smaller one. So some levels also plan against more than they require.

mod levels;

use std::cell::Cell;
use std::cmp::Ordering;
use std::time::{Duration, Instant};

use self::levels::{BY_THE_RULES, CLEAR_OF_DOMAINS, LAWFUL_REMAINDER, REMAINDER};
use super::entered;
use super::remainder::{begins_another, better_remainder};
use super::rules::{self, encountered, first_turn};
use super::sets::TargetSets;
use crate::numerics::bisected;
use crate::obstacle::{LandObstacle, Obstacle, SpaceTimeObstacle, level_sets};
use crate::parallel;
use crate::planner::{
    FAR_OFF_LENGTHS, MANY_TIMES, NoPlan, Outcome, Plan, PlanMethod, PlanRequest, Planned, Planner,
    Problem, SearchKind,
};
use crate::scenario::{Compliance, Scenario};
use crate::tolerance;
use crate::trajectory::{Segment, Trajectory};

/// Bisection steps for a larger common scale factor, each with a warm-started plan.
const SCALE_HALVINGS: usize = 3;

/// Bisection steps for the largest scale factor of one domain that a given plan is clear of.
const RETAINED_HALVINGS: usize = 10;

/// Metres by which reductions of domains may differ in answers that relax as much.
const SAME_REDUCTION_M: f64 = 1.0;

/// Seconds by which a manoeuvre by the rules arrives off its schedule, from which on it is compared with
/// other lawful plans. An alteration should be bold, but no detour of a quarter of an hour where a bend breaks no
/// rule, or where a domain need only be a little smaller.
const FAR_OFF_TIME_S: f64 = 300.0;

/// Accuracy of the least risk. No plan is sought at a risk above 1 less this. Dimensionless.
pub const RISK_STEP: f64 = 1.0 / 64.0;

/// How much of the request a plan satisfies, in the order in which requirements are given up.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum RelaxationLevel {
    /// Everything that compliance asks: the rules, and the ship domains where own ship's start
    /// permits them.
    Compliant,
    /// By the rules, clear of the hard sets and of reduced ship domains.
    Rules,
    /// Clear of the full ship domains, but not by the rules.
    Domains,
    /// Clear of the hard sets and of reduced ship domains.
    ReducedDomains,
    /// Clear of the hard sets and of reduced domains, without arriving. The motion ends at the
    /// horizon, or before the sets that cover the last waypoint.
    Waiting,
    /// Clear of the level sets of the least risk for which a plan was found.
    Risk,
    /// Enters or leaves a hard set; nothing is claimed of that set before it is left.
    Inside,
}

/// A planner's answer and the sets it was planned against.
#[derive(Debug, Clone)]
pub(super) struct Attempt {
    pub level: RelaxationLevel,
    /// The sets that are retained, in the order of the targets.
    pub whole: Vec<Obstacle>,
    /// Metres by which each ship domain is reduced.
    pub reductions: Vec<f64>,
    /// Level sets of `whole` at the accepted risk: the sets that were planned against.
    pub obstacles: Vec<Obstacle>,
    /// The accepted risk.
    pub risk: f64,
    /// Seconds, per target: nothing is claimed of its set before.
    pub released: Vec<Option<f64>>,
    pub planned: Planned,
    /// Why the first level has no plan.
    pub why: Option<NoPlan>,
}

impl Attempt {
    /// An attempt that enters no set.
    pub(super) fn of(
        level: RelaxationLevel,
        whole: Vec<Obstacle>,
        reductions: Vec<f64>,
        obstacles: Vec<Obstacle>,
        risk: f64,
        planned: Planned,
    ) -> Self {
        Self {
            level,
            released: vec![None; whole.len()],
            whole,
            reductions,
            obstacles,
            risk,
            planned,
            why: None,
        }
    }

    pub fn trajectory(&self) -> Option<&Trajectory> {
        self.planned.outcome.plan().map(|plan| &plan.trajectory)
    }

    /// Whether this answer relaxes less than another, more, or as much. Compares level, number of
    /// entered sets, risk and largest reduction of a domain, in this order.
    pub(super) fn relaxation_cmp(&self, other: &Self) -> Ordering {
        let plans = [self, other].map(|of| of.planned.outcome.plan());
        let [Some(plan), Some(others)] = plans else {
            return plans[0].is_none().cmp(&plans[1].is_none());
        };
        let entered = |of: &Self| of.released.iter().flatten().count();
        let level = |of: &Self, plan: &Plan| match plan.arrives() {
            true => of.level,
            false => of.level.max(RelaxationLevel::Waiting),
        };
        let reduced = |of: &Self| of.reductions.iter().copied().fold(0.0, f64::max);
        let discrete = (level(self, plan), entered(self));
        let mut order = discrete.cmp(&(level(other, others), entered(other)));
        for (own, others, same) in [
            (self.risk, other.risk, RISK_STEP),
            (reduced(self), reduced(other), SAME_REDUCTION_M),
        ] {
            if (own - others).abs() > same {
                order = order.then(own.total_cmp(&others));
            }
        }
        order
    }

    /// True where this answer relaxes less than another, or as much at a lower cost.
    pub(super) fn is_better_than(&self, other: &Self) -> bool {
        let cost = |of: &Self| of.planned.outcome.plan().map_or(f64::INFINITY, |p| p.cost);
        match self.relaxation_cmp(other) {
            Ordering::Equal => cost(self) < cost(other),
            order => order.is_lt(),
        }
    }

    fn is_infeasible(&self) -> bool {
        matches!(self.planned.outcome, Outcome::Infeasible(_))
    }
}

/// A scenario, its sets, and the time budget that all levels share.
pub(super) struct Relaxer<'a> {
    pub scenario: &'a Scenario,
    pub sets: &'a [TargetSets],
    pub land_obstacle: &'a LandObstacle,
    pub begun: Instant,
    /// True once an attempt was cut short, whatever answers in the end.
    pub is_cut_short: &'a Cell<bool>,
}

impl Relaxer<'_> {
    /// The answer to the request.
    pub fn answer(&self) -> Attempt {
        let (search, planner) = (self.scenario.search, self.scenario.planner.facts());
        let several = self.scenario.targets.len() > 1 && planner.searches.contains(&search);
        let answer = match search {
            SearchKind::Thorough if several => self.thorough_answer(),
            _ => self.answer_of_one_search(),
        };
        match self.is_cut_short.get() {
            true => out_of_time(answer),
            false => answer,
        }
    }

    /// The answer to the request without the risks that sets alone give (another scenario and its
    /// sets), where `answer` is not by the rules, takes a risk, or does not arrive. It is taken where
    /// it relaxes less and breaks no rule toward the ships that have a role by these risks.
    pub(super) fn lawful_answer(
        &self,
        scenario: &Scenario,
        sets: &[TargetSets],
        answer: &Attempt,
    ) -> Option<Attempt> {
        let is_lawful = |of: &Attempt| {
            let breaks = |trajectory| rules::breaks(self.scenario, trajectory);
            of.trajectory().map(breaks) == Some(0)
        };
        let arrives = answer.planned.outcome.plan().is_some_and(Plan::arrives);
        let gives_up = match answer.level {
            RelaxationLevel::Compliant | RelaxationLevel::Rules => false,
            RelaxationLevel::Domains => !is_lawful(answer),
            _ => true,
        };
        if arrives && !gives_up || self.time_left().is_zero() {
            return None;
        }
        let other = self.of(scenario, sets).answer();
        (other.relaxation_cmp(answer).is_lt() && is_lawful(&other)).then_some(other)
    }

    /// The answer with a role toward the ships that have none, but toward which `answer` breaks
    /// rules, and its scenario and sets. It is taken where it relaxes no more and breaks fewer rules,
    /// and no more than `answer` without these roles.
    pub(super) fn answer_with_roles_of(
        &self,
        answer: &Attempt,
    ) -> Option<(Scenario, Vec<TargetSets>, Attempt)> {
        if self.time_left().is_zero() {
            return None;
        }
        let plan = answer.trajectory()?;
        let scenario = rules::with_risk_of_plan(self.scenario, self.sets, plan)?;
        let sets = super::sets(&scenario);
        let other = self.of(&scenario, &sets).answer();
        let broken = rules::breaks(self.scenario, plan);
        let again = other.trajectory()?;
        let is_better = other.relaxation_cmp(answer).is_le()
            && rules::breaks(&scenario, again) < broken
            && rules::breaks(self.scenario, again) <= broken;
        is_better.then_some((scenario, sets, other))
    }

    /// For another scenario and its sets, in the same time.
    pub(super) fn of<'b>(&'b self, scenario: &'b Scenario, sets: &'b [TargetSets]) -> Relaxer<'b> {
        Relaxer {
            scenario,
            sets,
            ..*self
        }
    }

    /// The answer of the first level that has one; without any, that of the first level.
    pub(super) fn answer_of_one_search(&self) -> Attempt {
        let first = self.first();
        let mut first = self.much_cheaper_than(&first).unwrap_or(first);
        let problem = self.problem(&first.obstacles);
        if let Some(kept) = better_remainder(self.scenario, &problem, &first) {
            let none = first.planned.outcome.plan().is_none();
            if none && kept.broken > 0 {
                first.level = RelaxationLevel::Domains;
            }
            first.why = match &first.planned.outcome {
                Outcome::Infeasible(why) if kept.broken > 0 => Some(why.clone()),
                _ => first.why.take(),
            };
            let is_late = matches!(first.planned.outcome, Outcome::Deadline(None));
            first.planned = kept.planned;
            if is_late {
                first = out_of_time(first);
            }
        }
        if self.scenario.planner.facts().relaxes_domains_only {
            return self.without_domains(first);
        }
        let why = match &first.planned.outcome {
            Outcome::Solved(_) | Outcome::Deadline(Some(_)) => {
                return self.finished(&first).unwrap_or(first);
            }
            Outcome::Deadline(None) => return self.late(first),
            Outcome::Infeasible(reason) => reason.clone(),
        };
        let relaxed = self.relaxed(first, &why);
        let relaxed = self.much_cheaper_than(&relaxed).unwrap_or(relaxed);
        let relaxed = self.finished(&relaxed).unwrap_or(relaxed);
        let arrives = relaxed.planned.outcome.plan().is_none_or(Plan::arrives);
        let is_relaxed = relaxed.level > RelaxationLevel::Compliant || !arrives;
        let why = relaxed.why.clone().unwrap_or(why);
        Attempt {
            why: is_relaxed.then_some(why),
            ..relaxed
        }
    }

    /// The plan that satisfies the whole request.
    pub(super) fn first(&self) -> Attempt {
        self.at_most_the_risk(RelaxationLevel::Compliant, &self.first_scales(), |_| true)
    }

    /// The cheapest accepted plan of a level; without any, the attempt. Where a risk is accepted, a plan that
    /// takes none is tried besides one around the smaller sets: the search may miss it among these.
    fn at_most_the_risk(
        &self,
        level: RelaxationLevel,
        scales: &[f64],
        accepted: impl Fn(&Attempt) -> bool,
    ) -> Attempt {
        let risk = self.scenario.max_risk;
        let found = self.attempt(level, scales, risk);
        if risk == 0.0 || self.scenario.planner.facts().relaxes_domains_only {
            return found;
        }
        let without = Attempt {
            planned: self.attempt(level, scales, 0.0).planned,
            ..found.clone()
        };
        let cost = |of: &Attempt| {
            let plan = of.planned.outcome.plan().filter(|_| accepted(of));
            plan.map_or(f64::INFINITY, |plan| plan.cost)
        };
        match cost(&without) {
            least if least.is_finite() && least <= cost(&found) => without,
            _ => found,
        }
    }

    /// The answer of the first level below the request that has one.
    fn relaxed(&self, first: Attempt, why: &NoPlan) -> Attempt {
        if is_inside(why) {
            return self.leaving_sets(first);
        }
        if !why.is_for_the_sets() {
            return first;
        }
        let at_end = matches!(why, NoPlan::EndCovered { .. });
        let at_end = at_end.then(|| self.without_domains_at_end());
        let found = at_end.flatten().or_else(|| self.of_levels());
        match self.or_cut_again(found) {
            Some(found) if !matches!(found.planned.outcome, Outcome::Deadline(None)) => {
                self.letting_pass(&found).unwrap_or(found)
            }
            Some(found) => self.late(found),
            None => self.leaving_sets(first),
        }
    }

    /// The answer where the time ran out before there was a plan. It is the remainder of the last
    /// plan, if that is clear of the hard sets: this takes no search.
    fn late(&self, attempt: Attempt) -> Attempt {
        match self.of_level(&REMAINDER, |_| true) {
            Some(found) => out_of_time(found),
            None => self.leaving_sets(attempt),
        }
    }

    /// [`RelaxationLevel::Rules`]: the manoeuvre under way, finished in smaller domains, where the
    /// plan of an attempt begins another and breaks no fewer rules.
    fn finished(&self, attempt: &Attempt) -> Option<Attempt> {
        if !(self.are_rules_asked() && begins_another(self.scenario, &attempt.planned)) {
            return None;
        }
        let found = self.remainder_clear_of_hard_sets(RelaxationLevel::Rules)?;
        let breaks = |trajectory| rules::breaks(self.scenario, trajectory);
        let fewest = attempt.trajectory().map_or(usize::MAX, breaks);
        (found.1 <= fewest).then_some(found.0)
    }

    /// The remainder against the hard sets and as much of the domains as it is clear of, and the
    /// number of rules that it breaks.
    fn remainder_clear_of_hard_sets(&self, level: RelaxationLevel) -> Option<(Attempt, usize)> {
        if self.scenario.memory.remainder.is_empty() {
            return None;
        }
        let risk = self.scenario.max_risk;
        let (whole, reductions) = self.asked(&self.scales(0.0));
        let obstacles = level_sets(&whole, risk);
        let none = Planned::of(Outcome::Infeasible(NoPlan::NoTrajectory));
        let mut found = Attempt::of(level, whole, reductions, obstacles, risk, none);
        let kept = better_remainder(self.scenario, &self.problem(&found.obstacles), &found)?;
        found.planned = kept.planned;
        let retained = match self.scenario.compliance.shapes() {
            true => self.retained_along(found.trajectory()?, risk),
            false => self.scales(0.0),
        };
        Some((self.clear_of(&found, &retained, level), kept.broken))
    }

    /// [`RelaxationLevel::Rules`] or [`RelaxationLevel::ReducedDomains`]: the remainder of the last
    /// plan, if that is clear of the hard sets; else a plan that is clear of all full domains except
    /// those over the last waypoint, of which it retains what it can.
    fn without_domains_at_end(&self) -> Option<Attempt> {
        if !self.are_domains_asked() {
            return None;
        }
        let level = match self.are_rules_asked() {
            true => RelaxationLevel::Rules,
            false => RelaxationLevel::ReducedDomains,
        };
        if let Some((kept, broken)) = self.remainder_clear_of_hard_sets(level)
            && (broken == 0 || level > RelaxationLevel::Rules)
        {
            return Some(kept);
        }
        let risk = self.scenario.max_risk;
        let mut scales = self.scales(1.0);
        loop {
            let found = self.attempt(level, &scales, risk);
            let Outcome::Infeasible(NoPlan::EndCovered { target, .. }) = &found.planned.outcome
            else {
                let retained = self.retained_along(found.trajectory()?, risk);
                let clear = self.clear_of(&found, &retained, level);
                return Some(match level {
                    RelaxationLevel::ReducedDomains => self.with_larger_domains(clear, &retained),
                    _ => clear,
                });
            };
            let is_over = |sets: &TargetSets| sets.hard.name() == target && sets.has_domain();
            let over = self.sets.iter().position(is_over)?;
            if scales[over] == 0.0 {
                return None;
            }
            scales[over] = 0.0;
        }
    }

    /// A lawful plan that costs a tenth of a manoeuvre by the rules that is far off its schedule: one of the
    /// whole request that is no such manoeuvre, the rest of the last plan, or a manoeuvre in smaller
    /// domains. During a manoeuvre only the rest of the last plan.
    fn much_cheaper_than(&self, answer: &Attempt) -> Option<Attempt> {
        let plan = answer.planned.outcome.plan()?;
        let is_dear = plan.method == PlanMethod::Rules && self.is_far_off(plan);
        if !is_dear || self.time_left().is_zero() {
            return None;
        }
        let is_better = |other: &Attempt| {
            other.planned.outcome.plan().is_some_and(|found| {
                found.arrives()
                    && MANY_TIMES * found.cost <= plan.cost
                    && rules::breaks(self.scenario, &found.trajectory) == 0
            })
        };
        let rest = || self.of_level(&LAWFUL_REMAINDER, |_| true).filter(is_better);
        let found = match self.scenario.memory.under_way {
            Some(_) => rest(),
            None => (self
                .of_level(&CLEAR_OF_DOMAINS, is_better)
                .filter(is_better))
            .or_else(rest)
            .or_else(|| self.of_level(&BY_THE_RULES, is_better)),
        };
        let mut found = found?;
        if found.reductions.iter().all(|metres| *metres == 0.0) {
            found.level = RelaxationLevel::Compliant;
        }
        let other = found.planned.outcome.plan().map_or(f64::NAN, |p| p.cost);
        let cost = plan.cost;
        found.why = Some(NoPlan::OutOfProportion { cost, other });
        Some(found)
    }

    /// True for a plan minutes off its schedule, or one whose space-time error is, in the root mean square,
    /// more than some lengths and than any ship domain reaches beyond its hard set.
    fn is_far_off(&self, plan: &Plan) -> bool {
        let off_time = plan.trajectory.end_time() - self.scenario.desired.duration();
        let far = FAR_OFF_LENGTHS * self.scenario.own_ship.hull.length;
        let far = self.sets.iter().map(|s| s.shape_reach).fold(far, f64::max);
        off_time.abs() > FAR_OFF_TIME_S || plan.cost > far * far
    }

    /// [`RelaxationLevel::Rules`], or [`RelaxationLevel::ReducedDomains`]: a plan clear of the hard
    /// sets that slows down until the ships have passed, where it breaks fewer rules than an answer,
    /// or where that is not clear of the hard sets.
    fn letting_pass(&self, answer: &Attempt) -> Option<Attempt> {
        let trajectory = answer.trajectory()?;
        if !self.are_rules_asked() {
            return None;
        }
        let broken = |trajectory: &Trajectory| rules::breaks(self.scenario, trajectory);
        let most = match answer.level {
            RelaxationLevel::Risk | RelaxationLevel::Inside => usize::MAX,
            RelaxationLevel::Rules | RelaxationLevel::Domains => broken(trajectory).min(1),
            _ => broken(trajectory),
        };
        if most == 0 || self.time_left().is_zero() {
            return None;
        }
        let risk = self.scenario.max_risk;
        let (whole, reductions) = self.asked(&self.scales(0.0));
        let obstacles = level_sets(&whole, risk);
        let encounters = encountered(self.scenario, self.sets);
        let problem = Problem {
            encountered: &encounters,
            ..self.problem(&obstacles)
        };
        let plan = self.scenario.planner.let_pass(&problem, &broken, most)?;
        let level = match broken(&plan.trajectory) {
            0 => RelaxationLevel::Rules,
            _ => RelaxationLevel::ReducedDomains,
        };
        let planned = Planned::of(Outcome::Solved(plan));
        let found = Attempt::of(level, whole, reductions, obstacles, risk, planned);
        let retained = self.retained_along(found.trajectory()?, risk);
        Some(self.clear_of(&found, &retained, level))
    }

    /// If a level used up its share of the time and no plan is safe, spends the remaining time on the
    /// shortened mission.
    fn or_cut_again(&self, found: Option<Attempt>) -> Option<Attempt> {
        let is_safe = |of: &Attempt| of.trajectory().is_some() && of.level < RelaxationLevel::Risk;
        let has_time = self.is_cut_short.get() && !self.time_left().is_zero();
        if found.as_ref().is_some_and(is_safe) || !has_time {
            return found;
        }
        match (self.cut(1.0), found) {
            (Some(again), Some(found)) if !again.is_better_than(&found) => Some(found),
            (Some(again), _) => Some(again),
            (None, found) => found,
        }
    }

    /// [`RelaxationLevel::Inside`]: the motion with the least harm. Without a motion the attempt is
    /// returned, with the reason why there is no plan without any set where that is so.
    fn leaving_sets(&self, attempt: Attempt) -> Attempt {
        let hard: Vec<Obstacle> = self.sets.iter().map(|s| s.hard.clone()).collect();
        let mut problem = self.problem(&hard);
        // few changes of speed are preferred over the cost
        if self.scenario.settings.tidy != Some(false) {
            problem.tidy = Some(self.scenario.settings.tidiness);
        }
        let own = self.scenario.own_ship.hull;
        let targets = self.scenario.targets.iter().zip(&hard);
        let nominal: Vec<_> = targets
            .map(|(t, hard)| entered::nominal(t, hard, own))
            .collect();
        let is_up = || self.time_left().is_zero();
        let found = self.scenario.planner.leaving_sets(&problem, &nominal);
        let found = found.and_then(|planned| Some((planned.outcome.plan()?.clone(), planned)));
        let found = found.filter(|(plan, _)| plan.arrives() || !self.is_infeasible_alone());
        let Some((plan, planned)) = found else {
            let alone = self.alone();
            return match is_up() {
                _ if alone.is_infeasible() => Attempt {
                    planned: alone.planned,
                    ..attempt
                },
                true => out_of_time(attempt),
                false => attempt,
            };
        };
        let left = |set| {
            let left = entered::left_for_good(set, &plan.trajectory, is_up)?;
            // nothing is claimed for a ship that has arrived
            Some(if left > 0.0 { left } else { problem.horizon })
        };
        let released = hard.iter().map(left).collect();
        let timed_out = matches!(attempt.planned.outcome, Outcome::Deadline(_)) || is_up();
        let outcome = if timed_out {
            Outcome::Deadline(Some(plan))
        } else {
            planned.outcome
        };
        let reductions = self.given_up(&attempt.reductions);
        Attempt {
            level: RelaxationLevel::Inside,
            obstacles: hard.clone(),
            whole: hard,
            reductions,
            risk: 0.0,
            released,
            planned: Planned {
                outcome,
                stats: planned.stats,
                path_time: planned.path_time,
                ..attempt.planned
            },
            why: attempt.why,
        }
    }

    /// Metres by which domains are reduced where all are given up that are asked for.
    pub(super) fn given_up(&self, reductions: &[f64]) -> Vec<f64> {
        match self.scenario.compliance {
            Compliance::Shape | Compliance::Rules => {
                self.sets.iter().map(|s| s.shape_reach).collect()
            }
            Compliance::None => reductions.to_vec(),
        }
    }

    /// The level sets of the hard sets.
    pub(super) fn against_hard_sets(&self, risk: f64) -> Vec<Obstacle> {
        level_sets(&self.asked(&self.scales(0.0)).0, risk)
    }

    /// The plan without any set.
    fn alone(&self) -> Attempt {
        let alone = self.of(self.scenario, &[]);
        alone.attempt(RelaxationLevel::Compliant, &[], 0.0)
    }

    /// True where the sets are not the reason, as there is no plan without any. Along paths there is
    /// one wherever the horizon is long enough.
    fn is_infeasible_alone(&self) -> bool {
        !self.follows_paths() && self.alone().is_infeasible()
    }

    /// The only level below the first for a planner that relaxes domains only: the hard sets.
    fn without_domains(&self, mut first: Attempt) -> Attempt {
        let blocked = match &first.planned.outcome {
            // the ellipse around a domain may contain own ship where the domain does not
            Outcome::Infeasible(NoPlan::StartInside { .. }) => true,
            Outcome::Infeasible(reason) => reason.is_for_the_sets(),
            Outcome::Solved(_) | Outcome::Deadline(_) => false,
        };
        if !(self.are_domains_asked() && blocked && self.sets.iter().any(|s| s.shape_reach > 0.0)) {
            return first;
        }
        let level = RelaxationLevel::ReducedDomains;
        let again = self.attempt(level, &self.scales(0.0), self.scenario.max_risk);
        // the report describes the pass that gave the answer
        if !again.is_infeasible() {
            first = again;
        }
        first
    }

    pub(super) fn time_left(&self) -> Duration {
        super::deadline(self.scenario).saturating_sub(self.begun.elapsed())
    }

    /// True where the rules ask something of own ship.
    fn are_rules_asked(&self) -> bool {
        self.scenario.compliance == Compliance::Rules
            && !encountered(self.scenario, self.sets).is_empty()
    }

    fn are_domains_asked(&self) -> bool {
        self.scenario.compliance.shapes()
    }

    fn has_domains(&self) -> bool {
        self.sets.iter().any(TargetSets::has_domain)
    }

    fn follows_paths(&self) -> bool {
        self.scenario.planner.facts().follows_paths
    }

    /// The planning problem of the scenario against these sets, with the time that is left.
    pub(super) fn problem<'b>(&'b self, obstacles: &'b [Obstacle]) -> Problem<'b> {
        Problem {
            deadline: self.time_left(),
            first_turn: self
                .are_domains_asked()
                .then(|| first_turn(self.sets))
                .flatten(),
            ..super::problem(self.scenario, obstacles, self.land_obstacle)
        }
    }

    /// Plans against domains of these scale factors at a risk.
    fn attempt(&self, level: RelaxationLevel, scales: &[f64], risk: f64) -> Attempt {
        let planner = self.scenario.planner;
        let facts = planner.facts();
        let is_late = level != RelaxationLevel::Compliant && self.time_left().is_zero();
        // along paths a few lines are tested all the same
        let is_skipped = is_late && !facts.follows_paths && !facts.relaxes_domains_only;
        if is_skipped {
            // out of time: there is no plan, so nothing is given up, and no set is scaled for it
            let (whole, _) = self.scaled(&self.scales(0.0));
            let (kept, none) = (self.scales(0.0), Planned::of(Outcome::Deadline(None)));
            return Attempt::of(level, whole.clone(), kept, whole, risk, none);
        }
        let (whole, reductions) = self.asked(scales);
        let obstacles = planner.outer_sets(level_sets(&whole, risk));
        let mut problem = self.problem(&obstacles);
        let mut encounters = Vec::new();
        if level <= RelaxationLevel::Rules && self.scenario.compliance == Compliance::Rules {
            encounters = encountered(self.scenario, self.sets);
            problem.under_way = self.scenario.memory.under_way;
        }
        problem.encountered = &encounters;
        let planned = planner.plan(&PlanRequest {
            problem,
            whole: &whole,
            max_risk: risk,
            may_wait: level == RelaxationLevel::Waiting,
            settings: &self.scenario.settings,
        });
        if planned.is_cut_short {
            self.is_cut_short.set(true);
        }
        Attempt::of(level, whole, reductions, obstacles, risk, planned)
    }

    /// The plan of an attempt refined for another risk, without a search; `None` where that fails.
    fn warm_started(&self, attempt: &Attempt, risk: f64) -> Option<Attempt> {
        let obstacles = level_sets(&attempt.whole, risk);
        let (planner, problem) = (self.scenario.planner, self.problem(&obstacles));
        let outcome = warm_started(planner, &problem, attempt.planned.outcome.plan()?)?;
        let mut refined = Attempt {
            obstacles,
            risk,
            ..attempt.clone()
        };
        refined.planned.outcome = outcome;
        matches!(refined.planned.outcome, Outcome::Solved(_)).then_some(refined)
    }

    /// One scale factor for every domain.
    fn scales(&self, scale: f64) -> Vec<f64> {
        vec![scale; self.sets.len()]
    }

    /// The sets with domains of these scale factors, and metres by which each domain is reduced.
    fn scaled(&self, scales: &[f64]) -> (Vec<Obstacle>, Vec<f64>) {
        let scaled = |index: usize, sets: &TargetSets| sets.scaled(scales[index]);
        // a thread costs more than copies of the hard sets or of the full domains
        let is_built = scales.iter().any(|scale| *scale > 0.0 && *scale < 1.0);
        let scaled = match is_built {
            true => parallel::map(self.sets, scaled),
            false => (self.sets.iter().enumerate())
                .map(|(index, sets)| scaled(index, sets))
                .collect(),
        };
        let scaled = scaled.into_iter();
        scaled.map(|s| (s.obstacle, s.reduction)).unzip()
    }

    /// [`Self::scaled`], without reductions of domains that nobody asked for: these are not given up.
    fn asked(&self, scales: &[f64]) -> (Vec<Obstacle>, Vec<f64>) {
        let (whole, reductions) = self.scaled(scales);
        match self.scenario.compliance.shapes() {
            true => (whole, reductions),
            false => (whole, self.scales(0.0)),
        }
    }

    /// The sets of the first level, and metres by which each ship domain is reduced.
    pub(super) fn first_sets(&self) -> (Vec<Obstacle>, Vec<f64>) {
        self.asked(&self.first_scales())
    }

    /// The full ship domains, where they are asked for.
    fn first_scales(&self) -> Vec<f64> {
        self.scales(if self.are_domains_asked() { 1.0 } else { 0.0 })
    }

    /// The plan of an attempt, claimed to be clear of domains of these scale factors.
    pub(super) fn clear_of(
        &self,
        attempt: &Attempt,
        scales: &[f64],
        level: RelaxationLevel,
    ) -> Attempt {
        let (whole, reductions) = self.scaled(scales);
        Attempt {
            level,
            obstacles: level_sets(&whole, attempt.risk),
            whole,
            reductions: match self.scenario.compliance {
                Compliance::Shape | Compliance::Rules => reductions,
                Compliance::None => attempt.reductions.clone(),
            },
            ..attempt.clone()
        }
    }

    /// Scale factor of each domain that a motion is clear of, from below, by bisection.
    pub(super) fn retained_along(&self, trajectory: &Trajectory, risk: f64) -> Vec<f64> {
        parallel::map(self.sets, |_, sets| {
            let clear = |scale: f64| {
                let set = sets.scaled(scale).obstacle;
                let set = if risk > 0.0 { set.at_risk(risk) } else { set };
                !set.is_entered(trajectory.segments(), tolerance::TOUCH_M)
            };
            if !sets.has_domain() || clear(1.0) {
                return 1.0;
            }
            let [retained, _] = bisected([0.0, 1.0], RETAINED_HALVINGS, clear);
            retained
        })
    }

    /// Enlarges the smallest retained domain, and shrinks no other, by warm-started plans.
    fn with_larger_domains(&self, found: Attempt, retained: &[f64]) -> Attempt {
        let least = |scales: &[f64]| scales.iter().copied().fold(1.0, f64::min);
        let (mut best, mut retained) = (found, retained.to_vec());
        let (mut low, mut high) = (least(&retained), 1.0);
        for _ in 0..SCALE_HALVINGS {
            let scale = 0.5 * (low + high);
            let scales: Vec<f64> = retained.iter().map(|k| k.max(scale)).collect();
            let obstacles = level_sets(&self.scaled(&scales).0, best.risk);
            let problem = self.problem(&obstacles);
            let refined = |from| warm_started(self.scenario.planner, &problem, from);
            let Some(outcome) = best.planned.outcome.plan().and_then(refined) else {
                return best;
            };
            if matches!(outcome, Outcome::Deadline(_)) {
                return out_of_time(best);
            }
            let Some(plan) = outcome.plan() else {
                high = scale;
                continue;
            };
            retained = self.retained_along(&plan.trajectory, best.risk);
            low = least(&retained).max(scale);
            best.planned.outcome = outcome;
            best = self.clear_of(&best, &retained, RelaxationLevel::ReducedDomains);
        }
        best
    }
}

/// Marks an answer as one that the deadline kept from being improved. More time changes nothing where
/// the sets are not the reason.
pub(super) fn out_of_time(mut attempt: Attempt) -> Attempt {
    attempt.planned.outcome = match attempt.planned.outcome {
        Outcome::Solved(plan) => Outcome::Deadline(Some(plan)),
        Outcome::Infeasible(why) if why.is_for_the_sets() || is_inside(&why) => {
            attempt.why = Some(why);
            Outcome::Deadline(None)
        }
        other => other,
    };
    attempt
}

/// Length of a motion, metres.
fn sailed(motion: &[Segment]) -> f64 {
    motion.iter().map(Segment::length).sum()
}

/// A plan refined against other sets, by a planner that can.
fn warm_started(planner: &dyn Planner, problem: &Problem, from: &Plan) -> Option<Outcome> {
    let mut outcome = planner.warm_started(problem, &from.trajectory)?;
    if let Some(plan) = outcome.plan_mut() {
        plan.method = from.method.warm_started();
    }
    Some(outcome)
}

fn is_inside(why: &NoPlan) -> bool {
    matches!(
        why,
        NoPlan::StartInside { .. } | NoPlan::StartCovered { .. }
    )
}
