//! How a manoeuvre ends.

use searoom_geometry::frame::Side;

/// Ending of a manoeuvre.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Ending {
    /// Follows the route, which it never left.
    Follow,
    /// Line and arc back onto a leg, then the route.
    Return { leg: usize, speed: f64 },
    /// Arc and line to the last waypoint.
    Goal { side: Side, speed: f64 },
}

impl Ending {
    /// Speed of the dependent segment variables, m/s; 0 without any.
    pub(crate) fn speed(self) -> f64 {
        match self {
            Self::Follow => 0.0,
            Self::Return { speed, .. } | Self::Goal { speed, .. } => speed,
        }
    }

    /// This ending at another speed.
    pub(crate) fn at_speed(self, speed: f64) -> Self {
        match self {
            Self::Follow => Self::Follow,
            Self::Return { leg, .. } => Self::Return { leg, speed },
            Self::Goal { side, .. } => Self::Goal { side, speed },
        }
    }

    /// Number of dependent segment variables.
    pub(crate) fn dependents(self) -> usize {
        if self == Self::Follow { 0 } else { 2 }
    }
}
