//! Studies of a scenario: questions about its obstacles, comparison of planners, and faults of the
//! scenario itself.

pub mod assess;
pub mod compare;
pub mod lint;
