//! How a plan of forces was found.

use super::guess::Start;
use super::solver::Status;
use crate::frame::Side;
use crate::planner::Planned;

/// What came of one start.
#[derive(Debug, Clone, PartialEq)]
pub struct StartReport {
    /// Which.
    pub start: Start,
    /// How its solve ended.
    pub status: Status,
    /// True when solved and clear of every set.
    pub feasible: bool,
    /// The integral of the stage cost.
    pub objective: f64,
    /// Steps of the solver.
    pub iterations: usize,
    /// Per set the side on which it is passed.
    pub sides: Vec<Option<Side>>,
}

/// Plans that pass every set alike.
#[derive(Debug, Clone, PartialEq)]
pub struct HomotopyClass {
    /// Per set the side on which it lies when nearest; `None` where it is far.
    pub sides: Vec<Option<Side>>,
    /// The least objective found.
    pub objective: f64,
    /// Starts that led there.
    pub starts: usize,
}

/// How a plan of forces was found.
#[derive(Debug, Clone, PartialEq)]
pub struct ControlReport {
    /// Every start, in their order.
    pub starts: Vec<StartReport>,
    /// The classes of the feasible plans, the cheapest first.
    pub classes: Vec<HomotopyClass>,
    /// Intervals of the grid of the starts: their objectives, and those of the classes, are on it.
    pub start_intervals: usize,
    /// Intervals of the plan's grid; without a plan of the last one that was tried.
    pub intervals: usize,
    /// The largest deviation at the end of an interval on that grid, in the ship's units; NaN where no start led to a plan.
    pub defect: f64,
}

/// A plan of forces and how it was found.
#[derive(Debug, Clone)]
pub struct Controlled {
    /// The verdict; the cost of a plan is the integral of the stage cost, its horizon the problem's.
    pub planned: Planned,
    /// How.
    pub report: ControlReport,
}
