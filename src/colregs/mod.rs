//! The collision regulations: encounters and roles, the duties of each role, ship domains that
//! follow from them, and the assessment of own ship's compliance.
//!
//! A new role needs a variant of [`Role`], its condition in [`role_within`], and its row in
//! [`Role::duties`]. Planner, ship domain, scores, monitors and documents read that row.

pub mod compliance;
mod domain;
mod encounter;
mod role;
mod rules;
mod thresholds;

pub use domain::{ShipDomain, ship_domain, sweep};
pub(crate) use encounter::least_risk_distance;
pub use encounter::{Encounter, Risk, TargetMemory, encounter, first_risk, sweep_distance};
pub use role::{Role, Sectors, SteadyShip, role_within};
pub(crate) use rules::Duty;
pub use rules::{
    APPARENT_SPEED, APPARENT_TIME, APPARENT_TURN, ClosedSide, CrossingAhead, Encountered,
    MOST_SMALL_TURNS, MayAct, ON_COURSE, RoleDuties, SMALL_TURN, Situation,
};
pub use thresholds::{MonitorLimits, RiskLimits, ScoreLimits, Thresholds};
