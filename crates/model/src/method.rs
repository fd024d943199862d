//! The method that made a plan.

searoom_geometry::words! {
    /// Method that made a plan. The graph search that was asked for need not have run.
    pub enum PlanMethod {
        /// A manoeuvre by the rules of the road: a search of the graph of such manoeuvres.
        Rules => "rules",
        /// A* on the space-time graph, and the refinement of its plan and of standard manoeuvres.
        AStar => "a-star",
        /// Dijkstra's algorithm on the space-time graph, and the refinement that follows A*.
        Dijkstra => "dijkstra",
        /// The best of many searches among several targets.
        Thorough => "thorough",
        /// Refinement of the plan of a search against other sets, without a search of its own.
        WarmStart => "warm-start",
        /// Hybrid A* over place, course and time, for a wide detour.
        HybridAStar => "hybrid-a-star",
        /// Search of the path-time graph.
        PathTimeGraph => "path-time-graph",
        /// Optimal control under forces.
        OptimalControl => "optimal-control",
        /// The remainder of the last plan.
        Remainder => "remainder",
        /// Escape with the least harm from sets that own ship is in.
        LeastHarm => "least-harm",
        /// Own ship slows or waits on its way, short of the sets or until ships have passed: dynamic
        /// programming over length and time, or lower speeds in turn, without a graph.
        Waiting => "waiting",
        /// Own ship lies at the last waypoint, leaves it while sets pass over it, and returns: a grid of
        /// departures, without a graph.
        OffStation => "off-station",
        /// Own ship stays where it is.
        Stay => "stay",
        /// A planner of a library user.
        Other => "other",
    }
}

impl PlanMethod {
    /// Name in tables, figures and texts.
    pub fn label(self) -> &'static str {
        match self {
            Self::Rules => "by the rules",
            Self::AStar => "A*",
            Self::Dijkstra => "Dijkstra",
            Self::Thorough => "thorough search",
            Self::WarmStart => "warm start",
            Self::HybridAStar => "hybrid A*",
            Self::PathTimeGraph => "path-time graph",
            Self::OptimalControl => "optimal control",
            Self::Remainder => "remainder of the last plan",
            Self::LeastHarm => "least harm",
            Self::Waiting => "waits on its route",
            Self::OffStation => "clears its place",
            Self::Stay => "stays in place",
            Self::Other => "another planner",
        }
    }

    /// True where a search that the request names made the plan, or the plan that a warm start
    /// refined.
    pub fn is_by_search(self) -> bool {
        matches!(
            self,
            Self::AStar | Self::Dijkstra | Self::Thorough | Self::WarmStart
        )
    }

    /// True where every such plan has search statistics, false where none has; `None` where a part
    /// of the plan may come from a search.
    pub fn has_statistics(self) -> Option<bool> {
        match self {
            Self::OptimalControl
            | Self::Remainder
            | Self::Waiting
            | Self::OffStation
            | Self::Stay => Some(false),
            // the best of many plans may be one of another method, of a stricter request
            Self::LeastHarm | Self::Thorough | Self::Other => None,
            Self::Rules
            | Self::AStar
            | Self::Dijkstra
            | Self::WarmStart
            | Self::HybridAStar
            | Self::PathTimeGraph => Some(true),
        }
    }

    /// That of a plan of this method after a warm start against other sets. It refines all but the
    /// plans of a graph search in the same way as their own method.
    pub fn warm_started(self) -> Self {
        match self.is_by_search() {
            true => Self::WarmStart,
            false => self,
        }
    }
}
