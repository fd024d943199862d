//! Random encounters, and targets that do anything their sets allow: what the claims are tested with.

mod behaviour;
mod encounter_generator;

pub use behaviour::{Behaviour, Signal};
pub use encounter_generator::{
    Drawn, EncounterKind, GeneratorError, Placement, random_encounter, random_traffic,
};
