//! Interior-point iteration: errors, barrier, step, multipliers.

use super::iterate::{Iterate, RowPoint};
use super::line_search::{Accepted, Search};
use super::newton::Curvature;
use super::stage::{Multipliers, StageProblem, Triple, Vector};
use super::workspace::Workspace;
use super::{Settings, SolverReport, SolverStatus};

/// The barrier is reduced once the error is below this multiple of it.
const BARRIER_ERROR: f64 = 10.0;
/// Fraction and power of itself to the smaller of which the barrier falls.
const BARRIER_FRACTION: f64 = 0.2;
const BARRIER_POWER: f64 = 1.5;
/// Mean multiplier above which the error is scaled down.
const LARGE_MULTIPLIER: f64 = 100.0;
/// Largest ratio of a dual to its central value after a step.
const DUAL_SPREAD: f64 = 1e10;
/// Least fraction-to-boundary parameter.
const FRACTION_TO_BOUNDARY: f64 = 0.99;
/// Least initial distance of a control from its limits, as a fraction of their distance: for a cold
/// and for a warm start.
const BOUND_PUSH: f64 = 1e-2;
const BOUND_PUSH_WARM: f64 = 1e-5;
/// Objective or state beyond which the problem counts as unbounded.
const DIVERGED: f64 = 1e12;

/// Solves from an iterate and leaves the result there, whatever the status. `keep_going` is called
/// before each step and between the trial points of its line search.
///
/// Deterministic. Each step costs `O(stages (N + M)³ + rows (N + M)²)` and allocates nothing.
pub fn solve<const N: usize, const M: usize>(
    problem: &impl StageProblem<N, M>,
    iterate: &mut Iterate<N, M>,
    work: &mut Workspace<N, M>,
    settings: &Settings,
    keep_going: &dyn Fn() -> bool,
) -> SolverReport {
    let mut report = SolverReport {
        status: SolverStatus::BadProblem,
        iterations: 0,
        objective: f64::NAN,
        error: f64::INFINITY,
        shortfall: 0.0,
        row_multiplier: 0.0,
    };
    let limits = problem.limits();
    let open = (0..M).all(|i| limits[0][i] < limits[1][i]);
    let rows = work.offsets.last().copied().unwrap_or(0);
    let sound = settings.penalty > 0.0 && settings.barrier > 0.0 && settings.tolerance > 0.0;
    if problem.stages() == 0
        || !open
        || !sound
        || !work.fits(problem)
        || !iterate.fits(problem, rows)
    {
        return report;
    }
    let mut method = Method {
        problem,
        at: iterate,
        work,
        settings,
        limits,
        barrier: settings.barrier,
        last_shift: 0.0,
    };
    method.initialise();
    report.status = method.run(&mut report, keep_going);
    report.shortfall = method
        .work
        .rows
        .iter()
        .fold(0.0, |most: f64, row| most.max(-row));
    report.row_multiplier = method
        .at
        .rows
        .iter()
        .fold(0.0, |most: f64, row| most.max(row.multiplier));
    report.objective = method.objective();
    report
}

pub(super) struct Method<'a, P, const N: usize, const M: usize> {
    pub problem: &'a P,
    pub at: &'a mut Iterate<N, M>,
    pub work: &'a mut Workspace<N, M>,
    pub settings: &'a Settings,
    pub limits: [Vector<M>; 2],
    pub barrier: f64,
    pub last_shift: f64,
}

/// Errors of the optimality conditions.
#[derive(Debug, Clone, Copy)]
struct Errors {
    dual: f64,
    primal: f64,
    /// Largest complementarity products.
    products: [f64; 2],
    scale: f64,
}

impl Errors {
    /// Scaled error at a barrier: distance of the products from it.
    fn at(&self, barrier: f64) -> f64 {
        let [least, most] = self.products;
        let off = (most - barrier).max(barrier - least).max(0.0);
        self.primal
            .max(self.dual / self.scale)
            .max(off / self.scale)
    }
}

impl<P: StageProblem<N, M>, const N: usize, const M: usize> Method<'_, P, N, M> {
    /// Moves controls within their limits, sets the given first state, and completes the
    /// multipliers.
    fn initialise(&mut self) {
        let n = self.problem.stages();
        let warm = self.at.is_warm();
        self.at.states[0] = self.problem.first();
        let (barrier, penalty) = (self.barrier, self.settings.penalty);
        let [low, high] = self.limits;
        for (k, control) in self.at.controls.iter_mut().enumerate() {
            for i in 0..M {
                let width = high[i] - low[i];
                let width = if width.is_finite() { width } else { 1.0 };
                // warm start: the product with the old multiplier is the barrier
                let keep = |dual: Option<f64>| match dual {
                    Some(dual) => {
                        (barrier / dual).clamp(BOUND_PUSH_WARM * width, BOUND_PUSH * width)
                    }
                    None => BOUND_PUSH * width,
                };
                let (below, above) = if warm {
                    (Some(self.at.low[k][i]), Some(self.at.high[k][i]))
                } else {
                    (None, None)
                };
                control[i] = control[i]
                    .max(low[i] + keep(below))
                    .min(high[i] - keep(above));
            }
        }
        self.evaluate();
        if !warm {
            self.at.multipliers = vec![Vector::zeros(); n];
            self.at.low = vec![Vector::zeros(); n];
            self.at.high = vec![Vector::zeros(); n];
            self.at.rows = self
                .work
                .rows
                .iter()
                .map(|&row| RowPoint::central(row, barrier, penalty))
                .collect();
        }
        for (row, &value) in self.at.rows.iter_mut().zip(&self.work.rows) {
            if !warm {
                break;
            }
            let least = barrier / (1.0 + value.abs());
            row.multiplier = row.multiplier.clamp(
                least.min(0.5 * penalty),
                penalty - barrier.min(0.5 * penalty),
            );
            row.price = penalty - row.multiplier;
            row.elastic = barrier / row.price;
            row.slack = (value + row.elastic).max(barrier / row.multiplier);
        }
        for (k, control) in self.at.controls.iter().enumerate() {
            for i in 0..M {
                let central = |room: f64| {
                    if room.is_finite() {
                        barrier / room
                    } else {
                        0.0
                    }
                };
                let (below, above) = (central(control[i] - low[i]), central(high[i] - control[i]));
                let spread = |dual: f64, central: f64| {
                    if warm {
                        dual.clamp(1e-2 * central, 1e2 * central)
                    } else {
                        central
                    }
                };
                self.at.low[k][i] = spread(self.at.low[k][i], below);
                self.at.high[k][i] = spread(self.at.high[k][i], above);
            }
        }
    }

    fn run(&mut self, report: &mut SolverReport, keep_going: &dyn Fn() -> bool) -> SolverStatus {
        let mut search = Search::new(self.infeasibility());
        search.restart(&mut self.work.filter);
        let mut forced = false;
        loop {
            self.differentiate();
            let errors = self.errors();
            report.error = errors.at(0.0);
            if !report.error.is_finite() {
                return SolverStatus::NotANumber;
            }
            if report.error <= self.settings.tolerance {
                return SolverStatus::Solved;
            }
            let objective = self.objective();
            let far = |v: &Vector<N>| v.amax() > DIVERGED;
            if objective < -DIVERGED || self.at.states.iter().any(far) {
                return SolverStatus::Unbounded;
            }
            if report.iterations >= self.settings.max_iterations {
                return SolverStatus::Iterations;
            }
            if !keep_going() {
                return SolverStatus::OutOfTime;
            }
            while errors.at(self.barrier) <= BARRIER_ERROR * self.barrier {
                let floor = 0.1 * self.settings.tolerance;
                let next = (BARRIER_FRACTION * self.barrier)
                    .min(self.barrier.powf(BARRIER_POWER))
                    .max(floor);
                // at the least barrier the tolerance decides
                if next >= self.barrier {
                    break;
                }
                self.barrier = next;
                search.restart(&mut self.work.filter);
            }
            let Some(used) = self.factorise(forced) else {
                return SolverStatus::Singular;
            };
            self.work
                .target
                .iter_mut()
                .zip(&self.work.values)
                .for_each(|(t, v)| *t = v.defect);
            self.set_row_targets();
            self.step();
            let to_limit = FRACTION_TO_BOUNDARY.max(1.0 - self.barrier);
            let longest = self.longest(to_limit);
            if !longest[0].is_finite() {
                return SolverStatus::NotANumber;
            }
            match search.run(self, longest, to_limit, keep_going) {
                Accepted::OutOfTime => return SolverStatus::OutOfTime,
                Accepted::Step(primal) => {
                    self.take(primal, longest[1]);
                    forced = false;
                }
                // the exact step may be poor: try again with the convex model
                Accepted::Not if used == Curvature::Exact && self.settings.gauss_newton => {
                    forced = true;
                }
                Accepted::Not => match search.forced_step(&mut self.work.filter) {
                    Some(fraction) => {
                        self.trial_along(fraction * longest[0]);
                        self.take(fraction * longest[0], longest[1]);
                        forced = false;
                    }
                    None => return SolverStatus::Stalled,
                },
            }
            report.iterations += 1;
        }
    }

    /// Evaluates the functions at the iterate.
    fn evaluate(&mut self) {
        for k in 0..self.problem.stages() {
            let range = self.work.rows_of(k);
            let rows = &mut self.work.rows[range];
            self.work.values[k] = self.problem.values(k, &self.at.point(k), rows);
        }
    }

    /// Evaluates the derivatives at the iterate with its multipliers.
    fn differentiate(&mut self) {
        for (to, row) in self.work.row_multipliers.iter_mut().zip(&self.at.rows) {
            *to = row.multiplier;
        }
        for k in 0..self.problem.stages() {
            let range = self.work.rows_of(k);
            let multipliers = Multipliers {
                defect: &self.at.multipliers[k],
                rows: &self.work.row_multipliers[range.clone()],
            };
            self.problem.derivatives(
                k,
                &self.at.point(k),
                multipliers,
                &mut self.work.derivatives[k],
                &mut self.work.row_gradients[range],
            );
        }
    }

    pub(super) fn objective(&self) -> f64 {
        self.work.values.iter().map(|v| v.cost).sum()
    }

    /// Sum of the absolute defects of equations and rows.
    pub(super) fn infeasibility(&self) -> f64 {
        let equations: f64 = self.work.values.iter().map(|v| v.defect.lp_norm(1)).sum();
        let rows = self.work.rows.iter().zip(&self.at.rows);
        equations
            + rows
                .map(|(g, p)| (g + p.elastic - p.slack).abs())
                .sum::<f64>()
    }

    fn errors(&mut self) -> Errors {
        let n = self.problem.stages();
        let [low, high] = self.limits;
        let (mut dual, mut primal) = (0.0_f64, 0.0_f64);
        let mut products = [f64::INFINITY, f64::NEG_INFINITY];
        let mut sum = 0.0;
        let mut count = 0;
        let mut pair = |room: f64, multiplier: f64| {
            if room.is_finite() {
                products = [
                    products[0].min(room * multiplier),
                    products[1].max(room * multiplier),
                ];
                sum += multiplier;
                count += 1;
            }
        };
        let mut carried = Vector::<N>::zeros();
        let mut not_a_number = false;
        for k in 0..n {
            let d = &self.work.derivatives[k];
            let l = &self.at.multipliers[k];
            let mut g = Triple {
                x: d.gradient.x + d.defect_x.tr_mul(l),
                u: d.gradient.u + d.defect_u.tr_mul(l) - self.at.low[k] + self.at.high[k],
                y: d.gradient.y + d.defect_y.tr_mul(l),
            };
            for r in self.work.rows_of(k) {
                g.add_scaled(-self.at.rows[r].multiplier, &self.work.row_gradients[r]);
            }
            // the first state is no variable
            if k > 0 {
                dual = dual.max((carried + g.x).amax());
            }
            dual = dual.max(g.u.amax());
            carried = g.y;
            primal = primal.max(self.work.values[k].defect.amax());
            for i in 0..M {
                pair(self.at.controls[k][i] - low[i], self.at.low[k][i]);
                pair(high[i] - self.at.controls[k][i], self.at.high[k][i]);
            }
            // a maximum loses a NaN
            not_a_number |= !(g.x.sum() + g.u.sum() + g.y.sum()).is_finite()
                || !self.work.values[k].defect.sum().is_finite();
        }
        dual = dual.max(carried.amax());
        for (row, value) in self.at.rows.iter().zip(&self.work.rows) {
            pair(row.slack, row.multiplier);
            pair(row.elastic, row.price);
            primal = primal.max((value + row.elastic - row.slack).abs());
            dual = dual.max((self.settings.penalty - row.multiplier - row.price).abs());
            not_a_number |= !value.is_finite();
        }
        if count == 0 {
            products = [0.0, 0.0];
        }
        sum += self
            .at
            .multipliers
            .iter()
            .map(|l| l.lp_norm(1))
            .sum::<f64>();
        let mean = sum / (count + n * N) as f64;
        Errors {
            dual: if not_a_number { f64::NAN } else { dual },
            primal: if not_a_number { f64::INFINITY } else { primal },
            products,
            scale: mean.max(LARGE_MULTIPLIER) / LARGE_MULTIPLIER,
        }
    }

    /// Accepts the trial point; `primal` and `dual` are the fractions of the steps.
    fn take(&mut self, primal: f64, dual: f64) {
        let [low, high] = self.limits;
        let barrier = self.barrier;
        for k in 0..self.problem.stages() {
            for i in 0..M {
                let [down, up] = self.limit_steps(k, i);
                self.at.low[k][i] += dual * down;
                self.at.high[k][i] += dual * up;
            }
            let step = self.work.new_multipliers[k] - self.at.multipliers[k];
            self.at.multipliers[k] += primal * step;
        }
        self.at.states.copy_from_slice(&self.work.trial.states);
        self.at.controls.copy_from_slice(&self.work.trial.controls);
        let near = |dual: f64, room: f64| {
            dual.clamp(barrier / (DUAL_SPREAD * room), DUAL_SPREAD * barrier / room)
        };
        for k in 0..self.problem.stages() {
            for i in 0..M {
                let u = self.at.controls[k][i];
                if low[i].is_finite() {
                    self.at.low[k][i] = near(self.at.low[k][i], u - low[i]);
                }
                if high[i].is_finite() {
                    self.at.high[k][i] = near(self.at.high[k][i], high[i] - u);
                }
            }
        }
        for (r, step) in self.work.row_steps.iter().enumerate() {
            let row = &mut self.at.rows[r];
            row.slack = self.work.trial.slacks[r];
            row.elastic = self.work.trial.elastics[r];
            row.multiplier = near(row.multiplier + dual * step.multiplier, row.slack);
            row.price = near(row.price + dual * step.price, row.elastic);
        }
        let work = &mut *self.work;
        std::mem::swap(&mut work.values, &mut work.trial.values);
        std::mem::swap(&mut work.rows, &mut work.trial.rows);
    }
}
