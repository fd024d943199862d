//! The optimal-control planner, paper section III.D: forces that keep a ship with dynamics clear of moving ellipsoids.
//!
//! ```text
//! starts ─► collocation ─► interior point ─► rows where the motion is deepest ─► again, warm ─► the best of all
//! ```
//!
//! A plan is a local optimum. The starts choose the sides on which sets are passed; the solver finds the numbers.

pub mod attempt;
mod between;
mod defect;
mod grid;
pub mod guess;
mod keep_out;
mod passing;
mod plan;
mod receding;
mod reference;
pub mod solver;
pub mod task;
pub mod transcription;

pub use keep_out::{Keep, KeepOut};
pub use plan::{ControlReport, Controlled, HomotopyClass, StartReport, outer_sets, plan};
pub use receding::{Measured, RecedingHorizon};
