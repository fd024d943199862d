//! Small dense matrices of fixed size. nalgebra's factorisations need bounds on the dimension that
//! const generics cannot state.

/// Matrix with `R` rows and `C` columns.
pub type Matrix<const R: usize, const C: usize> = nalgebra::SMatrix<f64, R, C>;

/// Vector with `R` rows.
pub type Vector<const R: usize> = nalgebra::SVector<f64, R>;

/// LU factorisation `P A = L U` with row exchanges. O(N³/3).
#[derive(Debug, Clone, Copy)]
pub(super) struct Lu<const N: usize> {
    factors: Matrix<N, N>,
    pivots: [usize; N],
}

impl<const N: usize> Lu<N> {
    pub fn identity() -> Self {
        Self {
            factors: Matrix::identity(),
            pivots: std::array::from_fn(|i| i),
        }
    }

    /// `None` where the matrix is singular or not finite.
    pub fn new(mut a: Matrix<N, N>) -> Option<Self> {
        let mut pivots = [0; N];
        for k in 0..N {
            let mut best = k;
            for i in k + 1..N {
                if a[(i, k)].abs() > a[(best, k)].abs() {
                    best = i;
                }
            }
            // negated on purpose: a NaN is no pivot
            if !(a[(best, k)].abs() > 0.0) || !a[(best, k)].is_finite() {
                return None;
            }
            pivots[k] = best;
            if best != k {
                a.swap_rows(best, k);
            }
            let inverse = 1.0 / a[(k, k)];
            for i in k + 1..N {
                a[(i, k)] *= inverse;
            }
            for j in k + 1..N {
                let above = a[(k, j)];
                for i in k + 1..N {
                    a[(i, j)] -= a[(i, k)] * above;
                }
            }
        }
        Some(Self { factors: a, pivots })
    }

    /// Overwrites `b` with `A^-1 b`.
    pub fn solve<const C: usize>(&self, b: &mut Matrix<N, C>) {
        for k in 0..N {
            if self.pivots[k] != k {
                b.swap_rows(k, self.pivots[k]);
            }
        }
        for c in 0..C {
            for k in 0..N {
                let value = b[(k, c)];
                for i in k + 1..N {
                    b[(i, c)] -= self.factors[(i, k)] * value;
                }
            }
            for k in (0..N).rev() {
                b[(k, c)] /= self.factors[(k, k)];
                let value = b[(k, c)];
                for i in 0..k {
                    b[(i, c)] -= self.factors[(i, k)] * value;
                }
            }
        }
    }

    /// Overwrites `b` with `A'^-1 b`.
    pub fn solve_transposed(&self, b: &mut Vector<N>) {
        for k in 0..N {
            let mut value = b[k];
            for i in 0..k {
                value -= self.factors[(i, k)] * b[i];
            }
            b[k] = value / self.factors[(k, k)];
        }
        for k in (0..N).rev() {
            let mut value = b[k];
            for i in k + 1..N {
                value -= self.factors[(i, k)] * b[i];
            }
            b[k] = value;
        }
        for k in (0..N).rev() {
            b.swap_rows(k, self.pivots[k]);
        }
    }
}

/// Cholesky factorisation `A = L L'`. O(M³/6).
#[derive(Debug, Clone, Copy)]
pub(super) struct Cholesky<const M: usize> {
    lower: Matrix<M, M>,
}

impl<const M: usize> Cholesky<M> {
    pub fn identity() -> Self {
        Self {
            lower: Matrix::identity(),
        }
    }

    /// Factorises the lower half; `None` where the matrix is not positive definite beyond rounding.
    pub fn new(a: &Matrix<M, M>) -> Option<Self> {
        let mut lower = Matrix::zeros();
        for j in 0..M {
            let mut square = a[(j, j)];
            for k in 0..j {
                square -= lower[(j, k)] * lower[(j, k)];
            }
            // negated on purpose: a NaN is not positive
            if !(square > M as f64 * f64::EPSILON * a[(j, j)].abs()) || !square.is_finite() {
                return None;
            }
            let root = square.sqrt();
            lower[(j, j)] = root;
            for i in j + 1..M {
                let mut value = a[(i, j)];
                for k in 0..j {
                    value -= lower[(i, k)] * lower[(j, k)];
                }
                lower[(i, j)] = value / root;
            }
        }
        Some(Self { lower })
    }

    /// Overwrites `b` with `A^-1 b`.
    pub fn solve<const C: usize>(&self, b: &mut Matrix<M, C>) {
        for c in 0..C {
            for i in 0..M {
                let mut value = b[(i, c)];
                for k in 0..i {
                    value -= self.lower[(i, k)] * b[(k, c)];
                }
                b[(i, c)] = value / self.lower[(i, i)];
            }
            for i in (0..M).rev() {
                let mut value = b[(i, c)];
                for k in i + 1..M {
                    value -= self.lower[(k, i)] * b[(k, c)];
                }
                b[(i, c)] = value / self.lower[(i, i)];
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{Rng, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    #[test]
    fn factors_solve_both_systems_and_reject_singular_matrices() {
        let mut rng = ChaCha8Rng::seed_from_u64(3);
        for _ in 0..200 {
            let a = Matrix::<5, 5>::from_fn(|_, _| rng.random_range(-1.0..1.0));
            let b = Matrix::<5, 2>::from_fn(|_, _| rng.random_range(-1.0..1.0));
            let lu = Lu::new(a).expect("regular");
            let mut x = b;
            lu.solve(&mut x);
            assert!((a * x - b).amax() < 1e-9);
            let mut x = b.column(0).into_owned();
            lu.solve_transposed(&mut x);
            assert!((a.transpose() * x - b.column(0)).amax() < 1e-9);
            let square = a * a.transpose();
            let mut x = b;
            let cholesky = Cholesky::new(&square).expect("positive");
            cholesky.solve(&mut x);
            assert!((square * x - b).amax() < 1e-6);
            assert!(Cholesky::new(&(square - Matrix::identity() * square.trace())).is_none());
        }
        assert!(Lu::<3>::new(Matrix::zeros()).is_none());
        assert!(Lu::<3>::new(Matrix::repeat(f64::NAN)).is_none());
        assert!(Cholesky::<2>::new(&Matrix::repeat(1.0)).is_none());
        assert!(Cholesky::<2>::new(&Matrix::repeat(f64::NAN)).is_none());
    }
}
