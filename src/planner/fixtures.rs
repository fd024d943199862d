//! Ship and problem of the unit tests.

use std::time::Duration;

use super::{Objective, Problem, SearchKind};
use crate::frame::{Pose, Vector};
use crate::obstacle::{LandObstacle, Obstacle};
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
    Problem {
        own,
        desired,
        alternatives: &[],
        objective: Objective::SpaceTimeError,
        obstacles,
        land_obstacle: LandObstacle::none(),
        horizon,
        time_weight: 25.0,
        search: SearchKind::AStar,
        deadline: Duration::from_secs(5),
        first_turn: None,
        encountered: &[],
    }
}
