//! Dual active-set method: adds the most violated constraint first and drops active constraints
//! whose multipliers reach zero.

use crate::space_time::refinement::factor::{
    LANES, Padded, Square, Triangle, add, add_scaled, dot, inverse_transposed_factor, remove,
};
use crate::space_time::refinement::quadratic::{
    Constraint, MAX_VARIABLES, Programme, Row, Solution, Unsolved,
};

/// Largest number of steps; a programme of this size needs about as many as it has constraints.
const MAX_ITERATIONS: usize = 1000;

/// Rates of a multiplier below this count as zero.
const MIN_RATE: f64 = 1e-14;

/// Least squared share of a normal that the active normals do not span; less is rounding.
const MIN_INDEPENDENT: f64 = 1e-12;

/// Violation in metres at which its price has doubled. This term keeps the Hessian definite.
pub(crate) const SOFTENED_M: f64 = 1e3;

/// Relative violation that counts as none.
const VIOLATION_TOLERANCE: f64 = 1e-9;

#[derive(Clone, Copy, PartialEq)]
enum Kind {
    Low(usize),
    High(usize),
    Row(usize),
}

/// Row with the reciprocal of its scale.
struct Scaled<const N: usize> {
    normal: Padded<N>,
    bound: f64,
    scale: f64,
}

impl<const N: usize> Scaled<N> {
    fn value(&self, x: &Padded<N>) -> f64 {
        dot(&self.normal, x) - self.bound
    }
}

/// Programme in arrays of exactly the size it needs, for which the compiler unrolls loops.
pub(crate) struct Compact<const N: usize> {
    size: usize,
    /// True where the last variable is the largest violation of a row.
    elastic: bool,
    hessian: Square<N>,
    gradient: Padded<N>,
    low: Padded<N>,
    high: Padded<N>,
    rows: Vec<Scaled<N>>,
}

/// State of the dual method: `x` minimises the cost with the active constraints as equations.
struct Point<const N: usize> {
    x: Padded<N>,
    j: Square<N>,
    r: Triangle<N>,
    /// Active constraints (the first `count`) and their multipliers.
    active: [Kind; N],
    multipliers: Padded<N>,
    count: usize,
}

/// Result of adding a constraint.
enum AddResult {
    Active,
    /// It contradicts the active constraints.
    Contradicts,
    /// Too many steps, or a number that is not finite.
    Stopped,
}

impl<const N: usize> Point<N> {
    /// Unconstrained minimum; `None` when the Hessian is not positive definite.
    fn free(of: &Compact<N>) -> Option<Self> {
        let j = inverse_transposed_factor(&of.hessian, of.size)?;
        let mut x = [0.0; N];
        for column in j.iter().take(of.size) {
            add_scaled(&mut x, -dot(column, &of.gradient), column);
        }
        Some(Self {
            x,
            j,
            r: Triangle::new(),
            active: [Kind::Low(0); N],
            multipliers: [0.0; N],
            count: 0,
        })
    }

    fn active(&self) -> &[Kind] {
        &self.active[..self.count]
    }

    fn is_finite(&self) -> bool {
        dot(&self.x, &self.x).is_finite()
    }

    /// Direction of a constraint relative to the active ones.
    fn direction_of(&self, of: &Compact<N>, constraint: Kind) -> ConstraintDirection<N> {
        let (n, q) = (of.size, self.count);
        let mut d = [0.0; N];
        for (d, column) in d.iter_mut().zip(&self.j).take(n) {
            *d = match constraint {
                Kind::Low(i) => column[i],
                Kind::High(i) => -column[i],
                Kind::Row(row) => dot(column, &of.rows[row].normal),
            };
        }
        let mut z = [0.0; N];
        for (column, d) in self.j[q..n].iter().zip(&d[q..n]) {
            add_scaled(&mut z, *d, column);
        }
        let back = self.r.solve(&d, q);
        ConstraintDirection { d, z, back }
    }

    /// Step at which the first multiplier, each decreasing at its rate, is zero, and the index of
    /// that multiplier.
    fn first_zero(&self, rates: &Padded<N>) -> (f64, Option<usize>) {
        let mut first = (f64::INFINITY, None);
        for (i, (multiplier, rate)) in self
            .multipliers
            .iter()
            .zip(rates)
            .enumerate()
            .take(self.count)
        {
            if *rate > MIN_RATE && *multiplier < first.0 * rate {
                first = (multiplier / rate, Some(i));
            }
        }
        first
    }

    fn drop(&mut self, i: usize) {
        let q = self.count;
        remove((&mut self.j, &mut self.r), i, q);
        self.multipliers.copy_within(i + 1..q, i);
        self.active.copy_within(i + 1..q, i);
        self.count -= 1;
    }

    /// Moves to the minimum over the active constraints and this one, and drops constraints on the
    /// way. `steps` counts down.
    fn add_constraint(&mut self, of: &Compact<N>, entering: Kind, steps: &mut usize) -> AddResult {
        let mut multiplier = 0.0;
        loop {
            if *steps == 0 || !self.is_finite() {
                return AddResult::Stopped;
            }
            *steps -= 1;
            let q = self.count;
            let ConstraintDirection { d, z, back } = self.direction_of(of, entering);
            let (dual_step, leaving) = self.first_zero(&back);
            let mut free = d;
            free[..q].fill(0.0);
            // z . normal
            let slope = dot(&free, &free);
            let primal_step = if slope > MIN_INDEPENDENT * dot(&d, &d) {
                -of.value(entering, &self.x) / slope
            } else {
                f64::INFINITY
            };
            let step = dual_step.min(primal_step);
            if step.is_infinite() {
                return AddResult::Contradicts;
            }
            add_scaled(&mut self.multipliers, -step, &back);
            multiplier += step;
            if primal_step.is_finite() {
                add_scaled(&mut self.x, step, &z);
            }
            if primal_step <= dual_step {
                let (factors, length) = ((&mut self.j, &mut self.r), slope.sqrt());
                add(factors, (&d, &z, length), q, of.size);
                self.multipliers[q] = multiplier;
                self.active[q] = entering;
                self.count += 1;
                return AddResult::Active;
            }
            if let Some(i) = leaving {
                self.drop(i);
            }
        }
    }

    /// Recomputes `x` and the multipliers from the factors, without accumulated rounding.
    fn finish(&mut self, of: &Compact<N>) {
        let mut bounds = [0.0; N];
        for (bound, kind) in bounds.iter_mut().zip(self.active()) {
            *bound = match *kind {
                Kind::Low(i) => of.low[i],
                Kind::High(i) => -of.high[i],
                Kind::Row(row) => of.rows[row].bound,
            };
        }
        let along = self.r.solve_transposed(&bounds, self.count);
        let (mut x, mut sums) = ([0.0; N], [0.0; N]);
        for (k, column) in self.j.iter().enumerate().take(of.size) {
            let gradient_form = dot(column, &of.gradient);
            let share = if k < self.count {
                along[k]
            } else {
                -gradient_form
            };
            sums[k] = along[k] + gradient_form;
            add_scaled(&mut x, share, column);
        }
        self.x = x;
        self.multipliers = self.r.solve(&sums, self.count);
    }
}

/// Normal of a constraint in terms of the factors: `J' normal`, and the change of `x` and the
/// decrease of the multipliers per unit of its own multiplier.
struct ConstraintDirection<const N: usize> {
    d: Padded<N>,
    z: Padded<N>,
    back: Padded<N>,
}

impl<const N: usize> Compact<N> {
    /// With a price, the largest violation is the last variable.
    pub(crate) fn of(programme: &Programme, price: Option<f64>) -> Self {
        let n = programme.size;
        let head = |row: &Row| {
            let mut padded = [0.0; N];
            padded[..n].copy_from_slice(&row[..n]);
            padded
        };
        let mut hessian = [[0.0; N]; N];
        for (to, from) in hessian.iter_mut().zip(programme.hessian) {
            *to = head(from);
        }
        let (mut gradient, low, mut high) = (
            head(programme.gradient),
            head(programme.low),
            head(programme.high),
        );
        if let Some(price) = price {
            hessian[n][n] = price / SOFTENED_M;
            (gradient[n], high[n]) = (price, f64::MAX);
        }
        let of_row = |row: &Constraint| {
            let mut normal = head(&row.coefficients);
            if price.is_some() {
                normal[n] = 1.0;
            }
            let size = dot(&normal, &normal).sqrt();
            Scaled {
                normal,
                bound: row.bound,
                scale: 1.0 / (1.0 + row.bound.abs()).max(size),
            }
        };
        Self {
            size: n + usize::from(price.is_some()),
            elastic: price.is_some(),
            hessian,
            gradient,
            low,
            high,
            rows: programme.rows.iter().map(of_row).collect(),
        }
    }

    fn value(&self, kind: Kind, x: &Padded<N>) -> f64 {
        match kind {
            Kind::Low(i) => x[i] - self.low[i],
            Kind::High(i) => self.high[i] - x[i],
            Kind::Row(r) => self.rows[r].value(x),
        }
    }

    /// Most violated inactive constraint, relative to its scale.
    fn violated(&self, at: &Point<N>, boxes: &[Padded<N>; 2]) -> Option<Kind> {
        let mut worst = (-VIOLATION_TOLERANCE, None);
        let mut examine = |kind: Kind, v: f64| {
            if v < worst.0 && !at.active().contains(&kind) {
                worst = (v, Some(kind));
            }
        };
        // entries beyond the variables are zero and violate nothing
        let x = &at.x;
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
            if least(lane) < -VIOLATION_TOLERANCE {
                for (i, v) in lane.iter().enumerate() {
                    examine(kind(i), *v);
                }
            }
        }
        for (r, row) in self.rows.iter().enumerate() {
            examine(Kind::Row(r), row.value(x) * row.scale);
        }
        worst.1
    }

    /// Solves the programme, see [`Programme::solve`].
    #[inline(never)]
    pub(crate) fn solve(self) -> Result<Solution, Unsolved> {
        let Some(mut at) = Point::free(&self) else {
            return Err(Unsolved::Stopped);
        };
        let mut steps = MAX_ITERATIONS;
        let boxes = [self.low, self.high].map(|bounds| bounds.map(|b| 1.0 / (1.0 + b.abs())));
        while let Some(entering) = self.violated(&at, &boxes) {
            match at.add_constraint(&self, entering, &mut steps) {
                AddResult::Active => {}
                AddResult::Contradicts => return Err(Unsolved::Contradiction),
                AddResult::Stopped => return Err(Unsolved::Stopped),
            }
        }
        at.finish(&self);
        if !at.is_finite() {
            return Err(Unsolved::Stopped);
        }
        let mut multipliers = vec![0.0; self.rows.len()];
        for (kind, u) in at.active().iter().zip(&at.multipliers) {
            if let Kind::Row(row) = kind {
                multipliers[*row] = u.max(0.0);
            }
        }
        let mut x = [0.0; MAX_VARIABLES];
        x[..N].copy_from_slice(&at.x);
        let mut missing = 0.0;
        if self.elastic {
            missing = std::mem::take(&mut x[self.size - 1]).max(0.0);
        }
        Ok(Solution {
            x,
            multipliers,
            missing,
        })
    }
}
