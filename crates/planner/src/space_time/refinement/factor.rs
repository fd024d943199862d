//! Factors of a dual active-set method: `J = L^-T Q` and the triangle `R`.
//!
//! `J` is stored by columns, so every operation runs along memory. Sizes are multiples of
//! [`LANES`], known at compile time. Entries beyond a programme's own variables are zero, so no
//! loop has a remainder.

/// Number of independent partial sums.
pub(crate) const LANES: usize = 4;

/// Vector with one entry per variable, zero beyond.
pub(crate) type Padded<const N: usize> = [f64; N];

/// Matrix of padded vectors.
pub(crate) type Square<const N: usize> = [[f64; N]; N];

/// Scalar product.
pub(crate) fn dot<const N: usize>(a: &Padded<N>, b: &Padded<N>) -> f64 {
    let mut sums = [0.0; LANES];
    for (x, y) in a.chunks_exact(LANES).zip(b.chunks_exact(LANES)) {
        for (sum, (x, y)) in sums.iter_mut().zip(x.iter().zip(y)) {
            *sum += x * y;
        }
    }
    (sums[0] + sums[1]) + (sums[2] + sums[3])
}

/// `to += factor * from`.
pub(crate) fn add_scaled<const N: usize>(to: &mut Padded<N>, factor: f64, from: &Padded<N>) {
    for (t, f) in to.iter_mut().zip(from) {
        *t += factor * f;
    }
}

/// Columns of `L^-T` for `H = L L'`, which are the rows of `L^-1`; `n` of them.
///
/// Eliminates below each diagonal in turn, in the matrix and in the inverse, so that rows are
/// independent.
pub(crate) fn inverse_transposed_factor<const N: usize>(
    h: &Square<N>,
    n: usize,
) -> Option<Square<N>> {
    let mut rest = *h;
    let mut inverse = [[0.0; N]; N];
    for (i, row) in inverse.iter_mut().enumerate().take(n) {
        row[i] = 1.0;
    }
    for k in 0..n {
        let (above, below) = rest.split_at_mut(k + 1);
        let (known, later) = inverse.split_at_mut(k + 1);
        let (pivots, known) = (&above[k], &mut known[k]);
        // negated on purpose: a NaN is not positive
        if !(pivots[k] > 0.0) {
            return None;
        }
        let reciprocal = 1.0 / pivots[k];
        let rows = below.iter_mut().zip(later).take(n - k - 1);
        for (row, inverse) in rows {
            let factor = -row[k] * reciprocal;
            add_scaled(row, factor, pivots);
            add_scaled(inverse, factor, known);
        }
        let scale = reciprocal.sqrt();
        known.iter_mut().for_each(|v| *v *= scale);
    }
    Some(inverse)
}

/// Triangle `R` by columns, with the reciprocals of its diagonal.
#[derive(Debug, Clone)]
pub(crate) struct Triangle<const N: usize> {
    columns: Square<N>,
    reciprocals: Padded<N>,
}

impl<const N: usize> Triangle<N> {
    pub(crate) fn new() -> Self {
        Self {
            columns: [[0.0; N]; N],
            reciprocals: [0.0; N],
        }
    }

    /// Solves `R x = d` for the first `q` entries.
    pub(crate) fn solve(&self, d: &Padded<N>, q: usize) -> Padded<N> {
        let mut found = [0.0; N];
        let mut rest = *d;
        for i in (0..q).rev() {
            found[i] = rest[i] * self.reciprocals[i];
            add_scaled(&mut rest, -found[i], &self.columns[i]);
        }
        found
    }

    /// Solves `R' x = b` for the first `q` entries.
    pub(crate) fn solve_transposed(&self, b: &Padded<N>, q: usize) -> Padded<N> {
        let mut found = [0.0; N];
        for i in 0..q {
            // entries not yet computed are zero
            found[i] = (b[i] - dot(&self.columns[i], &found)) * self.reciprocals[i];
        }
        found
    }
}

/// Adds a constraint with `d = J' normal` to `q` active ones. A reflection turns `d` from `q` on,
/// of the given length, into its first component. `z` is the sum of the columns from `q` on, each
/// times its entry of `d`.
pub(crate) fn add<const N: usize>(
    (j, r): (&mut Square<N>, &mut Triangle<N>),
    (d, z, length): (&Padded<N>, &Padded<N>, f64),
    q: usize,
    n: usize,
) {
    // avoids cancellation
    let turned = length.copysign(d[q]);
    let first = d[q] + turned;
    let scale = 1.0 / (turned * first);
    let mut along = *z;
    add_scaled(&mut along, turned, &j[q]);
    add_scaled(&mut j[q], -scale * first, &along);
    for (column, d) in j.iter_mut().zip(d).take(n).skip(q + 1) {
        add_scaled(column, -scale * d, &along);
    }
    r.columns[q] = [0.0; N];
    r.columns[q][..q].copy_from_slice(&d[..q]);
    r.columns[q][q] = -turned;
    r.reciprocals[q] = -1.0 / turned;
}

/// Removes active constraint `i` of `q`.
pub(crate) fn remove<const N: usize>(
    (j, r): (&mut Square<N>, &mut Triangle<N>),
    i: usize,
    q: usize,
) {
    r.columns.copy_within(i + 1..q, i);
    for k in i..q - 1 {
        let (a, b) = (r.columns[k][k], r.columns[k][k + 1]);
        let h = (a * a + b * b).sqrt();
        r.reciprocals[k] = 1.0 / h;
        if h == 0.0 {
            continue;
        }
        let (c, s) = (a / h, b / h);
        for column in &mut r.columns[k..q - 1] {
            let (a, b) = (column[k], column[k + 1]);
            (column[k], column[k + 1]) = (c * a + s * b, c * b - s * a);
        }
        let (above, below) = j.split_at_mut(k + 1);
        for (a, b) in above[k].iter_mut().zip(&mut below[0]) {
            (*a, *b) = (c * *a + s * *b, c * *b - s * *a);
        }
    }
}
