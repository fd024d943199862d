//! Small dense convex quadratic programme, solved by the dual active-set method of Goldfarb &
//! Idnani (doi:10.1007/BF02591962).

use crate::space_time::refinement::active_set::Compact;
use crate::space_time::refinement::factor::LANES;

/// Largest number of variables. It is fixed, so that a row is an array.
pub(crate) const MAX_VARIABLES: usize = 24;

/// Row of coefficients, one per variable.
pub(crate) type Row = [f64; MAX_VARIABLES];

/// Linear constraint `coefficients . x >= bound`.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Constraint {
    pub coefficients: Row,
    pub bound: f64,
}

/// Programme: minimise `x'Hx/2 + g'x` subject to box and rows.
#[derive(Debug)]
pub(crate) struct Programme<'a> {
    pub size: usize,
    /// Positive definite Hessian, one row per variable.
    pub hessian: &'a [Row],
    pub gradient: &'a Row,
    pub low: &'a Row,
    pub high: &'a Row,
    pub rows: &'a [Constraint],
    /// Price per unit of the largest violation of a row, where not all rows can be satisfied;
    /// `None` where all must be.
    pub price: Option<f64>,
}

/// Solution of a programme.
#[derive(Debug, Clone)]
pub(crate) struct Solution {
    pub x: Row,
    /// Multipliers, one per row, not negative; zero where the row is inactive. Their sum is the
    /// least exact penalty on the largest violation, or its price.
    pub multipliers: Vec<f64>,
    /// Largest violation of the rows; zero where all can be satisfied.
    pub missing: f64,
}

/// Reason why a programme has no solution.
pub(crate) enum Unsolved {
    /// No `x` satisfies all rows and the box.
    Contradiction,
    /// The Hessian is not positive definite, a number is not finite, or the step limit was reached.
    Stopped,
}

impl Programme<'_> {
    /// Solves the programme. Where the rows contradict one another or the box, minimises the cost
    /// plus the price of the largest violation and a negligible multiple of its square. `None` for
    /// a contradiction without a price, an indefinite Hessian or a number that is not finite.
    pub(crate) fn solve(&self) -> Option<Solution> {
        match (self.answer(None), self.price) {
            (Err(Unsolved::Contradiction), Some(price)) => self.answer(Some(price)),
            (answer, _) => answer,
        }
        .ok()
    }

    /// Solves with an additional variable where violations have a price.
    fn answer(&self, price: Option<f64>) -> Result<Solution, Unsolved> {
        let size = self.size + usize::from(price.is_some());
        match size.div_ceil(LANES) {
            0 | 1 => Compact::<4>::of(self, price).solve(),
            2 => Compact::<8>::of(self, price).solve(),
            3 => Compact::<12>::of(self, price).solve(),
            4 => Compact::<16>::of(self, price).solve(),
            5 => Compact::<20>::of(self, price).solve(),
            6 => Compact::<MAX_VARIABLES>::of(self, price).solve(),
            _ => Err(Unsolved::Stopped),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::space_time::refinement::active_set::SOFTENED_M;
    use crate::space_time::refinement::factor::dot;
    use rand::{Rng, SeedableRng};
    use rand_chacha::ChaCha8Rng;
    use std::ops::Range;

    /// Bounds of the random programmes' box.
    const LOW: Row = [-1.0; MAX_VARIABLES];
    const HIGH: Row = [2.0; MAX_VARIABLES];

    /// Strictly convex cost in up to 13 variables, with rows whose bounds are drawn from a given
    /// range.
    struct Random {
        size: usize,
        hessian: [Row; MAX_VARIABLES],
        gradient: Row,
        rows: Vec<Constraint>,
    }

    impl Random {
        fn new(rng: &mut ChaCha8Rng, rows: Range<usize>, bounds: Range<f64>) -> Self {
            let size = rng.random_range(2..14);
            let mut hessian = [[0.0; MAX_VARIABLES]; MAX_VARIABLES];
            let mut root = hessian;
            let mut gradient = [0.0; MAX_VARIABLES];
            let some = |rng: &mut ChaCha8Rng, row: &mut Row| {
                let unit = |c: &mut f64| *c = rng.random_range(-1.0..1.0);
                row[..size].iter_mut().for_each(unit);
            };
            for i in 0..size {
                gradient[i] = rng.random_range(-5.0..5.0);
                some(rng, &mut root[i]);
            }
            for i in 0..size {
                for k in 0..size {
                    hessian[i][k] = dot(&root[i], &root[k]) + if i == k { 0.05 } else { 0.0 };
                }
            }
            let count = rng.random_range(rows);
            let rows = (0..count)
                .map(|_| {
                    let mut coefficients = [0.0; MAX_VARIABLES];
                    some(rng, &mut coefficients);
                    Constraint {
                        coefficients,
                        bound: rng.random_range(bounds.clone()),
                    }
                })
                .collect();
            Self {
                size,
                hessian,
                gradient,
                rows,
            }
        }

        fn programme(&self) -> Programme<'_> {
            Programme {
                size: self.size,
                hessian: &self.hessian,
                gradient: &self.gradient,
                low: &LOW,
                high: &HIGH,
                rows: &self.rows,
                price: None,
            }
        }
    }

    /// Random point of the box near another.
    fn beside(rng: &mut ChaCha8Rng, x: &Row, size: usize) -> Row {
        let scale = 10f64.powf(rng.random_range(-4.0..0.5));
        let mut p = *x;
        for v in &mut p[..size] {
            *v = (*v + scale * rng.random_range(-1.0..1.0)).clamp(-1.0, 2.0);
        }
        p
    }

    /// Tests the optimality conditions: projected gradient on the exact penalty would be slow.
    #[test]
    fn solutions_are_feasible_and_no_feasible_direction_descends() {
        let mut rng = ChaCha8Rng::seed_from_u64(41);
        for _ in 0..400 {
            // the origin satisfies every row, so the programme is feasible
            let random = Random::new(&mut rng, 0..6, -1.0..0.0);
            let Random {
                size: n,
                hessian,
                gradient,
                rows,
            } = &random;
            let n = *n;
            let x = random.programme().solve().expect("positive definite").x;
            let feasible = |p: &Row| {
                (0..n).all(|i| p[i] >= -1.0 - 1e-7 && p[i] <= 2.0 + 1e-7)
                    && rows
                        .iter()
                        .all(|r| dot(&r.coefficients, p) >= r.bound - 1e-7)
            };
            let value = |p: &Row| {
                (0..n)
                    .map(|i| p[i] * (0.5 * dot(&hessian[i], p) + gradient[i]))
                    .sum::<f64>()
            };
            assert!(feasible(&x), "{x:?}");
            let best = value(&x);
            for _ in 0..300 {
                let p = beside(&mut rng, &x, n);
                if feasible(&p) {
                    assert!(value(&p) >= best - 1e-6, "{} {best}", value(&p));
                }
            }
        }
    }

    /// Contradictory rows: no change within the box lowers the sum of cost and price of the largest
    /// violation, and without a price there is no solution.
    #[test]
    fn contradictory_rows_minimise_cost_plus_price() {
        let mut rng = ChaCha8Rng::seed_from_u64(43);
        let mut missed = 0;
        for _ in 0..400 {
            let random = Random::new(&mut rng, 5..25, -1.0..2.0);
            let n = random.size;
            let price = rng.random_range(1.0..50.0);
            let hard = random.programme();
            let programme = Programme {
                price: Some(price),
                ..random.programme()
            };
            let Solution {
                x,
                multipliers,
                missing,
            } = programme.solve().expect("positive definite");
            let violation = |p: &Row| {
                let rows = random.rows.iter();
                rows.map(|r| r.bound - dot(&r.coefficients, p))
                    .fold(0.0, f64::max)
            };
            let value = |p: &Row| {
                let cost: f64 = (0..n)
                    .map(|i| p[i] * (0.5 * dot(&random.hessian[i], p) + random.gradient[i]))
                    .sum();
                let over = violation(p);
                cost + price * (over + 0.5 * over * over / SOFTENED_M)
            };
            assert!((violation(&x) - missing).abs() < 1e-7, "{missing}");
            assert_eq!(hard.solve().is_none(), missing > 0.0, "{missing}");
            assert!(multipliers.iter().all(|m| *m >= 0.0));
            if missing == 0.0 {
                continue;
            }
            missed += 1;
            let paid = price * (1.0 + missing / SOFTENED_M);
            let sum: f64 = multipliers.iter().sum();
            assert!((sum - paid).abs() < 1e-9 * paid, "{sum} {paid}");
            let best = value(&x);
            for _ in 0..300 {
                let p = beside(&mut rng, &x, n);
                assert!(value(&p) >= best - 1e-6, "{} {best}", value(&p));
            }
        }
        assert!(missed > 100, "{missed}");
    }
}
