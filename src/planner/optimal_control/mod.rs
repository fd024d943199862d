//! The optimal-control planner, paper section III.D: forces that keep a ship with dynamics clear of moving ellipsoids.
//!
//! ```text
//! starts ─► collocation ─► interior point ─► rows where the motion is deepest ─► again, warm ─► the best of all
//! ```
//!
//! A plan is a local optimum. The starts choose the sides on which sets are passed; the solver finds the numbers.

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
// what tests and benches of the solver alone need; no part of what a user is promised
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
