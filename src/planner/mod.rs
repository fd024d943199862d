//! A problem, a plan, an outcome: what every planner takes and gives.

mod clock;
mod control_settings;
pub mod cost;
mod explored;
mod line_error;
mod no_plan;
pub mod optimal_control;
pub mod path_time;
pub mod space_time;

pub use control_settings::ControlSettings;
pub use explored::{EdgeVerdict, ExploredEdge, ExploredGraph, ExploredNode, NodeKind};
pub use no_plan::NoPlan;

use std::time::Duration;

use crate::colregs::{Duty, Encountered};
use crate::frame::{Side, Vector};
use crate::obstacle::{Coast, Obstacle};
use crate::trajectory::{DesiredTrajectory, Segment, Trajectory};
use crate::vessel::OwnShip;

/// Which search runs over the graph.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SearchKind {
    /// Best first by cost plus an admissible bound of the cost to go.
    AStar,
    /// Best first by cost.
    Dijkstra,
}

/// Which planner.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PlannerKind {
    /// Chooses her way and her speed: [`space_time`].
    SpaceTime,
    /// Keeps to given paths and chooses her speed: [`path_time`].
    PathTime,
    /// Chooses her forces: [`optimal_control`].
    OptimalControl,
}

impl PlannerKind {
    /// The word for it in files and on the command line.
    pub fn word(self) -> &'static str {
        match self {
            Self::SpaceTime => "space-time",
            Self::PathTime => "path-time",
            Self::OptimalControl => "optimal-control",
        }
    }
}

/// What a planner minimises.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Objective {
    /// The space-time error, docs/theory.md section 7, m².
    SpaceTimeError,
    /// The time of arrival, s.
    Time,
    /// The length of the way, m; of ways of one length the time.
    Length,
    /// The length of the way and its largest risk, m: what `weight` metres are to certainty.
    LengthRisk {
        /// Metres, not negative.
        weight: f64,
    },
}

impl Objective {
    /// The word for it in files.
    pub fn word(self) -> &'static str {
        match self {
            Self::SpaceTimeError => "space-time-error",
            Self::Time => "time",
            Self::Length => "length",
            Self::LengthRisk { .. } => "length-risk",
        }
    }

    /// The unit of what is minimised.
    pub fn unit(self) -> &'static str {
        match self {
            Self::SpaceTimeError => "m²",
            Self::Time => "s",
            Self::Length | Self::LengthRisk { .. } => "m",
        }
    }
}

/// What a planner is asked: keep `own` clear of every obstacle, close to `desired`, until she arrives.
///
/// # Examples
///
/// ```
/// use searoom::obstacle::Coast;
/// use searoom::pipeline;
/// use searoom::planner::{Problem, space_time};
/// use searoom::scenario::Scenario;
///
/// let scenario = Scenario::read("scenarios/colregs/give-way.toml".as_ref())?;
/// let sets: Vec<_> = pipeline::sets(&scenario).into_iter().map(|target| target.hard).collect();
/// let asked = pipeline::problem(&scenario, &sets, Coast::none());
/// let clear = space_time::plan(&asked).outcome;
/// // the same without anybody else
/// let alone = space_time::plan(&Problem { obstacles: &[], ..asked }).outcome;
/// let cost = |outcome: &searoom::planner::Outcome| outcome.plan().map(|plan| plan.cost);
/// assert!(cost(&clear) > cost(&alone) && cost(&alone) < Some(1.0));
/// # Ok::<(), searoom::scenario::ScenarioError>(())
/// ```
#[derive(Debug, Clone)]
pub struct Problem<'a> {
    /// Own ship and her limits.
    pub own: &'a OwnShip,
    /// Where she is meant to be, and when.
    pub desired: &'a DesiredTrajectory,
    /// Other paths that she may sail, metres: the path-time planner's.
    pub alternatives: &'a [Vec<Vector>],
    /// What is minimised; the space-time planner knows the space-time error alone.
    pub objective: Objective,
    /// The sets to stay out of, own ship's footprint folded in.
    pub obstacles: &'a [Obstacle],
    /// Land to stay off, own ship's footprint folded in.
    pub coast: &'a Coast,
    /// Seconds: arrival must not be later; the obstacles are known until then.
    pub horizon: f64,
    /// `q` of eq. (30), m²/s².
    pub time_weight: f64,
    /// Search over the graph.
    pub search: SearchKind,
    /// Wall-clock budget of one plan.
    pub deadline: Duration,
    /// Side to which own ship should turn first: a plan that first turns to the other has to be cheaper by
    /// [`AGAINST_THE_RULES`].
    pub first_turn: Option<Side>,
    /// The targets toward which a plan has to comply with the rules of the road; empty where that is not asked.
    pub encountered: &'a [Encountered],
}

impl Problem<'_> {
    /// What is asked of the first alteration.
    pub(crate) fn duty(&self) -> Duty {
        Duty::of(self.encountered.iter().map(|e| e.role))
    }
}

/// Share of the cost by which a plan has to be cheaper whose first turn is to the side that the collision
/// regulations discourage.
pub const AGAINST_THE_RULES: f64 = 0.05;

/// What the search did to find the cheapest plan on the graph.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct SearchStats {
    /// Nodes whose successors were made.
    pub expanded: usize,
    /// Nodes made.
    pub generated: usize,
    /// Edges tested against every obstacle.
    pub edges_checked: usize,
    /// Nodes expanded after that, to find plans that pass the targets on other sides.
    pub further_expanded: usize,
}

/// A collision-free trajectory to the end of the desired path.
#[derive(Debug, Clone)]
pub struct Plan {
    /// From own ship's pose at t = 0 to the last waypoint, or to the horizon.
    pub trajectory: Trajectory,
    /// What was minimised, in the objective's unit.
    pub cost: f64,
    /// The first plan on the graph, before refinement, in the same unit: for one target its cheapest, among several at most four times that;
    /// `None` where the graph had none.
    pub graph_cost: Option<f64>,
    /// Metres of the shortest way to the last waypoint that are left at the end: 0 for a plan that arrives. One that does not
    /// goes on to the horizon.
    pub to_go: f64,
}

impl Plan {
    /// A motion for the least space-time error, which is computed anew for all of it: searches compare by coarser quadrature.
    /// `None` of what is no trajectory.
    pub(crate) fn measured(
        problem: &Problem,
        motion: Vec<Segment>,
        graph_cost: Option<f64>,
    ) -> Option<Self> {
        Some(Self {
            cost: cost::whole_space_time_error(problem.desired, &motion, problem.time_weight),
            trajectory: Trajectory::new(motion).ok()?,
            graph_cost,
            to_go: 0.0,
        })
    }
}

/// What ends the hold of a ship that stands on: the plan is to hold course and speed until then, and this escape after it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Escape {
    /// Seconds: the latest time at which an escape is known to be clear.
    pub latest: f64,
    /// Radians of its first turn, to port positive; 0 where it is by less speed.
    pub turn: f64,
    /// m/s of its beginning.
    pub speed: f64,
}

/// What a planner answers. None of these is an error.
#[derive(Debug, Clone)]
pub enum Outcome {
    /// A plan, clear of every set.
    Solved(Plan),
    /// No plan exists among the candidates.
    Infeasible(NoPlan),
    /// The budget ran out; the best plan so far, if there is one.
    Deadline(Option<Plan>),
}

impl Outcome {
    /// The plan, where there is one.
    pub fn plan(&self) -> Option<&Plan> {
        match self {
            Self::Solved(plan) => Some(plan),
            Self::Deadline(plan) => plan.as_ref(),
            Self::Infeasible(_) => None,
        }
    }
}

impl Outcome {
    fn into_plan(self) -> Option<Plan> {
        match self {
            Self::Solved(plan) => Some(plan),
            Self::Deadline(plan) => plan,
            Self::Infeasible(_) => None,
        }
    }

    fn plan_mut(&mut self) -> Option<&mut Plan> {
        match self {
            Self::Solved(plan) => Some(plan),
            Self::Deadline(plan) => plan.as_mut(),
            Self::Infeasible(_) => None,
        }
    }
}

/// The answer of a planner with what led to it.
#[derive(Debug, Clone)]
pub struct Planned {
    /// The verdict.
    pub outcome: Outcome,
    /// What the search did.
    pub stats: SearchStats,
    /// Every node and edge that the search made.
    pub explored: ExploredGraph,
    /// The diagram that the path-time planner planned in; boxed, as most plans have none.
    pub path_time: Option<Box<path_time::PathTimeDiagram>>,
    /// Where own ship stands on (Rule 17).
    pub escape: Option<Escape>,
}

impl Planned {
    /// An answer that no search led to.
    pub(crate) fn of(outcome: Outcome) -> Self {
        Self {
            outcome,
            stats: SearchStats::default(),
            explored: ExploredGraph::new(),
            path_time: None,
            escape: None,
        }
    }
}
