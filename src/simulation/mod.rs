//! Random encounters, and random motions of targets within their sets.

mod behaviour;
mod encounter_generator;

pub use behaviour::{Behaviour, Signal};
pub use encounter_generator::{
    EncounterKind, GeneratorError, Meeting, Placement, RandomEncounter, random_encounter,
    random_meeting, random_traffic,
};
