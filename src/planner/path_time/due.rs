//! The desired trajectory on one leg: due at its start, then on at a speed.

use crate::obstacle::PathTime;
use crate::trajectory::{DesiredTrajectory, NetworkLeg};

/// See the head of the file.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Due {
    /// Seconds at which the leg is to be begun.
    pub start: f64,
    /// m/s.
    pub speed: f64,
}

impl Due {
    /// `None` on alternatives.
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

    /// Metres that own ship is behind; negative ahead.
    pub(crate) fn lag(&self, at: PathTime) -> f64 {
        (at.time - self.start) * self.speed - at.distance
    }
}
