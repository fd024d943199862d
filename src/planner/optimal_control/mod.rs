//! The optimal-control planner.

pub mod attempt;
pub mod between;
pub mod guess;
pub mod keep_out;
pub mod reference;
pub mod solver;
pub mod task;
pub mod transcription;
