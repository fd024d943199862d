//! A small dense convex quadratic programme by the dual active-set method of Goldfarb & Idnani
//! (doi:10.1007/BF02591962).

use super::factor::{
    LANES, Padded, Square, Triangle, add, add_scaled, dot, inverse_transposed_factor, remove,
};

/// Most variables of a programme: fixed, so that no step allocates.
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

impl Programme<'_> {
    /// The minimum; rows that cannot be met together with the box and earlier rows are left out, one
    /// at a time (the caller's merit function sees what is violated). `None` when the Hessian is not
    /// positive definite or a number is not finite.
    pub(crate) fn solve(&self) -> Option<Solution> {
        match self.size.div_ceil(LANES) {
            0 | 1 => self.padded::<4>().solve(),
            2 => self.padded::<8>().solve(),
            3 => self.padded::<12>().solve(),
            4 => self.padded::<16>().solve(),
            5 => self.padded::<20>().solve(),
            _ => self.padded::<MAX_VARIABLES>().solve(),
        }
    }

    fn padded<const N: usize>(&self) -> Sized<N> {
        let n = self.size;
        let head = |row: &Row| {
            let mut padded = [0.0; N];
            padded[..n].copy_from_slice(&row[..n]);
            padded
        };
        let mut hessian = [[0.0; N]; N];
        for (to, from) in hessian.iter_mut().zip(self.hessian) {
            *to = head(from);
        }
        let of_row = |row: &Constraint| {
            let normal = head(&row.coefficients);
            let size = dot(&normal, &normal).sqrt();
            Scaled {
                normal,
                bound: row.bound,
                scale: 1.0 / (1.0 + row.bound.abs()).max(size),
            }
        };
        Sized {
            size: n,
            hessian,
            gradient: head(self.gradient),
            low: head(self.low),
            high: head(self.high),
            rows: self.rows.iter().map(of_row).collect(),
        }
    }
}

/// A row, with the reciprocal of what its violation is measured by.
struct Scaled<const N: usize> {
    normal: Padded<N>,
    bound: f64,
    /// Zero where the row is left out.
    scale: f64,
}

impl<const N: usize> Scaled<N> {
    fn value(&self, x: &Padded<N>) -> f64 {
        dot(&self.normal, x) - self.bound
    }
}

/// A programme in arrays just as long as it needs, for which loops are unrolled.
struct Sized<const N: usize> {
    size: usize,
    hessian: Square<N>,
    gradient: Padded<N>,
    low: Padded<N>,
    high: Padded<N>,
    rows: Vec<Scaled<N>>,
}

impl<const N: usize> Sized<N> {
    fn solve(mut self) -> Option<Solution> {
        loop {
            match self.attempt() {
                Ok(solution) => return Some(solution),
                Err(Some(row)) => self.rows[row].scale = 0.0,
                Err(None) => return None,
            }
        }
    }

    fn value(&self, kind: Kind, x: &Padded<N>) -> f64 {
        match kind {
            Kind::Low(i) => x[i] - self.low[i],
            Kind::High(i) => self.high[i] - x[i],
            Kind::Row(r) => self.rows[r].value(x),
        }
    }

    /// The most violated constraint that is not active, each relative to its scale.
    fn violated(&self, x: &Padded<N>, active: &[Kind], boxes: &[Padded<N>; 2]) -> Option<Kind> {
        let mut worst = (-SATISFIED, None);
        let mut look = |kind: Kind, v: f64| {
            if v < worst.0 && !active.contains(&kind) {
                worst = (v, Some(kind));
            }
        };
        // what is beyond the variables is zero and violates nothing
        let lanes: [Padded<N>; 2] = [
            std::array::from_fn(|i| (x[i] - self.low[i]) * boxes[0][i]),
            std::array::from_fn(|i| (self.high[i] - x[i]) * boxes[1][i]),
        ];
        let least = |lane: &Padded<N>| {
            let mut least = [0.0_f64; LANES];
            for chunk in lane.chunks_exact(LANES) {
                for (l, v) in least.iter_mut().zip(chunk) {
                    *l = if *v < *l { *v } else { *l };
                }
            }
            least.into_iter().fold(0.0, f64::min)
        };
        let kinds: [fn(usize) -> Kind; 2] = [Kind::Low, Kind::High];
        for (lane, kind) in lanes.iter().zip(kinds) {
            if least(lane) < -SATISFIED {
                for (i, v) in lane.iter().enumerate() {
                    look(kind(i), *v);
                }
            }
        }
        for (r, row) in self.rows.iter().enumerate() {
            if row.scale > 0.0 {
                look(Kind::Row(r), row.value(x) * row.scale);
            }
        }
        worst.1
    }

    /// Once, or a row to leave out, or nothing where that would not help either.
    #[inline(never)]
    fn attempt(&self) -> Result<Solution, Option<usize>> {
        let n = self.size;
        let mut j = inverse_transposed_factor(&self.hessian, n).ok_or(None)?;
        let mut x = [0.0; N];
        for column in j.iter().take(n) {
            add_scaled(&mut x, -dot(column, &self.gradient), column);
        }
        let mut r = Triangle::new();
        let mut active: Vec<Kind> = Vec::with_capacity(n);
        let mut u = [0.0; N];
        let mut steps = 0;
        let boxes = [self.low, self.high].map(|bounds| bounds.map(|b| 1.0 / (1.0 + b.abs())));
        while let Some(entering) = self.violated(&x, &active, &boxes) {
            let mut multiplier = 0.0;
            loop {
                steps += 1;
                if steps > MAX_STEPS || !dot(&x, &x).is_finite() {
                    return Err(None);
                }
                let q = active.len();
                let mut d = [0.0; N];
                for (d, column) in d.iter_mut().zip(&j).take(n) {
                    *d = match entering {
                        Kind::Low(i) => column[i],
                        Kind::High(i) => -column[i],
                        Kind::Row(row) => dot(column, &self.rows[row].normal),
                    };
                }
                let mut z = [0.0; N];
                for (column, d) in j[q..n].iter().zip(&d[q..n]) {
                    add_scaled(&mut z, *d, column);
                }
                let back = r.solve(&d, q);
                let (mut dual_step, mut leaving) = (f64::INFINITY, None);
                for i in 0..q {
                    if back[i] > 1e-14 && u[i] < dual_step * back[i] {
                        dual_step = u[i] / back[i];
                        leaving = Some(i);
                    }
                }
                let mut free = d;
                free[..q].fill(0.0);
                // z . normal
                let slope = dot(&free, &free);
                let primal_step = if slope > 1e-16 * dot(&d, &d) {
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
                add_scaled(&mut u, -step, &back);
                multiplier += step;
                if primal_step.is_finite() {
                    add_scaled(&mut x, step, &z);
                }
                if primal_step <= dual_step {
                    add((&mut j, &mut r), (&d, &z, slope.sqrt()), q, n);
                    u[q] = multiplier;
                    active.push(entering);
                    break;
                }
                if let Some(i) = leaving {
                    remove((&mut j, &mut r), &mut u, i, q);
                    active.remove(i);
                }
            }
        }
        if !dot(&x, &x).is_finite() {
            return Err(None);
        }
        let mut multipliers = vec![0.0; self.rows.len()];
        for (kind, u) in active.iter().zip(&u) {
            if let Kind::Row(row) = kind {
                multipliers[*row] = *u;
            }
        }
        let mut whole = [0.0; MAX_VARIABLES];
        whole[..N].copy_from_slice(&x);
        Ok(Solution {
            x: whole,
            multipliers,
        })
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
            let mut root = [[0.0; MAX_VARIABLES]; MAX_VARIABLES];
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
                    hessian[i][k] = dot(&root[i], &root[k]) + if i == k { 0.05 } else { 0.0 };
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
