//! The factors of a dual active-set method: `J = L^-T Q` and the triangle `R`, kept by plane rotations.

use super::quadratic::{MAX_VARIABLES, Matrix, Row};

/// The scalar product of the first `n` numbers.
pub(crate) fn dot(a: &Row, b: &Row, n: usize) -> f64 {
    a[..n].iter().zip(&b[..n]).map(|(x, y)| x * y).sum()
}

/// `L^-T` for `H = L L'`.
pub(crate) fn inverse_transposed_factor(h: &Matrix, n: usize) -> Option<Matrix> {
    let mut l: Matrix = [[0.0; MAX_VARIABLES]; MAX_VARIABLES];
    for i in 0..n {
        for k in 0..=i {
            let sum = h[i][k] - dot(&l[i], &l[k], k);
            if i == k {
                // negated on purpose: a NaN is not positive
                if !(sum > 0.0) {
                    return None;
                }
                l[i][i] = sum.sqrt();
            } else {
                l[i][k] = sum / l[k][k];
            }
        }
    }
    let mut inverse: Matrix = [[0.0; MAX_VARIABLES]; MAX_VARIABLES];
    // column c of L^-1 is row c of its transpose
    for c in 0..n {
        inverse[c][c] = 1.0 / l[c][c];
        for i in c + 1..n {
            let sum: f64 = (c..i).map(|k| l[i][k] * inverse[c][k]).sum();
            inverse[c][i] = -sum / l[i][i];
        }
    }
    Some(inverse)
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
        for row in j.iter_mut().take(n) {
            let (a, b) = (row[k - 1], row[k]);
            row[k - 1] = c * a + s * b;
            row[k] = c * b - s * a;
        }
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
        for row in j.iter_mut().take(n) {
            let (a, b) = (row[k], row[k + 1]);
            row[k] = c * a + s * b;
            row[k + 1] = c * b - s * a;
        }
    }
}
