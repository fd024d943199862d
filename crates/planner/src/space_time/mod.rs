//! Space-time planner: searches a graph of Dubins segments tangent to the obstacles for the least
//! space-time error, then refines the result.
//!
//! ```text
//! route ─► nominal motion ─► graph (A*) ─► initial guesses ─► SQP ─► exact test ─► plan
//! ```
//!
//! The graph decides the sides, the order and whether to wait. The refinement optimises the
//! lengths; speeds stay in the finite set. The cheapest candidate that passes the exact contact
//! test wins. The graph's own best plan is one of the candidates.
//!
//! All steps share `manoeuvre`. Each directory uses only those before it in the order `manoeuvre`,
//! `graph` and `grid`, `refinement`, `rules`, `selection`, `fallback`.
//!
//! Where own ship has a duty by the collision regulations, `rules` plans instead: it searches a graph
//! of manoeuvres by the rules. Tidy plans toward sets without roles are looked for in that graph, too.

mod bound;
mod context;
mod covered_end;
mod fallback;
mod graph;
mod grid;
mod land;
mod manoeuvre;
pub(super) mod piece;
mod proxy;
mod refinement;
mod route;
mod rules;
mod selection;
pub mod settings;
mod similarity;

pub use bound::Heuristic;
pub use fallback::escape::{after_holding, nominal_motion};
pub(super) use fallback::harm::NominalHulls;
pub use selection::warm_start::warm_started;
pub use settings::SpaceTimeSettings;

use std::cell::RefCell;

use super::clock::Clock;
use super::{
    ExploredGraph, Minimises, NoPlan, NominalTarget, Outcome, Plan, PlanMethod, PlanRequest,
    Planned, Planner, PlannerFacts, PlannerKind, Problem, SearchKind, SearchStats,
};
use crate::search::{Search, Stop};
use context::Context;
use covered_end::end_covered;
use fallback::off_station::off_station;
use fallback::sequential;
use fallback::waiting::waiting;
use graph::Graph;
use graph::node::{self, State};
use grid::hybrid_a_star;
use manoeuvre::conflict::Conflict;
use piece::pieces;
use proxy::{Proxy, by_obstacle, first_contact, first_met, within_reach};
use route::Route;
use rules::automaton::{Effort, Explored};
use rules::bodies::first_within_a_length;
use rules::compliance::broken_rules;
use rules::groups::{self, RulePlan};
use searoom_geometry::tolerance;
use searoom_model::trajectory::{DesiredTrajectory, Segment, Trajectory};
use searoom_parallel as parallel;
use searoom_sets::{LAND, SpaceTimeObstacle};
use selection::Selection;
use selection::coarse_search::CoarseSearch;
use settings::SearchBudget;
use similarity::Similarity;

/// Searches a graph, and refines the result.
pub struct SpaceTimePlanner;

impl Planner for SpaceTimePlanner {
    fn facts(&self) -> &'static PlannerFacts {
        &PlannerFacts {
            name: const { PlannerKind::SpaceTime.word() },
            label: "space-time",
            minimises: Minimises::SpaceTimeError,
            follows_paths: false,
            keeps_off_land: true,
            keeps_rules: true,
            uses_ellipses: false,
            relaxes_domains_only: false,
            has_no_return: true,
            searches: &[
                SearchKind::AStar,
                SearchKind::Dijkstra,
                SearchKind::Thorough,
            ],
        }
    }

    fn plan(&self, request: &PlanRequest) -> Planned {
        let problem = &request.problem;
        match request.may_wait {
            true => waiting(problem, Clock::new(problem.deadline)),
            false => plan(problem),
        }
    }

    fn warm_started(&self, problem: &Problem, from: &Trajectory) -> Option<Outcome> {
        Some(warm_started(problem, from).outcome)
    }

    fn wide_detour(&self, problem: &Problem) -> Option<Planned> {
        let clock = Clock::new(problem.deadline);
        let planned = plan_normalised(problem, clock, |problem, proxies, _| {
            if let Some(covered) = end_covered(problem, proxies) {
                return Planned::of(Outcome::Infeasible(covered));
            }
            hybrid_a_star::hybrid_a_star(problem, clock)
                .unwrap_or_else(|| Planned::of(Outcome::Infeasible(NoPlan::NoTrajectory)))
        });
        planned.outcome.plan().is_some().then_some(planned)
    }

    fn short_of_end(&self, problem: &Problem) -> Option<(NoPlan, Option<DesiredTrajectory>)> {
        covered_end::short_of_end(problem)
    }

    fn off_station(&self, problem: &Problem, arrival: &[Segment], until: f64) -> Vec<Plan> {
        off_station(problem, arrival, until)
    }

    fn let_pass(
        &self,
        problem: &Problem,
        broken: &dyn Fn(&Trajectory) -> usize,
        most: usize,
    ) -> Option<Plan> {
        fallback::let_pass::let_pass(problem, broken, most)
    }

    fn leaving_sets(&self, problem: &Problem, nominal: &[NominalTarget]) -> Option<Planned> {
        fallback::escape::escape(problem, nominal)
    }
}

/// Plans one problem.
///
/// The plan is clear of every obstacle to rounding (never deeper than 1e-7 m). It keeps the turning
/// radius, uses only the given speeds, and ends at the last waypoint before the horizon. It is the
/// cheapest of the candidates, not proven to be globally optimal. Equal problems give equal plans
/// unless the deadline is reached. Waypoints on a straight line change nothing.
pub fn plan(problem: &Problem) -> Planned {
    let clock = Clock::new(problem.deadline);
    plan_normalised(problem, clock, |problem, proxies, _| {
        plan_clear_of(problem, proxies, clock)
    })
}

/// Plans a problem in normalised coordinates. Where the restored plan touches a set, or stays at the
/// start of a round trip that vanishes at the normalised size, plans it without scaling; where that
/// does so too, plans the original problem.
fn plan_normalised(
    problem: &Problem,
    clock: Clock,
    plan: impl Fn(&Problem, &[Proxy], Option<&Similarity>) -> Planned,
) -> Planned {
    let desired = problem.desired.straightened();
    let problem = &Problem {
        desired: &desired,
        ..*problem
    };
    let pieces = pieces(problem.obstacles, problem.horizon);
    let proxies = within_reach(problem, &pieces);
    let similarity = Similarity::of(problem, &proxies);
    let found = plan_transformed(problem, &proxies, &similarity, clock, &plan).or_else(|| {
        let similarity = similarity.without_scaling()?;
        plan_transformed(problem, &proxies, &similarity, clock, &plan)
    });
    found.unwrap_or_else(|| plan(problem, &proxies, None))
}

fn plan_transformed(
    problem: &Problem,
    proxies: &[Proxy],
    similarity: &Similarity,
    clock: Clock,
    plan: impl Fn(&Problem, &[Proxy], Option<&Similarity>) -> Planned,
) -> Option<Planned> {
    let normalised = similarity.normalised(problem, clock)?;
    let normalised = normalised.problem(problem);
    let pieces = pieces(normalised.obstacles, normalised.horizon);
    let planned = plan(
        &normalised,
        &within_reach(&normalised, &pieces),
        Some(similarity),
    );
    let planned = similarity.restored(planned, problem.horizon);
    let touches = |plan: &Plan| {
        let segments = plan.trajectory.segments();
        first_met(proxies, segments).is_some() || land::meets(problem.land_obstacle, segments)
    };
    let stays = |plan: &Plan| {
        let sailed: f64 = plan.trajectory.segments().iter().map(Segment::length).sum();
        sailed <= tolerance::ARRIVAL_M && problem.desired.comes_by(problem.own.pose.position)
    };
    let is_wrong = |plan: &Plan| touches(plan) || stays(plan);
    (!planned.outcome.plan().is_some_and(is_wrong)).then_some(planned)
}

/// True where own ship starts at the last waypoint and the path is not a round trip.
fn has_arrived(problem: &Problem) -> bool {
    let here = problem.own.pose.position;
    let at_end = (problem.desired.end() - here).norm() <= tolerance::LENGTH_M;
    // a path that passes own ship's position earlier, as a round trip does, remains to be followed
    at_end && !problem.desired.comes_by(here)
}

fn plan_clear_of(problem: &Problem, proxies: &[Proxy], clock: Clock) -> Planned {
    plan_with(problem, proxies, clock, None)
}

/// Clear motions to the last waypoint that leave the route once and pass the sets in different
/// ways, the plan first.
fn ways_in_one_manoeuvre(problem: &Problem, proxies: &[Proxy], clock: Clock) -> Vec<Vec<Segment>> {
    let mut others = Vec::new();
    let planned = plan_with(problem, proxies, clock, Some(&mut others));
    let plan = planned.outcome.into_plan();
    let plan = plan.map(|plan| plan.trajectory.segments().to_vec());
    plan.into_iter().chain(others).collect()
}

/// Plans one problem. If `others` is given, plans a single departure from the route and returns its
/// alternatives there.
fn plan_with(
    problem: &Problem,
    proxies: &[Proxy],
    clock: Clock,
    others: Option<&mut Vec<Vec<Segment>>>,
) -> Planned {
    let refuse = |reason| Planned::of(Outcome::Infeasible(reason));
    let own = problem.own;
    for proxy in proxies {
        if let Some(slack) = proxy.slack(own.pose.position, 0.0)
            // negated on purpose: a NaN is inside
            && !(slack >= -tolerance::TOUCH_M)
        {
            return refuse(NoPlan::StartInside {
                target: problem.obstacles[proxy.obstacle].name().to_owned(),
                depth: -slack,
            });
        }
    }
    if let Some(depth) = problem.land_obstacle.depth(own.pose.position)
        // negated on purpose: a NaN is on land
        && !(depth <= tolerance::TOUCH_M)
    {
        return refuse(NoPlan::StartOnLand { depth });
    }
    if has_arrived(problem) {
        let plan = Plan::staying(problem);
        return Planned::of(plan.map_or(Outcome::Infeasible(NoPlan::NoRoute), Outcome::Solved));
    }
    let Some(route) = Route::new(problem, clock) else {
        return refuse(NoPlan::NoRoute);
    };
    let nominal_motion = route.follow(0.0, 0.0);
    let arrival = nominal_motion.last().map_or(0.0, Segment::end_time);
    // negated on purpose: a NaN is too late
    if !(arrival <= problem.horizon) {
        return refuse(NoPlan::HorizonTooShort {
            earliest: arrival,
            horizon: problem.horizon,
        });
    }
    if let Some(covered) = end_covered(problem, proxies) {
        return refuse(covered);
    }
    let blocks = land::proxies(problem);
    let contact = first_contact(proxies, &nominal_motion);
    let grounding = land::first_contact(problem.land_obstacle, &nominal_motion);
    let first_conflict = contact.map(|c| c.1).into_iter().chain(grounding);
    let first_conflict = first_conflict.reduce(f64::min);
    let at = first_conflict.unwrap_or(0.0);
    let context = Context::new(problem, &route, proxies, &blocks, at);
    let is_clear = first_conflict.is_none() && problem.under_way.is_none();
    let too_near = is_clear.then(|| first_within_a_length(&context, &nominal_motion));
    let too_near = too_near.flatten();
    let due = first_conflict.or(too_near);
    let has_duty = !problem.duty().is_none() && due.is_some();
    if has_duty || problem.under_way.is_some() {
        let explored = RefCell::default();
        let effort = Effort {
            clock,
            explored: &explored,
        };
        let kept = groups::by_the_rules(&context, &nominal_motion, due, effort);
        let is_lawful = |kept: &RulePlan| broken_rules(problem, &kept.motion) == 0;
        let kept = kept.filter(|kept| too_near.is_none() || is_lawful(kept));
        let Explored { counts, graph } = explored.into_inner();
        if let Some(kept) = kept {
            let plan = Plan::measured(problem, kept.motion, PlanMethod::Rules);
            let outcome = match plan {
                Some(plan) if clock.is_up() => Outcome::Deadline(Some(plan)),
                Some(plan) => Outcome::Solved(plan),
                None => Outcome::Infeasible(NoPlan::NoRoute),
            };
            return Planned {
                escape: kept.escape,
                manoeuvres: kept.manoeuvres,
                stats: Some(counts),
                explored: graph,
                ..Planned::of(outcome)
            };
        }
        if clock.is_up() && too_near.is_none() {
            return Planned::of(Outcome::Deadline(None));
        }
        if first_conflict.is_some() {
            return refuse(no_candidate(problem, contact, grounding));
        }
    }
    // the graph alone takes milliseconds around hundreds of sets
    if first_conflict.is_some() && clock.is_up() {
        return Planned::of(Outcome::Deadline(None));
    }
    let conflicts = match first_conflict {
        Some(_) => conflicts_of(problem, proxies, &nominal_motion),
        None => Vec::new(),
    };
    let search = |context: &Context, others: Option<&mut Vec<Vec<Segment>>>, clock| {
        let targets = by_obstacle(context.proxies).count();
        let budgets = &problem.settings.budgets;
        let budget = budgets.of(targets, others.is_some(), problem.search);
        attempt(context, budget, &nominal_motion, &conflicts, others, clock)
    };
    // where the nominal motion meets one obstacle alone, the plan around that one is the answer if it is clear of
    // the others, so that a ship that is never near changes nothing. Half of the time is left for all of them
    let is_asked = others.is_none() && problem.search != SearchKind::Thorough;
    let met = met_alone(proxies, &nominal_motion).filter(|_| is_asked && grounding.is_none());
    let around_one = met.map(|proxies| {
        let proxies = &proxies[..];
        let half = Clock::new(clock.left() / 2);
        search(&Context { proxies, ..context }, None, half)
    });
    let is_clear = |best: &Attempt| {
        let plan = best.plan.as_ref();
        plan.is_some_and(|plan| first_met(proxies, plan.trajectory.segments()).is_none())
    };
    let best = match around_one.filter(is_clear) {
        Some(best) => best,
        None => search(&context, others, clock),
    };
    let outcome = match (best.plan, best.timed_out) {
        (plan, true) => Outcome::Deadline(plan),
        (Some(plan), false) => Outcome::Solved(plan),
        (None, false) => Outcome::Infeasible(no_candidate(problem, contact, grounding)),
    };
    Planned {
        is_cut_short: best.is_cut_short,
        stats: Some(best.stats),
        explored: best.explored,
        ..Planned::of(outcome)
    }
}

/// Proxies of the only one of several obstacles that a motion meets.
fn met_alone<'a>(proxies: &[Proxy<'a>], motion: &[Segment]) -> Option<Vec<Proxy<'a>>> {
    let mut met = by_obstacle(proxies).filter(|of_one| first_contact(of_one, motion).is_some());
    let alone = met.next().filter(|of_one| of_one.len() < proxies.len())?;
    met.next().is_none().then(|| alone.to_vec())
}

/// Conflicts of a motion with sets and with land, by their beginning.
fn conflicts_of(problem: &Problem, proxies: &[Proxy], motion: &[Segment]) -> Vec<Conflict> {
    let mut conflicts: Vec<Conflict> = by_obstacle(proxies)
        .filter_map(|h| Conflict::of(h, motion))
        .map(|conflict| land::beyond_land(problem.land_obstacle, conflict, motion))
        .collect();
    conflicts.extend(land::conflicts(problem.land_obstacle, motion));
    conflicts.sort_by(|a, b| a.from.total_cmp(&b.from));
    conflicts
}

/// The cheapest candidate of a search within a budget.
struct Attempt {
    plan: Option<Plan>,
    timed_out: bool,
    is_cut_short: bool,
    stats: SearchStats,
    explored: ExploredGraph,
}

/// Searches the graph, and among several targets a grid. Refines what they find and the manoeuvres around
/// the conflicts of the nominal motion. Resolves conflicts that are far apart one after another, unless
/// `others` are asked for.
fn attempt(
    context: &Context,
    budget: &SearchBudget,
    nominal_motion: &[Segment],
    conflicts: &[Conflict],
    others: Option<&mut Vec<Vec<Segment>>>,
    clock: Clock,
) -> Attempt {
    let mut selection = Selection::new(*context, budget, conflicts);
    selection.others = others.is_some().then(Vec::new);
    let has_grid = budget.searches_grid && context.first_conflict(nominal_motion).is_some();
    let search_grid = || {
        let grid = CoarseSearch::new(*context, nominal_motion, clock)?;
        let along = grid.along_grid(clock);
        Some((grid, along))
    };
    let search_graph = || searched_graph(context, budget, nominal_motion, clock);
    let ((search, stop), grid) = match has_grid {
        true => parallel::join(search_graph, search_grid),
        false => (search_graph(), None),
    };
    if let Some((grid, along)) = grid {
        selection.add_coarse_search(grid, along);
    }
    if let Stop::Goal(goal) = stop {
        let path = node::path_to(&search, goal);
        let cost = search.nodes()[goal].cost;
        selection.add_graph_plan(cost, &path.iter().collect::<Vec<_>>());
    }
    let mut timed_out = matches!(stop, Stop::Time);
    let mut is_cut_short = false;
    timed_out |= selection.refine(nominal_motion, conflicts, clock);
    if let Some(others) = others {
        *others = selection.others.take().unwrap_or_default();
    } else if !timed_out && sequential::are_several(conflicts, &context.problem.settings.conflicts)
    {
        // a single manoeuvre around conflicts that are far apart is long and expensive, if it exists
        let (motion, is_late) =
            sequential::resolve_sequentially(context, nominal_motion, &selection, budget, clock);
        // without a motion, too, the time may have been up
        timed_out = clock.is_up();
        is_cut_short = is_late;
        if let Some(motion) = motion {
            selection.add_candidate(motion);
        }
    }
    Attempt {
        plan: selection.plan(),
        timed_out,
        is_cut_short,
        stats: search.counts(),
        explored: node::explored(search),
    }
}

/// Searches the graph in the stages of the budget.
fn searched_graph(
    context: &Context,
    budget: &SearchBudget,
    nominal_motion: &[Segment],
    clock: Clock,
) -> (Search<State>, Stop) {
    let mut graph = Graph::new(context, nominal_motion, clock);
    let mut search = Search::new(graph.root());
    let mut expansions = 0;
    let mut stages = budget.stages.iter();
    loop {
        let stop = search.next_goal(&mut graph, expansions);
        let (Stop::Budget, Some((most, weight))) = (&stop, stages.next()) else {
            return (search, stop);
        };
        if context.problem.search != SearchKind::Dijkstra {
            search.weigh(*weight);
        }
        expansions = *most;
    }
}

/// Reason that names the first contact of the nominal motion, with land or with a target's set.
fn no_candidate(
    problem: &Problem,
    contact: Option<(usize, f64)>,
    grounding: Option<f64>,
) -> NoPlan {
    let target = contact.map(|(i, time)| (problem.obstacles[i].name().to_owned(), time));
    let land = grounding.map(|time| (LAND.to_owned(), time));
    let first = target
        .into_iter()
        .chain(land)
        .min_by(|a, b| a.1.total_cmp(&b.1));
    first.map_or(NoPlan::NoTrajectory, |(target, time)| {
        if problem.duty().is_none() {
            NoPlan::NoCandidate { target, time }
        } else {
            NoPlan::NoneComplies { target, time }
        }
    })
}
