//! The contact oracle: hull against hull in continuous time, by the checker's distances.

use crate::colregs::SteadyShip;
use crate::evaluation::{Body, MovingSlabs};
use crate::frame::Vector;
use crate::geometry::ConvexPolygon;
use crate::target::Uncertainty;
use crate::trajectory::{Cubic, Segment};
use crate::vessel::Hull;

/// Own ship's motion within a step, from t = 0.
#[derive(Debug, Clone)]
pub(super) enum OwnMotion {
    Segments(Vec<Segment>),
    Cubic(Cubic),
}

impl OwnMotion {
    /// Largest speed, m/s.
    fn fastest(&self) -> f64 {
        match self {
            Self::Segments(segments) => segments.iter().map(|s| s.speed).fold(0.0, f64::max),
            Self::Cubic(cubic) => cubic.bounds().speed,
        }
    }
}

/// Least distance of the hulls so far, metres, and when.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Clearance {
    pub least: f64,
    pub time: f64,
    /// The first contact; hulls that touch are in contact, and a NaN is a contact.
    pub contact: Option<f64>,
}

impl Clearance {
    pub const NONE: Self = Self {
        least: f64::INFINITY,
        time: 0.0,
        contact: None,
    };

    /// Sees a step that begins at `time` and lasts `step` seconds. Own ship begins at `start` and
    /// moves with `own`; the target begins at `target` and keeps its course and speed.
    pub fn see(
        &mut self,
        (time, step): (f64, f64),
        (hull, start, own): (&Hull, Vector, &OwnMotion),
        (target_hull, target): (&Hull, &SteadyShip),
    ) {
        let apart = (target.pose.position - start).norm();
        let closing = own.fastest() + target.speed;
        let reach = hull.half_diagonal() + target_hull.half_diagonal();
        if apart - reach - closing * step > self.least.max(0.0) {
            return;
        }
        let sets = Uncertainty::constant(
            target_hull.polygon(&target.pose),
            ConvexPolygon::point(target.velocity()),
        );
        let (slabs, body) = (MovingSlabs::new(&sets), Body::hull(hull));
        let found = match own {
            OwnMotion::Segments(segments) => slabs.least_distance(segments, body),
            OwnMotion::Cubic(cubic) => slabs.least_distance(&[*cubic], body),
        };
        // negated on purpose: a NaN is taken over and is a contact
        if !(found.value >= self.least) && !self.least.is_nan() {
            (self.least, self.time) = (found.value, time + found.time);
        }
        if !(found.value > 0.0) && self.contact.is_none() {
            self.contact = Some(time + found.time);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frame::Pose;
    use rand::{Rng, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    /// Against the distances of the polygons at many instants.
    #[test]
    fn the_least_distance_is_that_of_dense_sampling() {
        let mut rng = ChaCha8Rng::seed_from_u64(8);
        let (mut met, mut passed) = (0, 0);
        for case in 0..300 {
            let mut within = |r: f64| rng.random_range(-r..r);
            let (own_hull, hull) = (Hull::new(30.0, 8.0), Hull::new(60.0, 12.0));
            let start = Pose::new(Vector::new(within(50.0), within(50.0)), within(3.0));
            let rate = if case % 2 == 0 { within(0.05) } else { 0.0 };
            let segment = Segment::new(start, 0.0, 10.0, 5.0 + within(2.0), rate);
            let target = SteadyShip {
                pose: Pose::new(Vector::new(within(90.0), within(90.0)), within(3.0)),
                speed: 5.0 + within(4.0),
            };
            let mut clearance = Clearance::NONE;
            for k in 0..20 {
                let (time, step) = (f64::from(k) * 0.5, 0.5);
                let part = segment.between(time, time + step);
                let part = Segment {
                    start_time: 0.0,
                    ..part
                };
                let own = OwnMotion::Segments(vec![part]);
                let mut now = target;
                now.pose.position += target.velocity() * time;
                clearance.see(
                    (time, step),
                    (&own_hull, part.start.position, &own),
                    (&hull, &now),
                );
            }
            let at = |time: f64| {
                let mut pose = target.pose;
                pose.position += target.velocity() * time;
                own_hull
                    .polygon(&segment.pose_at(time))
                    .separation(&hull.polygon(&pose))
            };
            let scan = (0..=5000)
                .map(|k| at(f64::from(k) * 0.002))
                .fold(f64::INFINITY, f64::min);
            // a clear distance is the least one; an overlap is found, not measured
            if scan > 0.05 {
                passed += 1;
                assert!(
                    (clearance.least - scan).abs() < 0.05,
                    "{clearance:?} {scan}"
                );
                assert_eq!(clearance.contact, None);
            } else if scan < -0.05 {
                met += 1;
                assert!(
                    clearance.contact.is_some() && clearance.least < 0.0,
                    "{scan}"
                );
            }
        }
        assert!(met > 30 && passed > 100, "{met} {passed}");
    }

    #[test]
    fn a_place_that_is_no_number_is_a_contact() {
        let own = OwnMotion::Segments(vec![Segment::straight(
            Pose::new(Vector::new(f64::NAN, 0.0), 0.0),
            0.0,
            1.0,
            5.0,
        )]);
        let target = SteadyShip {
            pose: Pose::new(Vector::new(1e4, 0.0), 0.0),
            speed: 1.0,
        };
        let hull = Hull::new(30.0, 8.0);
        let mut clearance = Clearance::NONE;
        clearance.see(
            (3.0, 1.0),
            (&hull, Vector::new(f64::NAN, 0.0), &own),
            (&hull, &target),
        );
        assert!(clearance.contact.is_some() && clearance.least.is_nan());
    }
}
