//! Candidates: the graph's plans and what the refinement makes of them; the cheapest clear one wins.

pub(crate) mod budget;
pub(crate) mod initial_guess;
pub(crate) mod warm_start;

use crate::frame::{Side, cross};
use crate::planner::Plan;
use crate::planner::clock::Clock;
use crate::planner::cost::space_time_error;
use crate::planner::space_time::graph::node::State;
use crate::planner::space_time::land;
use crate::planner::space_time::proxy::{Proxy, by_obstacle, first_met};
use crate::planner::space_time::refinement::approach::{COARSE_CHORD_RAD, FINE_CHORD_RAD};
use crate::planner::space_time::refinement::insertion::{pruned, with_insertions};
use crate::planner::space_time::refinement::trial::Context;
use crate::planner::space_time::refinement::{InitialGuess, Refinement};
use crate::planner::space_time::rules::compliance::complies;
use crate::planner::space_time::selection::budget::SearchBudget;
use crate::planner::space_time::selection::initial_guess::{
    Canonical, Conflict, ahead, from_graph, slowing, waiting,
};
use crate::trajectory::Segment;

/// Ahead of schedule first, then around the set: of use in every conflict.
const RUSH: Canonical = Canonical {
    turn: 0.5,
    lead: 0.3,
    reach: 0.9,
    slow: false,
    rush: 0.5,
};

/// Manoeuvres tried on both sides whatever the graph says: its best plan can lie in a bad basin. Chosen from
/// 152 of all angles, leads and offsets, for 400 encounters: the set that together comes nearest to the best.
const COMPACT: [Canonical; 4] = [
    Canonical {
        turn: 1.4,
        lead: 0.6,
        reach: 0.6,
        slow: false,
        rush: 0.0,
    },
    Canonical {
        turn: 1.0,
        lead: 1.0,
        reach: 0.9,
        slow: true,
        rush: 0.0,
    },
    Canonical {
        turn: 0.4,
        lead: 1.4,
        reach: 0.6,
        slow: false,
        rush: 0.0,
    },
    RUSH,
];

/// The same where the way through the set is long beside the way around it, as when overtaking.
const SLENDER: [Canonical; 5] = [
    Canonical {
        turn: 0.2,
        lead: 0.3,
        reach: 0.6,
        slow: false,
        rush: 0.0,
    },
    Canonical {
        turn: 0.2,
        lead: 1.0,
        reach: 0.9,
        slow: false,
        rush: 0.0,
    },
    Canonical {
        turn: 0.7,
        lead: 0.3,
        reach: 0.6,
        slow: true,
        rush: 0.0,
    },
    Canonical {
        turn: 0.4,
        lead: 0.3,
        reach: 0.9,
        slow: false,
        rush: 0.0,
    },
    RUSH,
];

/// Way through over way around from which a conflict is slender.
const SLENDER_FROM: f64 = 2.5;

/// A side whose offset is this many times the other's gets one manoeuvre only.
const FAR_SIDE: f64 = 1.8;

/// Way lost over way around below which waiting is tried as well.
const WORTH_WAITING: f64 = 1.2;

/// Way won over way around below which rushing is tried as well.
const WORTH_RUSHING: f64 = 1.2;

/// Conflicts that get manoeuvres of their own, earliest first.
const MAX_CONFLICTS: usize = 2;

/// Of manoeuvres that are enriched: the share of the cost by which one may be behind the best, and below which two are
/// the same.
const BEHIND: f64 = 0.05;
const ALIKE: f64 = 1e-3;

/// Metres of line above which the leaders are cut for additions, and the best of them once more.
const UNCUT_M: [f64; 2] = [200.0, 80.0];

/// Steps of a refinement after an enrichment, and of the last one, without scraps.
const STEPS_ENRICHED: usize = 8;
const STEPS_TIDY: usize = 6;

/// Share of the cost that an enrichment has to gain for another to be tried.
const WORTH_ANOTHER: f64 = 0.01;

/// Share of the cost that a manoeuvre without scraps of turns and lines may cost more.
const TIDINESS: f64 = 2e-3;

/// Rounds after which arcs are cut into fine chords.
const FINE_FROM: usize = 6;

/// A clear trajectory.
#[derive(Debug, Clone)]
struct Candidate {
    motion: Vec<Segment>,
    cost: f64,
}

/// What is known so far.
#[derive(Debug)]
pub(crate) struct Selection<'a> {
    context: Context<'a>,
    /// The route on schedule.
    nominal_motion: &'a [Segment],
    search_budget: &'a SearchBudget,
    signatures: Vec<Vec<bool>>,
    guesses: Vec<InitialGuess>,
    best: Option<Candidate>,
    graph_cost: Option<f64>,
}

impl<'a> Selection<'a> {
    pub(crate) fn new(
        context: Context<'a>,
        nominal_motion: &'a [Segment],
        search_budget: &'a SearchBudget,
    ) -> Self {
        Self {
            context,
            nominal_motion,
            search_budget,
            signatures: Vec::new(),
            guesses: Vec::new(),
            best: None,
            graph_cost: None,
        }
    }

    /// Ways around the targets seen so far.
    pub(crate) fn signatures(&self) -> usize {
        self.signatures.len()
    }

    /// Takes a manoeuvre to refine.
    pub(crate) fn begin_from(&mut self, guess: InitialGuess) {
        self.guesses.push(guess);
    }

    /// Takes a plan of the graph, the states after the root, already tested; false where it does not comply with the rules.
    pub(crate) fn offer(&mut self, cost: f64, way: &[&State]) -> bool {
        let motion: Vec<Segment> = way.iter().flat_map(|s| s.motion.iter().copied()).collect();
        if !complies(&self.context, self.nominal_motion, &motion) {
            return false;
        }
        let signature = self.signature(&motion);
        self.graph_cost.get_or_insert(cost);
        if self.signatures.contains(&signature) {
            return true;
        }
        self.signatures.push(signature);
        self.guesses.extend(from_graph(self.context.problem, way));
        self.consider(motion);
        true
    }

    /// On which side each target is passed: the sign of its relative bearing rate at the least distance
    /// of the middles.
    fn signature(&self, motion: &[Segment]) -> Vec<bool> {
        by_obstacle(self.context.proxies)
            .map(|proxies| {
                let mut nearest = (f64::INFINITY, false);
                for s in motion {
                    for k in 0..=4 {
                        let t = s.start_time + s.duration * f64::from(k) / 4.0;
                        let (position, velocity) = (s.pose_at(t).position, s.velocity_at(t));
                        let relative = |h: &Proxy| h.relative(position, velocity, t);
                        if let Some((r, w)) = proxies.iter().find_map(relative)
                            && r.norm() < nearest.0
                        {
                            nearest = (r.norm(), cross(w, r) > 0.0);
                        }
                    }
                }
                nearest.1
            })
            .collect()
    }

    /// Refines the graph's plans and the canonical ones; true when the time ran out.
    pub(crate) fn refine(&mut self, conflicts: &[Conflict], clock: Clock) -> bool {
        let mut context = self.context;
        context.chord = COARSE_CHORD_RAD;
        let (problem, route) = (context.problem, context.route);
        let mut guesses = std::mem::take(&mut self.guesses);
        let leg = problem.desired.legs().len() - 1;
        let duty = problem.duty();
        let sides = duty.sides();
        for conflict in conflicts.iter().take(MAX_CONFLICTS) {
            if conflict.astern.0 < WORTH_WAITING * conflict.nearest_offset() {
                for across in [false, true] {
                    guesses.extend(
                        sides
                            .iter()
                            .filter_map(|side| waiting(problem, *side, across, conflict, leg)),
                    );
                }
            }
            if !duty.is_none() {
                let slower = sides.iter();
                guesses.extend(slower.filter_map(|side| slowing(problem, *side, conflict, leg)));
            }
            if duty.is_none() && conflict.ahead.0 < WORTH_RUSHING * conflict.nearest_offset() {
                let both = Side::BOTH.into_iter();
                guesses.extend(both.filter_map(|side| ahead(problem, side, conflict, leg)));
            }
            let slender = conflict.slenderness() > SLENDER_FROM;
            let manoeuvres = if slender { &SLENDER[..] } else { &COMPACT[..] };
            let manoeuvres = &manoeuvres[..manoeuvres.len().min(self.search_budget.manoeuvres)];
            for &side in sides {
                let far = conflict.offset(side) > FAR_SIDE * conflict.offset(side.opposite());
                let tried = if far && sides.len() > 1 {
                    &manoeuvres[..1]
                } else {
                    manoeuvres
                };
                guesses.extend(
                    tried
                        .iter()
                        .filter_map(|c| c.guess(problem, route, side, conflict, leg)),
                );
            }
        }
        let mut running: Vec<Refinement> = guesses
            .into_iter()
            .take_while(|_| !clock.is_up())
            .filter_map(|s| Refinement::fitting(&context, s))
            .collect();
        for round in 0..self.search_budget.steps {
            let decided = round >= self.search_budget.rounds
                && running.iter().any(|r| r.best_cost().is_finite());
            // nothing counts as clear before fine chords have seen it
            if decided || round > FINE_FROM && running.iter().all(Refinement::is_finished) {
                break;
            }
            race(&mut running, round, self.search_budget.places);
            if round == FINE_FROM {
                context.chord = FINE_CHORD_RAD;
                for refinement in running.iter_mut().filter(|r| !r.is_overtaken()) {
                    if !clock.is_up() {
                        refinement.look_again(&context);
                    }
                }
            }
            for refinement in running.iter_mut().filter(|r| !r.is_finished()) {
                if clock.is_up() {
                    self.collect(ranked(&running));
                    return true;
                }
                refinement.step(&context);
            }
        }
        for refinement in running.iter_mut().filter(|r| !r.is_finished()) {
            if !clock.is_up() {
                refinement.settle(&context);
            }
        }
        let tidy = self.polish(&mut running, clock);
        self.collect(tidy.iter().chain(ranked(&running)));
        clock.is_up()
    }

    /// Adds what the leaders lack and refines them anew, and again what the best of them lacks; in the end without scraps,
    /// where that costs next to nothing.
    fn polish(&self, running: &mut Vec<Refinement>, clock: Clock) -> Option<Refinement> {
        let leaders = leaders(running, self.search_budget.leaders);
        let mut least = leaders.first()?.1;
        let [first, then] = UNCUT_M;
        let mut best = None;
        let mut gained = 0.0;
        for (guess, rank) in leaders {
            let again = self.richer(&guess, first, clock);
            let after = again
                .as_ref()
                .map_or(f64::INFINITY, Refinement::rank)
                .min(rank);
            if best.is_none() || after < least {
                gained = 1.0 - after / rank;
                best = again.as_ref().and_then(Refinement::best).or(Some(guess));
                least = after;
            }
            running.extend(again);
        }
        if self.search_budget.twice && gained > WORTH_ANOTHER {
            let again = best.as_ref().and_then(|s| self.richer(s, then, clock));
            best = again.as_ref().and_then(Refinement::best).or(best);
            running.extend(again);
        }
        let least = best_of(running)?.rank();
        let guess = best.and_then(|s| pruned(&self.context, &s));
        let tidy = guess.and_then(|s| self.refined(s, STEPS_TIDY, clock))?;
        (tidy.rank() <= (1.0 + TIDINESS) * least).then_some(tidy)
    }

    /// With what a manoeuvre lacks, refined anew; `None` where it lacks nothing or the time is up.
    fn richer(&self, guess: &InitialGuess, uncut: f64, clock: Clock) -> Option<Refinement> {
        if clock.is_up() {
            return None;
        }
        self.refined(
            with_insertions(&self.context, guess, uncut)?,
            STEPS_ENRICHED,
            clock,
        )
    }

    /// A refinement from beginning to end, of so many steps at most, and fewer where the time is up.
    fn refined(&self, guess: InitialGuess, most: usize, clock: Clock) -> Option<Refinement> {
        let mut refinement = Refinement::fitting(&self.context, guess)?;
        for _ in 0..most {
            if refinement.is_finished() || clock.is_up() {
                return Some(refinement);
            }
            refinement.step(&self.context);
        }
        refinement.settle(&self.context);
        Some(refinement)
    }

    /// Tests what the refinements found, in this order, until one passes.
    fn collect<'r>(&mut self, found: impl Iterator<Item = &'r Refinement>) {
        for refinement in found {
            let Some(motion) = refinement.best_motion(&self.context) else {
                return;
            };
            if self.consider(motion) {
                return;
            }
        }
    }

    /// True once a motion was clear.
    pub(crate) fn has_plan(&self) -> bool {
        self.best.is_some()
    }

    /// Keeps a motion when it is clear, in time and the cheapest so far; true when it is clear.
    pub(crate) fn consider(&mut self, motion: Vec<Segment>) -> bool {
        let problem = self.context.problem;
        let cost: f64 = motion
            .iter()
            .map(|s| space_time_error(problem.desired, s, problem.time_weight))
            .sum();
        let in_time = motion
            .last()
            .is_some_and(|s| s.end_time() <= problem.horizon);
        let clear = in_time
            && cost.is_finite()
            && complies(&self.context, self.nominal_motion, &motion)
            && first_met(self.context.proxies, &motion).is_none()
            && !land::meets(problem.coast, &motion);
        if clear && self.best.as_ref().is_none_or(|b| cost < b.cost) {
            self.best = Some(Candidate { motion, cost });
        }
        clear
    }

    /// The cheapest clear motion.
    pub(crate) fn plan(self) -> Option<Plan> {
        let best = self.best?;
        Plan::measured(self.context.problem, best.motion, self.graph_cost)
    }
}

fn best_of(running: &[Refinement]) -> Option<&Refinement> {
    let costs = |a: &&Refinement, b: &&Refinement| a.rank().total_cmp(&b.rank());
    running.iter().min_by(costs)
}

/// The cheapest of all and the next that is another, with their ranks: what a manoeuvre lacks can be worth more than the
/// lead of one that lacks nothing. So many at most.
fn leaders(running: &[Refinement], most: usize) -> Vec<(InitialGuess, f64)> {
    let mut found: Vec<(InitialGuess, f64)> = Vec::with_capacity(most);
    for refinement in ranked(running) {
        let rank = refinement.rank();
        let least = found.first().map_or(rank, |f| f.1);
        let alike = found.iter().any(|f| rank <= (1.0 + ALIKE) * f.1);
        // negated on purpose: a NaN is behind
        if found.len() == most || !(rank <= (1.0 + BEHIND) * least) {
            break;
        }
        if !alike {
            found.extend(refinement.best().map(|guess| (guess, rank)));
        }
    }
    found
}

/// Cheapest first.
fn ranked(running: &[Refinement]) -> impl Iterator<Item = &Refinement> {
    let mut found: Vec<_> = running.iter().collect();
    found.sort_by(|a, b| a.rank().total_cmp(&b.rank()));
    found.into_iter()
}

/// Stops what has fallen behind after so many rounds, but never the first that is nearly clear. A missing metre costs at least the median of what it
/// costs them: one that is stuck deep inside a set sees no price at all.
fn race(running: &mut [Refinement], rounds: usize, places: &[(usize, usize)]) {
    let places = places.iter().rev().find(|(from, _)| *from <= rounds);
    let places = places.map_or(running.len(), |p| p.1);
    let mut going: Vec<&mut Refinement> =
        running.iter_mut().filter(|r| !r.is_overtaken()).collect();
    if going.is_empty() {
        return;
    }
    let mut prices: Vec<f64> = going.iter().map(|r| r.price()).collect();
    prices.sort_by(f64::total_cmp);
    let usual = prices[(prices.len() - 1) / 2];
    going.sort_by(|a, b| a.expected_cost(usual).total_cmp(&b.expected_cost(usual)));
    let clear = going.iter().position(|r| r.is_nearly_clear());
    for (place, refinement) in going.into_iter().enumerate().skip(places) {
        if Some(place) != clear {
            refinement.stop();
        }
    }
}
