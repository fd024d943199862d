//! Motions that enter hard sets, and when they have left them.

use crate::geometry::ConvexPolygon;
use crate::numerics::bisected;
use crate::obstacle::{ConvexObstacle, Obstacle, PolytopeObstacle, SpaceTimeObstacle};
use crate::planner::NominalTarget;
use crate::target::{Motion, Target, Uncertainty};
use crate::tolerance::TOUCH_M;
use crate::trajectory::{Segment, Trajectory};
use crate::vessel::Hull;

/// Shortest step in time between two samples of the depth, seconds.
const SAMPLE_S: f64 = 1.0;

/// Bisection steps within one sample step.
const HALVINGS: usize = 30;

/// Samples between two readings of the clock.
const SAMPLES_PER_CLOCK_READING: u32 = 1000;

/// A target without uncertainty: hull and set at its nominal velocity. `hard` is its hard set.
pub(super) fn nominal(target: &Target, hard: &Obstacle, own: Hull) -> NominalTarget {
    let Motion::Ship(ship) = &target.motion else {
        let (length, beam) = (0.0, 0.0);
        let set = hard.at_risk(1.0);
        return NominalTarget {
            hull: set.clone(),
            set,
            own: Hull { length, beam },
        };
    };
    let moving = |initial: ConvexPolygon| {
        let sets = Uncertainty::new(initial, ship.nominal_velocities());
        let velocity = ConvexPolygon::point(ship.velocity());
        Obstacle::new(target.name.clone(), sets.clone()).unwrap_or_else(|_| {
            PolytopeObstacle::new(target.name.clone(), hard.outer_section(0.0), velocity).into()
        })
    };
    let hull = match ship.route.is_empty() {
        true => ship.hull.polygon(&ship.pose),
        false => ship.outer_hull(0.0),
    };
    NominalTarget {
        hull: moving(hull),
        set: moving(hard.outer_section(0.0)),
        own,
    }
}

/// Time from which a motion is clear of a set, seconds; `None` where it is always clear.
///
/// The motion's end where it never is clear, or where the time runs out before that is known. Errs
/// to the late side, by some nanoseconds. Steps by the depth over the closing speed, then bisects.
pub(super) fn left_for_good(
    set: &Obstacle,
    trajectory: &Trajectory,
    is_up: impl Fn() -> bool,
) -> Option<f64> {
    let end = trajectory.end_time();
    // the set that the planners avoid: a narrow one must not be touched, not even crossed
    let set = set.outer_with_interior();
    let contact = |from: f64| {
        let later = trajectory.segments().iter().filter(|s| s.end_time() > from);
        let mut later = later.map(|s: &Segment| s.between(from, s.end_time()));
        later.find_map(|s| set.first_contact(&s, TOUCH_M))
    };
    let depth = |time: f64| {
        let at = trajectory.pose_at(time).position;
        -set.signed_distance(at, time).distance
    };
    // negated so that a NaN is inside
    let inside = |time: f64| !(depth(time) <= 0.0);
    let own = trajectory.segments().iter().map(|s| s.speed);
    let closing = own.fold(0.0, f64::max) + greatest_speed(&set);
    let (mut from, mut samples) = (trajectory.start_time(), 0_u32);
    // a ship that has arrived has no motion to test
    let mut met = if end > from {
        contact(from)?
    } else {
        inside(from).then_some(from)?
    };
    loop {
        let mut last = met.max(from);
        // at this depth the set is not left earlier
        let after = |time: f64| time + (depth(time) / closing).max(SAMPLE_S);
        let mut next = after(last);
        while next < end && inside(next) {
            (last, next) = (next, after(next));
            samples += 1;
            if samples.is_multiple_of(SAMPLES_PER_CLOCK_READING) && is_up() {
                return Some(end);
            }
        }
        if next >= end {
            return Some(end);
        }
        [_, from] = bisected([last, next], HALVINGS, inside);
        match contact(from) {
            Some(again) => met = again,
            None => return Some(from),
        }
    }
}

/// Upper bound of the speed of any point of a set, m/s; infinite where unknown.
fn greatest_speed(set: &Obstacle) -> f64 {
    let speeds = set.slabs().iter().map(|slab| match slab.obstacle() {
        ConvexObstacle::Polytope(o) => o.velocity().reach(),
        ConvexObstacle::Ellipsoid(_) => f64::INFINITY,
    });
    speeds.fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frame::{Pose, Vector};
    use crate::geometry::Ellipse;
    use crate::obstacle::EllipsoidObstacle;

    /// Leaving a large set takes half an hour: found, or nothing is claimed when the time is up.
    #[test]
    fn out_of_time_nothing_is_claimed_of_a_set() {
        let around = |size: f64| Ellipse::disc(Vector::zeros(), size);
        let set = EllipsoidObstacle::new("storm", around(9000.0), around(1e-3)).into();
        let start = Pose::new(Vector::zeros(), 0.0);
        let way = Segment::straight(start, 0.0, 4000.0, 5.0).into();
        let found = left_for_good(&set, &way, || false).expect("it starts inside");
        assert!((found - 1800.0).abs() < 2.0, "{found}");
        assert_eq!(left_for_good(&set, &way, || true), Some(4000.0));
    }
}
