//! The views of a recording: each file logs the entities of one of them.

pub mod chart;
pub mod closed_loop;
pub mod closest;
pub mod curves;
pub mod explored;
pub mod geographic;
pub mod land;
pub mod rules;
pub mod ships;
pub mod space_time;
pub mod summary;
pub mod velocities;
