//! Input of commands: scenarios and rows of numbers.

pub mod files;
pub mod rows;
pub mod scenes;
