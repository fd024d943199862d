//! The method that made a plan.

/// Method that made a plan. The graph search that was asked for need not have run.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
#[cfg_attr(feature = "schemars", derive(schemars::JsonSchema))]
pub enum PlanMethod {
    /// A manoeuvre by the rules of the road: a search of the graph of such manoeuvres.
    Rules,
    /// A* on the space-time graph, and the refinement of its plan and of standard manoeuvres.
    AStar,
    /// Dijkstra's algorithm on the space-time graph, and the refinement that follows A*.
    Dijkstra,
    /// The best of many searches among several targets.
    Thorough,
    /// Refinement of the plan of a search against other sets, without a search of its own.
    WarmStart,
    /// Hybrid A* over place, course and time, for a wide detour.
    HybridAStar,
    /// Search of the path-time graph.
    PathTimeGraph,
    /// Optimal control under forces.
    OptimalControl,
    /// The remainder of the last plan.
    Remainder,
    /// Escape with the least harm from sets that own ship is in.
    LeastHarm,
    /// Own ship slows or waits on its way, short of the sets or until ships have passed: dynamic
    /// programming over length and time, or lower speeds in turn, without a graph.
    Waiting,
    /// Own ship lies at the last waypoint, leaves it while sets pass over it, and returns: a grid of
    /// departures, without a graph.
    OffStation,
    /// Own ship stays where it is.
    Stay,
    /// A planner of a library user.
    Other,
}

searoom_geometry::words!(PlanMethod {
    Rules => "rules",
    AStar => "a-star",
    Dijkstra => "dijkstra",
    Thorough => "thorough",
    WarmStart => "warm-start",
    HybridAStar => "hybrid-a-star",
    PathTimeGraph => "path-time-graph",
    OptimalControl => "optimal-control",
    Remainder => "remainder",
    LeastHarm => "least-harm",
    Waiting => "waiting",
    OffStation => "off-station",
    Stay => "stay",
    Other => "other",
});

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
