//! Several targets: those that are passed in one manoeuvre, and the manoeuvres one after another.

use std::rc::Rc;

use crate::search::{Search, Space, Stop};
use crate::space_time::context::Context;
use crate::space_time::manoeuvre::motion::part;
use crate::space_time::manoeuvre::speeds::ManoeuvreSpeeds;
use crate::space_time::rules::automaton::Effort;
use crate::space_time::rules::compliance::broken_rules;
use crate::space_time::rules::departure::can_hold_speed;
use crate::space_time::rules::manoeuvre::{Manoeuvre, Manoeuvres};
use crate::{Escape, PlannedManoeuvre, Problem, UnderWay};
use searoom_colregs::{Duty, Encountered};
use searoom_model::trajectory::Segment;

/// Greatest ratio of the cost of a plan that breaks no rule to that of the cheapest. *J* is squared: ten
/// times the distance. One manoeuvre around ships that are met an hour apart breaks no rule, but no
/// one would sail it.
const MOST_COST_RATIO: f64 = 100.0;

/// The same of a plan that breaks fewer rules than the cheapest, but some.
const MOST_UNLAWFUL_COST_RATIO: f64 = 1.5;

/// Most manoeuvres that are looked for, and most plans that the judges are asked for.
const MOST_EXPANDED: usize = 100;
const MOST_PLANS: usize = 8;

/// A plan by the rules.
pub(crate) struct RulePlan {
    pub motion: Vec<Segment>,
    /// The escape of a ship that stands on.
    pub escape: Option<Escape>,
    pub manoeuvres: Vec<PlannedManoeuvre>,
}

/// The cheapest lawful plan of manoeuvres one after another.
///
/// The next manoeuvre begins when own ship is on the route again. Several targets may be passed in
/// one manoeuvre: of the groupings the cheapest by the rules is taken; where none is, the one that breaks
/// the fewest, up to a price. `None` where no manoeuvre is found.
pub(crate) fn by_the_rules(
    context: &Context,
    nominal_motion: &[Segment],
    effort: Effort,
) -> Option<RulePlan> {
    let plan = cheapest(context, nominal_motion, effort);
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
    cheapest(&context, nominal_motion, effort)
}

fn cheapest(context: &Context, nominal_motion: &[Segment], effort: Effort) -> Option<RulePlan> {
    let root = Sailed {
        motion: nominal_motion.to_vec(),
        from: 0.0,
        cost: 0.0,
        // a manoeuvre under way is for the present risks, also where nothing would be met
        contact: match context.first_conflict(nominal_motion) {
            None if context.problem.under_way.is_some() => Some(0.0),
            contact => contact,
        },
        escape: None,
        manoeuvres: Vec::new(),
    };
    let mut graph = Sequences { context, effort };
    let mut search = Search::new(Step::Sailed(Rc::new(root)));
    let mut best: Option<(usize, Rc<Sailed>)> = None;
    let mut cheapest: Option<f64> = None;
    for _ in 0..MOST_PLANS {
        let Stop::Goal(goal) = search.next_goal(&mut graph, MOST_EXPANDED) else {
            break;
        };
        let Step::Sailed(plan) = &search.nodes()[goal].state else {
            break;
        };
        let broken = broken_rules(context.problem, &plan.motion);
        let most = match broken {
            0 => MOST_COST_RATIO,
            _ => MOST_UNLAWFUL_COST_RATIO,
        };
        let cheapest = *cheapest.get_or_insert(plan.cost);
        let better = |(least, _): &(usize, Rc<Sailed>)| broken < *least;
        if best.as_ref().is_none_or(better) && plan.cost <= most * cheapest {
            best = Some((broken, plan.clone()));
        }
        if broken == 0 {
            break;
        }
    }
    best.map(|(_, plan)| RulePlan {
        motion: plan.motion.clone(),
        escape: plan.escape,
        manoeuvres: plan.manoeuvres.clone(),
    })
}

/// Manoeuvres, and the route again: up to a time a part of a plan.
struct Sailed {
    /// To the end of the route.
    motion: Vec<Segment>,
    /// Seconds from which on the motion follows the route.
    from: f64,
    /// Cost until then, m²; to the end where nothing is met.
    cost: f64,
    /// Seconds at which the motion meets a set or land.
    contact: Option<f64>,
    escape: Option<Escape>,
    manoeuvres: Vec<PlannedManoeuvre>,
}

/// A node of the graph of sequences.
enum Step {
    Sailed(Rc<Sailed>),
    /// The next manoeuvre, toward all targets whose risk has begun `until` a time: looked for when it
    /// leaves the queue, as it costs hardly less than the one toward fewer targets.
    Wider {
        before: Rc<Sailed>,
        until: f64,
        /// Cost of the manoeuvre toward fewer targets, m².
        narrower: f64,
    },
}

/// The graph of sequences: an edge is a manoeuvre toward some of the targets that are not passed.
struct Sequences<'c, 'a> {
    context: &'c Context<'a>,
    effort: Effort<'c>,
}

impl Space for Sequences<'_, '_> {
    type State = Step;

    fn successors(&mut self, step: &Step, out: &mut Vec<(Step, f64)>) {
        match step {
            Step::Sailed(before) => {
                if let Some(contact) = before.contact {
                    self.add_manoeuvres(before, contact, 0.0, out);
                }
            }
            Step::Wider {
                before,
                until,
                narrower,
            } => self.add_manoeuvres(before, *until, *narrower, out),
        }
    }

    fn bound(&mut self, _: &Step) -> f64 {
        0.0
    }

    fn is_goal(&self, step: &Step) -> bool {
        matches!(step, Step::Sailed(sailed) if sailed.contact.is_none())
    }

    fn admits(&mut self, _: &Step) -> bool {
        true
    }

    fn is_out_of_time(&self) -> bool {
        self.effort.clock.is_up()
    }
}

impl Sequences<'_, '_> {
    /// Adds the manoeuvre toward the targets whose risk has begun until a time, and the node of that
    /// toward more of them.
    fn add_manoeuvres(
        &self,
        before: &Rc<Sailed>,
        until: f64,
        narrower: f64,
        out: &mut Vec<(Step, f64)>,
    ) {
        let problem = self.context.problem;
        let (from, number) = (before.from, before.manoeuvres.len());
        let begun = problem.under_way.filter(|_| number == 0);
        let contact = before.contact.unwrap_or(0.0);
        let most = problem.encountered.len() + usize::from(problem.under_way.is_some());
        // negated on purpose: a NaN is too early
        if number > most || !(contact >= from) {
            return;
        }
        let lasts = |e: &Encountered| begun.is_some() && e.risk_since <= 0.0;
        // negated on purpose: a NaN is not past
        let remaining = problem
            .encountered
            .iter()
            .filter(|e| !(e.tcpa <= from) || lasts(e));
        let toward = |until: f64| remaining.clone().filter(move |e| e.risk_since <= until);
        let group: Vec<Encountered> = toward(until).copied().collect();
        let all = group.len() == remaining.clone().count();
        let motion = (&before.motion[..], from);
        let found = resolved(
            self.context,
            &group,
            all,
            motion,
            contact,
            begun,
            self.effort,
        );
        let mut cost = narrower;
        let mut wider = f64::INFINITY;
        if let Some(found) = found {
            let joined = found.whole.joined;
            let stands_on = Duty::of(group.iter().map(|e| e.role)).stands_on;
            let holds = number == 0 && found.begun.is_none() && can_hold_speed(problem);
            let escape = (stands_on && holds).then(|| found.escape());
            let mut manoeuvres = before.manoeuvres.clone();
            manoeuvres.push(found.planned());
            let conflict = self.context.first_conflict(&found.whole.motion);
            cost = self.cost_of(&found, from, conflict.is_none());
            if toward(joined).count() > group.len() {
                wider = joined;
            }
            let sailed = Sailed {
                from: joined,
                cost: before.cost + cost,
                contact: conflict,
                escape: before.escape.or(escape),
                manoeuvres,
                motion: found.whole.motion,
            };
            out.push((Step::Sailed(Rc::new(sailed)), (cost - narrower).max(0.0)));
        }
        if !all {
            let next = Step::Wider {
                before: before.clone(),
                until: wider,
                narrower: cost.max(narrower),
            };
            out.push((next, (cost - narrower).max(0.0)));
        }
    }

    /// Cost of a manoeuvre from where the route was sailed before, m²: until own ship is on it again, or
    /// to the end.
    fn cost_of(&self, found: &Manoeuvre, from: f64, to_end: bool) -> f64 {
        let (problem, whole) = (self.context.problem, &found.whole);
        let sailed = match to_end {
            true => part(&whole.motion, from, f64::INFINITY),
            false => part(&whole.motion, from, whole.joined),
        };
        let error = match to_end {
            true => problem.error_to_end(&sailed),
            false => problem.error_of(&sailed),
        };
        error * whole.first.price()
    }
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
