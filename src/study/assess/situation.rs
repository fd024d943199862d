//! Own ship among the obstacles at t = 0.

use crate::frame::{Pose, Vector, direction};
use crate::obstacle::Obstacle;
use crate::trajectory::Segment;

/// Own ship at t = 0 and the obstacles around it.
#[derive(Debug, Clone, Copy)]
pub struct Situation<'a> {
    /// Position, metres, and heading, radians; the course is the heading.
    pub pose: Pose,
    /// m/s, not negative.
    pub speed: f64,
    /// The greatest speed of an alteration, m/s; at least `speed` is used.
    pub max_speed: f64,
    /// The interval is `[0, horizon]`, seconds. It may be infinite except for the risk of holding
    /// course.
    pub horizon: f64,
    /// They include own ship's footprint.
    pub obstacles: &'a [Obstacle],
}

impl Situation<'_> {
    /// The velocity if course and speed are held, m/s.
    pub fn velocity(&self) -> Vector {
        self.velocity_on(self.pose.heading, self.speed)
    }

    /// The velocity on a heading, radians, at a speed, m/s.
    pub(super) fn velocity_on(&self, heading: f64, speed: f64) -> Vector {
        direction(heading) * speed
    }

    /// Course and speed held over the horizon.
    pub fn held(&self) -> Segment {
        Segment {
            start: self.pose,
            start_time: 0.0,
            duration: self.horizon,
            speed: self.speed,
            turn_rate: 0.0,
        }
    }
}
