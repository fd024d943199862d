//! What a navigator asks of the sets without planning: where a target may be, how large the risk is at a point,
//! how near a velocity comes, and the least alteration that leaves every velocity obstacle.
//!
//! ```text
//! Situation (own ship, obstacles, horizon) + Query (times, points, velocities) ─► Assessment
//! ```

mod alteration;
mod answer;
mod situation;

pub use alteration::{Alteration, least_alteration};
pub use answer::{
    Approach, Assessment, HoldCourse, PointAssessment, PointRisk, Query, SpaceTimePoint,
    TargetSections, VelocityAssessment, assess,
};
pub use situation::Situation;
