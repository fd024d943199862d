//! The stage problem: what the solver is asked, one stage after another.

use super::dense::{Matrix, Vector};

/// One stage's variables, a gradient by them or a step in them: the state before, the control, the state after.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Triple<const N: usize, const M: usize> {
    /// By the state before.
    pub x: Vector<N>,
    /// By the control.
    pub u: Vector<M>,
    /// By the state after.
    pub y: Vector<N>,
}

impl<const N: usize, const M: usize> Triple<N, M> {
    /// All zeros.
    pub fn zeros() -> Self {
        Self {
            x: Vector::zeros(),
            u: Vector::zeros(),
            y: Vector::zeros(),
        }
    }

    pub(super) fn dot(&self, other: &Self) -> f64 {
        self.x.dot(&other.x) + self.u.dot(&other.u) + self.y.dot(&other.y)
    }

    pub(super) fn add_scaled(&mut self, factor: f64, other: &Self) {
        self.x.axpy(factor, &other.x, 1.0);
        self.u.axpy(factor, &other.u, 1.0);
        self.y.axpy(factor, &other.y, 1.0);
    }
}

/// A symmetric matrix over one stage's variables, by its lower blocks.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Blocks<const N: usize, const M: usize> {
    /// State before with itself.
    pub xx: Matrix<N, N>,
    /// Control with the state before.
    pub ux: Matrix<M, N>,
    /// Control with itself.
    pub uu: Matrix<M, M>,
    /// State after with the state before.
    pub yx: Matrix<N, N>,
    /// State after with the control.
    pub yu: Matrix<N, M>,
    /// State after with itself.
    pub yy: Matrix<N, N>,
}

impl<const N: usize, const M: usize> Blocks<N, M> {
    /// All zeros.
    pub fn zeros() -> Self {
        Self {
            xx: Matrix::zeros(),
            ux: Matrix::zeros(),
            uu: Matrix::zeros(),
            yx: Matrix::zeros(),
            yu: Matrix::zeros(),
            yy: Matrix::zeros(),
        }
    }

    pub(super) fn add(&mut self, other: &Self) {
        self.xx += other.xx;
        self.ux += other.ux;
        self.uu += other.uu;
        self.yx += other.yx;
        self.yu += other.yu;
        self.yy += other.yy;
    }

    /// Adds `weight v v'`. Rows seldom hold all three.
    pub(super) fn add_square(&mut self, weight: f64, v: &Triple<N, M>) {
        let any = |part: &[f64]| part.iter().any(|value| *value != 0.0);
        self.yy.ger(weight, &v.y, &v.y, 1.0);
        if any(v.x.as_slice()) {
            self.xx.ger(weight, &v.x, &v.x, 1.0);
            self.yx.ger(weight, &v.y, &v.x, 1.0);
        }
        if any(v.u.as_slice()) {
            self.ux.ger(weight, &v.u, &v.x, 1.0);
            self.uu.ger(weight, &v.u, &v.u, 1.0);
            self.yu.ger(weight, &v.y, &v.u, 1.0);
        }
    }
}

/// What a stage is worth at a point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Values<const N: usize> {
    /// Its part of the objective.
    pub cost: f64,
    /// What has to vanish.
    pub defect: Vector<N>,
}

impl<const N: usize> Values<N> {
    /// All zeros.
    pub fn zeros() -> Self {
        Self {
            cost: 0.0,
            defect: Vector::zeros(),
        }
    }
}

/// The derivatives of a stage at a point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Derivatives<const N: usize, const M: usize> {
    /// Of the cost.
    pub gradient: Triple<N, M>,
    /// Of the defect by the state before.
    pub defect_x: Matrix<N, N>,
    /// Of the defect by the control.
    pub defect_u: Matrix<N, M>,
    /// Of the defect by the state after: regular.
    pub defect_y: Matrix<N, N>,
    /// Positive semidefinite part of the second derivative of the cost (Gauss–Newton).
    pub convex: Blocks<N, M>,
    /// What is missing from it to the second derivative of `cost + multipliers . defect - row multipliers . rows`.
    pub curvature: Blocks<N, M>,
}

impl<const N: usize, const M: usize> Derivatives<N, M> {
    /// All zeros.
    pub fn zeros() -> Self {
        Self {
            gradient: Triple::zeros(),
            defect_x: Matrix::zeros(),
            defect_u: Matrix::zeros(),
            defect_y: Matrix::zeros(),
            convex: Blocks::zeros(),
            curvature: Blocks::zeros(),
        }
    }
}

/// A point in one stage's variables.
#[derive(Debug, Clone, Copy)]
pub struct Point<'a, const N: usize, const M: usize> {
    /// The state before.
    pub x: &'a Vector<N>,
    /// The control.
    pub u: &'a Vector<M>,
    /// The state after.
    pub y: &'a Vector<N>,
}

/// Multipliers of one stage.
#[derive(Debug, Clone, Copy)]
pub struct Multipliers<'a, const N: usize> {
    /// Of the defect.
    pub defect: &'a Vector<N>,
    /// Of the rows.
    pub rows: &'a [f64],
}

/// The problem
///
/// ```text
/// min  sum cost_k(x_k, u_k, x_k+1)     x_0 given
/// s.t. defect_k(x_k, u_k, x_k+1) = 0                 N equations that determine x_k+1
///      rows_k(x_k, u_k, x_k+1) >= 0                  as many as the stage says, at an exact penalty
///      low <= u_k <= high                            strictly within; infinite where there is none
///
/// with `N` states and `M` controls. Every function is twice differentiable.
pub trait StageProblem<const N: usize, const M: usize> {
    /// Their number, at least one.
    fn stages(&self) -> usize;

    /// The given first state.
    fn first(&self) -> Vector<N>;

    /// The least and the greatest control.
    fn limits(&self) -> [Vector<M>; 2];

    /// How many rows a stage has.
    fn rows(&self, stage: usize) -> usize;

    /// Cost and defect; writes the rows.
    fn values(&self, stage: usize, at: Point<N, M>, rows: &mut [f64]) -> Values<N>;

    /// All derivatives; writes the gradients of the rows.
    fn derivatives(
        &self,
        stage: usize,
        at: Point<N, M>,
        multipliers: Multipliers<N>,
        derivatives: &mut Derivatives<N, M>,
        rows: &mut [Triple<N, M>],
    );
}
