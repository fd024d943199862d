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
mod graph_cost;
mod land;
mod larger_sets;
mod less_speed;
mod long_routes;
mod optimal_control;
mod path_networks;
mod path_time;
mod roles;
mod rules;
mod simulated_documents;
mod stays;
mod stopping;
mod warm_starts;
