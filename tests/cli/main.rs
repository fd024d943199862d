//! The program, run as a user runs it.

mod assessing;
mod bad_input;
mod campaign;
mod compare;
mod docs;
mod figures;
mod foreign;
mod golden;
mod ignored;
mod lint;
mod plan;
mod program;
#[cfg(feature = "recording")]
mod recordings;
mod schemas;
mod simulate;
mod suite;
mod tables;
mod terminal;
mod traffic;
mod verdict;
mod verify;
