//! A problem, a plan, an outcome: what every planner takes and gives.

mod clock;
mod control_settings;
pub mod cost;
mod explored;
mod line_error;
pub mod optimal_control;
pub mod path_time;
pub mod space_time;

pub use control_settings::ControlSettings;
pub use explored::{EdgeVerdict, ExploredEdge, ExploredGraph, ExploredNode, NodeKind};

use std::time::Duration;

use crate::colregs::{Duty, Encountered};
use crate::frame::{Side, Vector};
use crate::obstacle::{Coast, Obstacle};
use crate::trajectory::{DesiredTrajectory, NetworkError, Trajectory};
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
    /// The space-time error, formulas section 7, m².
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
}

/// What a planner is asked: keep `own` clear of every obstacle, close to `desired`, until she arrives.
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
    pub fn duty(&self) -> Duty {
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
    /// From own ship's pose at t = 0 to the last waypoint.
    pub trajectory: Trajectory,
    /// What was minimised, in the objective's unit.
    pub cost: f64,
    /// The cheapest plan on the graph before refinement, m²; `None` where the graph had none.
    pub graph_cost: Option<f64>,
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

/// Why there is no plan.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum NoPlan {
    /// Own ship starts inside an obstacle.
    #[error("own ship starts inside the set of '{target}', {depth:.1} m deep")]
    StartInside {
        /// Name of the obstacle.
        target: String,
        /// Metres.
        depth: f64,
    },
    /// Own ship starts nearer to land than she may be on some heading.
    #[error(
        "own ship starts {depth:.1} m nearer to land than her half-diagonal and the land margin allow"
    )]
    StartAshore {
        /// Metres.
        depth: f64,
    },
    /// The end cannot be reached before the horizon even without obstacles.
    #[error(
        "the last waypoint is reached after {earliest:.1} s at best, on the path found for the turning radius, without targets, but the horizon is {horizon:.1} s"
    )]
    HorizonTooShort {
        /// Seconds.
        earliest: f64,
        /// Seconds.
        horizon: f64,
    },
    /// The waypoints and own ship's pose cannot be joined by a path.
    #[error("no path joins own ship and the waypoints: a coordinate is out of range")]
    NoRoute,
    /// A planner that keeps to a path begins on it.
    #[error("own ship is {away:.3} m from the first waypoint; the path-time planner begins there")]
    OffPath {
        /// Metres.
        away: f64,
    },
    /// The alternatives and the main path are no network.
    #[error("the paths cannot be sailed: {0}")]
    NoNetwork(NetworkError),
    /// The end of the path cannot be reached before the horizon even without obstacles.
    #[error(
        "the last waypoint is reached after {earliest:.1} s at best, on the shortest of the paths at the greatest speed, without targets, but the horizon is {horizon:.1} s"
    )]
    PathTooLong {
        /// Seconds.
        earliest: f64,
        /// Seconds.
        horizon: f64,
    },
    /// The start of the path is in a set at t = 0.
    #[error(
        "own ship starts inside the set of '{target}', {depth:.1} m deep, which stays over the start {}",
        until_text(*until)
    )]
    StartCovered {
        /// Name of the obstacle.
        target: String,
        /// Metres.
        depth: f64,
        /// Seconds; `None` up to the horizon.
        until: Option<f64>,
    },
    /// No motion along the paths is clear of every set; what bars the way where own ship came nearest to the end.
    #[error(
        "no motion along the path is clear of every set: {to_go:.0} m before its end own ship, at the earliest, meets the set of '{target}' after {time:.1} s, which stays there {}",
        until_text(*until)
    )]
    Barred {
        /// Name of the obstacle.
        target: String,
        /// Metres to the end of the path.
        to_go: f64,
        /// Seconds.
        time: f64,
        /// Seconds; `None` up to the horizon.
        until: Option<f64>,
    },
    /// The sets leave a way, but not within the horizon.
    #[error(
        "no motion along the path is clear of every set and at the end before the horizon of {horizon:.1} s"
    )]
    OutOfTime {
        /// Seconds.
        horizon: f64,
    },
    /// No candidate is clear of every set.
    #[error(
        "no trajectory of the graph or its refinement is clear of every set until arrival; held on the desired \
         trajectory, own ship meets the set of '{target}' after {time:.1} s"
    )]
    NoCandidate {
        /// Name of the obstacle that the undisturbed motion meets first.
        target: String,
        /// Seconds.
        time: f64,
    },
    /// No candidate came of the search at all, though the undisturbed motion meets no set.
    #[error(
        "no trajectory of the graph or its refinement arrives clear of every set, though the desired trajectory meets none: the numbers leave no digits for it"
    )]
    NoTrajectory,
    /// No start of the optimal-control planner led out of every set.
    #[error(
        "of {starts} starts none leads to a plan clear of every set; the least deep of those solved is {depth:.3} m inside the set of '{target}' at {time:.1} s"
    )]
    Locked {
        /// Starts that were tried.
        starts: usize,
        /// Name of the obstacle.
        target: String,
        /// Seconds.
        time: f64,
        /// Metres.
        depth: f64,
    },
    /// No start of the optimal-control planner was solved at all.
    #[error("of {starts} starts none was solved: {why}")]
    Unsolved {
        /// Starts that were tried.
        starts: usize,
        /// How the first one ended.
        why: String,
    },
    /// Plans of a coarse grid, but none on the finer one that the ship's motion needs.
    #[error(
        "there are plans on {coarse} intervals, but they are too coarse for the ship, and on {intervals} the cheapest is lost: {why}"
    )]
    Lost {
        /// Of the horizon, as asked for.
        coarse: usize,
        /// Of the horizon, in the end.
        intervals: usize,
        /// How the solve on the finer grid ended.
        why: String,
    },
    /// The motion between the nodes is not the ship's.
    #[error(
        "with {intervals} intervals, the most that were tried, the ship would be off the plan by {off:.1e} of her units at the end of an interval, {allowed:.0e} allowed; what may help: more intervals (planner.optimal_control), a shorter horizon"
    )]
    Coarse {
        /// Of the horizon.
        intervals: usize,
        /// In the ship's own units of length, speed and angle.
        off: f64,
        /// In the same units.
        allowed: f64,
    },
}

impl NoPlan {
    /// True when smaller sets might leave a way.
    pub fn is_for_the_sets(&self) -> bool {
        match self {
            Self::NoCandidate { .. }
            | Self::Barred { .. }
            | Self::OutOfTime { .. }
            | Self::Locked { .. }
            | Self::Lost { .. }
            | Self::Unsolved { .. } => true,
            Self::StartInside { .. }
            | Self::StartAshore { .. }
            | Self::StartCovered { .. }
            | Self::HorizonTooShort { .. }
            | Self::PathTooLong { .. }
            | Self::OffPath { .. }
            | Self::NoNetwork(_)
            | Self::Coarse { .. }
            | Self::NoRoute
            | Self::NoTrajectory => false,
        }
    }
}

fn until_text(until: Option<f64>) -> String {
    match until {
        Some(time) => format!("until {time:.1} s"),
        None => "up to the horizon".to_owned(),
    }
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
    fn plan_mut(&mut self) -> Option<&mut Plan> {
        match self {
            Self::Solved(plan) => Some(plan),
            Self::Deadline(plan) => plan.as_mut(),
            Self::Infeasible(_) => None,
        }
    }
}

/// The answer of a planner with what led to it.
///
/// ```
/// use searoom::evaluation::{Evaluation, Passage};
/// use searoom::obstacle::SpaceTimeObstacle;
/// use searoom::pipeline::{self, Run, TargetSets};
/// use searoom::planner::{Outcome, Plan, SearchStats};
/// use searoom::scenario::Scenario;
///
/// let scenario = Scenario::read("scenarios/colregs/give-way.toml".as_ref())?;
/// let run: Run = pipeline::run(scenario);
/// let sets: &TargetSets = &run.sets[0];
/// assert_eq!(sets.hard.name(), "target");
/// let Outcome::Solved(Plan { trajectory, cost, .. }) = &run.planned.outcome else {
///     panic!("there is room");
/// };
/// assert!(trajectory.end_time() > 300.0 && *cost > 0.0);
/// let SearchStats { expanded, generated, .. } = run.planned.stats;
/// assert!(expanded <= generated);
/// let judged: &Evaluation = run.evaluation.as_ref().expect("every plan is judged");
/// assert!(judged.verified() && judged.violations.is_empty());
/// let passage: &Passage = &judged.passages[0];
/// assert!(passage.dcpa >= passage.min_clearance);
/// # Ok::<(), searoom::scenario::ScenarioError>(())
/// ```
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
