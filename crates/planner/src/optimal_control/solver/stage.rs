//! Multistage problem: the interface of the solver.

/// Matrix with `R` rows and `C` columns.
pub type Matrix<const R: usize, const C: usize> = nalgebra::SMatrix<f64, R, C>;

/// Vector with `R` rows.
pub type Vector<const R: usize> = nalgebra::SVector<f64, R>;

/// Point in the variables of one stage, or a gradient or step in them: state, control, next state.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Triple<const N: usize, const M: usize> {
    /// State component.
    pub x: Vector<N>,
    /// Control component.
    pub u: Vector<M>,
    /// Next-state component.
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

/// Symmetric matrix over one stage's variables, by its lower blocks.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Blocks<const N: usize, const M: usize> {
    /// State by state.
    pub xx: Matrix<N, N>,
    /// Control by state.
    pub ux: Matrix<M, N>,
    /// Control by control.
    pub uu: Matrix<M, M>,
    /// Next state by state.
    pub yx: Matrix<N, N>,
    /// Next state by control.
    pub yu: Matrix<N, M>,
    /// Next state by next state.
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

    /// Adds `weight v v'`. Rows rarely have all three components.
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

/// Function values of a stage at a point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Values<const N: usize> {
    /// Stage cost.
    pub cost: f64,
    /// Equation defect, which must vanish.
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

/// Derivatives of a stage at a point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Derivatives<const N: usize, const M: usize> {
    /// Gradient of the cost.
    pub gradient: Triple<N, M>,
    /// Jacobian of the defect in the state.
    pub defect_x: Matrix<N, N>,
    /// Jacobian of the defect in the control.
    pub defect_u: Matrix<N, M>,
    /// Jacobian of the defect in the next state: regular.
    pub defect_y: Matrix<N, N>,
    /// Positive semidefinite part of the second derivative of the cost (Gauss–Newton).
    pub convex: Blocks<N, M>,
    /// Rest of the second derivative of `cost + multipliers . defect - row multipliers . rows`.
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

/// Multipliers of one stage.
#[derive(Debug, Clone, Copy)]
pub struct Multipliers<'a, const N: usize> {
    /// Multipliers of the defect.
    pub defect: &'a Vector<N>,
    /// Multipliers of the rows.
    pub rows: &'a [f64],
}

/// Multistage problem
///
/// ```text
/// min  sum cost_k(x_k, u_k, x_k+1)     x_0 given
/// s.t. defect_k(x_k, u_k, x_k+1) = 0                 N equations that determine x_k+1
///      rows_k(x_k, u_k, x_k+1) >= 0                  as many as the stage has, at an exact penalty
///      low <= u_k <= high                            strictly within; infinite where there is none
/// ```
///
/// with `N` states and `M` controls. Every function is twice differentiable.
pub trait StageProblem<const N: usize, const M: usize> {
    /// Number of stages, at least one.
    fn stages(&self) -> usize;

    /// Given first state.
    fn first(&self) -> Vector<N>;

    /// Lower and upper control limits.
    fn limits(&self) -> [Vector<M>; 2];

    /// Number of rows of a stage.
    fn rows(&self, stage: usize) -> usize;

    /// Cost and defect; writes the rows.
    fn values(&self, stage: usize, at: &Triple<N, M>, rows: &mut [f64]) -> Values<N>;

    /// All derivatives; writes the gradients of the rows.
    fn derivatives(
        &self,
        stage: usize,
        at: &Triple<N, M>,
        multipliers: Multipliers<N>,
        derivatives: &mut Derivatives<N, M>,
        rows: &mut [Triple<N, M>],
    );
}
