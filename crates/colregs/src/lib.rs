#![doc = include_str!("../README.md")]
#![forbid(unsafe_code)]
#![warn(missing_docs)]

#[cfg(test)]
#[path = "../../model/src/ship_fixtures.rs"]
mod ship_fixtures;

mod between_hulls;
pub mod compliance;
mod domain;
mod encounter;
mod role;
mod rules;
mod thresholds;

pub use between_hulls::BetweenHulls;
pub use domain::{ShipDomain, ship_domain, sweep};
pub use encounter::least_risk_distance;
pub use encounter::{Encounter, Risk, TargetMemory, encounter, first_risk, sweep_distance};
pub use role::{Role, Sectors, SteadyShip, role_within};
pub use rules::Duty;
pub use rules::{
    APPARENT_SPEED, APPARENT_TIME, APPARENT_TURN, ClosedSide, CrossingAhead, Encountered,
    MOST_SMALL_TURNS, MayAct, ON_COURSE, Paragraph, RoleDuties, SMALL_TURN, Situation,
};
pub use thresholds::{MonitorLimits, RiskLimits, ScoreLimits, Thresholds};
