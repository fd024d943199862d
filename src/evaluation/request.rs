//! What is judged.

use super::SpaceTimeSet;
use crate::frame::Vector;
use crate::geometry::Polygon;
use crate::target::Target;
use crate::trajectory::{DesiredTrajectory, Segment};
use crate::vessel::OwnShip;

/// How own ship may move.
///
/// # Examples
///
/// ```
/// use searoom::evaluation::{Freedom, Request, evaluate};
/// use searoom::scenario::Scenario;
/// use searoom::trajectory::Segment;
///
/// let scenario = Scenario::read("scenarios/colregs/give-way.toml".as_ref())?;
/// // own ship holds course and speed
/// let start = scenario.own_ship.pose;
/// let held = [Segment { start, start_time: 0.0, duration: 300.0, speed: 5.0, turn_rate: 0.0 }];
/// let request = Request {
///     segments: &held,
///     own: &scenario.own_ship,
///     freedom: Freedom::Limits,
///     desired: &scenario.desired,
///     targets: &scenario.targets,
///     sets: &[],
///     land: &[],
///     land_margin: 0.0,
///     horizon: scenario.horizon,
///     arrival_hold: scenario.arrival_hold,
///     time_weight: scenario.time_weight,
///     max_risk: 0.0,
/// };
/// let found = evaluate(&request);
/// // at 5.5 m/s, which is none of her speeds
/// let faster = [Segment { duration: 1500.0 / 5.5, speed: 5.5, ..held[0] }];
/// let alone = Request { segments: &faster, targets: &[], ..request };
/// assert!(!evaluate(&alone).verified());
/// assert!(evaluate(&Request { freedom: Freedom::Any, ..alone }).verified());
/// # Ok::<(), searoom::scenario::ScenarioError>(())
/// ```
#[derive(Debug, Clone, Copy)]
pub enum Freedom<'a> {
    /// Anywhere, on lines and arcs of at least her turning radius, at the speeds of her finite set.
    Limits,
    /// Along paths, the main one first, waypoints in metres: at any speed up to her greatest,
    /// turning on the spot where she moves off along another leg.
    Paths(&'a [Vec<Vector>]),
    /// The same, but to the horizon instead of to the last waypoint: what does not arrive.
    PathsToHorizon(&'a [Vec<Vector>]),
    /// Anywhere at any speed and radius, on any course from the start on, and nowhere in
    /// particular: what is no plan, to be compared with plans.
    Any,
}

/// What is to be judged, and by what.
///
/// # Examples
///
/// ```
/// use searoom::evaluation::{Freedom, Request, evaluate};
/// use searoom::scenario::Scenario;
/// use searoom::trajectory::Segment;
///
/// let scenario = Scenario::read("scenarios/colregs/give-way.toml".as_ref())?;
/// // own ship holds course and speed
/// let start = scenario.own_ship.pose;
/// let held = [Segment { start, start_time: 0.0, duration: 300.0, speed: 5.0, turn_rate: 0.0 }];
/// let request = Request {
///     segments: &held,
///     own: &scenario.own_ship,
///     freedom: Freedom::Limits,
///     desired: &scenario.desired,
///     targets: &scenario.targets,
///     sets: &[],
///     land: &[],
///     land_margin: 0.0,
///     horizon: scenario.horizon,
///     arrival_hold: scenario.arrival_hold,
///     time_weight: scenario.time_weight,
///     max_risk: 0.0,
/// };
/// let found = evaluate(&request);
/// assert!(!found.verified());
/// // with nobody else there is nothing wrong with it
/// assert!(evaluate(&Request { targets: &[], ..request }).verified());
/// # Ok::<(), searoom::scenario::ScenarioError>(())
/// ```
#[derive(Debug, Clone)]
pub struct Request<'a> {
    /// The trajectory's segments as they are, right or wrong.
    pub segments: &'a [Segment],
    /// Own ship and her limits; of no size where the sets already contain her.
    pub own: &'a OwnShip,
    /// How she may move.
    pub freedom: Freedom<'a>,
    /// Where she was meant to be, and when.
    pub desired: &'a DesiredTrajectory,
    /// The others.
    pub targets: &'a [Target],
    /// The sets that the plan was made against; several may bear one target's name.
    pub sets: &'a [SpaceTimeSet],
    /// Land, which may overlap itself.
    pub land: &'a [Polygon],
    /// Kept between own hull and land, metres.
    pub land_margin: f64,
    /// Seconds: arrival must not be later.
    pub horizon: f64,
    /// For how long after the end of the motion own ship is looked at where it lies, seconds:
    /// nothing is claimed of it then.
    pub arrival_hold: f64,
    /// `q` of eq. (30), m²/s².
    pub time_weight: f64,
    /// The risk of eq. (25) that was accepted, in `[0, 1)`: the sets are those of it already, the
    /// hulls are judged with velocities that are scaled about their centre by what is left of 1.
    pub max_risk: f64,
}
