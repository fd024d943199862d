//! Assessment of a situation without planning: possible target positions, risk at a point, closest
//! approach of a velocity, and the least alteration that leaves every velocity obstacle.
//!
//! ```text
//! Situation (ship, obstacles, horizon) + Query (times, points, velocities) ─► AssessmentDocument
//! ```

mod alteration;
mod answer;

pub use alteration::{Alteration, least_alteration};
pub use answer::{Query, SpaceTimePoint, assess};

use crate::frame::{Pose, Vector, direction};
use crate::obstacle::Obstacle;
use crate::scenario::Scenario;
use crate::trajectory::Segment;

/// Own ship at t = 0 and the obstacles around it.
#[derive(Debug, Clone, Copy)]
pub struct OwnSituation<'a> {
    /// Position, metres, and heading, radians; the course is the heading.
    pub pose: Pose,
    /// Speed in m/s, non-negative.
    pub speed: f64,
    /// Maximum speed of an alteration, m/s; at least `speed` is used.
    pub max_speed: f64,
    /// End of the time interval `[0, horizon]` in seconds. It may be infinite except for the risk
    /// of holding course.
    pub horizon: f64,
    /// Obstacles, including own ship's footprint.
    pub obstacles: &'a [Obstacle],
}

impl<'a> OwnSituation<'a> {
    /// Own ship of a scenario, among obstacles.
    pub fn of(scenario: &Scenario, obstacles: &'a [Obstacle]) -> Self {
        let own = &scenario.own_ship;
        Self {
            pose: own.pose,
            speed: own.speed,
            max_speed: own.max_speed(),
            horizon: scenario.horizon,
            obstacles,
        }
    }

    /// Velocity at constant course and speed, m/s.
    pub fn velocity(&self) -> Vector {
        self.velocity_on(self.pose.heading, self.speed)
    }

    /// Velocity for a heading in radians and a speed in m/s.
    fn velocity_on(&self, heading: f64, speed: f64) -> Vector {
        direction(heading) * speed
    }

    /// Motion at constant course and speed over the horizon.
    pub fn held(&self) -> Segment {
        Segment::straight(self.pose, 0.0, self.horizon, self.speed)
    }
}
