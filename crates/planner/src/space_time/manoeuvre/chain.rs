//! Trajectory of consecutive lines and arcs at constant speed.

use searoom_geometry::frame::Pose;
use searoom_geometry::tolerance;
use searoom_model::trajectory::Segment;

/// Motion under construction.
#[derive(Debug, Clone)]
pub(crate) struct Chain {
    pub segments: Vec<Segment>,
    /// Pose and time at its current end.
    pub pose: Pose,
    pub time: f64,
    speed: f64,
    radius: f64,
}

impl Chain {
    /// Empty motion from a pose and time, with a positive speed and a turning radius.
    pub(crate) fn new(pose: Pose, time: f64, speed: f64, radius: f64) -> Self {
        Self {
            segments: Vec::with_capacity(6),
            pose,
            time,
            speed,
            radius,
        }
    }

    /// Appends an arc of signed length in metres, to port positive.
    pub(crate) fn arc(&mut self, length: f64) {
        self.push(length.abs(), length.signum() / self.radius);
    }

    /// Appends a line of the given length in metres.
    pub(crate) fn line(&mut self, length: f64) {
        self.push(length, 0.0);
    }

    fn push(&mut self, length: f64, curvature: f64) {
        if length <= tolerance::LENGTH_M {
            return;
        }
        let segment = Segment::new(
            self.pose,
            self.time,
            length / self.speed,
            self.speed,
            curvature * self.speed,
        );
        (self.pose, self.time) = (segment.end(), segment.end_time());
        self.segments.push(segment);
    }
}
