//! Computational budget of the search and the refinement.

use crate::planner::space_time::refinement::MAX_STEPS;

/// Computational budget of the search and the refinement.
#[derive(Debug)]
pub(crate) struct SearchBudget {
    /// `(max_expansions, heuristic_weight)` of each search stage. The limit counts all expansions
    /// so far and bounds memory and time. A stage starts where the earlier ones found no plan.
    pub stages: &'static [(usize, f64)],
    /// Largest number of predefined manoeuvres per side.
    pub manoeuvres: usize,
    /// `(round, survivors)`: from that round on, only this many refinements continue, those of the
    /// least expected cost. The best one usually shows early.
    pub survivors: &'static [(usize, usize)],
    /// Largest number of racing rounds.
    pub steps: usize,
    /// Largest number of racing rounds once a manoeuvre is clear. The best one then lacks segment
    /// variables rather than steps.
    pub rounds: usize,
    /// Largest number of manoeuvres that get segment insertions.
    pub leaders: usize,
    /// True where the best of them may get a second insertion.
    pub insert_twice: bool,
    /// Largest number of nodes of the conflict search; 0 for none.
    pub conflict_nodes: usize,
}

impl SearchBudget {
    /// Budget for one target: finds the graph's optimum and tries all predefined manoeuvres.
    pub(crate) const ONE_TARGET: Self = Self {
        stages: &[(2_000, 1.0)],
        manoeuvres: usize::MAX,
        survivors: &[(0, 12), (1, 6), (2, 4), (4, 3), (6, 2)],
        steps: MAX_STEPS,
        rounds: 8,
        leaders: 2,
        insert_twice: true,
        conflict_nodes: 0,
    };

    /// Budget for several targets. A search takes longer, and predefined manoeuvres around one
    /// conflict are less often clear of all. A graph plan that is not optimal is usually as good an
    /// initial guess. The first stage is short; the later ones weight the heuristic less.
    pub(crate) const SEVERAL_TARGETS: Self = Self {
        stages: &[(20, 1.0), (200, 4.0), (1_300, 2.5)],
        manoeuvres: 2,
        survivors: &[(0, 6), (1, 3), (2, 2), (6, 1)],
        steps: MAX_STEPS,
        rounds: 5,
        leaders: 1,
        insert_twice: false,
        conflict_nodes: 0,
    };

    /// Budget of the second attempt of a thorough search among several targets.
    pub(crate) const THOROUGH: Self = Self {
        stages: &[(2_000, 1.0), (4_000, 1.5)],
        leaders: 4,
        conflict_nodes: 64,
        ..Self::ONE_TARGET
    };

    /// Budget of a warm start. A manoeuvre that is clear of other sets is clear of these soon or
    /// never.
    pub(crate) const WARM_START: Self = Self {
        steps: 16,
        ..Self::SEVERAL_TARGETS
    };

    /// Budget for the given number of targets.
    pub(crate) const fn of(targets: usize) -> &'static Self {
        if targets > 1 {
            &Self::SEVERAL_TARGETS
        } else {
            &Self::ONE_TARGET
        }
    }
}
