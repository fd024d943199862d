//! Scenarios sailed in the closed loop.

mod closed_loop;
#[cfg(test)]
#[path = "../../tests/campaigns/encounter_generator.rs"]
mod encounter_generator;

pub use closed_loop::{Command, Simulation};
#[cfg(test)]
pub(crate) use encounter_generator::{EncounterKind, Placement, random_encounter, random_traffic};
