//! Ship and motions of the unit tests. Other crates include this file in theirs.
#![allow(dead_code, reason = "each crate uses some")]

use searoom_geometry::frame::{Pose, Vector};
use searoom_model::trajectory::{DesiredTrajectory, Segment};
use searoom_model::vessel::{Hull, OwnShip};

/// Ship of 30 m at the origin, heading east, with these speeds.
pub(crate) fn own_ship(speeds: &[f64]) -> OwnShip {
    OwnShip {
        pose: Pose::new(Vector::zeros(), 0.0),
        speed: 5.0,
        hull: Hull::new(30.0, 8.0),
        turning_radius: 100.0,
        speeds: speeds.to_vec(),
        safety_margin: 20.0,
        tracking_margin: 0.0,
    }
}

/// A desired trajectory through places, with the speed of each leg.
pub(crate) fn desired(through: &[(f64, f64)], speeds: &[f64]) -> DesiredTrajectory {
    let through: Vec<Vector> = through.iter().map(|&(x, y)| Vector::new(x, y)).collect();
    DesiredTrajectory::new(&through, speeds).expect("valid")
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
