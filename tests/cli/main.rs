//! The program, run as a user runs it.

mod bad_input;
mod foreign;
mod golden;
mod planning;
mod program;
mod results;
mod verdict;
