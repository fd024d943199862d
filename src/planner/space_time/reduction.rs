//! Cost and rates in every slot of a manoeuvre, and their reduction to the free ones.

use super::quadratic::{MAX_VARIABLES, Matrix, Row};
use super::template::Sailed;

/// Cost and rates in all slots; the lower triangle of the Hessian.
pub(crate) struct Full {
    pub cost: f64,
    pub gradient: Row,
    pub hessian: Matrix,
}

impl Full {
    /// Adds two squared residuals with their rates.
    pub(crate) fn add(&mut self, weight: f64, n: usize, one: &(f64, Row), other: &(f64, Row)) {
        let scale = 2.0 * weight;
        for i in 0..n {
            let (a, b) = (scale * one.1[i], scale * other.1[i]);
            self.gradient[i] += a * one.0 + b * other.0;
            let row = &mut self.hessian[i][..=i];
            for ((h, p), q) in row.iter_mut().zip(&one.1).zip(&other.1) {
                *h += a * p + b * q;
            }
        }
    }
}

/// A row in all slots as a row in the free ones.
pub(crate) fn reduce(row: &Row, sailed: &Sailed, free: usize, all: usize) -> Row {
    let mut reduced = [0.0; MAX_VARIABLES];
    for i in 0..free {
        reduced[i] = row[i]
            + (0..all - free)
                .map(|k| row[free + k] * sailed.solved_rates[k][i])
                .sum::<f64>();
    }
    reduced
}

pub(crate) fn reduce_matrix(lower: &Matrix, sailed: &Sailed, free: usize, all: usize) -> Matrix {
    let mut half: Matrix = [[0.0; MAX_VARIABLES]; MAX_VARIABLES];
    for i in 0..all {
        let mut row = [0.0; MAX_VARIABLES];
        for k in 0..all {
            row[k] = if k <= i { lower[i][k] } else { lower[k][i] };
        }
        half[i] = reduce(&row, sailed, free, all);
    }
    let mut reduced: Matrix = [[0.0; MAX_VARIABLES]; MAX_VARIABLES];
    for i in 0..free {
        for k in 0..free {
            reduced[i][k] = half[i][k]
                + (0..all - free)
                    .map(|d| sailed.solved_rates[d][i] * half[free + d][k])
                    .sum::<f64>();
        }
    }
    reduced
}
