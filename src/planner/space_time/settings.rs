//! Candidate angles and durations of the space-time planner's searches.
//!
//! Each search has its own grid. The graph branches at every node and takes few values. The
//! enumeration of [`crate::planner::space_time::fallback::escape`] tests every value once and takes
//! more.

/// Seconds for which the graph holds a course beyond a vertex, one after another.
pub(crate) const GRAPH_HOLDS_S: [f64; 3] = [20.0, 40.0, 80.0];

/// Angles between the graph's return lines and the route, radians.
pub(crate) const GRAPH_RETURN_ANGLES: [f64; 2] = [0.4, 0.8];

/// Return angles of predefined manoeuvres, radians; the smallest that fits is used.
pub(crate) const MANOEUVRE_RETURN_ANGLES: [f64; 4] = [0.3, 0.5, 0.8, 1.1];

/// Seconds for which an exit from a set is held before the planner takes over. At the very edge of
/// a growing set every turn leads back into it.
pub(crate) const EXIT_HOLDS_S: [f64; 5] = [0.0, 10.0, 30.0, 60.0, 120.0];

/// Seconds for which a turn is held where own ship is in no set and there is no plan.
pub(crate) const EVASIVE_HOLDS_S: [f64; 3] = [30.0, 60.0, 120.0];
