//! A primal-dual interior-point method for problems that come in stages. It knows no ship.
//!
//! Newton steps on the barrier problem by a Riccati recursion (cost linear in the stages), a filter line search with
//! a second-order correction, exact second derivatives with Gauss–Newton where these have the wrong inertia and a
//! shift where that is singular, rows at an exact penalty (elastic), the barrier lowered monotonically. After
//! A. Wächter and L. T. Biegler (2006), doi:10.1007/s10107-004-0559-y; the recursion as in C. V. Rao, S. J. Wright and
//! J. B. Rawlings (1998), doi:10.1023/A:1021711402723. There is no restoration phase: the elastic rows stand in.

mod dense;
mod filter;
mod interior;
mod iterate;
mod line_search;
mod newton;
mod riccati;
mod stage;
mod workspace;

pub use dense::{Matrix, Vector};
pub use interior::solve;
pub use iterate::{Iterate, RowPoint};
pub use stage::{Blocks, Derivatives, Multipliers, Point, StageProblem, Triple, Values};
pub use workspace::Workspace;

/// How to solve.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Settings {
    /// Largest scaled error of the optimality conditions at the end.
    pub tolerance: f64,
    /// The barrier to begin with: 0.1 from nowhere, some thousandths from the solution of a problem nearby.
    pub barrier: f64,
    /// Price of one unit by which a row falls short: exact above the row's multiplier.
    pub penalty: f64,
    /// Steps at most.
    pub max_iterations: usize,
    /// False: exact second derivatives only, shifted where they have the wrong inertia.
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

/// Why the solver stopped. Only [`Status::Solved`] is a solution.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Status {
    /// The optimality conditions hold to the tolerance; rows may still fall short, see [`Report::shortfall`].
    Solved,
    /// The steps were spent.
    Iterations,
    /// No step along the search direction was acceptable, several times.
    Stalled,
    /// The objective or the point ran away.
    Unbounded,
    /// A function or a step was not a number.
    NotANumber,
    /// A stage's equations do not determine its state after.
    Singular,
    /// The caller's clock ran out.
    OutOfTime,
    /// No stage, limits without interior, or a start of the wrong size or not of numbers.
    BadProblem,
}

impl std::fmt::Display for Status {
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

/// What a solve came to; the point itself is in the iterate.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Report {
    /// Why it stopped.
    pub status: Status,
    /// Steps taken.
    pub iterations: usize,
    /// The objective, without penalties.
    pub objective: f64,
    /// Scaled error of the optimality conditions.
    pub error: f64,
    /// The most by which a row is below zero; 0 where none is.
    pub shortfall: f64,
    /// The largest multiplier of a row: the penalty is exact above it.
    pub row_multiplier: f64,
}

#[cfg(test)]
mod tests;
