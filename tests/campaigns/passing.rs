//! How a trajectory passes a ship on its nominal track.

use searoom::target::ShipTrack;
use searoom::trajectory::Trajectory;

/// Seconds between two looks.
const LOOK_S: f64 = 0.5;

/// True when own ship, seen from the target's estimate, crosses its course line ahead of it.
pub fn crosses_ahead(plan: &Trajectory, ship: &ShipTrack) -> bool {
    let seen: Vec<_> = plan
        .sample_times(LOOK_S, u32::MAX)
        .into_iter()
        .map(|t| ship.pose_at(t).body_coordinates(plan.pose_at(t).position))
        .collect();
    seen.windows(2)
        .find(|w| (w[0].y > 0.0) != (w[1].y > 0.0))
        .is_some_and(|w| w[0].x > 0.0)
}
