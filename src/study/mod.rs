//! Studies of a scenario: assessment of its obstacles, comparison of planners, and faults of the
//! scenario.

pub mod assess;
pub mod bound;
pub mod compare;
pub mod lint;
