//! Plans of single scenes, each planned once.

pub mod asked;
pub mod compliance;
pub mod encounters;
pub mod harbour;
pub mod invariance;
pub mod mutations;
pub mod relations;
pub mod several;
pub mod short_missions;
pub mod tidiness;
