//! Searches for plans that the graph and its refinement miss: sequential conflict resolution,
//! waiting on the route, and escape from sets that own ship starts in.

pub(crate) mod escape;
pub(crate) mod harm;
pub(crate) mod let_pass;
pub(crate) mod off_station;
pub(crate) mod sequential;
pub(crate) mod waiting;
