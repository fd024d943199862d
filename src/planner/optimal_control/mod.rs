//! Optimal-control planner, paper section III.D: forces that keep a ship with dynamics clear of
//! moving ellipsoids.
//!
//! ```text
//! initial guesses ─► collocation ─► interior point ─► rows at deepest points ─► warm start ─► best
//! ```
//!
//! A plan is a local optimum. The initial guess determines the sides on which sets are passed; the
//! solver optimises the states and forces.

mod attempt;
mod between;
mod defect;
mod grid;
mod guess;
mod keep_out;
mod passing;
mod plan;
mod receding;
mod reference;
mod report;
// needed by tests and benches of the solver only; not part of the public interface
#[doc(hidden)]
pub mod solver;
mod task;
#[doc(hidden)]
pub mod transcription;

pub use attempt::{Attempt, Inside, attempt};
pub use guess::{Start, family, profile_along};
pub use keep_out::{Keep, KeepOut};
pub use plan::{outer_sets, plan};
pub use receding::{Measured, RecedingHorizon};
pub use report::{ControlReport, Controlled, HomotopyClass, StartReport};
pub use solver::{Report, Settings, Status};
pub use task::{Controls, Profile, Task};
pub use transcription::Weights;
