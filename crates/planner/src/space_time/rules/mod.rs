//! Manoeuvres by the collision regulations: what one is, when it begins, which one is taken,
//! several one after another, and the further requirements on a motion. The same graph has tidy
//! manoeuvres without roles.

pub(crate) mod automaton;
pub(crate) mod bodies;
pub(crate) mod compliance;
mod departure;
pub(crate) mod groups;
mod hug;
mod manoeuvre;
pub(crate) mod search;
