//! Assessment of a situation without planning: possible target positions, risk at a point, closest
//! approach of a velocity, and the least alteration that leaves every velocity obstacle.
//!
//! ```text
//! Situation (ship, obstacles, horizon) + Query (times, points, velocities) ─► AssessmentDocument
//! ```

mod alteration;
mod answer;
mod situation;

pub use alteration::{Alteration, least_alteration};
pub use answer::{Query, SpaceTimePoint, assess};
pub use situation::OwnSituation;
