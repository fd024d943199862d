//! A scenario: read from a file, checked in full, then without invalid state.

use crate::planner::SearchKind;
use crate::target::Target;
use crate::trajectory::DesiredTrajectory;
use crate::vessel::OwnShip;

/// Which sets a plan keeps out of.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Compliance {
    /// The hard sets alone.
    None,
    /// The shaped sets, so that the cheapest plan follows the rules of the road.
    Shape,
}

/// A checked scenario, SI and east-north.
#[derive(Debug, Clone, PartialEq)]
pub struct Scenario {
    /// The scenario's title.
    pub title: String,
    /// Seconds.
    pub horizon: f64,
    /// Own ship.
    pub own_ship: OwnShip,
    /// Where she is meant to be, and when.
    pub desired: DesiredTrajectory,
    /// The others.
    pub targets: Vec<Target>,
    /// Which search.
    pub search: SearchKind,
    /// Which sets.
    pub compliance: Compliance,
    /// `q` of eq. (30), m²/s².
    pub time_weight: f64,
    /// Wall-clock budget of one plan, seconds.
    pub deadline: f64,
}
