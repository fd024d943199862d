//! Filter of a line search: pairs of infeasibility and objective that no later point may exceed in
//! both.

/// Infeasibility and objective of a point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Merit {
    /// Sum of the absolute defects.
    pub infeasibility: f64,
    /// Barrier objective.
    pub objective: f64,
}

/// Required decrease as a fraction of the infeasibility; Wächter and Biegler 2006, section 3.
const LESS_INFEASIBLE: f64 = 1e-5;
const LESS_OBJECTIVE: f64 = 1e-8;

/// Stored pairs, with a fixed capacity.
#[derive(Debug, Clone)]
pub(super) struct Filter {
    taken: Vec<Merit>,
    most: f64,
}

impl Filter {
    pub fn new(room: usize) -> Self {
        Self {
            taken: Vec::with_capacity(room),
            most: f64::INFINITY,
        }
    }

    /// Removes all pairs; keeps the largest permitted infeasibility.
    pub fn clear(&mut self, most: f64) {
        self.taken.clear();
        self.most = most;
    }

    /// False for a point that is worse in both than a stored pair, and for a NaN.
    pub fn accepts(&self, point: Merit) -> bool {
        point.infeasibility <= self.most
            && point.objective.is_finite()
            && self
                .taken
                .iter()
                .all(|t| point.infeasibility < t.infeasibility || point.objective < t.objective)
    }

    /// Stores a pair with its margins. At full capacity the oldest is removed.
    pub fn take(&mut self, point: Merit) {
        if self.taken.len() == self.taken.capacity() {
            self.taken.remove(0);
        }
        self.taken.push(Merit {
            infeasibility: (1.0 - LESS_INFEASIBLE) * point.infeasibility,
            objective: point.objective - LESS_OBJECTIVE * point.infeasibility,
        });
    }

    /// True where a point is sufficiently better than another in one of the two.
    pub fn improves(point: Merit, on: Merit) -> bool {
        point.infeasibility <= (1.0 - LESS_INFEASIBLE) * on.infeasibility
            || point.objective <= on.objective - LESS_OBJECTIVE * on.infeasibility
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn merit(infeasibility: f64, objective: f64) -> Merit {
        Merit {
            infeasibility,
            objective,
        }
    }

    #[test]
    fn points_worse_in_both_are_rejected_and_the_capacity_is_kept() {
        let mut filter = Filter::new(2);
        filter.clear(10.0);
        filter.take(merit(1.0, 1.0));
        assert!(!filter.accepts(merit(1.0, 1.0)) && !filter.accepts(merit(2.0, 3.0)));
        assert!(filter.accepts(merit(0.5, 9.0)) && filter.accepts(merit(2.0, 0.5)));
        assert!(!filter.accepts(merit(11.0, 0.0)) && !filter.accepts(merit(f64::NAN, 0.0)));
        assert!(
            !filter.accepts(merit(0.0, f64::NAN)) && !filter.accepts(merit(0.0, f64::NEG_INFINITY))
        );
        for _ in 0..5 {
            filter.take(merit(0.1, 0.1));
        }
        assert_eq!(filter.taken.capacity(), 2);
    }
}
