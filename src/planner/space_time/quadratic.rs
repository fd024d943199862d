//! A small dense convex quadratic programme by the dual active-set method of Goldfarb & Idnani
//! (doi:10.1007/BF02591962).

use super::active_set::Compact;
use super::factor::LANES;

/// Most variables of a programme: fixed, so that a row is an array.
pub(crate) const MAX_VARIABLES: usize = 24;

/// A row of numbers, one per variable.
pub(crate) type Row = [f64; MAX_VARIABLES];

/// `coefficients . x >= bound`.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Constraint {
    pub coefficients: Row,
    pub bound: f64,
}

/// `minimise x'Hx/2 + g'x` subject to box and rows.
#[derive(Debug)]
pub(crate) struct Programme<'a> {
    pub size: usize,
    /// Positive definite, a row per variable.
    pub hessian: &'a [Row],
    pub gradient: &'a Row,
    pub low: &'a Row,
    pub high: &'a Row,
    pub rows: &'a [Constraint],
}

/// Where the minimum is.
#[derive(Debug, Clone)]
pub(crate) struct Solution {
    pub x: Row,
    /// One per row, not negative; zero where the row is slack or was left out. Their sum is the least
    /// weight of an exact penalty on the largest violation.
    pub multipliers: Vec<f64>,
}

impl Programme<'_> {
    /// The minimum; rows that cannot be met together with the box and earlier rows are left out, one
    /// at a time (the caller's merit function sees what is violated). `None` when the Hessian is not
    /// positive definite or a number is not finite.
    pub(crate) fn solve(&self) -> Option<Solution> {
        match self.size.div_ceil(LANES) {
            0 | 1 => Compact::<4>::of(self).solve(),
            2 => Compact::<8>::of(self).solve(),
            3 => Compact::<12>::of(self).solve(),
            4 => Compact::<16>::of(self).solve(),
            5 => Compact::<20>::of(self).solve(),
            _ => Compact::<MAX_VARIABLES>::of(self).solve(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::factor::dot;
    use super::*;
    use rand::{Rng, SeedableRng};
    use rand_chacha::ChaCha8Rng;
    use std::ops::Range;

    /// The box of the random programmes.
    const LOW: Row = [-1.0; MAX_VARIABLES];
    const HIGH: Row = [2.0; MAX_VARIABLES];

    /// A strictly convex cost in up to 13 variables, with rows at bounds from the given range.
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
            }
        }
    }

    /// Projected gradient on the exact penalty is slow; the optimality conditions are the definition.
    #[test]
    fn solutions_are_feasible_and_no_feasible_direction_descends() {
        let mut rng = ChaCha8Rng::seed_from_u64(41);
        for _ in 0..400 {
            // the origin satisfies every row: the programme is feasible
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
                let scale = 10f64.powf(rng.random_range(-4.0..0.5));
                let mut p = x;
                p[..n]
                    .iter_mut()
                    .for_each(|v| *v += scale * rng.random_range(-1.0..1.0));
                p[..n].iter_mut().for_each(|v| *v = v.clamp(-1.0, 2.0));
                if feasible(&p) {
                    assert!(value(&p) >= best - 1e-6, "{} {best}", value(&p));
                }
            }
        }
    }

    /// With rows that contradict one another and the box: what is left is the minimum over the rows that push and the
    /// box, whichever were left out.
    #[test]
    fn what_contradicts_is_left_out_and_the_rest_is_a_minimum() {
        let mut rng = ChaCha8Rng::seed_from_u64(43);
        let mut pushing = 0;
        for _ in 0..400 {
            let random = Random::new(&mut rng, 5..25, -1.0..2.0);
            let Random {
                size: n,
                hessian,
                gradient,
                rows,
            } = &random;
            let solution = random.programme().solve().expect("positive definite");
            let Solution { x, multipliers } = solution;
            for (row, multiplier) in rows.iter().zip(&multipliers) {
                assert!(*multiplier >= 0.0);
                if *multiplier > 1e-9 {
                    pushing += 1;
                    let value = dot(&row.coefficients, &x) - row.bound;
                    assert!(value.abs() < 1e-7, "{value}");
                }
            }
            for i in 0..*n {
                assert!(x[i] >= -1.0 - 1e-7 && x[i] <= 2.0 + 1e-7, "{x:?}");
                let pushed: f64 = rows
                    .iter()
                    .zip(&multipliers)
                    .map(|(row, m)| row.coefficients[i] * m)
                    .sum();
                let rate = gradient[i] + dot(&hessian[i], &x) - pushed;
                let tolerance = 1e-9 * (1.0 + multipliers.iter().sum::<f64>());
                assert!(rate < tolerance || x[i] < -1.0 + 1e-7, "{i}: {rate} {x:?}");
                assert!(rate > -tolerance || x[i] > 2.0 - 1e-7, "{i}: {rate} {x:?}");
            }
        }
        assert!(pushing > 400, "{pushing}");
    }

    #[test]
    fn contradicting_rows_are_left_out() {
        let mut hessian = [[0.0; MAX_VARIABLES]; MAX_VARIABLES];
        hessian[0][0] = 1.0;
        let row = |c: f64, bound: f64| {
            let mut coefficients = [0.0; MAX_VARIABLES];
            coefficients[0] = c;
            Constraint {
                coefficients,
                bound,
            }
        };
        let programme = Programme {
            size: 1,
            hessian: &hessian,
            gradient: &[0.0; MAX_VARIABLES],
            low: &[-9.0; MAX_VARIABLES],
            high: &[9.0; MAX_VARIABLES],
            rows: &[row(1.0, 2.0), row(-1.0, 5.0)],
        };
        let x = programme.solve().expect("solvable").x[0];
        assert!((x - 2.0).abs() < 1e-9 || (x + 5.0).abs() < 1e-9);
    }
}
