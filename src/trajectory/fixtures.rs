//! Motions of the unit tests.

use super::{DesiredTrajectory, Segment};
use crate::frame::Pose;
use crate::geometry::fixtures::places;

/// A desired trajectory through places, with the speed of each leg.
pub(crate) fn desired(through: &[(f64, f64)], speeds: &[f64]) -> DesiredTrajectory {
    DesiredTrajectory::new(&places(through), speeds).expect("valid")
}

/// Segments of `(duration, speed, turn rate)` one after another, from 0 s on.
pub(crate) fn chain(start: Pose, parts: &[(f64, f64, f64)]) -> Vec<Segment> {
    let mut segments: Vec<Segment> = Vec::new();
    for &(duration, speed, turn_rate) in parts {
        let (pose, time) = segments
            .last()
            .map_or((start, 0.0), |s| (s.end(), s.end_time()));
        segments.push(Segment::new(pose, time, duration, speed, turn_rate));
    }
    segments
}
