//! Transcription of the optimal control problem: Hermite–Simpson collocation with constant forces
//! per interval.
//!
//! Per interval of `h` seconds, with `f` the rates of the ship,
//!
//! ```text
//! x_m = (x + y) / 2 + h/8 (f(x, u) - f(y, u))            state at half time, on the cubic
//! y - x - h/6 (f(x, u) + 4 f(x_m, u) + f(y, u)) = 0
//! cost = h/6 (l(x) + 4 l(x_m) + l(y)) + h u' R u,    l(x) = (x - r)' Q (x - r)
//! ```
//!
//! Rows are `(p - c)' Q_t^-1 (p - c) - 1 >= 0` for the position on the cubic at any fraction of the
//! interval. The rates are linear in the forces, so second derivatives with respect to them come
//! from `R` only.

use nalgebra::{Matrix2, Matrix2x6, Matrix6, Matrix6x3, Vector2};

use super::keep_out::Keep;
use super::solver::{Blocks, Derivatives, Matrix, Multipliers, StageProblem, Triple, Values};
use super::task::Controls;
use searoom_geometry::frame::wrap;
use searoom_model::trajectory::hermite;
use searoom_model::vessel::{ForceVector, Manoeuvring, Scales, StateVector};

/// Margin of the rows above level 1, which is a set's edge. It covers the tolerance of the solver.
const MARGIN: f64 = 1e-4;

/// Multipliers of rows below this contribute no second derivatives: these may be as inexact as the
/// solver's tolerance.
const NEGLIGIBLE: f64 = 1e-8;

/// Constraint to keep out of a set at a fraction of an interval.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Row {
    /// Index of the set.
    pub obstacle: usize,
    /// Fraction in `(0, 1]`.
    pub fraction: f64,
    keep: Keep,
    /// Hermite weights of the cubic: position and rate before, position and rate after.
    hermite: [f64; 4],
}

impl Row {
    /// `keep` is the section at that time.
    pub fn new(obstacle: usize, fraction: f64, keep: Keep) -> Self {
        Self {
            obstacle,
            fraction,
            keep,
            hermite: hermite(fraction),
        }
    }
}

/// Reference of the stage cost over one interval.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Span {
    /// Reference at its start, middle and end.
    pub reference: [StateVector; 3],
}

/// Diagonal weights of the stage cost.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Weights {
    /// Per squared unit of [`StateVector`] and second.
    pub state: StateVector,
    /// Per squared unit of [`ForceVector`] and second.
    pub force: ForceVector,
}

/// Problem in the ship's own units: variables are divided by [`Scales`].
#[derive(Debug, Clone)]
pub struct Transcription<'a, V> {
    vessel: &'a V,
    scales: Scales,
    /// True where the units are SI.
    plain: bool,
    gain: Matrix6x3<f64>,
    /// Length of an interval, seconds.
    step: f64,
    first: StateVector,
    force_limits: ForceVector,
    weights: Weights,
    cost_unit: f64,
    spans: Vec<Span>,
    rows: Vec<Vec<Row>>,
}

impl<'a, V: Manoeuvring> Transcription<'a, V> {
    /// `step` in seconds; `first` is the initial state; costs are divided by `cost_unit`.
    pub fn new(
        vessel: &'a V,
        step: f64,
        first: StateVector,
        controls: Controls,
        cost_unit: f64,
        spans: Vec<Span>,
    ) -> Self {
        let scales = vessel.scales();
        let one = |v: &[f64]| v.iter().all(|x| *x == 1.0);
        Self {
            vessel,
            scales,
            plain: one(scales.state.as_slice()) && one(scales.force.as_slice()),
            gain: vessel.gain(),
            step,
            first,
            force_limits: controls.force_limits,
            weights: controls.weights,
            cost_unit,
            rows: vec![Vec::new(); spans.len()],
            spans,
        }
    }

    /// Rows of each interval.
    pub fn rows_mut(&mut self) -> &mut [Vec<Row>] {
        &mut self.rows
    }

    /// Unit of the solver's cost.
    pub fn cost_unit(&self) -> f64 {
        self.cost_unit
    }

    /// State in SI from the solver's units.
    pub fn state(&self, scaled: &Matrix<6, 1>) -> StateVector {
        scaled.component_mul(&self.scales.state)
    }

    /// Force in SI from the solver's units.
    pub fn force(&self, scaled: &Matrix<3, 1>) -> ForceVector {
        scaled.component_mul(&self.scales.force)
    }

    /// State in the solver's units.
    pub fn scaled_state(&self, state: &StateVector) -> Matrix<6, 1> {
        state.component_div(&self.scales.state)
    }

    /// Force in the solver's units.
    pub fn scaled_force(&self, force: &ForceVector) -> Matrix<3, 1> {
        force.component_div(&self.scales.force)
    }

    fn off(&self, state: &StateVector, reference: &StateVector) -> StateVector {
        let mut off = state - reference;
        off[2] = wrap(off[2]);
        off
    }

    fn middle(&self, x: &StateVector, y: &StateVector, u: &ForceVector) -> Middle {
        let (before, after) = (self.vessel.rates(x, u), self.vessel.rates(y, u));
        Middle {
            state: 0.5 * (x + y) + self.step / 8.0 * (before - after),
            before,
            after,
        }
    }

    /// Position of the cubic at a row's time.
    fn position(
        &self,
        row: &Row,
        x: &StateVector,
        y: &StateVector,
        rates: &Middle,
    ) -> Vector2<f64> {
        let [a, b, c, d] = row.hermite;
        let (b, d) = (b * self.step, d * self.step);
        Vector2::new(
            a * x[0] + b * rates.before[0] + c * y[0] + d * rates.after[0],
            a * x[1] + b * rates.before[1] + c * y[1] + d * rates.after[1],
        )
    }
}

struct Middle {
    state: StateVector,
    before: StateVector,
    after: StateVector,
}

/// Product `left' diagonal right` for a diagonal given by its entries.
fn weighed(left: &Matrix6<f64>, diagonal: &StateVector, right: &Matrix6<f64>) -> Matrix6<f64> {
    let mut scaled = *right;
    for mut column in scaled.column_iter_mut() {
        column.component_mul_assign(diagonal);
    }
    left.tr_mul(&scaled)
}

impl<V: Manoeuvring> StageProblem<6, 3> for Transcription<'_, V> {
    fn stages(&self) -> usize {
        self.spans.len()
    }

    fn first(&self) -> Matrix<6, 1> {
        self.scaled_state(&self.first)
    }

    fn limits(&self) -> [Matrix<3, 1>; 2] {
        let high = self.scaled_force(&self.force_limits);
        [-high, high]
    }

    fn rows(&self, stage: usize) -> usize {
        self.rows[stage].len()
    }

    fn values(&self, stage: usize, at: &Triple<6, 3>, rows: &mut [f64]) -> Values<6> {
        let (x, u, y) = (self.state(&at.x), self.force(&at.u), self.state(&at.y));
        let middle = self.middle(&x, &y, &u);
        let rate = self.vessel.rates(&middle.state, &u);
        let sum = middle.before + 4.0 * rate + middle.after;
        let defect = y - x - self.step / 6.0 * sum;
        let [r0, r1, r2] = &self.spans[stage].reference;
        let square = |s: &StateVector, r: &StateVector| {
            let off = self.off(s, r);
            off.component_mul(&self.weights.state).dot(&off)
        };
        let state = square(&x, r0) + 4.0 * square(&middle.state, r1) + square(&y, r2);
        let force = u.component_mul(&self.weights.force).dot(&u);
        for (to, row) in rows.iter_mut().zip(&self.rows[stage]) {
            let position = self.position(row, &x, &y, &middle);
            *to = row.keep.level(position) - 1.0 - MARGIN;
        }
        Values {
            cost: self.step * (state / 6.0 + force) / self.cost_unit,
            defect: self.scaled_state(&defect),
        }
    }

    fn derivatives(
        &self,
        stage: usize,
        at: &Triple<6, 3>,
        multipliers: Multipliers<6>,
        out: &mut Derivatives<6, 3>,
        rows: &mut [Triple<6, 3>],
    ) {
        let h = self.step;
        let (x, u, y) = (self.state(&at.x), self.force(&at.u), self.state(&at.y));
        let l = multipliers.defect.component_div(&self.scales.state);
        let middle = self.middle(&x, &y, &u);
        let (jx, jy) = (self.vessel.jacobian(&x), self.vessel.jacobian(&y));
        let jm = self.vessel.jacobian(&middle.state);
        let half = Matrix6::from_diagonal_element(0.5);
        let (mx, my) = (half + h / 8.0 * jx, half - h / 8.0 * jy);
        let one = Matrix6::identity();
        out.defect_x = -one - h / 6.0 * (jx + 4.0 * (jm * mx));
        out.defect_y = one - h / 6.0 * (jy + 4.0 * (jm * my));
        out.defect_u = -h * self.gain;

        let [r0, r1, r2] = &self.spans[stage].reference;
        let unit = 1.0 / self.cost_unit;
        let q = self.weights.state * unit;
        let slope = |s: &StateVector, r: &StateVector| self.off(s, r).component_mul(&q);
        let qm = slope(&middle.state, r1);
        let third = h / 3.0;
        out.gradient = Triple {
            x: third * (slope(&x, r0) + 4.0 * mx.tr_mul(&qm)),
            u: 2.0 * h * unit * self.weights.force.component_mul(&u),
            y: third * (slope(&y, r2) + 4.0 * my.tr_mul(&qm)),
        };
        let ends = Matrix6::from_diagonal(&(third * q));
        out.convex = Blocks {
            xx: ends + 4.0 * third * weighed(&mx, &q, &mx),
            ux: Matrix::zeros(),
            uu: Matrix::from_diagonal(&(2.0 * h * unit * self.weights.force)),
            yx: 4.0 * third * weighed(&my, &q, &mx),
            yu: Matrix::zeros(),
            yy: ends + 4.0 * third * weighed(&my, &q, &my),
        };

        // derivatives of cost and defect with respect to the state at half time
        let by_middle = 4.0 * third * qm - 2.0 * third * jm.tr_mul(&l);
        let (mut wx, mut wy) = (
            -h / 6.0 * l + h / 8.0 * by_middle,
            -h / 6.0 * l - h / 8.0 * by_middle,
        );
        let hm = self.vessel.curvature(&middle.state, &(-2.0 * third * l));
        let (hx, hy) = (hm * mx, hm * my);
        out.curvature = Blocks {
            xx: mx.tr_mul(&hx),
            ux: Matrix::zeros(),
            uu: Matrix::zeros(),
            yx: my.tr_mul(&hx),
            yu: Matrix::zeros(),
            yy: my.tr_mul(&hy),
        };
        let (vx, vy) = (jx.fixed_rows::<2>(0), jy.fixed_rows::<2>(0));
        for ((to, row), &z) in rows.iter_mut().zip(&self.rows[stage]).zip(multipliers.rows) {
            let off = self.position(row, &x, &y, &middle) - row.keep.center;
            let slope: Vector2<f64> = 2.0 * (row.keep.inverse * off);
            let bend: Matrix2<f64> = -2.0 * z * row.keep.inverse;
            *to = Triple::zeros();
            if row.fraction == 1.0 {
                to.y.fixed_rows_mut::<2>(0).copy_from(&slope);
                let mut corner = out.curvature.yy.fixed_view_mut::<2, 2>(0, 0);
                corner += bend;
                continue;
            }
            let [a, b, c, d] = row.hermite;
            let (b, d) = (b * h, d * h);
            let place = |weight: f64, by_rate: f64, rate: Matrix2x6<f64>| {
                let mut by = rate * by_rate;
                by[(0, 0)] += weight;
                by[(1, 1)] += weight;
                by
            };
            let (px, py) = (place(a, b, vx.into_owned()), place(c, d, vy.into_owned()));
            to.x = px.tr_mul(&slope);
            to.y = py.tr_mul(&slope);
            // zero for a distant set
            if z < NEGLIGIBLE {
                continue;
            }
            let (bx, by) = (bend * px, bend * py);
            out.curvature.xx += px.tr_mul(&bx);
            out.curvature.yx += py.tr_mul(&bx);
            out.curvature.yy += py.tr_mul(&by);
            for i in 0..2 {
                wx[i] -= z * b * slope[i];
                wy[i] -= z * d * slope[i];
            }
        }
        out.curvature.xx += self.vessel.curvature(&x, &wx);
        out.curvature.yy += self.vessel.curvature(&y, &wy);
        if !self.plain {
            self.rescale(out, rows);
        }
    }
}

impl<V: Manoeuvring> Transcription<'_, V> {
    /// Converts derivatives with respect to SI variables to the solver's units.
    fn rescale(&self, out: &mut Derivatives<6, 3>, rows: &mut [Triple<6, 3>]) {
        let (s, f) = (&self.scales.state, &self.scales.force);
        let states = |m: &mut Matrix6<f64>, inverse: bool| {
            for j in 0..6 {
                for i in 0..6 {
                    m[(i, j)] *= if inverse { s[j] / s[i] } else { s[i] * s[j] };
                }
            }
        };
        states(&mut out.defect_x, true);
        states(&mut out.defect_y, true);
        for j in 0..3 {
            for i in 0..6 {
                out.defect_u[(i, j)] *= f[j] / s[i];
            }
        }
        for blocks in [&mut out.convex, &mut out.curvature] {
            states(&mut blocks.xx, false);
            states(&mut blocks.yx, false);
            states(&mut blocks.yy, false);
            for i in 0..3 {
                blocks.uu[(i, i)] *= f[i] * f[i];
            }
        }
        for triple in std::iter::once(&mut out.gradient).chain(rows) {
            triple.x.component_mul_assign(s);
            triple.u.component_mul_assign(f);
            triple.y.component_mul_assign(s);
        }
    }
}

#[cfg(test)]
mod tests;
