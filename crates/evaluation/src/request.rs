//! Input of an evaluation.

use super::SpaceTimeSet;
use searoom_geometry::Polygon;
use searoom_geometry::frame::Vector;
use searoom_model::target::Target;
use searoom_model::trajectory::{DesiredTrajectory, Segment};
use searoom_model::vessel::OwnShip;

/// Set of motions that own ship is allowed.
#[derive(Debug, Clone, Copy)]
pub enum Freedom<'a> {
    /// Lines and arcs of at least own turning radius, at the speeds of own ship's finite set.
    Limits,
    /// Like `Limits`, but the motion may end anywhere. For plans that do not arrive.
    LimitsWithoutArrival,
    /// Motion along paths, the main one first, waypoints in metres. Any speed up to own ship's
    /// greatest is allowed, and turns on the spot where it departs along another leg.
    Paths(&'a [Vec<Vector>]),
    /// Like `Paths`, but the motion ends at the horizon and not at the last waypoint. For plans
    /// that do not arrive.
    PathsToHorizon(&'a [Vec<Vector>]),
    /// Any speed, radius and initial course, without arrival. For motions that are no plans, but
    /// are compared with plans.
    Any,
}

/// Trajectory to evaluate, and all data it is evaluated against.
#[derive(Debug, Clone)]
pub struct Request<'a> {
    /// Segments of the trajectory, without prior validation.
    pub segments: &'a [Segment],
    /// Own ship and its limits; with zero size where the sets already contain its hull.
    pub own: &'a OwnShip,
    /// Set of motions that own ship is allowed.
    pub freedom: Freedom<'a>,
    /// Desired trajectory of own ship.
    pub desired: &'a DesiredTrajectory,
    /// Targets.
    pub targets: &'a [Target],
    /// Sets against which the plan was made; several may have the name of one target.
    pub sets: &'a [SpaceTimeSet],
    /// Land polygons, which may overlap.
    pub land: &'a [Polygon],
    /// Required distance between own hull and land, metres.
    pub land_margin: f64,
    /// Latest arrival time, seconds.
    pub horizon: f64,
    /// Time after the end of the motion over which clearances at rest are reported, seconds. They
    /// do not affect the verdict.
    pub arrival_hold: f64,
    /// Time until which own ship lies at the last waypoint after arrival, seconds; `None` where the
    /// motion ends there. Costs and delay are those before its first rest there; sets, hulls
    /// and land are judged until the stay ends.
    pub stay: Option<f64>,
    /// `q` of paper eq. (30), m²/s².
    pub time_weight: f64,
    /// Accepted risk of paper eq. (25), in `[0, 1)`. The sets are already the level sets of this
    /// risk. Hulls are judged with velocities scaled by `1 - max_risk` about their centre.
    pub max_risk: f64,
}

impl<'a> Request<'a> {
    /// Free water without targets. The motion ends within the horizon, seconds, and is held to own
    /// ship's limits; the time weight is the square of own speed.
    pub fn new(
        segments: &'a [Segment],
        own: &'a OwnShip,
        desired: &'a DesiredTrajectory,
        horizon: f64,
    ) -> Self {
        Self {
            segments,
            own,
            freedom: Freedom::Limits,
            desired,
            targets: &[],
            sets: &[],
            land: &[],
            land_margin: 0.0,
            horizon,
            arrival_hold: 60.0,
            stay: None,
            time_weight: own.speed * own.speed,
            max_risk: 0.0,
        }
    }
}
