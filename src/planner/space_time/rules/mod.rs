//! Manoeuvres by the collision regulations: the family, its manoeuvres one after another, and what
//! else a motion has to comply with.

mod compliance;
pub(crate) mod groups;
mod manoeuvre;
