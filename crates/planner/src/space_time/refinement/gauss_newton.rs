//! Gradient and Gauss-Newton Hessian of a manoeuvre's cost, accumulated over its points.
//!
//! Lengthening segment variable `i` moves a later point `p` as a rigid body: `dp/dl = b + c J(p)`
//! with the segment variable's own `b` (east, north, clock) and curvature `c`, and
//! `J(p) = (-p.y, p.x, 0)`. A residual with rates `r` in (east, north, clock) and weight `w` adds
//! `w (r . m_i)(r . m_j)` to the Hessian. So the points after a segment variable contribute one
//! symmetric 4 x 4 matrix. It is summed once from the end; there is no sum over the points per pair
//! of segment variables.

use crate::space_time::refinement::quadratic::{MAX_VARIABLES, Row};

/// Upper triangle of a symmetric 3 x 3 matrix: ee, en, et, nn, nt, tt.
type Weight = [f64; 6];

/// Twist of all that follows a segment variable: `b` (east, north, clock) about the origin, and
/// `c`.
pub(crate) type Twist = [f64; 4];

/// Squared residuals of one point: sums over the rates of each residual in (east, north, clock).
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Residuals {
    weight: Weight,
    gradient_form: [f64; 3],
}

impl Residuals {
    /// Adds `scale / 2 * value²` for a residual with these rates.
    pub(crate) fn add(&mut self, scale: f64, value: f64, rates: [f64; 3]) {
        let [e, n, t] = rates;
        let s = [scale * e, scale * n, scale * t];
        let squares = [s[0] * e, s[0] * n, s[0] * t, s[1] * n, s[1] * t, s[2] * t];
        accumulate(&mut self.weight, &squares);
        accumulate(&mut self.gradient_form, &s.map(|s| s * value));
    }
}

fn weigh([ee, en, et, nn, nt, tt]: Weight, v: [f64; 3]) -> [f64; 3] {
    [
        ee * v[0] + en * v[1] + et * v[2],
        en * v[0] + nn * v[1] + nt * v[2],
        et * v[0] + nt * v[1] + tt * v[2],
    ]
}

/// Adds each term to its sum; later sums stay as they are.
fn accumulate(sums: &mut [f64], terms: &[f64]) {
    for (sum, term) in sums.iter_mut().zip(terms) {
        *sum += term;
    }
}

fn dot3(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub(crate) fn dot4(a: &Twist, b: &Twist) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3]
}

/// Contribution of the points of one segment variable, or of all segment variables after one.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Accumulation {
    weight: Weight,
    /// Sums of `W J` and of `J W J`.
    mixed: [f64; 3],
    square: f64,
    gradient_form: [f64; 4],
}

impl Accumulation {
    fn add(&mut self, other: &Self) {
        accumulate(&mut self.weight, &other.weight);
        accumulate(&mut self.mixed, &other.mixed);
        self.square += other.square;
        accumulate(&mut self.gradient_form, &other.gradient_form);
    }

    /// Gradient with respect to a twist that moves all these points, as a linear form of the twist.
    pub(crate) fn gradient_form(&self) -> Twist {
        self.gradient_form
    }

    /// Second derivative along such a twist.
    pub(crate) fn curvature_along(&self, twist: &Twist) -> f64 {
        dot4(twist, &self.times(twist))
    }

    fn times(&self, v: &Twist) -> [f64; 4] {
        let base = [v[0], v[1], v[2]];
        let weighed = weigh(self.weight, base);
        [
            weighed[0] + v[3] * self.mixed[0],
            weighed[1] + v[3] * self.mixed[1],
            weighed[2] + v[3] * self.mixed[2],
            dot3(self.mixed, base) + v[3] * self.square,
        ]
    }
}

/// Contribution of a segment variable's own points with its own rate.
#[derive(Debug, Clone, Copy, Default)]
struct OwnTerms {
    cross: [f64; 4],
    square: f64,
    gradient_form: f64,
}

/// Accumulated sums of one manoeuvre.
#[derive(Debug)]
pub(crate) struct GaussNewton {
    variables: Vec<Accumulation>,
    own: Vec<OwnTerms>,
}

impl GaussNewton {
    /// Empty sums for the given number of segment variables.
    pub(crate) fn new(variables: usize) -> Self {
        Self {
            variables: vec![Accumulation::default(); variables],
            own: vec![OwnTerms::default(); variables],
        }
    }

    /// Adds a point of segment variable `index` at `place` (east, north from the origin of the
    /// twists). Its own segment variable moves it at `own` (east, north, clock).
    pub(crate) fn add(
        &mut self,
        index: usize,
        place: [f64; 2],
        own: [f64; 3],
        residuals: &Residuals,
    ) {
        let lever = [-place[1], place[0], 0.0];
        let mixed = weigh(residuals.weight, lever);
        let moment = &mut self.variables[index];
        accumulate(&mut moment.weight, &residuals.weight);
        accumulate(&mut moment.mixed, &mixed);
        moment.square += dot3(lever, mixed);
        accumulate(&mut moment.gradient_form, &residuals.gradient_form);
        moment.gradient_form[3] += dot3(lever, residuals.gradient_form);
        let weighed = weigh(residuals.weight, own);
        let mine = &mut self.own[index];
        accumulate(&mut mine.cross, &weighed);
        mine.cross[3] += dot3(lever, weighed);
        mine.square += dot3(own, weighed);
        mine.gradient_form += dot3(own, residuals.gradient_form);
    }

    /// Adds a point that each of the first segment variables moves at its own `rates`.
    pub(crate) fn add_directly(
        rates: &[[f64; 3]],
        residuals: &Residuals,
        gradient: &mut Row,
        lower: &mut [Row],
    ) {
        for (k, rate) in rates.iter().enumerate() {
            let weighed = weigh(residuals.weight, *rate);
            gradient[k] += dot3(*rate, residuals.gradient_form);
            for (i, other) in rates[..=k].iter().enumerate() {
                lower[k][i] += dot3(*other, weighed);
            }
        }
    }

    /// For every segment variable, the sum over its own points and those of all later ones.
    pub(crate) fn sums_from_each(&self) -> Vec<Accumulation> {
        let mut sums = self.variables.clone();
        for i in (1..sums.len()).rev() {
            let later = sums[i];
            sums[i - 1].add(&later);
        }
        sums
    }

    /// Adds all contributions to the gradient and to the lower triangle of the Hessian.
    pub(crate) fn finish(&self, twists: &[Twist], gradient: &mut Row, lower: &mut [Row]) {
        let mut later = Accumulation::default();
        for (j, twist) in twists.iter().enumerate().rev() {
            let own = &self.own[j];
            let mut column = later.times(twist);
            lower[j][j] += dot4(twist, &column) + own.square;
            gradient[j] += dot4(twist, &later.gradient_form) + own.gradient_form;
            accumulate(&mut column, &own.cross);
            for (h, m) in lower[j][..j].iter_mut().zip(twists) {
                *h += dot4(m, &column);
            }
            later.add(&self.variables[j]);
        }
    }
}

/// Reduces a row in all segment variables to the free ones. `solved` holds the rates of the
/// dependent segment variables, which come last.
pub(crate) fn reduce(row: &Row, solved: &[Row], free: usize) -> Row {
    let mut reduced = [0.0; MAX_VARIABLES];
    reduced[..free].copy_from_slice(&row[..free]);
    for (k, rates) in solved.iter().enumerate() {
        for (to, rate) in reduced[..free].iter_mut().zip(rates) {
            *to += row[free + k] * rate;
        }
    }
    reduced
}

/// Reduces a lower triangle in all segment variables to a symmetric matrix in the free ones.
pub(crate) fn reduce_matrix(mut lower: Vec<Row>, solved: &[Row], free: usize) -> Vec<Row> {
    let dependent = lower.split_off(free);
    for (d, rates) in solved.iter().enumerate() {
        let mut half = dependent[d];
        for (e, others) in solved.iter().enumerate() {
            let shared = 0.5 * dependent[d.max(e)][free + d.min(e)];
            for (h, o) in half[..free].iter_mut().zip(others) {
                *h += shared * o;
            }
        }
        for (i, row) in lower.iter_mut().enumerate() {
            let (rate, mine) = (rates[i], half[i]);
            let pairs = half[..=i].iter().zip(&rates[..=i]);
            for (to, (h, r)) in row[..=i].iter_mut().zip(pairs) {
                *to += rate * h + mine * r;
            }
        }
    }
    for i in 1..free {
        let (above, below) = lower.split_at_mut(i);
        for (row, mirrored) in above.iter_mut().zip(&below[0]) {
            row[i] = *mirrored;
        }
    }
    lower
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{Rng, SeedableRng};

    /// Compares with the explicit sum over points and pairs of segment variables.
    #[test]
    fn accumulation_equals_the_sum_over_all_points_and_pairs() {
        let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(7);
        let n = 9;
        let twists: Vec<Twist> = (0..n)
            .map(|_| [(); 4].map(|()| rng.random_range(-1.0..1.0)))
            .collect();
        let mut moments = GaussNewton::new(n);
        let (mut gradient, mut lower) = ([0.0; MAX_VARIABLES], vec![[0.0; MAX_VARIABLES]; n]);
        let (mut slow_gradient, mut slow) = (gradient, lower.clone());
        for _ in 0..60 {
            let variable = rng.random_range(0..n);
            let place = [(); 2].map(|()| rng.random_range(-3.0..3.0));
            let own = [(); 3].map(|()| rng.random_range(-1.0..1.0));
            let mut residuals = Residuals::default();
            for _ in 0..2 {
                let (scale, value) = (rng.random_range(0.1..2.0), rng.random_range(-2.0..2.0));
                let rates: [f64; 3] = [(); 3].map(|()| rng.random_range(-1.0..1.0));
                residuals.add(scale, value, rates);
                let of = |i: usize| {
                    let [e, n, t, c] = twists[i];
                    let moved = [e - c * place[1], n + c * place[0], t];
                    dot3(rates, if i == variable { own } else { moved })
                };
                for (i, row) in slow.iter_mut().enumerate().take(variable + 1) {
                    slow_gradient[i] += scale * value * of(i);
                    for (k, sum) in row.iter_mut().enumerate().take(i + 1) {
                        *sum += scale * of(i) * of(k);
                    }
                }
            }
            moments.add(variable, place, own, &residuals);
        }
        moments.finish(&twists, &mut gradient, &mut lower);
        for i in 0..n {
            assert!((gradient[i] - slow_gradient[i]).abs() < 1e-9, "slot {i}");
            for k in 0..=i {
                assert!((lower[i][k] - slow[i][k]).abs() < 1e-9, "slots {i} {k}");
            }
        }
    }

    /// Compares with `T' H T`, where `T` is the identity above the rates of the solved segment
    /// variables.
    #[test]
    fn a_reduced_matrix_is_the_product_with_the_rates() {
        let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(8);
        let (free, all) = (6, 8);
        let mut lower = vec![[0.0; MAX_VARIABLES]; all];
        for (i, row) in lower.iter_mut().enumerate().take(all) {
            row[..=i]
                .iter_mut()
                .for_each(|h| *h = rng.random_range(-1.0..1.0));
        }
        let mut solved = [[0.0; MAX_VARIABLES]; 2];
        for row in &mut solved {
            row[..free]
                .iter_mut()
                .for_each(|r| *r = rng.random_range(-1.0..1.0));
        }
        let reduced = reduce_matrix(lower.clone(), &solved, free);
        let rate = |variable: usize, i: usize| {
            if variable < free {
                f64::from(u8::from(variable == i))
            } else {
                solved[variable - free][i]
            }
        };
        for (i, row) in reduced.iter().enumerate().take(free) {
            for (k, found) in row.iter().enumerate().take(free) {
                let sum: f64 = (0..all)
                    .flat_map(|a| (0..all).map(move |b| (a, b)))
                    .map(|(a, b)| rate(a, i) * lower[a.max(b)][a.min(b)] * rate(b, k))
                    .sum();
                assert!((found - sum).abs() < 1e-9, "slots {i} {k}");
            }
        }
    }
}
