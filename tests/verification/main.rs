//! Tests of the plan document check: documents from the planners pass, and every alteration is
//! detected.

mod alter;
mod claims;
#[path = "../campaigns/documents.rs"]
mod documents;
mod extremes;
mod input;
mod motion;
mod out_of_reach;
mod risk;
mod safety;
mod simulations;
mod unsound;
