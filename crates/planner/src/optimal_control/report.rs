//! Report of an optimal-control plan.

use super::guess::Start;
use super::solver::SolverStatus;
use searoom_geometry::frame::Side;

/// Result of one initial guess.
#[derive(Debug, Clone, PartialEq)]
pub struct StartReport {
    /// Kind of guess.
    pub start: Start,
    /// Solver status.
    pub status: SolverStatus,
    /// True when solved and clear of every set.
    pub feasible: bool,
    /// Integral of the stage cost.
    pub objective: f64,
    /// Solver iterations.
    pub iterations: usize,
    /// Side on which each set is passed.
    pub sides: Vec<Option<Side>>,
}

/// Plans that pass every set on the same side.
#[derive(Debug, Clone, PartialEq)]
pub struct HomotopyClass {
    /// Side of each set at its closest approach; `None` where it stays far away.
    pub sides: Vec<Option<Side>>,
    /// Least objective found.
    pub objective: f64,
    /// Number of initial guesses that led to it.
    pub starts: usize,
}

/// Report of an optimal-control plan.
#[derive(Debug, Clone, PartialEq)]
pub struct ControlReport {
    /// Results of all initial guesses, in their order.
    pub starts: Vec<StartReport>,
    /// Classes of the feasible plans, cheapest first.
    pub classes: Vec<HomotopyClass>,
    /// Number of intervals for the initial guesses; their objectives, and those of the classes,
    /// refer to it.
    pub start_intervals: usize,
    /// Number of intervals of the plan; without a plan, of the last grid tried.
    pub intervals: usize,
    /// Largest deviation at the end of an interval on that grid, in the ship's units; NaN where no
    /// initial guess led to a plan.
    pub defect: f64,
}
