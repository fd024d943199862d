//! Closest approach of the nominal motions: own ship and target both follow their plans unchanged.

use crate::evaluation::distance::clearance::{Body, least_distance};
use crate::evaluation::distance::least::Least;
use crate::evaluation::sets::moving_slabs::MovingSlabs;
use crate::evaluation::sets::space_time_set::MovingSet;
use crate::frame::{Pose, heading_of};
use crate::geometry::ConvexPolygon;
use crate::target::{Motion, Target, VelocitySpell};
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
    let least: Least = match &target.motion {
        Motion::Ship(ship) => {
            let held = VelocitySpell {
                until: f64::INFINITY,
                velocities: ConvexPolygon::point(ship.velocity()),
            };
            let nominal = MovingSlabs::new(&ship.hull.polygon(&ship.pose), &[held]);
            nominal.least_distance(legs, Body::hull(&own.hull))
        }
        Motion::Sets { initial, velocity } => {
            least_distance(legs, Body::POINT, &MovingSet::new(initial, velocity))
        }
        Motion::Spells { initial, spells } => {
            MovingSlabs::new(initial, spells).least_distance(legs, Body::POINT)
        }
        Motion::Ellipses { .. } => return None,
    };
    Some(least.value)
}
