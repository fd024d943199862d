#![doc = include_str!("../README.md")]
#![forbid(unsafe_code)]
#![warn(missing_docs)]

// the file of fixtures names the crate as other crates do
#[cfg(test)]
extern crate self as searoom_model;

#[cfg(test)]
#[path = "../../geometry/src/geometry_fixtures.rs"]
mod geometry_fixtures;
#[cfg(test)]
mod ship_fixtures;

mod method;
mod request;
mod simulated;
pub mod target;
pub mod trajectory;
pub mod vessel;

pub use method::PlanMethod;
pub use request::{Compliance, ObjectiveKind, PlannerKind, SearchKind};
pub use simulated::{BehaviourKind, SailedVessel, SensorType};
