//! Ways to sail a scenario, and their names.

use crate::planner::{Objective, PlannerKind, SearchKind};
use crate::scenario::{Compliance, Scenario};
use crate::target::Representation;

/// A planner with its settings, or a baseline.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Method {
    /// A planner.
    Planner {
        /// Which.
        kind: PlannerKind,
        /// Over its graph; of no meaning for optimal control.
        search: SearchKind,
        /// What the sets of the targets are made of; `None` where that is settled by the targets.
        representation: Option<Representation>,
    },
    /// Own course and speed from t = 0, whatever is in the way.
    HoldCourse,
    /// The best constant velocity out of every velocity obstacle.
    ConstantVelocity,
}

impl Method {
    /// The scenario with what this method changes in it. What keeps to no rules keeps out of the shapes. The objective of a planner that knows the space-time error alone becomes
    /// that, and other paths are left to the planner that keeps to paths.
    pub fn asked(self, scenario: &Scenario) -> Scenario {
        let mut asked = scenario.clone();
        if let Self::Planner {
            kind,
            search,
            representation,
        } = self
        {
            asked.planner = kind;
            if kind != PlannerKind::SpaceTime && asked.compliance == Compliance::Rules {
                asked.compliance = Compliance::Shape;
            }
            asked.search = search;
            if let Some(representation) = representation {
                for target in &mut asked.targets {
                    target.representation = representation;
                }
            }
            if kind != PlannerKind::PathTime {
                asked.objective = Objective::SpaceTimeError;
                asked.alternatives.clear();
            }
        }
        asked
    }
}

impl std::fmt::Display for Method {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Planner {
                kind,
                search,
                representation,
            } => {
                f.write_str(match (kind, search) {
                    (PlannerKind::SpaceTime, SearchKind::AStar) => "space-time, A*",
                    (PlannerKind::SpaceTime, SearchKind::Dijkstra) => "space-time, Dijkstra",
                    (PlannerKind::PathTime, _) => "path-time",
                    (PlannerKind::OptimalControl, _) => "optimal control",
                })?;
                match representation {
                    Some(Representation::Ellipsoid) => f.write_str(", ellipsoids"),
                    Some(Representation::Polytope) | None => Ok(()),
                }
            }
            Self::HoldCourse => f.write_str("hold course"),
            Self::ConstantVelocity => f.write_str("constant velocity"),
        }
    }
}
