//! Searoom plans how a ship keeps clear of others when nobody knows exactly what they will do.

pub mod colregs;
pub mod evaluation;
pub mod frame;
pub mod geometry;
pub mod obstacle;
pub mod pipeline;
pub mod planner;
#[cfg(feature = "recording")]
pub mod recording;
pub mod report;
pub mod scenario;
pub mod search;
pub mod simulation;
pub mod target;
pub mod tolerance;
pub mod trajectory;
pub mod vessel;
