//! Newton step on the barrier problem, and its largest permitted fraction.

use super::interior::Method;
use super::riccati::{self, RightSide};
use super::stage::StageProblem;
use super::workspace::RowStep;

/// Factor between shifts, first shift relative to the largest second derivative of the controls,
/// and largest number of shifts.
const SHIFT_FACTOR: f64 = 6.0;
const FIRST_SHIFT: f64 = 1e-4;
const MAX_SHIFTS: usize = 40;

/// Second derivatives of a step.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Curvature {
    Exact,
    Convex,
}

impl<P: StageProblem<N, M>, const N: usize, const M: usize> Method<'_, P, N, M> {
    /// Factorises with the best second derivatives of the right inertia; `None` where none has it.
    pub(super) fn factorise(&mut self, convex_only: bool) -> Option<Curvature> {
        if !riccati::eliminate(&mut self.work.factors, &self.work.derivatives) {
            return None;
        }
        if !convex_only {
            self.assemble(Curvature::Exact, 0.0);
            if riccati::factorise(&mut self.work.factors, &self.work.hessian) {
                self.last_shift = 0.0;
                return Some(Curvature::Exact);
            }
        }
        let kind = if self.settings.gauss_newton {
            self.assemble(Curvature::Convex, 0.0);
            if riccati::factorise(&mut self.work.factors, &self.work.hessian) {
                return Some(Curvature::Convex);
            }
            Curvature::Convex
        } else {
            Curvature::Exact
        };
        let size = self
            .work
            .hessian
            .iter()
            .fold(0.0_f64, |most, h| most.max(h.uu.amax()).max(h.yy.amax()));
        let mut shift = if self.last_shift > 0.0 {
            self.last_shift / SHIFT_FACTOR / SHIFT_FACTOR
        } else {
            FIRST_SHIFT * size.max(f64::MIN_POSITIVE)
        };
        for _ in 0..MAX_SHIFTS {
            self.assemble(kind, shift);
            if riccati::factorise(&mut self.work.factors, &self.work.hessian) {
                self.last_shift = shift;
                return Some(kind);
            }
            shift *= SHIFT_FACTOR;
        }
        None
    }

    /// Second derivatives of the barrier problem with rows and limits eliminated.
    fn assemble(&mut self, curvature: Curvature, shift: f64) {
        let [low, high] = self.limits;
        for k in 0..self.problem.stages() {
            let mut h = self.work.derivatives[k].convex;
            if curvature == Curvature::Exact {
                h.add(&self.work.derivatives[k].curvature);
            }
            for i in 0..M {
                let u = self.at.controls[k][i];
                h.uu[(i, i)] +=
                    self.at.low[k][i] / (u - low[i]) + self.at.high[k][i] / (high[i] - u) + shift;
            }
            for i in 0..N {
                h.yy[(i, i)] += shift;
            }
            for r in self.work.rows_of(k) {
                let p = &self.at.rows[r];
                let weight = 1.0 / (p.slack / p.multiplier + p.elastic / p.price);
                self.work.weights[r] = weight;
                h.add_square(weight, &self.work.row_gradients[r]);
            }
            self.work.hessian[k] = h;
        }
    }

    pub(super) fn set_row_targets(&mut self) {
        for ((to, value), p) in self
            .work
            .row_target
            .iter_mut()
            .zip(&self.work.rows)
            .zip(&self.at.rows)
        {
            *to = value + p.elastic - p.slack;
        }
    }

    /// Newton step from the targets with the current factors.
    pub(super) fn step(&mut self) {
        let [low, high] = self.limits;
        let (barrier, penalty) = (self.barrier, self.settings.penalty);
        for k in 0..self.problem.stages() {
            let mut g = self.work.derivatives[k].gradient;
            for i in 0..M {
                let u = self.at.controls[k][i];
                g.u[i] += barrier / (high[i] - u) - barrier / (u - low[i]);
            }
            for r in self.work.rows_of(k) {
                let p = &self.at.rows[r];
                let factor = self.work.weights[r] * self.row_goal(r) - p.multiplier;
                g.add_scaled(factor, &self.work.row_gradients[r]);
            }
            self.work.gradient[k] = g;
        }
        riccati::solve(
            &mut self.work.factors,
            RightSide {
                gradient: &self.work.gradient,
                defect: &self.work.target,
            },
            &mut self.work.steps,
            &mut self.work.new_multipliers,
        );
        for k in 0..self.problem.stages() {
            for r in self.work.rows_of(k) {
                let p = self.at.rows[r];
                let along = self.work.row_gradients[r].dot(&self.work.steps[k]);
                let multiplier = -self.work.weights[r] * (along + self.row_goal(r));
                let price = penalty - p.multiplier - p.price - multiplier;
                self.work.row_steps[r] = RowStep {
                    slack: barrier / p.multiplier - p.slack - p.slack / p.multiplier * multiplier,
                    elastic: barrier / p.price - p.elastic - p.elastic / p.price * price,
                    multiplier,
                    price,
                };
            }
        }
    }

    /// Residual of the linearised row, slack and elastic eliminated.
    fn row_goal(&self, r: usize) -> f64 {
        let p = &self.at.rows[r];
        let unbalanced = self.settings.penalty - p.multiplier - p.price;
        self.work.row_target[r] - p.elastic + p.slack + self.barrier / p.price
            - self.barrier / p.multiplier
            - p.elastic / p.price * unbalanced
    }

    /// Longest primal and dual steps that keep the fraction `1 - to_limit` of every distance; NaN
    /// for a step that is a NaN.
    pub(super) fn longest(&self, to_limit: f64) -> [f64; 2] {
        let [low, high] = self.limits;
        let (mut primal, mut dual) = (1.0_f64, 1.0_f64);
        let cut = |most: &mut f64, value: f64, step: f64| {
            if step < -to_limit * value {
                *most = most.min(-to_limit * value / step);
            }
        };
        let mut sum = 0.0;
        for (k, step) in self.work.steps.iter().enumerate() {
            sum += step.y.sum() + step.u.sum();
            for i in 0..M {
                let u = self.at.controls[k][i];
                cut(&mut primal, u - low[i], step.u[i]);
                cut(&mut primal, high[i] - u, -step.u[i]);
                let [down, up] = self.limit_steps(k, i);
                cut(&mut dual, self.at.low[k][i], down);
                cut(&mut dual, self.at.high[k][i], up);
            }
        }
        for (p, step) in self.at.rows.iter().zip(&self.work.row_steps) {
            cut(&mut primal, p.slack, step.slack);
            cut(&mut primal, p.elastic, step.elastic);
            cut(&mut dual, p.multiplier, step.multiplier);
            cut(&mut dual, p.price, step.price);
            sum += step.multiplier;
        }
        if sum.is_finite() {
            [primal, dual]
        } else {
            [f64::NAN; 2]
        }
    }

    /// Steps of the multipliers of a control's two limits.
    pub(super) fn limit_steps(&self, k: usize, i: usize) -> [f64; 2] {
        let [low, high] = self.limits;
        let (u, du) = (self.at.controls[k][i], self.work.steps[k].u[i]);
        let of = |room: f64, multiplier: f64, approach: f64| {
            if room.is_finite() {
                (self.barrier - multiplier * approach) / room - multiplier
            } else {
                0.0
            }
        };
        [
            of(u - low[i], self.at.low[k][i], du),
            of(high[i] - u, self.at.high[k][i], -du),
        ]
    }
}
