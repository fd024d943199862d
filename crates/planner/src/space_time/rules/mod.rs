//! Manoeuvres by the collision regulations: what one is, when it begins, which one is taken,
//! several one after another, and the further requirements on a motion.

mod compliance;
mod departure;
pub(crate) mod groups;
mod manoeuvre;
mod search;
