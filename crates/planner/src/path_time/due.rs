//! Desired trajectory on one leg: a start time and a constant speed.

use searoom_model::trajectory::{DesiredTrajectory, NetworkLeg};
use searoom_sets::PathTime;

/// Desired trajectory on one leg.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Due {
    /// Time in seconds at which own ship should enter the leg.
    pub start: f64,
    /// Desired speed in m/s.
    pub speed: f64,
}

impl Due {
    /// Returns the schedule of a leg; `None` for a leg of an alternative path.
    pub(crate) fn on(desired: &DesiredTrajectory, leg: &NetworkLeg) -> Option<Self> {
        if leg.path > 0 {
            return None;
        }
        let middle = leg.start_distance + 0.5 * leg.length;
        let index = desired
            .legs()
            .partition_point(|d| d.start_distance <= middle)
            .max(1)
            - 1;
        let whole = &desired.legs()[index];
        Some(Self {
            start: whole.start_time + (leg.start_distance - whole.start_distance) / whole.speed,
            speed: whole.speed,
        })
    }

    /// Lag behind the schedule in metres; negative when ahead.
    pub(crate) fn lag(&self, at: PathTime) -> f64 {
        (at.time - self.start) * self.speed - at.distance
    }
}
