//! When an answer is due.

use std::time::{Duration, Instant};

/// A budget of wall-clock time, counted from when it was made.
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

    /// What is left of the budget.
    pub(crate) fn left(&self) -> Duration {
        self.budget.saturating_sub(self.begun.elapsed())
    }

    /// True once the time is up, and ever after.
    pub(crate) fn is_up(&self) -> bool {
        self.begun.elapsed() >= self.budget
    }
}
