//! Random encounters.

mod encounter_generator;

pub use encounter_generator::{
    EncounterKind, GeneratorError, Meeting, Placement, RandomEncounter, random_encounter,
    random_meeting, random_traffic,
};
