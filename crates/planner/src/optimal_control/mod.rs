//! Optimal-control planner, paper section III.D: forces that keep a ship with dynamics clear of
//! moving ellipsoids.
//!
//! ```text
//! initial guesses ─► collocation ─► interior point ─► rows at deepest points ─► warm start ─► best
//! ```
//!
//! A plan is a local optimum. The initial guess determines the sides on which sets are passed; the
//! solver optimises the states and forces.

mod attempt;
mod between;
mod defect;
mod grid;
mod guess;
mod keep_out;
mod passing;
mod plan;
mod reference;
mod report;
// needed by tests and benches of the solver only; not part of the public interface
#[doc(hidden)]
pub mod solver;
mod task;
#[doc(hidden)]
pub mod transcription;
mod warm_start;

pub use attempt::{Inside, StartAttempt, attempt};
pub use guess::{Start, family, profile_along};
pub use keep_out::{Keep, KeepOut};
pub use plan::plan;
pub use report::{ControlReport, HomotopyClass, StartReport};
pub use solver::{Settings, SolverReport, SolverStatus};
pub use task::{Controls, Profile, Task, force, node, state};
pub use transcription::Weights;
pub use warm_start::WarmStart;

use super::{
    Minimises, ObjectiveKind, PlanRequest, Planned, Planner, PlannerFacts, PlannerKind, SearchKind,
};
use searoom_sets::Obstacle;

/// Chooses the forces on a ship with dynamics.
pub struct OptimalControlPlanner;

impl Planner for OptimalControlPlanner {
    fn facts(&self) -> &'static PlannerFacts {
        &PlannerFacts {
            name: const { PlannerKind::OptimalControl.word() },
            label: "optimal control",
            minimises: Minimises::Own(ObjectiveKind::StageCost),
            follows_paths: false,
            keeps_off_land: false,
            keeps_rules: false,
            uses_ellipses: true,
            relaxes_domains_only: true,
            has_no_return: false,
            searches: &[SearchKind::AStar],
        }
    }

    fn plan(&self, request: &PlanRequest) -> Planned {
        plan(&request.problem, &request.settings.optimal_control)
    }

    fn outer_sets(&self, sets: Vec<Obstacle>) -> Vec<Obstacle> {
        // ellipsoids as they are, others by the smallest ellipses around their two sets
        let outer = |set| KeepOut::outer_of(set).set().clone().into();
        sets.iter().map(outer).collect()
    }
}
