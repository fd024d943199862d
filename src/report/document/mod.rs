//! The JSON documents of the contract, sections 3 and 5.
//!
//! A number that is not finite is written as null. Keys of what does not exist yet are absent.

mod parts;
mod plan;
mod suite;

pub use parts::*;
pub use plan::{PLAN_FORMAT, PlanDocument};
pub use suite::{
    INTERNAL_FAULT, SuiteDocument, SuiteRunDocument, SuiteSummaryDocument, UNREADABLE,
};
