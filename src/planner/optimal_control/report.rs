//! How a plan of forces was found.

use super::guess::Start;
use super::solver::Status;
use crate::frame::Side;
use crate::planner::Planned;

/// What came of one start.
///
/// # Examples
///
/// ```
/// # use searoom::{pipeline, scenario::Scenario};
/// use searoom::planner::optimal_control::StartReport;
///
/// let scenario = Scenario::read("scenarios/paper/figure_9.toml".as_ref())?;
/// let run = pipeline::run(scenario);
/// let report = run.control.as_ref().expect("planned by forces");
/// let best: &StartReport = report.starts.iter().min_by(|a, b| a.objective.total_cmp(&b.objective)).expect("a start");
/// assert!(best.feasible && best.iterations > 0);
/// assert_eq!(best.sides.len(), 3, "one for each of the sets");
/// # Ok::<(), searoom::scenario::ScenarioError>(())
/// ```
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
///
/// # Examples
///
/// ```
/// # use searoom::{pipeline, scenario::Scenario};
/// use searoom::planner::optimal_control::HomotopyClass;
///
/// let scenario = Scenario::read("scenarios/paper/figure_9.toml".as_ref())?;
/// let run = pipeline::run(scenario);
/// let report = run.control.as_ref().expect("planned by forces");
/// let [first, second, ..]: &[HomotopyClass] = &report.classes[..] else { panic!("several ways round") };
/// assert!(first.objective <= second.objective && first.sides != second.sides);
/// # Ok::<(), searoom::scenario::ScenarioError>(())
/// ```
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
///
/// # Examples
///
/// ```
/// # use searoom::{pipeline, scenario::Scenario};
/// use searoom::planner::optimal_control::ControlReport;
///
/// let scenario = Scenario::read("scenarios/paper/figure_9.toml".as_ref())?;
/// let run = pipeline::run(scenario);
/// let report = run.control.as_ref().expect("planned by forces");
/// let report: &ControlReport = report;
/// assert!(report.intervals >= report.start_intervals);
/// assert!(report.defect < 1e-3, "in units of the ship: how far the motion is from hers");
/// # Ok::<(), searoom::scenario::ScenarioError>(())
/// ```
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
///
/// # Examples
///
/// ```
/// use searoom::obstacle::Coast;
/// use searoom::pipeline;
/// use searoom::planner::optimal_control::{Controlled, plan};
/// use searoom::scenario::Scenario;
///
/// let scenario = Scenario::read("scenarios/paper/figure_9.toml".as_ref())?;
/// // in free water
/// let problem = pipeline::problem(&scenario, &[], Coast::none());
/// let Controlled { planned, report } = plan(&problem, &scenario.control);
/// assert!(planned.outcome.plan().is_some_and(|plan| plan.trajectory.steered().is_some()));
/// assert!(report.starts.iter().any(|start| start.feasible));
/// # Ok::<(), searoom::scenario::ScenarioError>(())
/// ```
#[derive(Debug, Clone)]
pub struct Controlled {
    /// The verdict; the cost of a plan is the integral of the stage cost, its horizon the problem's.
    pub planned: Planned,
    /// How.
    pub report: ControlReport,
}
