//! Primal-dual interior-point method for multistage problems, independent of ships.
//!
//! Newton steps on the barrier problem use a Riccati recursion, linear in the stages. A filter line
//! search with a second-order correction accepts them. Second derivatives are exact. Where these
//! have the wrong inertia the method uses Gauss–Newton, and a shift where that is singular. Rows
//! have an exact penalty (elastic), which replaces a restoration phase. The barrier decreases
//! monotonically.
//!
//! After A. Wächter and L. T. Biegler (2006), doi:10.1007/s10107-004-0559-y; the recursion as in C.
//! V. Rao, S. J. Wright and J. B. Rawlings (1998), doi:10.1023/A:1021711402723.

mod filter;
mod interior;
mod iterate;
mod line_search;
mod newton;
mod riccati;
mod stage;
mod workspace;

pub use interior::solve;
pub use iterate::{Iterate, RowPoint};
pub use stage::{Blocks, Derivatives, Matrix, Multipliers, StageProblem, Triple, Values, Vector};
pub use workspace::Workspace;

/// Solver settings.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Settings {
    /// Largest scaled error of the optimality conditions of a solution.
    pub tolerance: f64,
    /// Initial barrier parameter: 0.1 for a cold start, some thousandths near the solution of a
    /// similar problem.
    pub barrier: f64,
    /// Penalty per unit of a row's shortfall: exact above the row's multiplier.
    pub penalty: f64,
    /// Largest number of steps.
    pub max_iterations: usize,
    /// False: only exact second derivatives, shifted where they have the wrong inertia.
    pub gauss_newton: bool,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            tolerance: 1e-6,
            barrier: 0.1,
            penalty: 100.0,
            max_iterations: 200,
            gauss_newton: true,
        }
    }
}

/// Reason why the solver stopped. Only [`SolverStatus::Solved`] is a solution.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SolverStatus {
    /// The optimality conditions hold to the tolerance; rows may still have a
    /// [`SolverReport::shortfall`].
    Solved,
    /// Step limit reached.
    Iterations,
    /// Repeatedly, no step along the search direction was acceptable.
    Stalled,
    /// The objective or the point diverged.
    Unbounded,
    /// A function or a step was a NaN.
    NotANumber,
    /// A stage's equations do not determine its next state.
    Singular,
    /// Deadline reached.
    OutOfTime,
    /// No stage, limits without interior, or a guess of the wrong size or not finite.
    BadProblem,
}

impl std::fmt::Display for SolverStatus {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Solved => "solved",
            Self::Iterations => "the steps of the solver were spent",
            Self::Stalled => "the solver found no acceptable step",
            Self::Unbounded => "the objective or the state runs away",
            Self::NotANumber => "a value is not a number",
            Self::Singular => "the equations of an interval do not determine its end",
            Self::OutOfTime => "the time ran out",
            Self::BadProblem => {
                "the problem has no interval, no force to choose, or a start that is no number"
            }
        })
    }
}

/// Report of a solve; the point itself is in the iterate.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SolverReport {
    /// Reason for stopping.
    pub status: SolverStatus,
    /// Number of steps.
    pub iterations: usize,
    /// Objective without penalties.
    pub objective: f64,
    /// Scaled error of the optimality conditions.
    pub error: f64,
    /// Largest shortfall of a row below zero; 0 where there is none.
    pub shortfall: f64,
    /// Largest multiplier of a row: the penalty is exact above it.
    pub row_multiplier: f64,
}

#[cfg(test)]
mod tests;
