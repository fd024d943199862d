//! Words of a request: its planner, how that searches, what it minimises, and which rules it follows.

use crate::PlanMethod;

searoom_geometry::words! {
    /// A planner of this project. A library user's own planner has another name.
    pub enum PlannerKind {
        /// Motions in the plane, on a graph in space-time.
        SpaceTime => "space-time",
        /// Motions along given paths.
        PathTime => "path-time",
        /// Motions under forces.
        OptimalControl => "optimal-control",
    }
}

searoom_geometry::words! {
    /// Graph search algorithm.
    pub enum SearchKind {
        /// A*: best first by cost plus an admissible lower bound of the cost to go.
        AStar => "a-star",
        /// Dijkstra's algorithm: best first by cost.
        Dijkstra => "dijkstra",
        /// The best of many searches among several targets, some with larger budgets. Ten times as
        /// slow.
        Thorough => "thorough",
    }
}

impl SearchKind {
    /// Name in tables and figures.
    pub fn label(self) -> &'static str {
        match self {
            Self::AStar => "A*",
            Self::Dijkstra => "Dijkstra",
            Self::Thorough => "thorough",
        }
    }

    /// The method of a plan that this search finds on the space-time graph.
    pub fn method(self) -> PlanMethod {
        match self {
            Self::AStar => PlanMethod::AStar,
            Self::Dijkstra => PlanMethod::Dijkstra,
            Self::Thorough => PlanMethod::Thorough,
        }
    }
}

searoom_geometry::words! {
    /// Degree to which a plan follows the collision regulations.
    pub enum Compliance {
        /// Only the hard sets are avoided.
        None => "none",
        /// Ship domains are avoided, so that the cheapest plan tends to follow the rules.
        Shape => "shape",
        /// Ship domains are avoided, and manoeuvres are restricted to readily apparent ones to the
        /// correct side.
        Rules => "rules",
    }
}

impl Compliance {
    /// True if ship domains are avoided.
    pub fn shapes(self) -> bool {
        match self {
            Self::None => false,
            Self::Shape | Self::Rules => true,
        }
    }
}

searoom_geometry::words! {
    /// Kind of quantity that a planner minimises.
    pub enum ObjectiveKind {
        /// The space-time error, m².
        SpaceTimeError => "space-time-error",
        /// Arrival time, s.
        Time => "time",
        /// Path length, m.
        Length => "length",
        /// Path length plus the weighted largest collision risk, m.
        LengthRisk => "length-risk",
        /// The integral of a planner's own stage cost.
        StageCost => "stage-cost",
    }
}
