//! Primal-dual iterate of the interior-point method, which later solves can reuse.

use super::stage::{StageProblem, Triple, Vector};

/// Row `row + elastic - slack = 0` with a priced elastic; slack and elastic are not negative.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RowPoint {
    /// Excess of the row above zero.
    pub slack: f64,
    /// Shortfall of the row below zero.
    pub elastic: f64,
    /// Multiplier of the row and of its slack, below the penalty.
    pub multiplier: f64,
    /// Multiplier of the elastic.
    pub price: f64,
}

impl RowPoint {
    /// Central point: both products equal `barrier` and the row's equation holds. Root of a
    /// quadratic, in the form without cancellation.
    pub fn central(row: f64, barrier: f64, penalty: f64) -> Self {
        let spread = (row * penalty).hypot(2.0 * barrier);
        // z or penalty - z, whichever is smaller, from a sum
        let small = 2.0 * barrier * penalty / (row.abs() * penalty + 2.0 * barrier + spread);
        let (multiplier, price) = if row >= 0.0 {
            (small, penalty - small)
        } else {
            (penalty - small, small)
        };
        Self {
            slack: barrier / multiplier,
            elastic: barrier / price,
            multiplier,
            price,
        }
    }
}

/// States, controls and all multipliers: initial guess of a solve and, afterwards, its result. A
/// later solve can start from it.
#[derive(Debug, Clone, PartialEq)]
pub struct Iterate<const N: usize, const M: usize> {
    /// States, one more than stages; the first is given.
    pub states: Vec<Vector<N>>,
    /// Controls, one per stage.
    pub controls: Vec<Vector<M>>,
    /// Multipliers of the defects, per stage.
    pub multipliers: Vec<Vector<N>>,
    /// Multipliers of the lower control limits, per stage.
    pub low: Vec<Vector<M>>,
    /// Multipliers of the upper control limits, per stage.
    pub high: Vec<Vector<M>>,
    /// All rows, stage by stage.
    pub rows: Vec<RowPoint>,
}

impl<const N: usize, const M: usize> Iterate<N, M> {
    /// Guess without multipliers; the solve initialises them.
    pub fn guess(states: Vec<Vector<N>>, controls: Vec<Vector<M>>) -> Self {
        Self {
            states,
            controls,
            multipliers: Vec::new(),
            low: Vec::new(),
            high: Vec::new(),
            rows: Vec::new(),
        }
    }

    /// Variables of one stage.
    pub fn point(&self, stage: usize) -> Triple<N, M> {
        Triple {
            x: self.states[stage],
            u: self.controls[stage],
            y: self.states[stage + 1],
        }
    }

    /// True when sizes and numbers fit the problem; all multipliers may be missing.
    pub(super) fn fits(&self, problem: &impl StageProblem<N, M>, rows: usize) -> bool {
        let n = problem.stages();
        let sized = self.states.len() == n + 1
            && self.controls.len() == n
            && [0, n].contains(&self.multipliers.len())
            && self.low.len() == self.multipliers.len()
            && self.high.len() == self.multipliers.len()
            && (self.multipliers.is_empty() || self.rows.len() == rows);
        let finite = |v: &[f64]| v.iter().all(|x| x.is_finite());
        sized
            && self.states.iter().all(|x| finite(x.as_slice()))
            && self.controls.iter().all(|x| finite(x.as_slice()))
            && self.multipliers.iter().all(|x| finite(x.as_slice()))
    }

    /// True when it contains multipliers.
    pub(super) fn is_warm(&self) -> bool {
        !self.multipliers.is_empty()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_central_row_solves_its_three_equations() {
        for row in [-1e6, -3.0, -1e-9, 0.0, 1e-12, 0.4, 70.0, 1e8] {
            for barrier in [1.0, 1e-4, 1e-9] {
                let p = RowPoint::central(row, barrier, 100.0);
                assert!(p.slack > 0.0 && p.elastic > 0.0, "{row} {barrier} {p:?}");
                assert!((p.slack * p.multiplier - barrier).abs() <= 1e-12 * barrier);
                assert!((p.elastic * p.price - barrier).abs() <= 1e-12 * barrier);
                assert!((p.multiplier + p.price - 100.0).abs() < 1e-12);
                let off = row + p.elastic - p.slack;
                assert!(
                    off.abs() <= 1e-9 * (1.0 + row.abs()),
                    "{row} {barrier} {off:e}"
                );
            }
        }
    }
}
