//! What a scenario says to the optimal-control planner.

use crate::vessel::{ForceVector, StateVector, VesselKind};

/// Ship, grid and weights of the stage cost `(x - r)' Q (x - r) + tau' R tau`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ControlSettings {
    /// Whose forces.
    pub vessel: VesselKind,
    /// Of the ship, metres: the vessel is scaled to it by Froude's law.
    pub length: f64,
    /// To either side of zero, positive: newtons, newtons, newton metres.
    pub force_limits: ForceVector,
    /// Of the horizon, at least one; more are taken where these are too coarse.
    pub intervals: usize,
    /// The diagonal of `Q`, not negative: per squared metre, radian, m/s and rad/s, and per second.
    pub state_weights: StateVector,
    /// The diagonal of `R`, positive: per squared newton and newton metre, and per second.
    pub force_weights: ForceVector,
}

impl ControlSettings {
    /// Of a vessel at the size of its model, with the defaults of docs/scenario.md.
    pub fn of(vessel: VesselKind) -> Self {
        Self::at_length(vessel, vessel.length())
    }

    /// The same of a ship of this length, metres. Plans of the same scene at another size are the same by Froude's law.
    pub fn at_length(vessel: VesselKind, length: f64) -> Self {
        Self {
            vessel,
            length,
            force_limits: vessel.force_limits(length),
            intervals: 50,
            state_weights: vessel.state_weights(length),
            force_weights: vessel.force_weights(length),
        }
    }
}
