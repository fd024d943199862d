//! The documentation and the help texts agree with the program.

pub mod documents;
mod help;
mod readme;
