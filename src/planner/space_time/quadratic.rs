//! A small dense convex quadratic programme by the dual active-set method of Goldfarb & Idnani
//! (doi:10.1007/BF02591962).

use super::factor::{add, add_scaled, dot, inverse_transposed_factor, remove};

/// Most variables of a programme: fixed, so that no step allocates.
pub(crate) const MAX_VARIABLES: usize = 24;

/// A row of numbers, one per variable.
pub(crate) type Row = [f64; MAX_VARIABLES];

/// A square matrix.
pub(crate) type Matrix = [Row; MAX_VARIABLES];

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
    /// Positive definite.
    pub hessian: &'a Matrix,
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

/// Share of the steepest descent below which an empty slot stays empty.
const NEXT_TO_NOTHING: f64 = 2e-3;

/// Steps before giving up; a programme of this size needs about as many as it has constraints.
const MAX_STEPS: usize = 400;

/// Relative violation that is none.
const SATISFIED: f64 = 1e-9;

#[derive(Clone, Copy, PartialEq)]
enum Kind {
    Low(usize),
    High(usize),
    Row(usize),
}

/// Reciprocals of what a violation of each constraint is measured by.
struct Scales {
    low: Row,
    high: Row,
    rows: Vec<f64>,
}

impl Programme<'_> {
    /// [`Programme::solve`] with the variables that were at a lower bound of zero last time left out at
    /// first, and taken in again where that is not optimal: most slots of a manoeuvre stay empty, and the
    /// cost grows with the cube of the size. `still` says which, and is brought up to date.
    pub(crate) fn solve_from(&self, still: &mut [bool; MAX_VARIABLES]) -> Option<Solution> {
        let n = self.size;
        for (s, low) in still.iter_mut().zip(self.low) {
            *s &= *low == 0.0;
        }
        loop {
            let free: Vec<usize> = (0..n).filter(|i| !still[*i]).collect();
            let pick = |row: &Row| {
                let mut picked = [0.0; MAX_VARIABLES];
                for (to, from) in picked.iter_mut().zip(&free) {
                    *to = row[*from];
                }
                picked
            };
            let mut hessian: Matrix = [[0.0; MAX_VARIABLES]; MAX_VARIABLES];
            for (to, from) in hessian.iter_mut().zip(&free) {
                *to = pick(&self.hessian[*from]);
            }
            let rows: Vec<Constraint> = self
                .rows
                .iter()
                .map(|r| Constraint {
                    coefficients: pick(&r.coefficients),
                    bound: r.bound,
                })
                .collect();
            let part = Programme {
                size: free.len(),
                hessian: &hessian,
                gradient: &pick(self.gradient),
                low: &pick(self.low),
                high: &pick(self.high),
                rows: &rows,
            };
            let solution = part.solve()?;
            let mut x = [0.0; MAX_VARIABLES];
            for (value, to) in solution.x.iter().zip(&free) {
                x[*to] = *value;
            }
            // a slot that would gain next to nothing may stay empty
            let steepest = self.gradient[..n]
                .iter()
                .fold(0.0_f64, |m, g| m.max(g.abs()));
            let mut settled = true;
            for i in (0..n).filter(|i| still[*i]).collect::<Vec<_>>() {
                let pull: f64 = self
                    .rows
                    .iter()
                    .zip(&solution.multipliers)
                    .map(|(r, m)| r.coefficients[i] * m)
                    .sum();
                if self.gradient[i] + dot(&self.hessian[i], &x, n) - pull
                    < -NEXT_TO_NOTHING * steepest
                {
                    still[i] = false;
                    settled = false;
                }
            }
            if settled {
                for i in 0..n {
                    still[i] = self.low[i] == 0.0 && x[i] <= 0.0;
                }
                return Some(Solution {
                    x,
                    multipliers: solution.multipliers,
                });
            }
        }
    }

    /// The minimum; rows that cannot be met together with the box and earlier rows are left out, one
    /// at a time (the caller's merit function sees what is violated). `None` when the Hessian is not
    /// positive definite or a number is not finite.
    pub(crate) fn solve(&self) -> Option<Solution> {
        let mut ignored = vec![false; self.rows.len()];
        loop {
            match self.attempt(&ignored) {
                Ok(solution) => return Some(solution),
                Err(Some(row)) => ignored[row] = true,
                Err(None) => return None,
            }
        }
    }

    fn value(&self, kind: Kind, x: &Row) -> f64 {
        match kind {
            Kind::Low(i) => x[i] - self.low[i],
            Kind::High(i) => self.high[i] - x[i],
            Kind::Row(r) => dot(&self.rows[r].coefficients, x, self.size) - self.rows[r].bound,
        }
    }

    /// The most violated constraint that is not active, each relative to its scale.
    fn violated(&self, x: &Row, active: &[Kind], scales: &Scales) -> Option<Kind> {
        let mut worst = (-SATISFIED, None);
        let mut look = |kind: Kind, v: f64| {
            if v < worst.0 && !active.contains(&kind) {
                worst = (v, Some(kind));
            }
        };
        for (i, x) in x.iter().enumerate().take(self.size) {
            look(Kind::Low(i), (x - self.low[i]) * scales.low[i]);
            look(Kind::High(i), (self.high[i] - x) * scales.high[i]);
        }
        for (r, scale) in scales.rows.iter().enumerate() {
            // left out rows have no weight
            if *scale > 0.0 {
                look(Kind::Row(r), self.value(Kind::Row(r), x) * scale);
            }
        }
        worst.1
    }

    fn scales(&self, ignored: &[bool]) -> Scales {
        let n = self.size;
        let of_row = |(row, left_out): (&Constraint, &bool)| {
            let norm = dot(&row.coefficients, &row.coefficients, n).sqrt();
            let scale = 1.0 / (1.0 + row.bound.abs()).max(norm);
            if *left_out { 0.0 } else { scale }
        };
        Scales {
            low: self.low.map(|l| 1.0 / (1.0 + l.abs())),
            high: self.high.map(|h| 1.0 / (1.0 + h.abs())),
            rows: self.rows.iter().zip(ignored).map(of_row).collect(),
        }
    }

    #[inline(never)]
    fn attempt(&self, ignored: &[bool]) -> Result<Solution, Option<usize>> {
        let n = self.size;
        let mut j = inverse_transposed_factor(self.hessian, n).ok_or(None)?;
        let mut x = [0.0; MAX_VARIABLES];
        for column in j.iter().take(n) {
            add_scaled(&mut x, -dot(column, self.gradient, n), column, n);
        }
        let mut r: Matrix = [[0.0; MAX_VARIABLES]; MAX_VARIABLES];
        let mut active: Vec<Kind> = Vec::with_capacity(n);
        let mut u = [0.0; MAX_VARIABLES + 1];
        let mut steps = 0;
        let scales = self.scales(ignored);
        while let Some(entering) = self.violated(&x, &active, &scales) {
            let mut multiplier = 0.0;
            loop {
                steps += 1;
                if steps > MAX_STEPS || !x[..n].iter().all(|v| v.is_finite()) {
                    return Err(None);
                }
                let q = active.len();
                let mut d = [0.0; MAX_VARIABLES];
                for (d, column) in d.iter_mut().zip(&j).take(n) {
                    *d = match entering {
                        Kind::Low(i) => column[i],
                        Kind::High(i) => -column[i],
                        Kind::Row(row) => dot(column, &self.rows[row].coefficients, n),
                    };
                }
                let mut z = [0.0; MAX_VARIABLES];
                for (column, d) in j[q..n].iter().zip(&d[q..n]) {
                    add_scaled(&mut z, *d, column, n);
                }
                let mut back = [0.0; MAX_VARIABLES];
                for i in (0..q).rev() {
                    let sum: f64 = (i + 1..q).map(|k| r[i][k] * back[k]).sum();
                    back[i] = (d[i] - sum) / r[i][i];
                }
                let (mut dual_step, mut leaving) = (f64::INFINITY, None);
                for i in 0..q {
                    if back[i] > 1e-14 && u[i] / back[i] < dual_step {
                        dual_step = u[i] / back[i];
                        leaving = Some(i);
                    }
                }
                // z . normal
                let slope: f64 = d[q..n].iter().map(|d| d * d).sum();
                let all = slope + d[..q].iter().map(|d| d * d).sum::<f64>();
                let primal_step = if slope > 1e-16 * all {
                    -self.value(entering, &x) / slope
                } else {
                    f64::INFINITY
                };
                let step = dual_step.min(primal_step);
                if step.is_infinite() {
                    return Err(match entering {
                        Kind::Row(row) => Some(row),
                        // a bound that contradicts active rows: leave out one of those
                        _ => active.iter().rev().find_map(|k| match k {
                            Kind::Row(row) => Some(*row),
                            _ => None,
                        }),
                    });
                }
                for i in 0..q {
                    u[i] -= step * back[i];
                }
                multiplier += step;
                if primal_step.is_finite() {
                    for i in 0..n {
                        x[i] += step * z[i];
                    }
                }
                if primal_step <= dual_step {
                    add(&mut j, &mut r, &mut d, q, n);
                    u[q] = multiplier;
                    active.push(entering);
                    break;
                }
                if let Some(i) = leaving {
                    remove(&mut j, &mut r, &mut u, i, q, n);
                    active.remove(i);
                }
            }
        }
        let mut multipliers = vec![0.0; self.rows.len()];
        for (kind, u) in active.iter().zip(&u) {
            if let Kind::Row(row) = kind {
                multipliers[*row] = *u;
            }
        }
        Ok(Solution { x, multipliers })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{Rng, SeedableRng};

    /// Projected gradient on the exact penalty is slow; the optimality conditions are the definition.
    #[test]
    fn solutions_are_feasible_and_no_feasible_direction_descends() {
        let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(41);
        for _ in 0..400 {
            let n = rng.random_range(2..14);
            let mut root: Matrix = [[0.0; MAX_VARIABLES]; MAX_VARIABLES];
            let mut hessian = root;
            let mut gradient = [0.0; MAX_VARIABLES];
            for i in 0..n {
                gradient[i] = rng.random_range(-5.0..5.0);
                root[i][..n]
                    .iter_mut()
                    .for_each(|c| *c = rng.random_range(-1.0..1.0));
            }
            for i in 0..n {
                for k in 0..n {
                    hessian[i][k] = dot(&root[i], &root[k], n) + if i == k { 0.05 } else { 0.0 };
                }
            }
            let (low, high) = ([-1.0; MAX_VARIABLES], [2.0; MAX_VARIABLES]);
            let rows: Vec<Constraint> = (0..rng.random_range(0..6))
                .map(|_| {
                    let mut coefficients = [0.0; MAX_VARIABLES];
                    coefficients[..n]
                        .iter_mut()
                        .for_each(|c| *c = rng.random_range(-1.0..1.0));
                    // the origin satisfies every row: the programme is feasible
                    Constraint {
                        coefficients,
                        bound: rng.random_range(-1.0..0.0),
                    }
                })
                .collect();
            let programme = Programme {
                size: n,
                hessian: &hessian,
                gradient: &gradient,
                low: &low,
                high: &high,
                rows: &rows,
            };
            let x = programme.solve().expect("positive definite").x;
            let feasible = |p: &Row| {
                (0..n).all(|i| p[i] >= -1.0 - 1e-7 && p[i] <= 2.0 + 1e-7)
                    && rows
                        .iter()
                        .all(|r| dot(&r.coefficients, p, n) >= r.bound - 1e-7)
            };
            let value = |p: &Row| {
                (0..n)
                    .map(|i| p[i] * (0.5 * dot(&hessian[i], p, n) + gradient[i]))
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

    #[test]
    fn leaving_out_what_stays_at_zero_changes_nothing() {
        let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(42);
        for _ in 0..300 {
            let n = 10;
            let mut hessian: Matrix = [[0.0; MAX_VARIABLES]; MAX_VARIABLES];
            let mut gradient = [0.0; MAX_VARIABLES];
            let mut root: Matrix = hessian;
            let (mut low, high) = ([0.0; MAX_VARIABLES], [2.0; MAX_VARIABLES]);
            let mut still = [false; MAX_VARIABLES];
            for i in 0..n {
                gradient[i] = rng.random_range(-3.0..5.0);
                low[i] = if i % 3 == 0 { -1.0 } else { 0.0 };
                still[i] = rng.random_bool(0.5);
                root[i][..n]
                    .iter_mut()
                    .for_each(|c| *c = rng.random_range(-1.0..1.0));
            }
            for i in 0..n {
                for k in 0..n {
                    hessian[i][k] = dot(&root[i], &root[k], n) + if i == k { 0.1 } else { 0.0 };
                }
            }
            let mut coefficients = [0.0; MAX_VARIABLES];
            coefficients[..n]
                .iter_mut()
                .for_each(|c| *c = rng.random_range(0.1..1.0));
            let rows = [Constraint {
                coefficients,
                bound: 1.0,
            }];
            let programme = Programme {
                size: n,
                hessian: &hessian,
                gradient: &gradient,
                low: &low,
                high: &high,
                rows: &rows,
            };
            let whole = programme.solve().expect("solvable").x;
            let part = programme.solve_from(&mut still).expect("solvable").x;
            for i in 0..n {
                assert!((whole[i] - part[i]).abs() < 0.05, "{whole:?} {part:?}");
            }
        }
    }

    #[test]
    fn contradicting_rows_are_left_out() {
        let mut hessian: Matrix = [[0.0; MAX_VARIABLES]; MAX_VARIABLES];
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
