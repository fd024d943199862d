#![doc = include_str!("../README.md")]
#![forbid(unsafe_code)]
#![warn(missing_docs)]

#[cfg(test)]
#[path = "../../geometry/src/geometry_fixtures.rs"]
mod geometry_fixtures;
#[cfg(test)]
#[path = "../../model/src/ship_fixtures.rs"]
mod ship_fixtures;

mod clock;
mod control_settings;
pub mod cost;
mod explored;
mod interface;
mod line_error;
mod no_plan;
pub mod optimal_control;
pub mod path_time;
pub mod search;
pub mod space_time;

pub use crate::search::Counts as SearchStats;
pub use control_settings::ControlSettings;
pub use cost::whole_space_time_error;
pub use explored::{EdgeVerdict, ExploredEdge, ExploredGraph, ExploredNode, NodeKind};
pub use interface::{Minimises, NominalTarget, PlanRequest, Planner, PlannerFacts, planner_words};
pub use no_plan::NoPlan;
pub use optimal_control::WarmStart;
pub use searoom_model::{ObjectiveKind, PlanMethod, PlannerKind, SearchKind};
pub use space_time::SpaceTimeSettings;

use std::time::Duration;

use searoom_colregs::{Duty, Encountered, ON_COURSE, Thresholds};
use searoom_geometry::frame::{Side, Vector, wrap};
use searoom_model::trajectory::{DesiredTrajectory, Segment, Trajectory};
use searoom_model::vessel::{OwnShip, VesselKind};
use searoom_sets::{LandObstacle, Obstacle};

/// All planners, in the order of `compare`.
pub const PLANNERS: [&dyn Planner; 3] = [
    &space_time::SpaceTimePlanner,
    &path_time::PathTimePlanner,
    &optimal_control::OptimalControlPlanner,
];

/// The planner of a scenario that names none.
pub const DEFAULT_PLANNER: &dyn Planner = PLANNERS[0];

/// Settings of the planners that have some.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PlannerSettings {
    /// Settings of the optimal-control planner.
    pub optimal_control: ControlSettings,
    /// True where plans of the space-time planner are tidy. `None` where only those under the rules
    /// of the road are.
    pub tidy: Option<bool>,
    /// How tidy they are.
    pub tidiness: Tidiness,
    /// What its searches are tuned by.
    pub space_time: &'static SpaceTimeSettings,
}

impl PlannerSettings {
    /// Default settings for an own ship of the given length, metres.
    pub fn at_length(length: f64) -> Self {
        Self {
            optimal_control: ControlSettings::at_length(VesselKind::CyberShip2, length),
            tidy: None,
            tidiness: Tidiness::at_length(length),
            space_time: &SpaceTimeSettings::DEFAULT,
        }
    }
}

/// Least times of a tidy plan: one that a crew would sail, with few turns and changes of speed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tidiness {
    /// Least time at a speed between two changes, seconds.
    pub speed_time: f64,
    /// Least duration of a line or an arc, seconds.
    pub segment_time: f64,
}

impl Tidiness {
    /// Least times for an own ship of the given length, metres. At a speed: 30 s for 30 m and less,
    /// 60 s for 100 m and more. For a segment: 3 s.
    pub fn at_length(length: f64) -> Self {
        let share = ((length - 30.0) / 70.0).clamp(0.0, 1.0);
        Self {
            speed_time: 30.0 + 30.0 * share,
            segment_time: 3.0,
        }
    }

    /// With times by another clock, `factor` of whose seconds are one second.
    pub fn scaled(self, factor: f64) -> Self {
        Self {
            speed_time: self.speed_time * factor,
            segment_time: self.segment_time * factor,
        }
    }
}

/// Quantity that a planner minimises.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Objective {
    /// The space-time error, docs/reference/theory.md section 7, m².
    SpaceTimeError,
    /// Arrival time, s.
    Time,
    /// Path length, m; among paths of equal length the arrival time.
    Length,
    /// Path length plus the weighted largest collision risk, m.
    LengthRisk {
        /// Metres equivalent to a risk of one; not negative.
        weight: f64,
    },
}

impl Objective {
    /// Its kind, named in files.
    pub fn kind(self) -> ObjectiveKind {
        match self {
            Self::SpaceTimeError => ObjectiveKind::SpaceTimeError,
            Self::Time => ObjectiveKind::Time,
            Self::Length => ObjectiveKind::Length,
            Self::LengthRisk { .. } => ObjectiveKind::LengthRisk,
        }
    }

    /// Unit of the minimised quantity.
    pub fn unit(self) -> &'static str {
        match self {
            Self::SpaceTimeError => "m²",
            Self::Time => "s",
            Self::Length | Self::LengthRisk { .. } => "m",
        }
    }
}

/// Planning problem: keep `own` clear of every obstacle and close to `desired` until the arrival.
#[derive(Debug, Clone)]
pub struct Problem<'a> {
    /// Own ship and its limits.
    pub own: &'a OwnShip,
    /// Desired trajectory.
    pub desired: &'a DesiredTrajectory,
    /// Alternative paths, metres; used by the path-time planner.
    pub alternatives: &'a [Vec<Vector>],
    /// Minimised quantity. The space-time planner supports the space-time error only.
    pub objective: Objective,
    /// Thresholds of manoeuvres by the rules.
    pub thresholds: &'a Thresholds,
    /// Sets to avoid, inflated by own ship's footprint.
    pub obstacles: &'a [Obstacle],
    /// Land to avoid, inflated by own ship's footprint.
    pub land_obstacle: &'a LandObstacle,
    /// Latest arrival, seconds. The obstacles are known until then.
    pub horizon: f64,
    /// Weight `q` of paper eq. (30), m²/s².
    pub time_weight: f64,
    /// Graph search algorithm.
    pub search: SearchKind,
    /// Wall-clock budget of one plan.
    pub deadline: Duration,
    /// Preferred side of the first turn. A plan that first turns to the other side must be cheaper
    /// by [`AGAINST_THE_RULES`].
    pub first_turn: Option<Side>,
    /// Targets toward which a plan must comply with the collision regulations; empty where
    /// compliance is not required.
    pub encountered: &'a [Encountered],
    /// Manoeuvre by the rules that own ship carries out at t = 0.
    pub under_way: Option<UnderWay>,
    /// How tidy a plan is, at some cost; `None` for the least cost alone.
    pub tidy: Option<Tidiness>,
    /// Own ship's state and last plan under forces; `None` where it moves ahead at its speed.
    pub warm_start: Option<&'a optimal_control::WarmStart>,
    /// Settings of the space-time planner's searches.
    pub settings: &'a SpaceTimeSettings,
}

impl<'a> Problem<'a> {
    /// Least space-time error without land, rules, alternative paths and tidiness. The time weight
    /// is the square of own speed; the budget is a minute.
    pub fn new(
        own: &'a OwnShip,
        desired: &'a DesiredTrajectory,
        obstacles: &'a [Obstacle],
        horizon: f64,
    ) -> Self {
        Self {
            own,
            desired,
            alternatives: &[],
            objective: Objective::SpaceTimeError,
            thresholds: Thresholds::standard(),
            obstacles,
            land_obstacle: LandObstacle::none(),
            horizon,
            time_weight: own.speed * own.speed,
            search: SearchKind::AStar,
            deadline: Duration::from_secs(60),
            first_turn: None,
            encountered: &[],
            under_way: None,
            tidy: None,
            warm_start: None,
            settings: &SpaceTimeSettings::DEFAULT,
        }
    }

    /// Space-time error of a part of a motion at the accuracy of the searches, m².
    pub(crate) fn error_of(&self, part: &[Segment]) -> f64 {
        let error = |s| cost::space_time_error(self.desired, s, self.time_weight);
        part.iter().map(error).sum()
    }

    /// Space-time error of a motion to its end, m²: with the wait of a ship that arrives early.
    pub(crate) fn error_to_end(&self, motion: &[Segment]) -> f64 {
        let after = |last| cost::error_after_end(self.desired, last, self.time_weight);
        self.error_of(motion) + motion.last().map_or(0.0, after)
    }

    /// Duty of own ship toward all encountered targets.
    pub(crate) fn duty(&self) -> Duty {
        Duty::of(self.encountered.iter().map(|e| e.role))
    }
}

/// Relative cost by which a plan must be cheaper when its first turn is to the side that the
/// collision regulations discourage.
pub const AGAINST_THE_RULES: f64 = 0.05;

/// Ratio of the costs up to which a plan is kept that keeps more than another: a ship domain, a length off a
/// ship, or a manoeuvre where a bend breaks no rule either. *J* is squared, so this is three times the
/// distance (docs/reference/rules.md).
pub const MANY_TIMES: f64 = 10.0;

/// Own lengths. A plan is far off its schedule where the root mean square of its space-time error is more, and
/// is then compared with others by [`MANY_TIMES`].
pub const FAR_OFF_LENGTHS: f64 = 20.0;

/// A collision-free trajectory to the end of the desired path.
#[derive(Debug, Clone)]
pub struct Plan {
    /// Motion from own ship's pose at t = 0 to the last waypoint, to before the sets over it, or to
    /// the horizon.
    pub trajectory: Trajectory,
    /// Minimised quantity, in the objective's unit.
    pub cost: f64,
    /// Method that made it.
    pub method: PlanMethod,
    /// Cost of the first plan on the graph before refinement, in the same unit. For one target, and
    /// for several of which the mission meets one alone, it is the graph's optimum around that one; for
    /// several it is at most four times that. `None` where the graph had no plan.
    pub graph_cost: Option<f64>,
    /// Remaining length of the shortest path to the last waypoint at the end, metres; 0 for a plan
    /// that arrives. Along paths a plan that does not arrive extends to the horizon.
    pub to_go: f64,
}

impl Plan {
    /// True where it ends at the last waypoint. Always true for motions under forces.
    pub fn arrives(&self) -> bool {
        self.to_go == 0.0
    }

    /// Plan that ends where own ship is, after no time.
    pub fn staying(problem: &Problem) -> Option<Self> {
        let stay = Segment::straight(problem.own.pose, 0.0, 0.0, problem.own.max_speed());
        Self::measured(problem, vec![stay], PlanMethod::Stay)
    }

    /// Plan that arrives, with its space-time error, which is integrated anew: searches use coarser
    /// quadrature. `None` for an invalid trajectory.
    pub fn measured(problem: &Problem, motion: Vec<Segment>, method: PlanMethod) -> Option<Self> {
        Some(Self {
            cost: cost::whole_space_time_error(problem.desired, &motion, problem.time_weight),
            trajectory: Trajectory::new(motion).ok()?,
            method,
            graph_cost: None,
            to_go: 0.0,
        })
    }
}

/// Escape manoeuvre of a stand-on ship. Own ship holds course and speed until `held_until`, then
/// escapes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Escape {
    /// End of the hold, seconds. The escape from there on is clear of every set.
    pub held_until: f64,
    /// First turn, radians, to port positive; 0 where the escape reduces speed.
    pub turn: f64,
    /// Speed at the start of the escape, m/s.
    pub speed: f64,
}

/// A manoeuvre by the rules along a plan: own ship alters course or speed, keeps it until the
/// targets have passed, returns, and joins the route.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PlannedManoeuvre {
    /// Seconds of the first alteration.
    pub begins: f64,
    /// Seconds of the turn back, or of the change of speed back.
    pub returns: f64,
    /// Seconds from which on own ship follows the route again.
    pub joins: f64,
    /// Heading before, radians.
    pub first_heading: f64,
    /// First turn, radians, to port positive; 0 where own ship reduces speed only.
    pub turn: f64,
}

impl PlannedManoeuvre {
    /// This manoeuvre with a clock that starts `time` seconds later.
    pub fn after(self, time: f64) -> Self {
        Self {
            begins: self.begins - time,
            returns: self.returns - time,
            joins: self.joins - time,
            ..self
        }
    }
}

/// The manoeuvre that own ship carries out at t = 0: it has left the route and is not back on it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct UnderWay {
    /// Seconds at which the manoeuvre began, negative.
    pub begins: f64,
    /// Heading before the manoeuvre, radians.
    pub first_heading: f64,
    /// First turn, radians, to port positive; 0 where own ship reduces speed only.
    pub turn: f64,
    /// Heading that own ship steers or turns to, radians.
    pub heading: f64,
    /// Speed, m/s.
    pub speed: f64,
    /// True where own ship has begun to return to its route.
    pub is_returning: bool,
}

impl UnderWay {
    /// True where own ship may still turn to a course parallel to its first one before the targets
    /// are passed.
    pub(crate) fn may_turn_back(&self) -> bool {
        let is_parallel = wrap(self.heading - self.first_heading).abs() <= ON_COURSE;
        !self.is_returning && self.turn != 0.0 && !is_parallel
    }
}

/// Result of a planner. None of these is an error.
#[derive(Debug, Clone)]
pub enum Outcome {
    /// A plan, clear of every set.
    Solved(Plan),
    /// No candidate is a plan.
    Infeasible(NoPlan),
    /// The budget ran out. Holds the best plan so far, if any.
    Deadline(Option<Plan>),
}

impl Outcome {
    /// The plan, if any.
    pub fn plan(&self) -> Option<&Plan> {
        match self {
            Self::Solved(plan) => Some(plan),
            Self::Deadline(plan) => plan.as_ref(),
            Self::Infeasible(_) => None,
        }
    }

    fn into_plan(self) -> Option<Plan> {
        match self {
            Self::Solved(plan) => Some(plan),
            Self::Deadline(plan) => plan,
            Self::Infeasible(_) => None,
        }
    }

    /// The plan, to change it.
    pub fn plan_mut(&mut self) -> Option<&mut Plan> {
        match self {
            Self::Solved(plan) => Some(plan),
            Self::Deadline(plan) => plan.as_mut(),
            Self::Infeasible(_) => None,
        }
    }
}

/// Result of a planner with its search statistics and by-products.
#[derive(Debug, Clone)]
pub struct Planned {
    /// The result.
    pub outcome: Outcome,
    /// Search statistics up to the cheapest plan on the graph; `None` where no graph was searched for
    /// this result.
    pub stats: Option<SearchStats>,
    /// All nodes and edges that the search generated.
    pub explored: ExploredGraph,
    /// Path-time diagram of the path-time planner; boxed because most plans have none.
    pub path_time: Option<Box<path_time::PathTimeDiagram>>,
    /// Report of a plan under forces.
    pub control: Option<Box<optimal_control::ControlReport>>,
    /// Escape of a stand-on ship (Rule 17).
    pub escape: Option<Escape>,
    /// The manoeuvres of a plan by the rules, in order of time.
    pub manoeuvres: Vec<PlannedManoeuvre>,
    /// True where a part of the search was given up to leave time for others.
    pub is_cut_short: bool,
    /// The best answers of a thorough search so far that give up as much as the plan, which is the
    /// last; else empty.
    pub improvements: Vec<Improvement>,
}

/// The best answer of a thorough search so far, from when one of its searches was complete.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Improvement {
    /// Planning time.
    pub after: Duration,
    /// Its [`Plan::cost`], m².
    pub cost: f64,
}

impl Planned {
    /// Result without a search.
    pub fn of(outcome: Outcome) -> Self {
        Self {
            outcome,
            stats: None,
            explored: ExploredGraph::new(),
            path_time: None,
            control: None,
            escape: None,
            manoeuvres: Vec::new(),
            is_cut_short: false,
            improvements: Vec::new(),
        }
    }

    /// Method that made the plan; `None` without one.
    pub fn method(&self) -> Option<PlanMethod> {
        self.outcome.plan().map(|plan| plan.method)
    }

    /// True for the remainder of the plan that own ship follows.
    pub fn is_remainder(&self) -> bool {
        self.method() == Some(PlanMethod::Remainder)
    }
}
