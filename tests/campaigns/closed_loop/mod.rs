//! Plans that are made again and again while own ship sails.

pub mod replanning;
pub mod simulation;
