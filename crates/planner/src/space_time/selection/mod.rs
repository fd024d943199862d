//! Candidate selection: refines the plans of the searches and predefined manoeuvres; the cheapest
//! clear candidate wins.

pub(crate) mod coarse_search;
mod corners;
pub(crate) mod initial_guess;
mod tidy;
pub(crate) mod warm_start;

use crate::Plan;
use crate::clock::Clock;
use crate::space_time::context::Context;
use crate::space_time::graph::node::State;
use crate::space_time::land;
use crate::space_time::manoeuvre::conflict::Conflict;
use crate::space_time::proxy::first_met;
use crate::space_time::refinement::insertion::{pruned, with_insertions};
use crate::space_time::refinement::{InitialGuess, Refinement};
use crate::space_time::selection::coarse_search::CoarseSearch;
use crate::space_time::selection::initial_guess::{EvasiveManoeuvre, from_graph};
use crate::space_time::selection::tidy::Prices;
use crate::space_time::settings::SearchBudget;
use searoom_geometry::frame::Side;
use searoom_model::trajectory::Segment;
use searoom_parallel as parallel;

/// Ahead of schedule first, then around the set: useful in every conflict.
const FASTER_FIRST: EvasiveManoeuvre = EvasiveManoeuvre {
    fast_share: 0.5,
    ..EvasiveManoeuvre::new(0.5, 0.3, 0.9)
};

/// Manoeuvres tried on both sides regardless of the graph, whose best plan can lie in a poor basin of attraction.
const COMPACT: [EvasiveManoeuvre; 3] = [
    EvasiveManoeuvre::new(1.4, 0.6, 0.6),
    EvasiveManoeuvre::slow(1.0, 1.0, 0.9),
    FASTER_FIRST,
];

/// Manoeuvres for conflicts that are long relative to their offset, as in overtaking.
const SLENDER: [EvasiveManoeuvre; 5] = [
    EvasiveManoeuvre::new(0.2, 0.3, 0.6),
    EvasiveManoeuvre::new(0.2, 1.0, 0.9),
    EvasiveManoeuvre::slow(0.7, 0.3, 0.6),
    EvasiveManoeuvre::new(0.4, 0.3, 0.9),
    FASTER_FIRST,
];

/// Relative cost difference below which two manoeuvres count as the same.
const SAME_COST: f64 = 1e-3;

/// Clear trajectory.
#[derive(Debug, Clone)]
struct Candidate {
    motion: Vec<Segment>,
    /// Cost with the price of its alterations, m².
    cost: f64,
}

/// Candidates of one problem.
#[derive(Debug)]
pub(crate) struct Selection<'a> {
    context: Context<'a>,
    search_budget: &'a SearchBudget,
    guesses: Vec<InitialGuess>,
    best: Option<Candidate>,
    graph_cost: Option<f64>,
    prices: Prices<'a>,
    coarse_search: Option<CoarseSearch<'a>>,
    along_grid: Vec<Refinement>,
    /// Clear motions that pass the sets in other ways than the cheapest, where they are asked for.
    pub others: Option<Vec<Vec<Segment>>>,
}

impl<'a> Selection<'a> {
    pub(crate) fn new(
        context: Context<'a>,
        search_budget: &'a SearchBudget,
        conflicts: &[Conflict],
    ) -> Self {
        Self {
            context,
            search_budget,
            guesses: Vec::new(),
            best: None,
            graph_cost: None,
            prices: Prices::of(context.problem, context.route, conflicts),
            coarse_search: None,
            along_grid: Vec::new(),
            others: None,
        }
    }

    /// Adds a manoeuvre to refine.
    pub(crate) fn add_initial_guess(&mut self, guess: InitialGuess) {
        self.guesses.push(guess);
    }

    /// Adds a tested plan of the graph, given by the states after the root.
    pub(crate) fn add_graph_plan(&mut self, cost: f64, path: &[&State]) {
        let motion: Vec<Segment> = path.iter().flat_map(|s| s.motion.iter().copied()).collect();
        self.graph_cost = Some(cost);
        self.guesses.extend(from_graph(self.context.problem, path));
        self.add_candidate(motion);
    }

    /// Adds a coarse search, with its refined manoeuvres.
    pub(crate) fn add_coarse_search(&mut self, search: CoarseSearch<'a>, along: Vec<Refinement>) {
        self.coarse_search = Some(search);
        self.along_grid = along;
    }

    /// Refines the manoeuvres added and the predefined ones around the conflicts of the nominal
    /// motion. Among several targets a hybrid A* follows for a cheaper motion. True when the deadline
    /// was reached.
    pub(crate) fn refine(
        &mut self,
        nominal_motion: &[Segment],
        conflicts: &[Conflict],
        clock: Clock,
    ) -> bool {
        let context = self.context;
        let (problem, route) = (context.problem, context.route);
        let mut guesses = std::mem::take(&mut self.guesses);
        let leg = problem.desired.legs().len() - 1;
        let settings = &problem.settings.guesses;
        for conflict in conflicts.iter().take(settings.max_conflicts) {
            let slender = conflict.slenderness() > settings.slender_from;
            let manoeuvres = if slender { &SLENDER[..] } else { &COMPACT[..] };
            for side in Side::BOTH {
                guesses.extend(
                    manoeuvres
                        .iter()
                        .filter_map(|c| c.guess(problem, route, side, conflict, leg)),
                );
            }
        }
        let tidy = problem.tidy.map(|tidy| (tidy, guesses.clone()));
        let coarse = Context {
            chord: problem.settings.refinement.coarse_chord,
            ..context
        };
        let mut running: Vec<Refinement> = guesses
            .into_iter()
            .take_while(|_| !clock.is_up())
            .filter_map(|s| Refinement::fitting(&coarse, s))
            .collect();
        if self.race(&mut running, clock) {
            running.append(&mut self.along_grid);
            self.collect(ranked(&running));
            return true;
        }
        running.append(&mut self.along_grid);
        let (grid, least) = (self.coarse_search.take(), self.least(&running));
        if let Some((motions, along)) = grid.map(|g| g.along_hybrid(least, clock)) {
            for motion in motions {
                self.add_candidate(motion);
            }
            running.extend(along);
        }
        if let Some((tidy, guesses)) = tidy {
            self.add_tidy(
                &tidy,
                (nominal_motion, conflicts),
                &running,
                &guesses,
                clock,
            );
        } else {
            let pruned = self.insert_and_prune(&mut running, clock);
            self.collect(pruned.iter().chain(ranked(&running)));
        }
        if self.others.is_some() {
            self.others = Some(self.other_ways(&running));
        }
        clock.is_up()
    }

    /// Refines the guesses until one is clear and has had its share of iterations. After a few iterations those
    /// with the lowest merit function, cost plus penalty, continue; the others do only where none of these
    /// becomes clear. True when the deadline was reached.
    fn race(&self, running: &mut Vec<Refinement>, clock: Clock) -> bool {
        let (most, begun) = (self.search_budget.racers, self.search_budget.race_from);
        let context = &self.context;
        let mut eliminated = Vec::new();
        let mut round = 0;
        if running.len() > most {
            parallel::each(running, |refinement| {
                (0..begun).for_each(|round| advance(refinement, context, round, clock));
            });
            running.sort_by(|a, b| a.standing().total_cmp(&b.standing()));
            eliminated = running.split_off(most);
            round = begun;
        }
        self.refine_all(running, round, clock);
        if !clock.is_up() && !eliminated.is_empty() && !self.has_clear(running) {
            self.refine_all(&mut eliminated, round, clock);
        }
        running.append(&mut eliminated);
        clock.is_up()
    }

    /// True where the motion of a refinement is clear by the exact test.
    fn has_clear(&self, running: &[Refinement]) -> bool {
        let motions = ranked(running).map_while(|r| r.best_motion(&self.context));
        motions.into_iter().any(|motion| self.is_clear(&motion))
    }

    /// Refines from a round on, until one is clear and has had its share of iterations, or none changes.
    fn refine_all(&self, running: &mut [Refinement], mut round: usize, clock: Clock) {
        let SearchBudget {
            max_iterations: steps,
            iterations_once_clear: rounds,
            ..
        } = *self.search_budget;
        let fine_from = self.context.problem.settings.refinement.fine_from;
        while round < steps && !clock.is_up() {
            let decided = round >= rounds && running.iter().any(|r| r.best_cost().is_finite());
            // only manoeuvres checked with fine chords count as clear
            if decided || round > fine_from && running.iter().all(Refinement::is_finished) {
                break;
            }
            // up to `rounds` no refinement depends on another
            let next = rounds.max(round + 1).min(steps);
            parallel::each(running, |refinement| {
                (round..next).for_each(|round| advance(refinement, &self.context, round, clock));
            });
            round = next;
        }
        parallel::each(running, |refinement| {
            if !refinement.is_finished() && !clock.is_up() {
                refinement.finish(&self.context);
            }
        });
    }

    /// Cost of the cheapest clear motion so far, m²; infinite without any.
    fn least(&self, running: &[Refinement]) -> f64 {
        let refined = best_of(running).map_or(f64::INFINITY, Refinement::best_cost);
        let best = self
            .best
            .as_ref()
            .map(|b| self.context.problem.error_to_end(&b.motion));
        best.unwrap_or(f64::INFINITY).min(refined)
    }

    /// Inserts segments into the best manoeuvres and refines them. In the end prunes short segments of the best
    /// where that costs almost nothing.
    fn insert_and_prune(&self, running: &mut Vec<Refinement>, clock: Clock) -> Option<Refinement> {
        let settings = &self.context.problem.settings.insertion;
        let SearchBudget {
            leaders: most,
            leader_margin: margin,
            ..
        } = *self.search_budget;
        let mut leaders: Vec<_> = leaders(running, most, margin)
            .into_iter()
            .map(|(guess, _)| (guess, None))
            .collect();
        parallel::each(&mut leaders, |(guess, inserted)| {
            *inserted = self.with_insertions(guess, clock);
        });
        running.extend(leaders.into_iter().filter_map(|(_, inserted)| inserted));
        let best = best_of(running)?;
        let least = best.rank();
        let guess = pruned(&self.context, &best.best()?)?;
        let pruned = refined(
            &self.context,
            guess,
            settings.iterations_after_pruning,
            clock,
        )?;
        (pruned.rank() <= (1.0 + settings.pruning_cost) * least).then_some(pruned)
    }

    /// Manoeuvre with insertions, refined; `None` where nothing is inserted or the deadline was
    /// reached.
    fn with_insertions(&self, guess: &InitialGuess, clock: Clock) -> Option<Refinement> {
        if clock.is_up() {
            return None;
        }
        let most = self.context.problem.settings.insertion.iterations;
        let guess = with_insertions(&self.context, guess)?;
        refined(&self.context, guess, most, clock)
    }

    /// Tests the refinements' results in the given order until one passes.
    fn collect<'r>(&mut self, found: impl Iterator<Item = &'r Refinement>) {
        for refinement in found {
            let Some(motion) = refinement.best_motion(&self.context) else {
                return;
            };
            if self.add_candidate(motion) {
                return;
            }
        }
    }

    /// Clear alternatives that pass the targets differently from the best candidate, cheapest first.
    fn other_ways(&self, running: &[Refinement]) -> Vec<Vec<Segment>> {
        let settings = &self.context.problem.settings.guesses;
        let best = self.best.iter();
        let mut ways: Vec<_> = best.map(|b| (b.motion.clone(), b.cost)).collect();
        for refinement in ranked(running) {
            if ways.len() >= settings.most_ways {
                break;
            }
            let Some(motion) = refinement.best_motion(&self.context) else {
                break;
            };
            let cost = self.cost_of(&motion);
            let is_same = |(other, of): &(Vec<_>, f64)| {
                is_same_way((other, *of), (&motion, cost), settings.same_way)
            };
            if !ways.iter().any(is_same) && self.is_clear(&motion) {
                ways.push((motion, cost));
            }
        }
        let others = ways.into_iter().skip(1);
        others.map(|(motion, _)| motion).collect()
    }

    /// Keeps a motion when it is clear, in time and the cheapest so far; true when it is clear.
    pub(crate) fn add_candidate(&mut self, motion: Vec<Segment>) -> bool {
        let cost = self.cost_of(&motion);
        let clear = cost.is_finite() && self.is_clear(&motion);
        if clear && self.best.as_ref().is_none_or(|b| cost < b.cost) {
            self.best = Some(Candidate { motion, cost });
        }
        clear
    }

    fn is_clear(&self, motion: &[Segment]) -> bool {
        let problem = self.context.problem;
        let in_time = motion
            .last()
            .is_some_and(|s| s.end_time() <= problem.horizon);
        in_time
            && first_met(self.context.proxies, motion).is_none()
            && !land::meets(problem.land_obstacle, motion)
    }

    /// Cost of a motion with the price of its alterations, m².
    pub(crate) fn cost_of(&self, motion: &[Segment]) -> f64 {
        self.context.problem.error_to_end(motion) * self.prices.factor(motion)
    }

    /// [`Self::cost_of`] the best candidate; infinite without any.
    pub(crate) fn least_cost(&self) -> f64 {
        self.best.as_ref().map_or(f64::INFINITY, |b| b.cost)
    }

    /// Cheapest clear motion.
    pub(crate) fn plan(self) -> Option<Plan> {
        let best = self.best?;
        let method = self.context.problem.search.method();
        Some(Plan {
            graph_cost: self.graph_cost,
            ..Plan::measured(self.context.problem, best.motion, method)?
        })
    }
}

/// True where two motions, with their costs, cost alike up to a fraction and turn to the same side first.
pub(crate) fn is_same_way(one: (&[Segment], f64), other: (&[Segment], f64), same: f64) -> bool {
    let side = |motion: &[Segment]| motion.iter().find_map(|s| Side::of_turn(s.turn_rate));
    (one.1 - other.1).abs() <= same * one.1 && side(one.0) == side(other.0)
}

/// Refinement with at most `most` steps, and fewer after the deadline.
fn refined(
    context: &Context,
    guess: InitialGuess,
    most: usize,
    clock: Clock,
) -> Option<Refinement> {
    Some(Refinement::fitting(context, guess)?.run(context, most, clock))
}

fn best_of(running: &[Refinement]) -> Option<&Refinement> {
    let costs = |a: &&Refinement, b: &&Refinement| a.rank().total_cmp(&b.rank());
    running.iter().min_by(costs)
}

/// The cheapest manoeuvres that differ from one another, with their ranks, at most `most`. None is
/// dearer than the cheapest by more than a fraction: insertions can gain more than its lead.
fn leaders(running: &[Refinement], most: usize, margin: f64) -> Vec<(InitialGuess, f64)> {
    let mut found: Vec<(InitialGuess, f64)> = Vec::with_capacity(most.min(running.len()));
    for refinement in ranked(running) {
        let rank = refinement.rank();
        let least = found.first().map_or(rank, |f| f.1);
        let alike = found.iter().any(|f| rank <= (1.0 + SAME_COST) * f.1);
        // negated on purpose: a NaN is too expensive
        if found.len() == most || !(rank <= (1.0 + margin) * least && rank.is_finite()) {
            break;
        }
        if !alike {
            found.extend(refinement.best().map(|guess| (guess, rank)));
        }
    }
    found
}

/// Refinements by rank, cheapest first.
fn ranked(running: &[Refinement]) -> impl Iterator<Item = &Refinement> {
    let mut found: Vec<_> = running.iter().collect();
    found.sort_by(|a, b| a.rank().total_cmp(&b.rank()));
    found.into_iter()
}

/// One round of a refinement, with fine chords from `fine_from` on.
fn advance(refinement: &mut Refinement, context: &Context, round: usize, clock: Clock) {
    let settings = &context.problem.settings.refinement;
    let mut context = *context;
    if round < settings.fine_from {
        context.chord = settings.coarse_chord;
    }
    if clock.is_up() {
        return;
    }
    if round == settings.fine_from {
        refinement.reevaluate(&context);
    }
    if !refinement.is_finished() {
        refinement.step(&context);
    }
}
