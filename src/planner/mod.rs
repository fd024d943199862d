//! A problem, a plan, an outcome: what every planner takes and gives.

mod control_settings;
pub mod cost;
mod explored;
pub mod optimal_control;
pub mod space_time;

pub use control_settings::{ControlSettings, PlannerKind};
pub use explored::{EdgeVerdict, ExploredEdge, ExploredGraph, ExploredNode, NodeKind};

use std::time::Duration;

use crate::obstacle::Obstacle;
use crate::trajectory::{DesiredTrajectory, Trajectory};
use crate::vessel::OwnShip;

/// Which search runs over the graph.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SearchKind {
    /// Best first by cost plus an admissible bound of the cost to go.
    AStar,
    /// Best first by cost.
    Dijkstra,
}

/// What a planner is asked: keep `own` clear of every obstacle, close to `desired`, until she arrives.
#[derive(Debug, Clone)]
pub struct Problem<'a> {
    /// Own ship and her limits.
    pub own: &'a OwnShip,
    /// Where she is meant to be, and when.
    pub desired: &'a DesiredTrajectory,
    /// The sets to stay out of, own ship's footprint folded in.
    pub obstacles: &'a [Obstacle],
    /// Seconds: arrival must not be later; the obstacles are known until then.
    pub horizon: f64,
    /// `q` of eq. (30), m²/s².
    pub time_weight: f64,
    /// Search over the graph.
    pub search: SearchKind,
    /// Wall-clock budget of one plan.
    pub deadline: Duration,
}

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
    /// The space-time error of the trajectory, m²; what was minimised.
    pub cost: f64,
    /// The cheapest plan on the graph before refinement, m²; `None` where the graph had none.
    pub graph_cost: Option<f64>,
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
    /// The motion between the nodes is not the ship's.
    #[error(
        "with {intervals} intervals, the most that were tried, the ship would be off the plan by {off:.1e} of her units at the end of an interval, {allowed:.0e} allowed"
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

/// The answer of a planner with what led to it.
#[derive(Debug, Clone)]
pub struct Planned {
    /// The verdict.
    pub outcome: Outcome,
    /// What the search did.
    pub stats: SearchStats,
    /// Every node and edge that the search made.
    pub explored: ExploredGraph,
}
