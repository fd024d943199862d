//! Methods of a comparison and their names.

use super::applies::has_choice;
use crate::planner::{Minimises, Objective, PLANNERS, PlanMethod, Planner, SearchKind};
use crate::scenario::Scenario;
use crate::target::Representation;

/// Planner with its settings, or a baseline.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Method {
    /// Planner.
    Planner {
        /// The planner.
        planner: &'static dyn Planner,
        /// Graph search; without effect on a planner without a graph.
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
    /// Every planner with each of its searches and each of these representations.
    pub(super) fn of_planners(representations: &[Option<Representation>]) -> Vec<Self> {
        let mut all = Vec::new();
        for planner in PLANNERS {
            let facts = planner.facts();
            let representations = match facts.uses_ellipses {
                true => &[None],
                false => representations,
            };
            for &representation in representations {
                all.extend(facts.searches.iter().map(|&search| Self::Planner {
                    planner,
                    search,
                    representation,
                }));
            }
        }
        all
    }

    /// Returns the scenario with the settings of this method, without those that the planner cannot
    /// honour: ship domains replace the rules, and the space-time error replaces the objective.
    pub fn asked(self, scenario: &Scenario) -> Scenario {
        let mut asked = scenario.clone();
        if let Self::Planner {
            planner,
            search,
            representation,
        } = self
        {
            asked.set_planner(planner);
            asked.search = search;
            if let Some(representation) = representation {
                let choosing = asked.targets.iter_mut().filter(|target| has_choice(target));
                choosing.for_each(|target| target.representation = representation);
            }
            if planner.facts().minimises != Minimises::Objective {
                asked.objective = Objective::SpaceTimeError;
            }
            if !planner.facts().follows_paths {
                asked.alternatives.clear();
            }
        }
        asked
    }
}

/// Name of a method: the planner, its search where it has several and `search` ran, what made the
/// plan where the planner and the search do not say it, and ellipsoids.
pub(super) fn named(
    planner: &dyn Planner,
    search: Option<SearchKind>,
    made: Option<PlanMethod>,
    representation: Option<Representation>,
) -> String {
    let facts = planner.facts();
    let search = search.filter(|_| facts.searches.len() > 1);
    let made = made.filter(|made| {
        let is_own = matches!(made, PlanMethod::OptimalControl | PlanMethod::PathTimeGraph);
        !is_own && !made.is_by_search()
    });
    let parts = [
        Some(facts.label),
        search.map(SearchKind::label),
        made.map(PlanMethod::label),
        (representation == Some(Representation::Ellipsoid)).then_some("ellipsoids"),
    ];
    let parts: Vec<&str> = parts.into_iter().flatten().collect();
    parts.join(", ")
}

impl std::fmt::Display for Method {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Planner {
                planner,
                search,
                representation,
            } => f.write_str(&named(*planner, Some(*search), None, *representation)),
            Self::HoldCourse => f.write_str("hold course"),
            Self::ConstantVelocity => f.write_str("constant velocity"),
        }
    }
}
