//! The table of relaxation levels, from the request to the least risk.
//!
//! A row says what its plan may claim, where it applies, which domains are planned against, where the plan comes
//! from, and how much of the domains is claimed in the end. [`Relaxer::of_levels`] asks one row after another.

use self::{Applies::*, Keeps::*, Source::*};
use super::RelaxationLevel::{self, *};
use super::{Attempt, RISK_STEP, Relaxer, out_of_time, sailed, warm_started};
use crate::obstacle::level_sets;
use crate::planner::{Outcome, Plan, Planned};
use crate::scenario::Scenario;
use crate::tolerance;
use crate::trajectory::{DesiredTrajectory, Segment};

/// Scale factor of a domain: the hard set, half way, and the full ship domain.
const HARD: f64 = 0.0;
const HALF: f64 = 0.5;
const FULL: f64 = 1.0;

/// Seconds between the next plan and the end of a remainder that is kept until then.
const BEFORE_END_S: f64 = 2.0;

/// A row of the table.
pub(super) struct Level {
    /// What its plan satisfies; where no domains are asked for, none is given up.
    claims: RelaxationLevel,
    applies: Applies,
    source: Source,
    /// Scale factors of all domains that a search plans against, in this order. A planner may find a way around a
    /// larger set and miss it for a smaller one, so some rows also plan against more than they require.
    scales: &'static [f64],
    /// What a search or a detour keeps of the domains; a remainder keeps what it is clear of.
    keeps: Keeps,
}

/// Where a row applies.
#[derive(Clone, Copy)]
enum Applies {
    Always,
    /// Rules are asked for, and some target has a role.
    IfRules,
    /// Besides, some target has a ship domain.
    IfRulesAndDomains,
    /// Ship domains are asked for.
    IfDomains,
    /// Besides, some target has one.
    IfSomeDomains,
    /// Some target has a ship domain that is not asked for, and the planner does not follow paths: one that does
    /// finds the plan around a larger set around the smaller one, too.
    IfOthersHelp,
}

/// Where the plan of a row comes from.
#[derive(Clone, Copy)]
enum Source {
    /// A search.
    Search,
    /// Besides, where a risk is accepted, a search for a plan that takes none.
    SearchAtNoRisk,
    /// The remainder of the last plan, if it is clear of the hard sets.
    Remainder,
    /// Besides, if it breaks no rule.
    LawfulRemainder,
    /// The remainder of a last plan that ends on the way.
    UnfinishedRemainder,
    /// A wide detour around the hard sets.
    WideDetour,
    /// The mission cut before the sets that cover its end, or where the last plan ends.
    CutMission,
    /// Searches at smaller and smaller risks.
    LeastRisk,
}

/// How much of the domains the plan of a row claims.
#[derive(Clone, Copy)]
enum Keeps {
    /// What was planned against.
    AsPlanned,
    /// As much as it happens to be clear of.
    Along,
    /// Besides, the smallest one is enlarged by warm-started plans.
    Enlarged,
}

const fn row(
    claims: RelaxationLevel,
    applies: Applies,
    source: Source,
    scales: &'static [f64],
    keeps: Keeps,
) -> Level {
    Level {
        claims,
        applies,
        source,
        scales,
        keeps,
    }
}

pub(super) const LAWFUL_REMAINDER: Level = row(Rules, IfRules, LawfulRemainder, &[HARD], Along);
pub(super) const BY_THE_RULES: Level = row(Rules, IfRulesAndDomains, Search, &[HALF, HARD], Along);
pub(super) const CLEAR_OF_DOMAINS: Level =
    row(Domains, IfRules, SearchAtNoRisk, &[FULL], AsPlanned);
pub(super) const REMAINDER: Level = row(ReducedDomains, IfDomains, Remainder, &[HARD], Along);

/// The rows below the request, in the order in which they are asked. Where none has a plan, the motion with the
/// least harm answers.
#[rustfmt::skip]
const BELOW: [Level; 12] = [
    LAWFUL_REMAINDER,
    BY_THE_RULES,
    CLEAR_OF_DOMAINS,
    REMAINDER,
    row(ReducedDomains, IfSomeDomains, Search,              &[HARD, HALF], Enlarged),
    row(ReducedDomains, IfOthersHelp,  Search,              &[FULL, HALF], Along),
    row(ReducedDomains, Always,        WideDetour,          &[HARD],       Enlarged),
    row(Waiting,        Always,        CutMission,          &[HARD],       AsPlanned),
    row(Waiting,        IfDomains,     Search,              &[FULL],       AsPlanned),
    row(Waiting,        Always,        Search,              &[HARD],       Along),
    row(ReducedDomains, Always,        UnfinishedRemainder, &[HARD],       Along),
    row(Risk,           Always,        LeastRisk,           &[HARD],       AsPlanned),
];

impl Relaxer<'_> {
    /// The answer of the first row of [`BELOW`] that has one.
    pub(super) fn of_levels(&self) -> Option<Attempt> {
        BELOW
            .iter()
            .find_map(|level| self.of_level(level, |_| true))
    }

    /// The plan of a row, an `accepted` one where several are made; `None` where the row does not apply or has
    /// none. An attempt without a plan says that the time ran out.
    pub(super) fn of_level(
        &self,
        level: &Level,
        accepted: impl Fn(&Attempt) -> bool,
    ) -> Option<Attempt> {
        if !self.applies(level.applies) {
            return None;
        }
        let Level { claims, scales, .. } = *level;
        // a plan along paths for a larger set is also found for the smaller one
        let tried = match level.keeps {
            Enlarged if self.follows_paths() => 1,
            _ => scales.len(),
        };
        match level.source {
            Search if claims == Waiting && self.is_infeasible_alone() => None,
            Search | SearchAtNoRisk => scales[..tried].iter().find_map(|scale| {
                let scales = self.scales(*scale);
                let found = match level.source {
                    SearchAtNoRisk => self.at_most_the_risk(claims, &scales, &accepted),
                    _ => self.attempt(claims, &scales, self.scenario.max_risk),
                };
                // by the rules, time that is up is for the levels below to say: they give up less
                let is_late = claims == Rules && found.trajectory().is_none();
                let found = (!found.is_infeasible() && !is_late).then(|| self.kept(found, level));
                found.filter(&accepted)
            }),
            Remainder => Some(self.remainder_clear_of_hard_sets(claims)?.0),
            LawfulRemainder => {
                let (found, broken) = self.remainder_clear_of_hard_sets(claims)?;
                (broken == 0).then_some(found)
            }
            UnfinishedRemainder => self.unfinished_remainder(claims),
            WideDetour => Some(self.kept(self.wide_detour(claims)?, level)),
            CutMission => self.cut(0.5),
            LeastRisk => self.at_least_risk(claims),
        }
    }

    fn applies(&self, applies: Applies) -> bool {
        let are_asked = self.are_domains_asked();
        match applies {
            Always => true,
            IfRules => self.are_rules_asked(),
            IfRulesAndDomains => self.are_rules_asked() && self.has_domains(),
            IfDomains => are_asked,
            IfSomeDomains => are_asked && self.has_domains(),
            IfOthersHelp => !are_asked && self.has_domains() && !self.follows_paths(),
        }
    }

    /// The attempt with what it keeps of the domains. Where they are not asked for, that is the hard sets.
    fn kept(&self, found: Attempt, level: &Level) -> Attempt {
        let (Some(trajectory), Along | Enlarged) = (found.trajectory(), level.keeps) else {
            return found;
        };
        let claims = self.claimed(level.claims);
        if !self.are_domains_asked() {
            return self.clear_of(&found, &self.scales(HARD), claims);
        }
        let retained = self.retained_along(trajectory, found.risk);
        let clear = self.clear_of(&found, &retained, claims);
        match level.keeps {
            Enlarged => self.with_larger_domains(clear, &retained),
            _ => clear,
        }
    }

    /// The level that a plan clear of the hard sets has: it gives up no domain that nobody asked for.
    fn claimed(&self, level: RelaxationLevel) -> RelaxationLevel {
        match level {
            ReducedDomains if !self.are_domains_asked() => Compliant,
            level => level,
        }
    }

    /// A wide detour around the hard sets, refined where that is cheaper.
    fn wide_detour(&self, level: RelaxationLevel) -> Option<Attempt> {
        let (planner, risk) = (self.scenario.planner, self.scenario.max_risk);
        let whole: Vec<_> = self.sets.iter().map(|s| s.hard.clone()).collect();
        let obstacles = level_sets(&whole, risk);
        let mut planned = planner.wide_detour(&self.problem(&obstacles))?;
        let wide = planned.outcome.plan()?;
        let refined = warm_started(planner, &self.problem(&obstacles), wide);
        let plan = match refined.as_ref().and_then(Outcome::plan) {
            Some(refined) if refined.cost < wide.cost => refined.clone(),
            _ => wide.clone(),
        };
        planned.outcome = match refined {
            Some(Outcome::Deadline(_)) => Outcome::Deadline(Some(plan)),
            _ => Outcome::Solved(plan),
        };
        let reductions = vec![0.0; whole.len()];
        Some(Attempt::of(
            level, whole, reductions, obstacles, risk, planned,
        ))
    }

    /// The remainder of a last plan that ends on the way, if it is clear of the hard sets and another plan is due
    /// before its end. Until then it is better than a risk.
    fn unfinished_remainder(&self, level: RelaxationLevel) -> Option<Attempt> {
        let (own, path) = (&self.scenario.own_ship, &self.scenario.desired);
        let last = self.scenario.memory.remainder.last()?;
        if last.end_time() < self.scenario.simulation.replan + BEFORE_END_S {
            return None;
        }
        let end = last.end().position;
        let left = path.left_from(end, sailed(&self.scenario.memory.remainder));
        // the schedule may be past that end
        let to_end = || DesiredTrajectory::new(&[own.pose.position, end], &[path.legs()[0].speed]);
        let short = Scenario {
            desired: path.shortened(left).or_else(|| to_end().ok())?,
            ..self.scenario.clone()
        };
        let of_short = self.of(&short, self.sets);
        let (mut found, _) = of_short.remainder_clear_of_hard_sets(self.claimed(level))?;
        if let Outcome::Solved(plan) = &mut found.planned.outcome {
            plan.to_go = left;
        }
        Some(found)
    }

    /// The answer for the mission cut before the hard sets that cover
    /// its end, or else where the last plan ends, each within a share of the time. It keeps the level
    /// of that answer. Without one the plan ends where own ship is, if the place is within its
    /// turning radius. After the deadline only the remainder of the last plan is considered.
    pub(super) fn cut(&self, share: f64) -> Option<Attempt> {
        let risk = self.scenario.max_risk;
        let (whole, reductions) = self.asked(&self.scales(0.0));
        let hard = level_sets(&whole, risk);
        let problem = self.problem(&hard);
        let (why, desired) = self.scenario.planner.short_of_end(&problem)?;
        let needs_time = desired.is_some() && self.scenario.memory.remainder.is_empty();
        if needs_time && self.time_left().is_zero() {
            return None;
        }
        let (own, path) = (&self.scenario.own_ship, &self.scenario.desired);
        let away = |short: &DesiredTrajectory| (short.end() - own.pose.position).norm();
        let is_near = desired.as_ref().map_or(0.0, away) <= own.turning_radius;
        let kept = &self.scenario.memory.remainder;
        let left = |last: &Segment| path.left_from(last.end().position, sailed(kept));
        let left = kept.last().map(left);
        let left = left.filter(|left| *left > tolerance::ARRIVAL_M);
        let before = left.and_then(|left| path.shortened(left));
        let mut late = false;
        let answer = desired.into_iter().chain(before).find_map(|desired| {
            let short = Scenario {
                desired,
                deadline: self.scenario.deadline - (1.0 - share) * self.time_left().as_secs_f64(),
                ..self.scenario.clone()
            };
            let answer = self.of(&short, self.sets).answer_of_one_search();
            late |= matches!(answer.planned.outcome, Outcome::Deadline(_));
            let arrives = answer.level < Waiting;
            (arrives && answer.trajectory().is_some()).then_some(answer)
        });
        if late {
            self.is_cut_short.set(true);
        }
        let mut found = match answer {
            Some(answer) => answer,
            None if is_near && !late => {
                let planned = Planned::of(Outcome::Solved(Plan::staying(&problem)?));
                let level = self.claimed(ReducedDomains);
                let found = Attempt::of(level, whole, reductions, hard, risk, planned);
                match self.are_domains_asked() {
                    true => {
                        let retained = self.retained_along(found.trajectory()?, risk);
                        self.clear_of(&found, &retained, level)
                    }
                    false => found,
                }
            }
            None => return None,
        };
        if let Outcome::Solved(plan) | Outcome::Deadline(Some(plan)) = &mut found.planned.outcome {
            let motion = &plan.trajectory;
            plan.to_go = path.left_from(motion.end().position, motion.length());
        }
        found.why = Some(why);
        Some(found)
    }

    /// The plan at the least risk for which one was found, by bisection
    /// to [`RISK_STEP`]. Along paths a motion that does not arrive counts as a plan.
    fn at_least_risk(&self, level: RelaxationLevel) -> Option<Attempt> {
        let hard = self.scales(0.0);
        let at = |risk: f64| {
            let found = self.attempt(level, &hard, risk);
            if self.follows_paths() && found.is_infeasible() {
                return Attempt {
                    level,
                    ..self.attempt(Waiting, &hard, risk)
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
            if self.time_left().is_zero() {
                return Some(out_of_time(best));
            }
            let risk = 0.5 * (low + high);
            let tried = self.warm_started(&best, risk).unwrap_or_else(|| at(risk));
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
}
