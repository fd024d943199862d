//! Wall-clock budget of one plan.

use std::time::{Duration, Instant};

/// Wall-clock budget, counted from its construction.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Clock {
    begun: Instant,
    budget: Duration,
}

impl Clock {
    pub(crate) fn new(budget: Duration) -> Self {
        Self {
            begun: Instant::now(),
            budget,
        }
    }

    /// Time left in the budget.
    pub(crate) fn left(&self) -> Duration {
        self.budget.saturating_sub(self.begun.elapsed())
    }

    /// True from the end of the budget on.
    pub(crate) fn is_up(&self) -> bool {
        self.begun.elapsed() >= self.budget
    }
}
