//! Manoeuvres by the collision regulations: the family, and what else a motion has to comply with.

mod compliance;
pub(crate) mod manoeuvre;
