//! Ship of the unit tests.

use super::{Hull, OwnShip};
use crate::frame::{Pose, Vector};

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
