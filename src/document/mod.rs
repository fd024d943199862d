//! Published JSON documents, the single description of a result. Text, pages and `inspect` render
//! them, and `verify` checks a [`PlanDocument`] alone.
//!
//! Non-finite numbers are written as null. The structs are those of `searoom-document`; here they
//! are made from runs, and analysed with the planners' sets.

mod encounter;
mod lines;
mod memory;
mod plan;

#[cfg(feature = "recording")]
pub(crate) use encounter::has_role;
pub(crate) use encounter::{MONITORS, breaks_in_words, rules_in_words};
pub(crate) use encounter::{chart_role, encounters};
#[cfg(feature = "recording")]
pub(crate) use lines::escape_words;
pub(crate) use lines::{
    TIME_LINE, headline, in_brackets, met, passing, plan_lines, verdict_line, verdict_parts,
    warnings,
};
pub use plan::legs::planned_legs;
pub(crate) use plan::legs::{CLOSEST, longest};
pub(crate) use plan::path_time::paths;
pub(crate) use plan::{
    cost_of, minimised, objective, relaxation, sample, samples, search_stats, timing, unverified,
};
pub use searoom_document::*;
