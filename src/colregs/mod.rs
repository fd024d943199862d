//! The rules of the road: encounters and the shapes that answer them.

mod domain;
mod encounter;

pub use encounter::{Encounter, Role};
