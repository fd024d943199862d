//! Own ship: hull, limits, shortest paths and manoeuvring models.

mod cybership2;
pub mod dubins;
mod froude;
mod kind;
mod manoeuvring;

pub use cybership2::CyberShip2;
pub use froude::FroudeScaled;
pub use kind::VesselKind;
pub use manoeuvring::{ForceVector, Manoeuvring, Scales, StateVector};

use searoom_geometry::ConvexPolygon;
use searoom_geometry::frame::{Pose, Vector};

/// A rectangular hull about its centre.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hull {
    /// Metres.
    pub length: f64,
    /// Metres.
    pub beam: f64,
}

impl Hull {
    /// A hull of this length and beam, metres.
    pub const fn new(length: f64, beam: f64) -> Self {
        Self { length, beam }
    }

    /// The rectangle at a pose.
    pub fn polygon(&self, pose: &Pose) -> ConvexPolygon {
        let (l, b) = (self.length / 2.0, self.beam / 2.0);
        let corners = [(l, -b), (l, b), (-l, b), (-l, -b)];
        ConvexPolygon::from_ccw(
            corners
                .iter()
                .map(|&(ahead, port)| pose.world_coordinates(Vector::new(ahead, port)))
                .collect(),
        )
    }

    /// Radius of the circle about the centre that contains the hull at any heading, metres.
    pub fn half_diagonal(&self) -> f64 {
        self.length.hypot(self.beam) / 2.0
    }
}

/// Own ship in the planners' model. Speeds change instantaneously.
#[derive(Debug, Clone, PartialEq)]
pub struct OwnShip {
    /// Pose at t = 0.
    pub pose: Pose,
    /// Speed at t = 0, m/s.
    pub speed: f64,
    /// The hull; without size where the sets already include it.
    pub hull: Hull,
    /// Smallest turning radius at every speed, metres, positive.
    pub turning_radius: f64,
    /// The finite set of speeds, m/s, increasing, not negative, the largest positive.
    pub speeds: Vec<f64>,
    /// Required distance between hulls, metres.
    pub safety_margin: f64,
    /// Own ship may be this far off its plan, metres: a part of the safety margin, and of the
    /// distance from land. The hulls keep the rest of it.
    pub tracking_margin: f64,
}

impl OwnShip {
    /// The largest speed, m/s.
    pub fn max_speed(&self) -> f64 {
        self.speeds.last().copied().unwrap_or(0.0)
    }

    /// The positive speeds, m/s, increasing.
    pub fn moving_speeds(&self) -> impl Iterator<Item = f64> + Clone + '_ {
        self.speeds.iter().copied().filter(|u| *u > 0.0)
    }

    /// At most `most` of the speeds, increasing: the least, the greatest and some between.
    pub fn some_speeds(&self, most: usize) -> impl Iterator<Item = f64> + '_ {
        let (last, most) = (
            self.speeds.len().saturating_sub(1),
            most.min(self.speeds.len()),
        );
        (0..most).map(move |k| self.speeds[k * last / (most - 1).max(1)])
    }

    /// The smallest speed, m/s; zero when own ship may stop.
    pub fn min_speed(&self) -> f64 {
        self.speeds.first().copied().unwrap_or(0.0)
    }
}
