//! Tests of the planners, from a scenario to the verdict of the independent checker.

#[path = "../campaigns/mod.rs"]
mod campaigns;

mod campaign;
mod closed_loop;
mod conformance;
mod control_solver;
mod encounters;
mod forced_loop;
mod generator;
mod land;
mod larger_sets;
mod long_routes;
mod optimal_control;
mod path_networks;
mod path_time;
mod roles;
mod rules;
mod simulated_documents;
mod stays;
mod stopping;
