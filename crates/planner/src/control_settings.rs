//! Settings of the optimal-control planner.

use searoom_model::vessel::{ForceVector, StateVector, VesselKind};

/// Ship, grid and weights of the stage cost `(x - r)' Q (x - r) + tau' R tau`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ControlSettings {
    /// Ship model.
    pub vessel: VesselKind,
    /// Length of the ship, metres. The model is scaled to it by Froude's law.
    pub length: f64,
    /// Largest forces to either side of zero, positive: newtons, newtons, newton metres.
    pub force_limits: ForceVector,
    /// Intervals of the horizon, at least one. The planner takes more where these are too coarse.
    pub intervals: usize,
    /// The diagonal of `Q`, not negative: per squared metre, radian, m/s and rad/s, and per second.
    pub state_weights: StateVector,
    /// The diagonal of `R`, positive: per squared newton and newton metre, and per second.
    pub force_weights: ForceVector,
}

impl ControlSettings {
    /// Settings of a vessel at model size, with the defaults of docs/reference/scenario.md.
    pub fn of(vessel: VesselKind) -> Self {
        Self::at_length(vessel, vessel.length())
    }

    /// Settings of a ship of the given length, metres. By Froude's law a scene scaled with the ship
    /// has the scaled plan.
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
