//! Several targets: those that are passed in one manoeuvre, and the manoeuvres one after another.

use std::collections::HashMap;
use std::rc::Rc;

use crate::search::{Search, Space, Stop};
use crate::space_time::context::Context;
use crate::space_time::manoeuvre::motion::part;
use crate::space_time::manoeuvre::speeds::ManoeuvreSpeeds;
use crate::space_time::rules::automaton::Effort;
use crate::space_time::rules::compliance::broken_rules;
use crate::space_time::rules::departure::can_hold_speed;
use crate::space_time::rules::manoeuvre::{Family, Manoeuvre, Manoeuvres};
use crate::{Escape, PlannedManoeuvre, Problem, UnderWay};
use searoom_colregs::{Duty, Encountered};
use searoom_model::trajectory::Segment;

/// A plan by the rules.
pub(crate) struct RulePlan {
    pub motion: Vec<Segment>,
    /// The escape of a ship that stands on.
    pub escape: Option<Escape>,
    pub manoeuvres: Vec<PlannedManoeuvre>,
}

/// The cheapest lawful plan of manoeuvres one after another, as far as a larger group costs no less than a
/// smaller one. The nominal motion meets a set or land, or comes within a length of a target, after `contact`
/// seconds.
///
/// The next manoeuvre begins when own ship is on the route again. Several targets may be passed in
/// one manoeuvre: of the groupings the cheapest by the rules is taken; where none is, the one that breaks
/// the fewest, up to a price. `None` where no manoeuvre is found. A manoeuvre takes about a millisecond; one is
/// looked for at most some hundred times.
pub(crate) fn by_the_rules(
    context: &Context,
    nominal_motion: &[Segment],
    contact: Option<f64>,
    effort: Effort,
) -> Option<RulePlan> {
    let plan = cheapest(context, nominal_motion, contact, effort);
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
    cheapest(&context, nominal_motion, contact, effort)
}

fn cheapest(
    context: &Context,
    nominal_motion: &[Segment],
    contact: Option<f64>,
    effort: Effort,
) -> Option<RulePlan> {
    let settings = &context.problem.settings.rules;
    let root = Begun {
        motion: nominal_motion.to_vec(),
        from: 0.0,
        cost: 0.0,
        // a manoeuvre under way is for the present risks, also where nothing would be met
        contact: match contact {
            None if context.problem.under_way.is_some() => Some(0.0),
            contact => contact,
        },
        escape: None,
        manoeuvres: Vec::new(),
    };
    let root = Rc::new(root);
    let mut graph = Sequences {
        context,
        effort,
        known: HashMap::new(),
    };
    // one plan first: the time may soon be up
    let first = graph.finished(root.clone(), Group::AtContact);
    let mut search = Search::new(Step::Begun(root.clone()));
    let most_expanded = settings.groups_per_target * (context.problem.encountered.len() + 1);
    let mut best: Option<(usize, Rc<Begun>)> = None;
    let mut cheapest: Option<f64> = None;
    let mut judge = |plan: &Rc<Begun>| {
        let cheapest = *cheapest.get_or_insert(plan.cost);
        let broken = broken_rules(context.problem, &plan.motion);
        let most = match broken {
            0 => settings.most_cost_ratio,
            _ => settings.most_unlawful_cost_ratio,
        };
        let better = best.as_ref().is_none_or(|(least, _)| broken < *least);
        if better && plan.cost <= most * cheapest {
            best = Some((broken, plan.clone()));
        }
        // the next ones cost no less
        broken == 0 || plan.cost > settings.most_cost_ratio * cheapest
    };
    let mut is_decided = false;
    for _ in 0..settings.most_plans {
        let Stop::Goal(goal) = search.next_goal(&mut graph, most_expanded) else {
            break;
        };
        is_decided = judge(search.nodes()[goal].state.begun());
        if is_decided {
            break;
        }
    }
    // where the limits or the time end the search: what is known, and larger groups throughout
    if !is_decided {
        let joined = graph.finished(root.clone(), Group::UntilJoined);
        let all = graph.finished(root.clone(), Group::All);
        for plan in [first, joined, all].iter().flatten() {
            if judge(plan) {
                break;
            }
        }
    }
    best.map(|(_, plan)| RulePlan {
        motion: plan.motion.clone(),
        escape: plan.escape,
        manoeuvres: plan.manoeuvres.clone(),
    })
}

/// The beginning of a plan: manoeuvres, until own ship follows the route again.
struct Begun {
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

impl Begun {
    fn is_whole(&self) -> bool {
        self.contact.is_none()
    }
}

/// Targets toward which a manoeuvre is made.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Group {
    /// Those whose risk has begun when the next set would be met.
    AtContact,
    /// Those whose risk begins before own ship is on the route again.
    UntilJoined,
    All,
}

/// A node of the graph of sequences.
enum Step {
    Begun(Rc<Begun>),
    /// The next manoeuvre toward a larger group: all targets whose risk has begun `until` a time. It is
    /// looked for when this node leaves the queue, as it mostly costs no less than that toward the smaller
    /// group.
    LargerGroup {
        before: Rc<Begun>,
        until: f64,
        /// Cost of the manoeuvre toward the smaller group, m².
        smaller: f64,
    },
}

impl Step {
    /// The beginning of the plan that it is, or goes on with.
    fn begun(&self) -> &Rc<Begun> {
        let (Self::Begun(begun) | Self::LargerGroup { before: begun, .. }) = self;
        begun
    }
}

/// The graph of sequences: an edge is a manoeuvre toward some of the targets that are not passed.
struct Sequences<'c, 'a> {
    context: &'c Context<'a>,
    effort: Effort<'c>,
    /// The manoeuvres that were looked for, by the beginning that they go on with and the size of the group.
    known: HashMap<(*const Begun, usize), Option<Rc<Begun>>>,
}

impl Space for Sequences<'_, '_> {
    type State = Step;

    fn successors(&mut self, step: &Step, out: &mut Vec<(Step, f64)>) {
        let (before, until, smaller) = match step {
            Step::Begun(before) => (before, before.contact, 0.0),
            Step::LargerGroup {
                before,
                until,
                smaller,
            } => (before, Some(*until), *smaller),
        };
        let Some(until) = until else {
            return;
        };
        let (mut cost, mut larger) = (smaller, f64::INFINITY);
        if let Some(begun) = self.manoeuvre(before, until) {
            if self.size(before, begun.from) > self.size(before, until) {
                larger = begun.from;
            }
            let own = begun.cost - before.cost;
            // a NaN is no cost, and not admitted
            cost = if own < smaller { smaller } else { own };
            // at the same cost it is the same manoeuvre
            if own != smaller {
                out.push((Step::Begun(begun), cost - smaller));
            }
        }
        let all = self.remaining(before).all(|e| has_begun(e, until));
        if !all && cost.is_finite() {
            let next = Step::LargerGroup {
                before: before.clone(),
                until: larger,
                smaller: cost,
            };
            out.push((next, cost - smaller));
        }
    }

    fn bound(&mut self, _: &Step) -> f64 {
        0.0
    }

    fn is_goal(&self, step: &Step) -> bool {
        matches!(step, Step::Begun(begun) if begun.is_whole())
    }

    fn admits(&mut self, _: &Step) -> bool {
        true
    }

    fn is_out_of_time(&self) -> bool {
        self.effort.clock.is_up()
    }
}

/// True where a risk has begun by a time. One that begins at no time has.
fn has_begun(encountered: &Encountered, until: f64) -> bool {
    // negated on purpose: a NaN is a risk
    !(encountered.risk_since > until)
}

impl<'a> Sequences<'_, 'a> {
    /// A beginning to its end, with a manoeuvre toward such a group at each conflict.
    fn finished(&mut self, begun: Rc<Begun>, group: Group) -> Option<Rc<Begun>> {
        let mut last = begun;
        while let Some(contact) = last.contact {
            let mut until = match group {
                Group::All => f64::INFINITY,
                Group::AtContact | Group::UntilJoined => contact,
            };
            let mut next = self.manoeuvre(&last, until)?;
            while group == Group::UntilJoined
                && self.size(&last, next.from) > self.size(&last, until)
            {
                until = next.from;
                next = self.manoeuvre(&last, until)?;
            }
            last = next;
        }
        Some(last)
    }

    /// Number of targets that are not passed and whose risk has begun by a time.
    fn size(&self, before: &Begun, until: f64) -> usize {
        let remaining = self.remaining(before);
        remaining.filter(|e| has_begun(e, until)).count()
    }

    /// The manoeuvre under way that a beginning goes on with.
    fn under_way(&self, before: &Begun) -> Option<UnderWay> {
        let begun = self.context.problem.under_way;
        begun.filter(|_| before.manoeuvres.is_empty())
    }

    /// The targets that are not passed.
    fn remaining(&self, before: &Begun) -> impl Iterator<Item = &'a Encountered> + use<'a> {
        let (from, under_way) = (before.from, self.under_way(before).is_some());
        let all = self.context.problem.encountered.iter();
        // negated on purpose: a NaN is not past
        all.filter(move |e| !(e.tcpa <= from) || under_way && e.risk_since <= 0.0)
    }

    /// A beginning with the next manoeuvre, toward the targets whose risk has begun until a time.
    fn manoeuvre(&mut self, before: &Rc<Begun>, until: f64) -> Option<Rc<Begun>> {
        let remaining = self.remaining(before);
        let group: Vec<Encountered> = remaining.filter(|e| has_begun(e, until)).copied().collect();
        let key = (Rc::as_ptr(before), group.len());
        if let Some(known) = self.known.get(&key) {
            return known.clone();
        }
        let found = self.resolved(before, &group).map(Rc::new);
        self.known.insert(key, found.clone());
        found
    }

    fn resolved(&self, before: &Begun, group: &[Encountered]) -> Option<Begun> {
        let problem = self.context.problem;
        let (from, number) = (before.from, before.manoeuvres.len());
        let contact = before.contact?;
        // no target is passed twice, but after a manoeuvre under way
        let most = problem.encountered.len() + usize::from(problem.under_way.is_some());
        // negated on purpose: a NaN is too early
        if number >= most || !(contact >= from) {
            return None;
        }
        let all = group.len() == self.remaining(before).count();
        let (motion, under_way) = ((&before.motion[..], from), self.under_way(before));
        let effort = self.effort;
        let found = resolved(self.context, group, all, motion, contact, under_way, effort)?;
        let stands_on = Duty::of(group.iter().map(|e| e.role)).stands_on;
        let holds = number == 0 && found.begun.is_none() && can_hold_speed(problem);
        let escape = (stands_on && holds).then(|| found.escape());
        let mut manoeuvres = before.manoeuvres.clone();
        manoeuvres.push(found.planned());
        let conflict = self.context.first_conflict(&found.whole.motion);
        Some(Begun {
            from: found.whole.joined,
            cost: before.cost + self.cost_of(&found, from, conflict.is_none()),
            contact: conflict,
            escape: before.escape.or(escape),
            manoeuvres,
            motion: found.whole.motion,
        })
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
        error * found.price
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
    let family = Family::by_the_rules(group, &context.problem.settings.rules);
    let mut manoeuvres = Manoeuvres::new(&context, motion, all, family, effort);
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
