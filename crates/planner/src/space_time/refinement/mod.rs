//! Refinement of a manoeuvre's lengths by sequential quadratic programming with an L1 merit
//! function.

pub(crate) mod active_set;
pub(crate) mod approach;
pub(crate) mod factor;
pub(crate) mod gauss_newton;
pub(crate) mod insertion;
pub(crate) mod model;
pub(crate) mod quadratic;
pub(crate) mod return_segments;
pub(crate) mod rollout;
pub(crate) mod structure;
pub(crate) mod trial;

use crate::AGAINST_THE_RULES;
use crate::clock::Clock;
use crate::space_time::context::Context;
use crate::space_time::context::FINE_CHORD_RAD;
use crate::space_time::manoeuvre::ending::Ending;
use crate::space_time::refinement::model::Model;
use crate::space_time::refinement::quadratic::{Constraint, MAX_VARIABLES, Programme, Row};
use crate::space_time::refinement::structure::{SegmentVariable, Structure};
use crate::space_time::refinement::trial::Trial;
use searoom_geometry::frame::Side;
use searoom_model::trajectory::Segment;

/// Longest turn of one segment variable where a step is restored or corrected, radians.
const LONGEST_RESTORED_ARC: f64 = std::f64::consts::TAU;

/// Depth in metres that needs no correction.
const CORRECTION_M: f64 = 1e-3;

/// Initial guess of a refinement.
#[derive(Debug, Clone)]
pub(crate) struct InitialGuess {
    pub structure: Structure,
    pub lengths: Row,
}

impl InitialGuess {
    /// Segment variables with their lengths, metres; at most [`MAX_VARIABLES`].
    pub(crate) fn new(pieces: &[(SegmentVariable, f64)], ending: Ending) -> Self {
        let mut lengths = [0.0; MAX_VARIABLES];
        for (to, (_, length)) in lengths.iter_mut().zip(pieces) {
            *to = *length;
        }
        let variables = pieces.iter().map(|piece| piece.0).collect();
        Self {
            structure: Structure { variables, ending },
            lengths,
        }
    }

    /// Segment variables with their lengths, metres.
    pub(crate) fn pieces(&self) -> impl Iterator<Item = (SegmentVariable, f64)> + '_ {
        let variables = self.structure.variables.iter().copied();
        variables.zip(self.lengths)
    }

    /// Side of the first turn of non-zero length.
    fn first_turn(&self) -> Option<Side> {
        self.pieces().find_map(|(variable, length)| match variable {
            SegmentVariable::Arc { side, .. } if length > 0.0 => Some(side),
            _ => None,
        })
    }
}

/// Manoeuvre that is clear of every set with the margin, as far as its contact rows show.
#[derive(Debug, Clone, Copy)]
struct Refined {
    cost: f64,
    /// Lengths of its segment variables.
    lengths: Row,
}

/// Refinement in progress.
#[derive(Debug)]
pub(crate) struct Refinement {
    structure: Structure,
    lengths: Row,
    model: Model,
    /// Factor on its costs when it is ranked among others.
    handicap: f64,
    best: Option<Refined>,
    penalty: f64,
    /// Sum of the multipliers of the last step, m²/m.
    price: f64,
    radius: f64,
    stalled: usize,
    raised: usize,
    steps: usize,
    finished: bool,
}

impl Refinement {
    /// Starts from the initial guess. Where its return does not fit before the end of the leg,
    /// starts from one with shorter lines, or from one that ends at the last waypoint.
    pub(crate) fn fitting(context: &Context, guess: InitialGuess) -> Option<Self> {
        Self::with_shorter_lines(context, guess.clone()).or_else(|| {
            let variables = guess.structure.variables.iter().rev();
            let last = variables.copied().find_map(|variable| match variable {
                SegmentVariable::Arc { side, speed } => Some(Ending::Goal { side, speed }),
                _ => None,
            });
            let mut onward = guess;
            onward.structure.ending = last?;
            Self::with_shorter_lines(context, onward)
        })
    }

    /// Starts from the initial guess, or from one with shorter lines.
    fn with_shorter_lines(context: &Context, mut guess: InitialGuess) -> Option<Self> {
        for _ in 0..4 {
            if let Some(refinement) = Self::new(context, guess.clone()) {
                return Some(refinement);
            }
            for (variable, length) in guess.structure.variables.iter().zip(&mut guess.lengths) {
                if matches!(variable, SegmentVariable::Line { .. }) {
                    *length *= 0.6;
                }
            }
        }
        None
    }

    /// `None` when the initial guess's ending does not fit.
    fn new(context: &Context, guess: InitialGuess) -> Option<Self> {
        let settings = &context.problem.settings.refinement;
        let model = context.model(&guess.structure, &guess.lengths)?;
        let penalty = settings.least_penalty + settings.penalty_per_cost * model.cost;
        let first = guess.first_turn();
        let wanted = context.problem.first_turn;
        let against = wanted.is_some_and(|side| first.is_some_and(|first| first != side));
        let mut refinement = Self {
            handicap: if against {
                1.0 + AGAINST_THE_RULES
            } else {
                1.0
            },
            structure: guess.structure,
            lengths: guess.lengths,
            model,
            best: None,
            penalty,
            price: penalty,
            radius: settings.first_radius_m,
            stalled: 0,
            raised: 0,
            steps: 0,
            finished: false,
        };
        refinement.keep_if_best(context);
        Some(refinement)
    }

    pub(crate) fn is_finished(&self) -> bool {
        self.finished
    }

    /// Motion of the cheapest clear manoeuvre so far.
    pub(crate) fn best_motion(&self, context: &Context) -> Option<Vec<Segment>> {
        let best = self.best?;
        let rollout = self
            .structure
            .roll_out(context.problem, context.route, &best.lengths)?;
        Some(rollout.motion())
    }

    /// Cheapest clear manoeuvre so far, as an initial guess.
    pub(crate) fn best(&self) -> Option<InitialGuess> {
        Some(InitialGuess {
            structure: self.structure.clone(),
            lengths: self.best.as_ref()?.lengths,
        })
    }

    /// Cost of the best clear manoeuvre, m²; infinite before there is one.
    pub(crate) fn best_cost(&self) -> f64 {
        self.best.as_ref().map_or(f64::INFINITY, |b| b.cost)
    }

    /// Cost of the current manoeuvre with its penalty, m².
    pub(crate) fn merit(&self) -> f64 {
        self.model.cost + self.penalty * self.model.violation
    }

    /// [`Self::merit`] with the handicap, by which refinements under way are compared; a NaN is the worst.
    pub(crate) fn standing(&self) -> f64 {
        let standing = self.handicap * self.merit();
        if standing.is_nan() {
            f64::INFINITY
        } else {
            standing
        }
    }

    /// Cost used for ranking among clear manoeuvres, m².
    pub(crate) fn rank(&self) -> f64 {
        self.handicap * self.best_cost()
    }

    /// Factor on its costs when it is ranked among others.
    pub(crate) fn handicap(&self) -> f64 {
        self.handicap
    }

    /// Only manoeuvres checked with fine chords count as clear.
    fn keep_if_best(&mut self, context: &Context) {
        let clear = self.model.least_slack >= 0.0 && context.chord <= FINE_CHORD_RAD;
        let better = self.best.as_ref().is_none_or(|b| self.model.cost < b.cost);
        if clear && better {
            self.best = Some(Refined {
                cost: self.model.cost,
                lengths: self.lengths,
            });
        }
    }

    /// Restoration: moves a nearly clear manoeuvre to the nearest clear one by a few steps of least
    /// change under the linearised rows.
    fn restore(&mut self, context: &Context) {
        let settings = &context.problem.settings.refinement;
        let n = self.structure.free();
        let mut identity = [[0.0; MAX_VARIABLES]; MAX_VARIABLES];
        for (i, row) in identity.iter_mut().enumerate() {
            row[i] = 1.0;
        }
        for _ in 0..settings.restorations {
            let clear = self.model.least_slack >= 0.0;
            let close = self.model.violation < settings.restorable_m;
            let worth = self.best.as_ref().is_none_or(|b| self.model.cost < b.cost);
            if clear || !close || !worth {
                return;
            }
            let programme = Programme {
                size: n,
                hessian: &identity,
                gradient: &[0.0; MAX_VARIABLES],
                low: &self.least_steps(context, &self.lengths, f64::INFINITY),
                high: &self.largest_steps(
                    context,
                    &self.lengths,
                    settings.largest_radius_m,
                    LONGEST_RESTORED_ARC,
                ),
                rows: &self.model.rows,
                price: None,
            };
            let Some(solution) = programme.solve() else {
                return;
            };
            let mut trial_lengths = self.lengths;
            for (length, step) in trial_lengths.iter_mut().zip(&solution.x).take(n) {
                *length = (*length + step).max(0.0);
            }
            let Some(model) = context.model(&self.structure, &trial_lengths) else {
                return;
            };
            if model.violation >= self.model.violation {
                return;
            }
            (self.lengths, self.model) = (trial_lengths, model);
            self.keep_if_best(context);
        }
    }

    /// Evaluates the current manoeuvre again with another chord length.
    pub(crate) fn reevaluate(&mut self, context: &Context) {
        if let Some(model) = context.model(&self.structure, &self.lengths) {
            self.model = model;
            (self.finished, self.stalled) = (false, 0);
            self.keep_if_best(context);
        }
    }

    /// Ends the refinement; the result counts as clear if it is nearly so.
    pub(crate) fn finish(&mut self, context: &Context) {
        self.finished = true;
        self.restore(context);
    }

    /// Takes at most `most` steps, then [`Self::finish`]; after the deadline neither.
    pub(crate) fn run(mut self, context: &Context, most: usize, clock: Clock) -> Self {
        self.go_on(context, most, clock);
        self
    }

    /// [`Self::run`] of a refinement that stays where it is.
    pub(crate) fn go_on(&mut self, context: &Context, most: usize, clock: Clock) {
        for _ in 0..most {
            if self.finished || clock.is_up() {
                return;
            }
            self.step(context);
        }
        self.finish(context);
    }

    /// Takes one SQP step.
    pub(crate) fn step(&mut self, context: &Context) {
        let settings = &context.problem.settings.refinement;
        self.steps += 1;
        let advanced = self.advance(context);
        if !advanced && self.model.least_slack < 0.0 && self.raised < settings.max_raises {
            // converged inside a set: raise the penalty
            self.raised += 1;
            self.penalty *= settings.penalty_factor;
            self.radius = settings.first_radius_m;
            self.stalled = 0;
            return;
        }
        if self.steps >= settings.max_steps || !advanced {
            self.finish(context);
        }
    }

    /// Least change of each length in a trust region: down to zero, or to the least time of a
    /// segment variable.
    fn least_steps(&self, context: &Context, lengths: &Row, radius: f64) -> Row {
        let mut low = lengths.map(|length| -length);
        if context.segment_time > 0.0 {
            for (low, variable) in low.iter_mut().zip(&self.structure.variables) {
                *low = (*low + context.segment_time * variable.speed()).min(0.0);
            }
        }
        low.map(|low| low.max(-radius))
    }

    /// Largest change of each length in a trust region: up to an arc of `longest` radians.
    fn largest_steps(&self, context: &Context, lengths: &Row, radius: f64, longest: f64) -> Row {
        let longest = longest * context.problem.own.turning_radius;
        let mut high = [radius; MAX_VARIABLES];
        let variables = self.structure.variables.iter().zip(lengths);
        for (high, (variable, length)) in high.iter_mut().zip(variables) {
            if matches!(variable, SegmentVariable::Arc { .. }) {
                *high = high.min((longest - length).max(0.0));
            }
        }
        high
    }

    /// Second-order correction: the least change, in the norm of the Hessian, that moves a full
    /// step out of the sets it curves into. Without it, steps along a face are cut to nothing.
    fn corrected(
        &self,
        context: &Context,
        trial_lengths: &Row,
        trial: &Trial,
    ) -> Option<(Row, Trial)> {
        if trial.violation <= CORRECTION_M {
            return None;
        }
        let programme = Programme {
            size: self.structure.free(),
            hessian: &self.model.hessian,
            gradient: &[0.0; MAX_VARIABLES],
            low: &self.least_steps(context, trial_lengths, self.radius),
            high: &self.largest_steps(context, trial_lengths, self.radius, LONGEST_RESTORED_ARC),
            rows: &context.rows(&self.structure, trial),
            price: None,
        };
        let solution = programme.solve()?;
        let mut corrected = *trial_lengths;
        for (length, step) in corrected.iter_mut().zip(&solution.x) {
            *length = (*length + step).max(0.0);
        }
        let trial = context.trial(&self.structure, &corrected)?;
        Some((corrected, trial))
    }

    fn advance(&mut self, context: &Context) -> bool {
        let settings = &context.problem.settings.refinement;
        let n = self.structure.free();
        let low = self.least_steps(context, &self.lengths, self.radius);
        let high = self.largest_steps(context, &self.lengths, self.radius, settings.longest_arc);
        let mut rows = Vec::with_capacity(self.model.rows.len());
        for row in &self.model.rows {
            let (mut reach, mut least) = (0.0, 0.0);
            for i in 0..n {
                let ends = (row.coefficients[i] * low[i], row.coefficients[i] * high[i]);
                reach += ends.0.max(ends.1);
                least += ends.0.min(ends.1);
            }
            // negated on purpose: a NaN is retained. A row satisfied in the whole box is not needed
            if !(least >= row.bound) {
                // a row that the box cannot satisfy requires only what is attainable
                rows.push(Constraint {
                    bound: row.bound.min(settings.attainable * reach),
                    ..*row
                });
            }
        }
        let programme = Programme {
            size: n,
            hessian: &self.model.hessian,
            gradient: &self.model.gradient,
            low: &low,
            high: &high,
            rows: &rows,
            price: Some(self.penalty),
        };
        let Some(solution) = programme.solve() else {
            return false;
        };
        self.price = solution.multipliers.iter().sum::<f64>();
        self.penalty = self.penalty.max(1.5 * self.price);
        let met = self.model.violation - solution.missing;
        let step = solution.x;
        let largest = step[..n].iter().fold(0.0_f64, |m, s| m.max(s.abs()));
        let linear: f64 = (0..n).map(|i| step[i] * self.model.gradient[i]).sum();
        let bent: f64 = (0..n)
            .map(|i| {
                step[i]
                    * (0..n)
                        .map(|k| self.model.hessian[i][k] * step[k])
                        .sum::<f64>()
            })
            .sum();
        let merit = self.merit();
        let mut share = 1.0;
        for _ in 0..=settings.max_backtracks {
            let predicted = share * (self.penalty * met - linear) - 0.5 * share * share * bent;
            let mut trial_lengths = self.lengths;
            for i in 0..n {
                trial_lengths[i] = (trial_lengths[i] + share * step[i]).max(0.0);
            }
            let mut found = context.trial(&self.structure, &trial_lengths);
            let gain = |o: &Trial| merit - o.cost - self.penalty * o.violation;
            let enough = |gained: f64| gained > 0.0 && gained >= settings.least_gain * predicted;
            if share == 1.0
                && let Some(trial) = &found
                && !enough(gain(trial))
                && let Some(corrected) = self.corrected(context, &trial_lengths, trial)
                && enough(gain(&corrected.1))
            {
                trial_lengths = corrected.0;
                found = Some(corrected.1);
            }
            let found = found.map(|trial| (gain(&trial), trial));
            if let Some((gained, trial)) = found
                && enough(gained)
            {
                let model = context.completed(&self.structure, trial);
                let settled = gained < settings.stalled * model.cost.max(1.0)
                    && model.violation < CORRECTION_M;
                self.stalled = if settled { self.stalled + 1 } else { 0 };
                (self.lengths, self.model) = (trial_lengths, model);
                self.keep_if_best(context);
                if share < 1.0 {
                    self.radius = (2.0 * share * largest)
                        .min(self.radius)
                        .max(settings.smallest_radius_m);
                } else if gained > 0.6 * predicted && largest > 0.9 * self.radius {
                    self.radius = (1.7 * self.radius).min(settings.largest_radius_m);
                }
                return self.stalled < 2;
            }
            share *= settings.backtrack;
        }
        self.radius = share * largest.min(self.radius);
        self.radius >= settings.smallest_radius_m
    }
}
