//! Computational budget of the search and the refinement.

use crate::SearchKind;
use crate::space_time::refinement::MAX_STEPS;

/// Computational budget of the search and the refinement.
#[derive(Debug)]
pub(crate) struct SearchBudget {
    /// `(max_expansions, heuristic_weight)` of each search stage. The limit counts all expansions
    /// so far and bounds memory and time. A stage starts where the earlier ones found no plan.
    pub stages: &'static [(usize, f64)],
    /// Largest number of iterations of a refinement.
    pub max_iterations: usize,
    /// Largest number of iterations once some manoeuvre is clear, because the best one then lacks segment
    /// variables rather than iterations.
    pub iterations_once_clear: usize,
    /// Largest number of manoeuvres that get segment insertions.
    pub leaders: usize,
    /// Relative cost difference from the best one up to which a manoeuvre gets them.
    pub leader_margin: f64,
    /// True where the best of them may get a second insertion.
    pub insert_twice: bool,
    /// True where a coarse grid is searched, too.
    pub searches_grid: bool,
    /// Where conflicts are resolved one after another: largest number of motions that have no way
    /// past their next conflict.
    pub dead_ends: usize,
    /// Largest number of conflicts that are resolved once a motion is clear of all, for a cheaper one.
    pub more_conflicts: usize,
}

impl SearchBudget {
    /// Budget for one target: finds the graph's optimum.
    pub(crate) const ONE_TARGET: Self = Self {
        stages: &[(2_000, 1.0)],
        max_iterations: MAX_STEPS,
        iterations_once_clear: 8,
        leaders: 8,
        leader_margin: 0.3,
        insert_twice: true,
        searches_grid: false,
        dead_ends: 3,
        more_conflicts: 3,
    };

    /// Budget for several targets. A search takes longer, and predefined manoeuvres around one
    /// conflict are less often clear of all; the coarse search finds what they miss. A graph plan that is
    /// not optimal is usually as good an initial guess. The first stage is short; the later ones weight the
    /// heuristic less.
    pub(crate) const SEVERAL_TARGETS: Self = Self {
        stages: &[(20, 1.0), (200, 4.0), (1_300, 2.5)],
        searches_grid: true,
        ..Self::ONE_TARGET
    };

    /// Budget for some of several targets, which are resolved one after another.
    pub(crate) const PART_OF_SEVERAL: Self = Self {
        searches_grid: false,
        ..Self::SEVERAL_TARGETS
    };

    /// Budget of a thorough search among several targets.
    pub(crate) const THOROUGH: Self = Self {
        stages: &[(2_000, 1.0), (4_000, 1.5)],
        dead_ends: 4,
        more_conflicts: 4,
        ..Self::SEVERAL_TARGETS
    };

    /// Budget of a warm start. A manoeuvre that is clear of other sets is clear of these soon or
    /// never.
    pub(crate) const WARM_START: Self = Self {
        max_iterations: 16,
        iterations_once_clear: 5,
        leaders: 1,
        insert_twice: false,
        ..Self::ONE_TARGET
    };

    /// Budget for the given number of targets, which may be some of all.
    pub(crate) const fn of(targets: usize, is_part: bool, search: SearchKind) -> &'static Self {
        match (targets, search) {
            (0 | 1, _) => &Self::ONE_TARGET,
            (_, SearchKind::Thorough) => &Self::THOROUGH,
            _ if is_part => &Self::PART_OF_SEVERAL,
            _ => &Self::SEVERAL_TARGETS,
        }
    }
}
