//! Scenarios and rows of numbers that a command reads.

pub mod files;
pub mod rows;
pub mod scenes;
