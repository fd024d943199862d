//! Workspace of the iteration, allocated once.

use super::filter::Filter;
use super::riccati::StageFactor;
use super::stage::{Blocks, Derivatives, StageProblem, Triple, Values, Vector};

/// Trial point: primal variables and function values.
#[derive(Debug, Clone)]
pub(super) struct Trial<const N: usize, const M: usize> {
    pub states: Vec<Vector<N>>,
    pub controls: Vec<Vector<M>>,
    pub slacks: Vec<f64>,
    pub elastics: Vec<f64>,
    pub values: Vec<Values<N>>,
    pub rows: Vec<f64>,
}

/// Memory for one problem size; a solve allocates nothing else.
#[derive(Debug, Clone)]
pub struct Workspace<const N: usize, const M: usize> {
    /// Index of the first row of each stage, and the number of rows.
    pub(super) offsets: Vec<usize>,
    pub(super) derivatives: Vec<Derivatives<N, M>>,
    pub(super) row_gradients: Vec<Triple<N, M>>,
    /// Contiguous multipliers of the rows, as the problem takes them.
    pub(super) row_multipliers: Vec<f64>,
    pub(super) values: Vec<Values<N>>,
    pub(super) rows: Vec<f64>,
    pub(super) hessian: Vec<Blocks<N, M>>,
    pub(super) gradient: Vec<Triple<N, M>>,
    pub(super) factors: Vec<StageFactor<N, M>>,
    pub(super) steps: Vec<Triple<N, M>>,
    pub(super) new_multipliers: Vec<Vector<N>>,
    /// Weight of each row: `1 / (s/z + e/y)`.
    pub(super) weights: Vec<f64>,
    pub(super) row_steps: Vec<RowStep>,
    /// Residuals to be eliminated: the function values, or a correction.
    pub(super) target: Vec<Vector<N>>,
    pub(super) row_target: Vec<f64>,
    pub(super) trial: Trial<N, M>,
    pub(super) filter: Filter,
}

/// Step of one row.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct RowStep {
    pub slack: f64,
    pub elastic: f64,
    pub multiplier: f64,
    pub price: f64,
}

/// Capacity of the filter.
const FILTER_ROOM: usize = 128;

impl<const N: usize, const M: usize> Workspace<N, M> {
    /// Workspace for the size of a problem.
    pub fn new(problem: &impl StageProblem<N, M>) -> Self {
        let n = problem.stages();
        let mut offsets = vec![0];
        for stage in 0..n {
            offsets.push(offsets[stage] + problem.rows(stage));
        }
        let rows = offsets[n];
        Self {
            offsets,
            derivatives: vec![Derivatives::zeros(); n],
            row_gradients: vec![Triple::zeros(); rows],
            row_multipliers: vec![0.0; rows],
            values: vec![Values::zeros(); n],
            rows: vec![0.0; rows],
            hessian: vec![Blocks::zeros(); n],
            gradient: vec![Triple::zeros(); n],
            factors: vec![StageFactor::new(); n],
            steps: vec![Triple::zeros(); n],
            new_multipliers: vec![Vector::zeros(); n],
            weights: vec![0.0; rows],
            row_steps: vec![RowStep::default(); rows],
            target: vec![Vector::zeros(); n],
            row_target: vec![0.0; rows],
            trial: Trial {
                states: vec![Vector::zeros(); n + 1],
                controls: vec![Vector::zeros(); n],
                slacks: vec![0.0; rows],
                elastics: vec![0.0; rows],
                values: vec![Values::zeros(); n],
                rows: vec![0.0; rows],
            },
            filter: Filter::new(FILTER_ROOM),
        }
    }

    /// Rows of a stage.
    pub(super) fn rows_of(&self, stage: usize) -> std::ops::Range<usize> {
        self.offsets[stage]..self.offsets[stage + 1]
    }

    pub(super) fn fits(&self, problem: &impl StageProblem<N, M>) -> bool {
        self.values.len() == problem.stages()
            && (0..problem.stages()).all(|k| self.rows_of(k).len() == problem.rows(k))
    }
}
