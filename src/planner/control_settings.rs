//! What a scenario says to the optimal-control planner.

use crate::vessel::{ForceVector, StateVector, VesselKind};

/// Ship, grid and weights of the stage cost `(x - r)' Q (x - r) + tau' R tau`.
///
/// # Examples
///
/// ```
/// use searoom::planner::ControlSettings;
/// use searoom::vessel::VesselKind;
///
/// let usual = ControlSettings::of(VesselKind::CyberShip2);
/// let finer = ControlSettings { intervals: 100, ..usual.clone() };
/// assert_eq!(usual.intervals, 50);
/// assert_eq!(finer.force_limits, VesselKind::CyberShip2.force_limits());
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ControlSettings {
    /// Whose forces.
    pub vessel: VesselKind,
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
    /// Of a ship, with what the contract gives where a file says nothing.
    pub fn of(vessel: VesselKind) -> Self {
        Self {
            vessel,
            force_limits: vessel.force_limits(),
            intervals: 50,
            state_weights: vessel.state_weights(),
            force_weights: vessel.force_weights(),
        }
    }
}
