//! Random encounters for tests, benches and documentation; scenarios sailed in the closed loop.

mod closed_loop;
mod encounter_generator;

pub use closed_loop::Simulation;
pub use encounter_generator::{
    EncounterKind, GeneratorError, Meeting, Placement, RandomEncounter, random_encounter,
    random_meeting, random_traffic,
};
