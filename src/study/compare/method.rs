//! Methods of a comparison and their names.

use crate::planner::{Objective, PlannerKind, SearchKind};
use crate::scenario::{Compliance, Scenario};
use crate::target::Representation;

/// Planner with its settings, or a baseline.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Method {
    /// Planner.
    Planner {
        /// Kind of planner.
        kind: PlannerKind,
        /// Graph search; without effect on optimal control.
        search: SearchKind,
        /// Representation of the sets; `None` if the targets determine it.
        representation: Option<Representation>,
    },
    /// Constant own course and speed from t = 0.
    HoldCourse,
    /// Best constant velocity outside every velocity obstacle.
    ConstantVelocity,
}

impl Method {
    /// Returns the scenario with the settings of this method. Only the space-time planner filters
    /// by rules; the others use ship domains alone. Only the path-time planner uses the objective
    /// and the alternative paths.
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
