//! The collision regulations: encounters and roles, the duties of each role, ship domains that
//! answer them, and the assessment of own ship's compliance.
//!
//! A new role needs its case in [`Role`] and in the conditions of [`role_within`], and its row in
//! [`Role::duties`], which planner, ship domain and scores read.

pub mod compliance;
mod domain;
mod encounter;
mod role;
mod rules;
mod thresholds;

pub use domain::{Shapes, shapes, sweep};
pub use encounter::{Encounter, Risk, TargetMemory, encounter, first_risk, risk_distance};
pub use role::{Role, Sectors, SteadyShip, raw_role, role_within};
pub(crate) use rules::Duty;
pub use rules::{
    APPARENT_SPEED, APPARENT_TIME, APPARENT_TURN, ClosedSide, CrossingAhead, Encountered,
    MOST_SMALL_TURNS, ON_COURSE, RoleDuties, SMALL_TURN,
};
pub use thresholds::{MonitorLimits, RiskLimits, ScoreLimits, Thresholds};
