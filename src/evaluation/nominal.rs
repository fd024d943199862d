//! Closest approach of the nominal motions: own ship and target both follow their plans unchanged.

use crate::evaluation::distance::clearance::Body;
use crate::evaluation::sets::moving_slabs::MovingSlabs;
use crate::frame::{Pose, heading_of};
use crate::geometry::ConvexPolygon;
use crate::target::{Motion, Target, Uncertainty};
use crate::trajectory::{DesiredTrajectory, Segment};
use crate::vessel::OwnShip;

/// Segments of own ship along the desired legs until the horizon, in seconds.
pub(crate) fn nominal_legs(desired: &DesiredTrajectory, horizon: f64) -> Vec<Segment> {
    let legs = desired.legs().iter();
    legs.take_while(|leg| leg.start_time <= horizon)
        .map(|leg| Segment {
            start: Pose::new(leg.start, heading_of(leg.direction)),
            start_time: leg.start_time,
            duration: leg.end_time().min(horizon) - leg.start_time,
            speed: leg.speed,
            turn_rate: 0.0,
        })
        .collect()
}

/// Least distance along `legs` between the hulls, metres; negative in overlap, certified.
///
/// For explicit sets: distance from own position to the set. Turns between legs are not evaluated.
/// `None` for ellipses.
pub(crate) fn nominal_distance(own: &OwnShip, legs: &[Segment], target: &Target) -> Option<f64> {
    let least = match &target.motion {
        Motion::Ship(ship) => {
            let hull = ship.hull.polygon(&ship.pose);
            let held = Uncertainty::constant(hull, ConvexPolygon::point(ship.velocity()));
            MovingSlabs::new(&held).least_distance(legs, Body::hull(&own.hull))
        }
        Motion::Sets(sets) if sets.initial.as_polygon().is_some() => {
            MovingSlabs::new(sets).least_distance(legs, Body::POINT)
        }
        Motion::Sets(_) => return None,
    };
    Some(least.value)
}
