//! How much is spent on finding a plan.

use crate::planner::space_time::refinement::MAX_STEPS;

/// What a search and a refinement may spend.
#[derive(Debug)]
pub(crate) struct SearchBudget {
    /// Up to so many expansions in all, which bounds memory and time, the bounds of what is to come are multiplied by so much.
    /// Each stage begins where those before have no plan.
    pub stages: &'static [(usize, f64)],
    /// Canonical manoeuvres that are tried on a side at most.
    pub manoeuvres: usize,
    /// How many refinements go on after so many steps: those of the least expected
    /// cost. A winner is seen early.
    pub places: &'static [(usize, usize)],
    /// Steps of the race at most.
    pub steps: usize,
    /// Steps of the race once a manoeuvre is clear: what the winner still lacks are segment variables, not steps.
    pub rounds: usize,
    /// Manoeuvres that are enriched at most.
    pub leaders: usize,
    /// True where the best of them may be enriched once more.
    pub twice: bool,
}

impl SearchBudget {
    /// For one target: the graph's best plan, and the cheapest manoeuvre that is known how to find.
    pub(crate) const ALONE: Self = Self {
        stages: &[(2_000, 1.0)],
        manoeuvres: usize::MAX,
        places: &[(0, 12), (1, 6), (2, 4), (4, 3), (6, 2)],
        steps: MAX_STEPS,
        rounds: 8,
        leaders: 2,
        twice: true,
    };

    /// For several: a search takes longer and canonical manoeuvres, each around one conflict, are clear of all more seldom. A
    /// plan of the graph that is not its best is as good a beginning as a rule. In haste first; what cannot be had so
    /// is had sooner with bounds that hold more of the truth.
    pub(crate) const AMONG_SEVERAL: Self = Self {
        stages: &[(20, 1.0), (200, 4.0), (1_300, 2.5)],
        manoeuvres: 2,
        places: &[(0, 6), (1, 3), (2, 2), (6, 1)],
        steps: MAX_STEPS,
        rounds: 5,
        leaders: 1,
        twice: false,
    };

    /// For a manoeuvre that is known to be clear of other sets: what is not clear of these soon never is.
    pub(crate) const CONTINUED: Self = Self {
        steps: 16,
        ..Self::AMONG_SEVERAL
    };

    /// For so many targets.
    pub(crate) const fn of(targets: usize) -> &'static Self {
        if targets > 1 {
            &Self::AMONG_SEVERAL
        } else {
            &Self::ALONE
        }
    }
}
