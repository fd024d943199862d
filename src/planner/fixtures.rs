//! Ship and problem of the unit tests.

use super::Problem;
use crate::frame::{Pose, Vector};
use crate::obstacle::Obstacle;
use crate::trajectory::DesiredTrajectory;
use crate::vessel::{Hull, OwnShip};

/// Ship of 30 m at the origin, heading east, with these speeds.
pub(crate) fn own_ship(speeds: &[f64]) -> OwnShip {
    OwnShip {
        pose: Pose::new(Vector::zeros(), 0.0),
        speed: 5.0,
        hull: Hull {
            length: 30.0,
            beam: 8.0,
        },
        turning_radius: 100.0,
        speeds: speeds.to_vec(),
        safety_margin: 20.0,
    }
}

/// Problem of least space-time error without land and rules.
pub(crate) fn problem<'a>(
    own: &'a OwnShip,
    desired: &'a DesiredTrajectory,
    obstacles: &'a [Obstacle],
    horizon: f64,
) -> Problem<'a> {
    Problem::new(own, desired, obstacles, horizon)
}
