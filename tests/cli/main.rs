//! The program, run as a user runs it.

mod assessing;
mod bad_input;
mod documents;
mod figures;
mod foreign;
mod golden;
mod planning;
mod program;
mod readme;
mod results;
mod simulating;
mod verdict;
