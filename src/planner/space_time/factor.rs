//! The factors of a dual active-set method: `J = L^-T Q` and the triangle `R`, kept by plane rotations.
//!
//! `J` is held by columns: every operation on it then runs along memory.

use super::quadratic::{MAX_VARIABLES, Matrix, Row};

/// The scalar product of the first `n` numbers, in four sums that do not wait for each other.
pub(crate) fn dot(a: &Row, b: &Row, n: usize) -> f64 {
    let (a, b) = (a[..n].chunks_exact(4), b[..n].chunks_exact(4));
    let rest = a.remainder().iter().zip(b.remainder());
    let rest: f64 = rest.map(|(x, y)| x * y).sum();
    let mut sums = [0.0; 4];
    for (x, y) in a.zip(b) {
        for (sum, (x, y)) in sums.iter_mut().zip(x.iter().zip(y)) {
            *sum += x * y;
        }
    }
    (sums[0] + sums[1]) + (sums[2] + sums[3]) + rest
}

/// `to += factor * from`, of the first `n` numbers.
pub(crate) fn add_scaled(to: &mut Row, factor: f64, from: &Row, n: usize) {
    for (t, f) in to[..n].iter_mut().zip(&from[..n]) {
        *t += factor * f;
    }
}

/// The columns of `L^-T` for `H = L L'`, which are the rows of `L^-1`.
pub(crate) fn inverse_transposed_factor(h: &Matrix, n: usize) -> Option<Matrix> {
    let mut l: Matrix = [[0.0; MAX_VARIABLES]; MAX_VARIABLES];
    let mut inverse: Matrix = [[0.0; MAX_VARIABLES]; MAX_VARIABLES];
    for i in 0..n {
        for k in 0..i {
            l[i][k] = (h[i][k] - dot(&l[i], &l[k], k)) / l[k][k];
        }
        let square = h[i][i] - dot(&l[i], &l[i], i);
        // negated on purpose: a NaN is not positive
        if !(square > 0.0) {
            return None;
        }
        l[i][i] = square.sqrt();
        let scale = 1.0 / l[i][i];
        let (above, below) = inverse.split_at_mut(i);
        let row = &mut below[0];
        for (k, known) in above.iter().enumerate() {
            add_scaled(row, -l[i][k] * scale, known, k + 1);
        }
        row[i] = scale;
    }
    Some(inverse)
}

/// Turns two columns in their plane: `(c, s)` times the first, `(-s, c)` times the second.
fn turn(columns: &mut Matrix, first: usize, c: f64, s: f64, n: usize) {
    let (above, below) = columns.split_at_mut(first + 1);
    let pairs = above[first][..n].iter_mut().zip(&mut below[0][..n]);
    for (a, b) in pairs {
        (*a, *b) = (c * *a + s * *b, c * *b - s * *a);
    }
}

/// Rotates `d` below `q` to zero and appends it to `R`.
pub(crate) fn add(j: &mut Matrix, r: &mut Matrix, d: &mut Row, q: usize, n: usize) {
    for k in (q + 1..n).rev() {
        if d[k] == 0.0 {
            continue;
        }
        let h = (d[k - 1] * d[k - 1] + d[k] * d[k]).sqrt();
        let (c, s) = (d[k - 1] / h, d[k] / h);
        (d[k - 1], d[k]) = (h, 0.0);
        turn(j, k - 1, c, s, n);
    }
    for i in 0..=q {
        r[i][q] = d[i];
    }
}

/// Drops active constraint `i` of `q`.
pub(crate) fn remove(j: &mut Matrix, r: &mut Matrix, u: &mut [f64], i: usize, q: usize, n: usize) {
    for k in i..q - 1 {
        u[k] = u[k + 1];
        for row in r.iter_mut().take(q) {
            row[k] = row[k + 1];
        }
    }
    for k in i..q - 1 {
        let h = (r[k][k] * r[k][k] + r[k + 1][k] * r[k + 1][k]).sqrt();
        if h == 0.0 {
            continue;
        }
        let (c, s) = (r[k][k] / h, r[k + 1][k] / h);
        let (above, below) = r.split_at_mut(k + 1);
        let pair = above[k][k..q - 1].iter_mut().zip(&mut below[0][k..q - 1]);
        for (a, b) in pair {
            (*a, *b) = (c * *a + s * *b, c * *b - s * *a);
        }
        turn(j, k, c, s, n);
    }
}
