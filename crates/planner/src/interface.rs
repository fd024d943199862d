//! Interface between planners and the rest of the program: facts and requests.

use super::{
    NoPlan, ObjectiveKind, Outcome, PLANNERS, Plan, Planned, PlannerSettings, Problem, SearchKind,
};
use searoom_model::trajectory::{DesiredTrajectory, Segment, Trajectory};
use searoom_model::vessel::Hull;
use searoom_sets::Obstacle;

/// A planner of the registry [`PLANNERS`].
///
/// Only [`Planner::facts`] and [`Planner::plan`] are required. The other methods serve relaxation
/// levels; a planner without them skips these levels.
pub trait Planner: Sync {
    /// Facts that other modules need.
    fn facts(&self) -> &'static PlannerFacts;

    /// Plans one problem. A plan is clear of every obstacle and keeps own ship's limits.
    fn plan(&self, request: &PlanRequest) -> Planned;

    /// Sets that contain these sets and that the planner avoids in their place.
    fn outer_sets(&self, sets: Vec<Obstacle>) -> Vec<Obstacle> {
        sets
    }

    /// Warm start: refines an earlier plan against new sets without a new search.
    fn warm_started(&self, _problem: &Problem, _from: &Trajectory) -> Option<Outcome> {
        None
    }

    /// A plan by a wider search, without refinement: use it only where nothing else is found. Ten
    /// to several hundred milliseconds.
    fn wide_detour(&self, _problem: &Problem) -> Option<Planned> {
        None
    }

    /// The reason why there is no plan to the end, where sets cover it until the horizon, and the
    /// mission cut before them; without one where nothing ahead of own ship is free. `None` where
    /// the end is not covered, or own ship is far off its path.
    fn short_of_end(&self, _problem: &Problem) -> Option<(NoPlan, Option<DesiredTrajectory>)> {
        None
    }

    /// Clear motions that go on from an `arrival` while sets pass over the last waypoint, or arrive
    /// later, until a stay ends at `until`, seconds. By default a planner offers none.
    fn off_station(&self, _problem: &Problem, _arrival: &[Segment], _until: f64) -> Vec<Plan> {
        Vec::new()
    }

    /// A plan that slows down until the encountered ships have passed. It is the one that breaks the
    /// fewest rules by `broken`, fewer than `most`.
    fn let_pass(
        &self,
        _problem: &Problem,
        _broken: &dyn Fn(&Trajectory) -> usize,
        _most: usize,
    ) -> Option<Plan> {
        None
    }

    /// The motion with the least harm, which may enter sets. `nominal` belongs to the obstacles.
    fn leaving_sets(&self, _problem: &Problem, _nominal: &[NominalTarget]) -> Option<Planned> {
        None
    }
}

/// A problem with everything else that a planner may use.
#[derive(Debug, Clone)]
pub struct PlanRequest<'a> {
    /// The problem. Its obstacles are the level sets of `whole` at `max_risk`.
    pub problem: Problem<'a>,
    /// The sets before the accepted risk is applied.
    pub whole: &'a [Obstacle],
    /// Accepted risk, in `[0, 1)`.
    pub max_risk: f64,
    /// True where the motion need not arrive. If it does not, it lasts until the horizon.
    pub may_wait: bool,
    /// Settings of the planners that have some.
    pub settings: &'a PlannerSettings,
}

/// Target on its nominal track, without uncertainty.
#[derive(Debug, Clone)]
pub struct NominalTarget {
    /// Hull of the target; for a target without one, its set.
    pub hull: Obstacle,
    /// Hard set of the target.
    pub set: Obstacle,
    /// Own hull; of zero size where the set already contains it.
    pub own: Hull,
}

/// Facts about a planner.
#[derive(Debug, Clone, Copy)]
pub struct PlannerFacts {
    /// Name in files and on the command line.
    pub name: &'static str,
    /// Name in tables and figures.
    pub label: &'static str,
    /// Quantity that it minimises.
    pub minimises: Minimises,
    /// It keeps to the mission's paths and their alternatives, which are clear of land. It turns on
    /// the spot at their corners, may wait, and has a plan for every subset of the sets that it
    /// has a plan for.
    pub follows_paths: bool,
    /// It keeps off land.
    pub keeps_off_land: bool,
    /// It can restrict a plan to manoeuvres that comply with the collision regulations.
    pub keeps_rules: bool,
    /// It replaces sets by ellipses, whatever represents the targets.
    pub uses_ellipses: bool,
    /// Only ship domains are relaxed, all at once.
    pub relaxes_domains_only: bool,
    /// The time of no return is defined by its plans.
    pub has_no_return: bool,
    /// Graph searches that `compare` runs.
    pub searches: &'static [SearchKind],
}

/// Quantity that a planner minimises.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Minimises {
    /// The space-time error.
    SpaceTimeError,
    /// Any [`super::Objective`].
    Objective,
    /// A quantity of its own.
    Own(ObjectiveKind),
}

impl PartialEq for dyn Planner {
    fn eq(&self, other: &Self) -> bool {
        self.facts().name == other.facts().name
    }
}

impl Eq for dyn Planner {}

impl std::fmt::Debug for dyn Planner {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.facts().name)
    }
}

/// Each planner and its name in files and on the command line.
pub fn planner_words() -> [(&'static str, &'static dyn Planner); PLANNERS.len()] {
    PLANNERS.map(|planner| (planner.facts().name, planner))
}
