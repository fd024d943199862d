//! Several targets: those that are passed in one manoeuvre, and the manoeuvres one after another.

use crate::space_time::context::Context;
use crate::space_time::manoeuvre::speeds::ManoeuvreSpeeds;
use crate::space_time::rules::automaton::Effort;
use crate::space_time::rules::compliance::broken_rules;
use crate::space_time::rules::departure::can_hold_speed;
use crate::space_time::rules::manoeuvre::{Manoeuvre, Manoeuvres};
use crate::{Escape, PlannedManoeuvre, Problem, UnderWay};
use searoom_colregs::{Duty, Encountered};
use searoom_model::trajectory::Segment;

/// Greatest ratio of J at which a grouping that breaks fewer rules replaces the best so far. J is
/// squared: ten times the distance. One manoeuvre around ships that are met an hour apart breaks no
/// rule, but no one would sail it.
const MOST_COST_RATIO: f64 = 100.0;

/// The same of a grouping that breaks fewer rules, but some.
const MOST_UNLAWFUL_COST_RATIO: f64 = 2.0;

/// A plan by the rules.
pub(crate) struct RulePlan {
    pub motion: Vec<Segment>,
    /// The escape of a ship that stands on.
    pub escape: Option<Escape>,
    pub manoeuvres: Vec<PlannedManoeuvre>,
}

/// Targets that are passed in one manoeuvre.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Together {
    /// Those whose risk has begun when the first set would be met.
    AtContact,
    /// Those whose risk has begun when own ship is on the route again.
    UntilJoined,
    All,
}

/// The cheapest manoeuvre for each conflict of the nominal motion, one after another.
///
/// The next manoeuvre begins when own ship is on the route again. Several targets may be passed in
/// one manoeuvre: the grouping that breaks the fewest rules is taken, up to a price. `None` where no
/// manoeuvre is found.
pub(crate) fn by_the_rules(
    context: &Context,
    nominal_motion: &[Segment],
    effort: Effort,
) -> Option<RulePlan> {
    let plan = in_groups(context, nominal_motion, effort);
    let begun = context.problem.under_way;
    if plan.is_some() || !begun.is_some_and(|begun| begun.is_returning) {
        return plan;
    }
    // too near the route for another line back to it: along the route
    let problem = Problem {
        under_way: None,
        ..*context.problem
    };
    let context = Context {
        problem: &problem,
        ..*context
    };
    in_groups(&context, nominal_motion, effort)
}

fn in_groups(context: &Context, nominal_motion: &[Segment], effort: Effort) -> Option<RulePlan> {
    // a manoeuvre under way is for the present risks, also where nothing would be met
    let contact = context.first_conflict(nominal_motion).unwrap_or(0.0);
    let mut encountered = context.problem.encountered.iter();
    if encountered.all(|e| e.risk_since <= contact) {
        return one_by_one(context, nominal_motion, Together::All, effort);
    }
    let mut best: Option<(usize, f64, RulePlan)> = None;
    for together in [Together::AtContact, Together::UntilJoined, Together::All] {
        let plan = one_by_one(context, nominal_motion, together, effort);
        let Some(plan) = plan else {
            continue;
        };
        let broken = broken_rules(context.problem, &plan.motion);
        let cost = context.problem.error_to_end(&plan.motion);
        let better = |(least, of, _): &(usize, f64, RulePlan)| {
            let most = match broken {
                0 => MOST_COST_RATIO,
                _ => MOST_UNLAWFUL_COST_RATIO,
            };
            broken < *least && cost <= most * of
        };
        if best.as_ref().is_none_or(better) {
            best = Some((broken, cost, plan));
        }
        let is_lawful = best.as_ref().is_some_and(|(least, ..)| *least == 0);
        if is_lawful || effort.clock.is_up() {
            break;
        }
    }
    best.map(|(_, _, plan)| plan)
}

fn one_by_one(
    context: &Context,
    nominal_motion: &[Segment],
    together: Together,
    effort: Effort,
) -> Option<RulePlan> {
    let encountered = context.problem.encountered;
    let mut kept = RulePlan {
        motion: nominal_motion.to_vec(),
        escape: None,
        manoeuvres: Vec::new(),
    };
    let mut from = 0.0;
    let most = encountered.len() + usize::from(context.problem.under_way.is_some());
    for step in 0..=most {
        let under_way = context.problem.under_way.filter(|_| step == 0);
        let contact = match context.first_conflict(&kept.motion) {
            Some(contact) => contact,
            None if under_way.is_some() => 0.0,
            None => return Some(kept),
        };
        // negated on purpose: a NaN is too early
        if !(contact >= from) {
            return None;
        }
        let lasts = |e: &Encountered| under_way.is_some() && e.risk_since <= 0.0;
        // negated on purpose: a NaN is not past
        let remaining = encountered.iter().filter(|e| !(e.tcpa <= from) || lasts(e));
        let mut until = match together {
            Together::All => f64::INFINITY,
            _ => contact,
        };
        let (group, found) = loop {
            let begun = remaining.clone().filter(|e| e.risk_since <= until);
            let group: Vec<_> = begun.copied().collect();
            let all = group.len() == remaining.clone().count();
            let motion = (&kept.motion[..], from);
            let found = resolved(context, &group, all, motion, contact, under_way, effort)?;
            let joined = found.whole.joined;
            let begins = |e: &Encountered| e.risk_since > until && e.risk_since < joined;
            if together != Together::UntilJoined || !remaining.clone().any(begins) {
                break (group, found);
            }
            until = joined;
        };
        if step == 0 {
            let stands_on = Duty::of(group.iter().map(|e| e.role)).stands_on;
            let holds = can_hold_speed(context.problem) && found.begun.is_none();
            kept.escape = (stands_on && holds).then(|| found.escape());
        }
        from = found.whole.joined;
        kept.manoeuvres.push(found.planned());
        kept.motion = found.whole.motion;
    }
    None
}

/// A manoeuvre toward some targets, from a motion that is on the route from a time on. One that is
/// under way goes on; where that cannot be, another begins.
fn resolved(
    context: &Context,
    group: &[Encountered],
    all: bool,
    motion: (&[Segment], f64),
    contact: f64,
    under_way: Option<UnderWay>,
    effort: Effort,
) -> Option<Manoeuvre> {
    let problem = Problem {
        encountered: group,
        under_way,
        ..*context.problem
    };
    let context = Context {
        problem: &problem,
        speeds: ManoeuvreSpeeds::at(&problem, contact),
        ..*context
    };
    let mut manoeuvres = Manoeuvres::new(&context, motion, all, effort);
    if let Some(begun) = under_way {
        let gone_on = manoeuvres.going_on(&begun);
        if begun.is_returning {
            return gone_on;
        }
        return gone_on.or_else(|| resolved(&context, group, all, motion, contact, None, effort));
    }
    match problem.duty().stands_on {
        true => manoeuvres.standing_on(contact),
        false => manoeuvres.giving_way(contact),
    }
}
