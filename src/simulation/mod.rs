//! Random encounters, and random motions of targets within their sets.

mod behaviour;
mod encounter_generator;

pub use behaviour::{Behaviour, Signal};
pub use encounter_generator::{
    EncounterKind, GeneratorError, Placement, RandomEncounter, random_encounter, random_traffic,
};
