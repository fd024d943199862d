//! Filter line search along a Newton step, with second-order correction.

use super::filter::{Filter, Merit};
use super::interior::Method;
use super::stage::{StageProblem, Triple};

/// Constants of Wächter and Biegler 2006, section 3.3.
const SUFFICIENT: f64 = 1e-8;
const SWITCH_INFEASIBILITY: f64 = 1.1;
const SWITCH_OBJECTIVE: f64 = 2.3;
const LEAST_STEP: f64 = 0.05;
/// Largest accepted infeasibility, and the one below which descent is required, as multiples of the
/// initial infeasibility or of one.
const MAX_INFEASIBILITY: f64 = 1e4;
const SMALL_INFEASIBILITY: f64 = 1e-4;
/// Factor by which a correction must reduce the infeasibility of the one before.
const CORRECTION_DECREASE: f64 = 0.99;
const MAX_CORRECTIONS: usize = 2;
/// Largest number of step halvings.
const MAX_HALVINGS: usize = 40;
/// Fraction of the step taken where none is acceptable, after which the filter is cleared, and the
/// largest number of such steps.
const FORCED_STEP: f64 = 0.1;
const MAX_FORCED_STEPS: usize = 6;
/// Relative differences of the objective below this are rounding.
const ROUNDING: f64 = 10.0 * f64::EPSILON;

/// Result of a line search.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Accepted {
    /// Fraction of the step; the trial point is in the workspace.
    Step(f64),
    Not,
    /// The deadline was reached first.
    OutOfTime,
}

/// State kept between line searches.
#[derive(Debug, Clone, Copy)]
pub(super) struct Search {
    most: f64,
    little: f64,
    forced_steps: usize,
}

impl Search {
    /// From the initial infeasibility.
    pub fn new(infeasibility: f64) -> Self {
        let size = infeasibility.max(1.0);
        Self {
            most: MAX_INFEASIBILITY * size,
            little: SMALL_INFEASIBILITY * size,
            forced_steps: 0,
        }
    }

    /// Clears the filter for a new barrier.
    pub fn restart(&mut self, filter: &mut Filter) {
        filter.clear(self.most);
    }

    /// Fraction of the longest step to take although no step is acceptable; `None` after too many
    /// of these.
    pub fn forced_step(&mut self, filter: &mut Filter) -> Option<f64> {
        self.forced_steps += 1;
        if self.forced_steps > MAX_FORCED_STEPS {
            return None;
        }
        self.restart(filter);
        Some(FORCED_STEP)
    }

    /// Finds an acceptable fraction of the step, the longest first. `keep_going` is called before
    /// each but the first.
    pub fn run<P: StageProblem<N, M>, const N: usize, const M: usize>(
        &self,
        method: &mut Method<'_, P, N, M>,
        longest: [f64; 2],
        to_limit: f64,
        keep_going: &dyn Fn() -> bool,
    ) -> Accepted {
        let from = method.merit();
        let descent = method.descent();
        let (theta, phi) = (from.infeasibility, from.objective);
        let least = {
            let filter = LEAST_STEP * 1e-5;
            let by_descent = if descent < 0.0 {
                let linear = 1e-8 * theta / -descent;
                if theta <= self.little {
                    linear.min(theta.powf(SWITCH_INFEASIBILITY) / (-descent).powf(SWITCH_OBJECTIVE))
                } else {
                    linear
                }
            } else {
                f64::INFINITY
            };
            (LEAST_STEP * by_descent).min(filter)
        };
        let mut step = longest[0];
        for halving in 0..MAX_HALVINGS {
            if halving > 0 && !keep_going() {
                return Accepted::OutOfTime;
            }
            let found = method.trial_along(step);
            let judged = self.judge(method, from, descent, step, found);
            if let Some(descends) = judged {
                return self.accept(method, from, descends, step);
            }
            if halving == 0
                && found.infeasibility >= theta
                && let Some((step, descends)) = self.correct(method, from, descent, step, to_limit)
            {
                return self.accept(method, from, descends, step);
            }
            step *= 0.5;
            if !(step >= least) {
                break;
            }
        }
        // only rounding is left to gain: accept the step
        if theta <= 1e-9 && descent.abs() <= 1e3 * ROUNDING * phi.abs().max(1.0) {
            method.trial_along(longest[0]);
            return Accepted::Step(longest[0]);
        }
        Accepted::Not
    }

    fn accept<P: StageProblem<N, M>, const N: usize, const M: usize>(
        &self,
        method: &mut Method<'_, P, N, M>,
        from: Merit,
        descends: bool,
        step: f64,
    ) -> Accepted {
        if !descends {
            method.work.filter.take(from);
        }
        Accepted::Step(step)
    }

    /// `None` for a rejected point; otherwise whether it is accepted for its descent of the
    /// objective.
    fn judge<P: StageProblem<N, M>, const N: usize, const M: usize>(
        &self,
        method: &Method<'_, P, N, M>,
        from: Merit,
        descent: f64,
        step: f64,
        found: Merit,
    ) -> Option<bool> {
        if !method.work.filter.accepts(found) {
            return None;
        }
        let slack = ROUNDING * from.objective.abs();
        let switch = descent < 0.0
            && step * (-descent).powf(SWITCH_OBJECTIVE)
                > from.infeasibility.powf(SWITCH_INFEASIBILITY);
        if switch && from.infeasibility <= self.little {
            let enough = found.objective <= from.objective + SUFFICIENT * step * descent + slack;
            return enough.then_some(true);
        }
        Filter::improves(found, from).then_some(false)
    }

    /// Second-order corrections: steps after which the defects of the full step vanish as well.
    fn correct<P: StageProblem<N, M>, const N: usize, const M: usize>(
        &self,
        method: &mut Method<'_, P, N, M>,
        from: Merit,
        descent: f64,
        first: f64,
        to_limit: f64,
    ) -> Option<(f64, bool)> {
        let mut step = first;
        let mut before = f64::INFINITY;
        for _ in 0..MAX_CORRECTIONS {
            method.add_trial_to_targets(step);
            method.step();
            step = method.longest(to_limit)[0];
            if !step.is_finite() {
                break;
            }
            let found = method.trial_along(step);
            // the test uses the descent of the step it corrects
            if let Some(descends) = self.judge(method, from, descent, first, found) {
                return Some((step, descends));
            }
            if !(found.infeasibility <= CORRECTION_DECREASE * before) {
                break;
            }
            before = found.infeasibility;
        }
        method.restore_targets();
        method.step();
        None
    }
}

impl<P: StageProblem<N, M>, const N: usize, const M: usize> Method<'_, P, N, M> {
    /// Infeasibility and barrier objective of the iterate.
    fn merit(&self) -> Merit {
        let [low, high] = self.limits;
        let mut rooms = Logarithms::new();
        for control in &self.at.controls {
            for i in 0..M {
                rooms.add(control[i] - low[i]);
                rooms.add(high[i] - control[i]);
            }
        }
        let mut penalty = 0.0;
        for row in &self.at.rows {
            rooms.add(row.slack);
            rooms.add(row.elastic);
            penalty += row.elastic;
        }
        Merit {
            infeasibility: self.infeasibility(),
            objective: self.objective() + self.settings.penalty * penalty
                - self.barrier * rooms.sum(),
        }
    }

    /// Slope of the barrier objective along the step.
    fn descent(&self) -> f64 {
        let [low, high] = self.limits;
        let mut slope = 0.0;
        for (k, step) in self.work.steps.iter().enumerate() {
            slope += self.work.derivatives[k].gradient.dot(step);
            for i in 0..M {
                let u = self.at.controls[k][i];
                slope += self.barrier * step.u[i] * (1.0 / (high[i] - u) - 1.0 / (u - low[i]));
            }
        }
        for (p, step) in self.at.rows.iter().zip(&self.work.row_steps) {
            slope += self.settings.penalty * step.elastic
                - self.barrier * (step.slack / p.slack + step.elastic / p.elastic);
        }
        slope
    }

    /// Point at a fraction of the step, and its merit.
    pub(super) fn trial_along(&mut self, step: f64) -> Merit {
        let [low, high] = self.limits;
        let n = self.problem.stages();
        let trial = &mut self.work.trial;
        let mut rooms = Logarithms::new();
        trial.states[0] = self.at.states[0];
        for k in 0..n {
            trial.states[k + 1] = self.at.states[k + 1] + self.work.steps[k].y * step;
            trial.controls[k] = self.at.controls[k] + self.work.steps[k].u * step;
            for i in 0..M {
                let u = trial.controls[k][i];
                rooms.add(u - low[i]);
                rooms.add(high[i] - u);
            }
        }
        let (mut cost, mut infeasibility) = (0.0, 0.0);
        for k in 0..n {
            let range = self.work.offsets[k]..self.work.offsets[k + 1];
            let at = Triple {
                x: trial.states[k],
                u: trial.controls[k],
                y: trial.states[k + 1],
            };
            let values = self.problem.values(k, &at, &mut trial.rows[range]);
            trial.values[k] = values;
            cost += values.cost;
            infeasibility += values.defect.lp_norm(1);
        }
        let mut penalty = 0.0;
        for (r, (p, ds)) in self.at.rows.iter().zip(&self.work.row_steps).enumerate() {
            let slack = p.slack + step * ds.slack;
            let elastic = p.elastic + step * ds.elastic;
            trial.slacks[r] = slack;
            trial.elastics[r] = elastic;
            rooms.add(slack);
            rooms.add(elastic);
            penalty += elastic;
            infeasibility += (trial.rows[r] + elastic - slack).abs();
        }
        Merit {
            infeasibility,
            objective: cost + self.settings.penalty * penalty - self.barrier * rooms.sum(),
        }
    }

    /// Sets `target = step target + defect of the trial`.
    fn add_trial_to_targets(&mut self, step: f64) {
        let work = &mut *self.work;
        for (to, values) in work.target.iter_mut().zip(&work.trial.values) {
            *to = *to * step + values.defect;
        }
        for (r, to) in work.row_target.iter_mut().enumerate() {
            let off = work.trial.rows[r] + work.trial.elastics[r] - work.trial.slacks[r];
            *to = *to * step + off;
        }
    }

    fn restore_targets(&mut self) {
        let work = &mut *self.work;
        for (to, values) in work.target.iter_mut().zip(&work.values) {
            *to = values.defect;
        }
        for (r, to) in work.row_target.iter_mut().enumerate() {
            let p = &self.at.rows[r];
            *to = work.rows[r] + p.elastic - p.slack;
        }
    }
}

/// Sum of logarithms, several of them at a time as the logarithm of a product: factors between
/// 1e-30 and 1e30 cannot overflow.
#[derive(Debug, Clone, Copy)]
struct Logarithms {
    sum: f64,
    product: f64,
    factors: u32,
}

/// Number of factors of one product.
const FACTORS: u32 = 8;

impl Logarithms {
    fn new() -> Self {
        Self {
            sum: 0.0,
            product: 1.0,
            factors: 0,
        }
    }

    /// Adds the logarithm of a distance; nothing for an infinite one, NaN for one that is not
    /// positive.
    fn add(&mut self, room: f64) {
        if room == f64::INFINITY {
            return;
        }
        self.product *= if room > 0.0 { room } else { f64::NAN };
        self.factors += 1;
        if self.factors == FACTORS {
            self.sum += self.product.ln();
            (self.product, self.factors) = (1.0, 0);
        }
    }

    fn sum(&self) -> f64 {
        self.sum + self.product.ln()
    }
}
