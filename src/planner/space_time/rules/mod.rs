//! Manoeuvres by the collision regulations: one manoeuvre, several one after another, and the
//! further requirements on a motion.

mod compliance;
pub(crate) mod groups;
mod manoeuvre;
