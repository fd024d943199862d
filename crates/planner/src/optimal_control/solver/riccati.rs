//! Newton step by a Riccati recursion over the stages; the cost is linear in their number.

use nalgebra::{Cholesky, Const};

use super::stage::{Blocks, Derivatives, Matrix, Triple, Vector};

/// Factorised stage of the equations
///
/// ```text
/// min  sum 1/2 d' H d + g . d     s.t.  defect + C d = 0,    d = (dx, du, dy)
/// ```
///
/// with `dy = A dx + B du + b` from the stage's own equations and `du = K dx + k` from the cost to
/// go.
#[derive(Debug, Clone, Copy)]
pub(super) struct StageFactor<const N: usize, const M: usize> {
    /// Inverse of the Jacobian of the equations in the next state.
    inverse: Matrix<N, N>,
    by_state: Matrix<N, N>,
    by_control: Matrix<N, M>,
    constant: Vector<N>,
    /// Blocks of `H` that involve the next state; `yy` includes the cost to go from there.
    after: Blocks<N, M>,
    cholesky: Cholesky<f64, Const<M>>,
    gain: Matrix<M, N>,
    feed: Vector<M>,
    /// Block `ux` of the condensed stage.
    mixed: Matrix<M, N>,
    /// Gradient of the cost to go from the next state, including the stage's own.
    slope: Vector<N>,
}

impl<const N: usize, const M: usize> StageFactor<N, M> {
    pub fn new() -> Self {
        Self {
            inverse: Matrix::identity(),
            by_state: Matrix::zeros(),
            by_control: Matrix::zeros(),
            constant: Vector::zeros(),
            after: Blocks::zeros(),
            cholesky: Cholesky::pack_dirty(Matrix::identity()),
            gain: Matrix::zeros(),
            feed: Vector::zeros(),
            mixed: Matrix::zeros(),
            slope: Vector::zeros(),
        }
    }
}

/// Solves every stage's equations for the next state. False where they do not determine it.
/// O(stages N³).
pub(super) fn eliminate<const N: usize, const M: usize>(
    factors: &mut [StageFactor<N, M>],
    derivatives: &[Derivatives<N, M>],
) -> bool {
    for (factor, stage) in factors.iter_mut().zip(derivatives) {
        let inverse = stage.defect_y.try_inverse();
        let Some(inverse) = inverse.filter(|m| m.sum().is_finite()) else {
            return false;
        };
        factor.inverse = inverse;
        factor.by_state = -inverse * stage.defect_x;
        factor.by_control = -inverse * stage.defect_u;
    }
    true
}

/// Factorises from the last stage to the first. False where a condensed control block is not
/// positive definite: the equations then have the wrong inertia. O(stages (N + M)³).
pub(super) fn factorise<const N: usize, const M: usize>(
    factors: &mut [StageFactor<N, M>],
    hessian: &[Blocks<N, M>],
) -> bool {
    let mut to_go = Matrix::<N, N>::zeros();
    for (factor, h) in factors.iter_mut().zip(hessian).rev() {
        let (a, b) = (&factor.by_state, &factor.by_control);
        factor.after = *h;
        factor.after.yy += to_go;
        // products with the next state, each computed once
        let half_a = factor.after.yy * a * 0.5 + h.yx;
        let full_b = factor.after.yy * b + h.yu;
        let mixed = h.ux + full_b.tr_mul(a) + b.tr_mul(&h.yx);
        let across = full_b.tr_mul(b);
        let uu = h.uu + 0.5 * (across + across.transpose()) + symmetric_half(&h.yu, b);
        let Some(cholesky) = positive_definite(uu) else {
            return false;
        };
        let mut gain = -mixed;
        cholesky.solve_mut(&mut gain);
        let round = half_a.tr_mul(a);
        let square = mixed.tr_mul(&gain);
        to_go = h.xx + round + round.transpose() + 0.5 * (square + square.transpose());
        factor.cholesky = cholesky;
        factor.gain = gain;
        factor.mixed = mixed;
    }
    true
}

/// Cholesky factor; `None` where the matrix is not positive definite beyond rounding.
fn positive_definite<const M: usize>(a: Matrix<M, M>) -> Option<Cholesky<f64, Const<M>>> {
    let factor = Cholesky::new(a)?;
    // negated on purpose: a NaN is not positive
    let is_rounding = |j: usize| {
        let square = factor.l_dirty()[(j, j)].powi(2);
        !(square > M as f64 * f64::EPSILON * a[(j, j)].abs() && square.is_finite())
    };
    (!(0..M).any(is_rounding)).then_some(factor)
}

/// The part of `h' b + b' h` that is missing from `(yy b + h)' b`, made symmetric.
fn symmetric_half<const N: usize, const M: usize>(
    h: &Matrix<N, M>,
    b: &Matrix<N, M>,
) -> Matrix<M, M> {
    let across = h.tr_mul(b);
    0.5 * (across + across.transpose())
}

/// Right-hand side of a solve with given factors.
#[derive(Debug, Clone, Copy)]
pub(super) struct RightSide<'a, const N: usize, const M: usize> {
    /// Gradients `g`, per stage.
    pub gradient: &'a [Triple<N, M>],
    /// Defects, per stage.
    pub defect: &'a [Vector<N>],
}

/// Solves for the step and the new multipliers of the equations; `steps[k].y` is `steps[k + 1].x`.
/// O(stages N²).
pub(super) fn solve<const N: usize, const M: usize>(
    factors: &mut [StageFactor<N, M>],
    right: RightSide<N, M>,
    steps: &mut [Triple<N, M>],
    multipliers: &mut [Vector<N>],
) {
    let mut slope = Vector::<N>::zeros();
    for (k, factor) in factors.iter_mut().enumerate().rev() {
        let g = &right.gradient[k];
        factor.constant = -factor.inverse * right.defect[k];
        factor.slope = g.y + slope;
        let to_go = factor.slope + factor.after.yy * factor.constant;
        let mut feed =
            -(g.u + factor.by_control.tr_mul(&to_go) + factor.after.yu.tr_mul(&factor.constant));
        let bent = g.x + factor.by_state.tr_mul(&to_go) + factor.after.yx.tr_mul(&factor.constant);
        factor.cholesky.solve_mut(&mut feed);
        slope = bent + factor.mixed.tr_mul(&feed);
        factor.feed = feed;
    }
    let mut x = Vector::<N>::zeros();
    for (k, factor) in factors.iter().enumerate() {
        let u = factor.gain * x + factor.feed;
        let y = factor.by_state * x + factor.by_control * u + factor.constant;
        let multiplier =
            -(factor.after.yx * x + factor.after.yu * u + factor.after.yy * y + factor.slope);
        multipliers[k] = factor.inverse.tr_mul(&multiplier);
        steps[k] = Triple { x, u, y };
        x = y;
    }
}
