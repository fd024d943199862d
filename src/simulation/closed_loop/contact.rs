//! The contact test: hull against hull in continuous time, by the checker's distances.

use crate::colregs::SteadyShip;
use crate::evaluation::{Body, MovingSlabs};
use crate::frame::Pose;
use crate::geometry::ConvexPolygon;
use crate::target::Uncertainty;
use crate::trajectory::GroundSegment;
use crate::vessel::Hull;

/// Outline that own ship may not touch.
#[derive(Debug, Clone)]
pub(super) enum Shape {
    Hull(Hull),
    /// An explicit set about its position, which does not turn.
    Set(ConvexPolygon),
}

impl Shape {
    fn at(&self, pose: &Pose) -> ConvexPolygon {
        match self {
            Self::Hull(hull) => hull.polygon(pose),
            Self::Set(set) => set.translated(pose.position),
        }
    }

    /// Metres from the position to the farthest point.
    fn reach(&self) -> f64 {
        match self {
            Self::Hull(hull) => hull.half_diagonal(),
            Self::Set(set) => set.reach(),
        }
    }
}

#[derive(Debug, Clone)]
struct Step {
    time: f64,
    /// From t = 0.
    own: Vec<GroundSegment>,
    target: SteadyShip,
    /// Lower bound of the distance of the hulls in the step, metres.
    bound: f64,
}

/// Contacts and least distance of the hulls of two ships.
///
/// A step is searched at once where hulls might meet in it. The least distance is searched at the
/// end, in the steps that may hold it.
#[derive(Debug, Clone)]
pub(super) struct Clearance {
    /// A point beside an explicit set, which holds own hull.
    own: Hull,
    target: Shape,
    least: Least,
    /// No hulls were farther apart than this, metres.
    nearer_than: f64,
    open: Vec<Step>,
}

/// Least distance of two hulls, metres.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Least {
    pub metres: f64,
    pub time: f64,
    /// The first contact; hulls that touch are in contact, and a NaN is a contact.
    pub contact: Option<f64>,
}

impl Clearance {
    pub fn new(own: Hull, target: Shape) -> Self {
        Self {
            own,
            target,
            least: Least {
                metres: f64::INFINITY,
                time: 0.0,
                contact: None,
            },
            nearer_than: f64::INFINITY,
            open: Vec::new(),
        }
    }

    /// Adds a step that begins at `time` and lasts `step` seconds. Own ship moves with `own`; the
    /// target begins at `target` and keeps its course and speed.
    pub fn add(&mut self, (time, step): (f64, f64), own: &[GroundSegment], target: &SteadyShip) {
        let start = own.first().map(|s| s.track.start.position);
        let apart = start.map_or(f64::NAN, |start| (target.pose.position - start).norm());
        // a NaN is the greatest
        let fastest = own.iter().map(|s| s.track.speed).max_by(f64::total_cmp);
        let closing = fastest.unwrap_or(f64::NAN) + target.speed;
        let reach = self.own.half_diagonal() + self.target.reach();
        let bound = apart - reach - closing * step;
        // centres are farther apart than hulls
        self.nearer_than = self.nearer_than.min(apart);
        let added = Step {
            time,
            own: own.to_vec(),
            target: *target,
            bound,
        };
        // negated on purpose: a NaN is searched
        if !(bound > 0.0) {
            self.least.update(&added, (&self.own, &self.target));
        } else if bound <= self.nearer_than {
            self.open.push(added);
            let nearer_than = self.nearer_than;
            if self.open.len().is_power_of_two() {
                self.open.retain(|step| step.bound <= nearer_than);
            }
        }
    }

    pub fn is_contact(&self) -> bool {
        self.least.contact.is_some()
    }

    /// The least distance so far. O(steps near it).
    pub fn settled(&self) -> Least {
        let mut least = self.least;
        let mut open: Vec<&Step> = self.open.iter().collect();
        open.sort_by(|a, b| a.bound.total_cmp(&b.bound).then(a.time.total_cmp(&b.time)));
        for step in open {
            if step.bound > least.metres {
                break;
            }
            least.update(step, (&self.own, &self.target));
        }
        least
    }
}

impl Least {
    fn update(&mut self, step: &Step, (own, target): (&Hull, &Shape)) {
        let sets = Uncertainty::constant(
            target.at(&step.target.pose),
            ConvexPolygon::point(step.target.velocity()),
        );
        let (slabs, body) = (MovingSlabs::new(&sets), Body::hull(own));
        let found = slabs.least_distance(&step.own, body);
        let time = step.time + found.time;
        // negated on purpose: a NaN is taken over and is a contact
        if !(found.value >= self.metres) && !self.metres.is_nan() {
            (self.metres, self.time) = (found.value, time);
        }
        if !(found.value > 0.0) && self.contact.is_none_or(|first| time < first) {
            self.contact = Some(time);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frame::Vector;
    use crate::trajectory::Segment;
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
            let segment = GroundSegment {
                track: Segment::new(start, 0.0, 10.0, 5.0 + within(2.0), rate),
                crab: within(1.0),
            };
            let pose = Pose::new(Vector::new(within(90.0), within(90.0)), within(3.0));
            let target = SteadyShip::new(pose, 5.0 + within(4.0));
            let mut clearance = Clearance::new(own_hull, Shape::Hull(hull));
            for k in 0..20 {
                let (time, step) = (f64::from(k) * 0.5, 0.5);
                let part = segment.part(time, time + step, time);
                let own = [part];
                let mut now = target;
                now.pose.position += target.velocity() * time;
                clearance.add((time, step), &own, &now);
            }
            let at = |time: f64| {
                let mut pose = target.pose;
                pose.position += target.velocity() * time;
                let own = own_hull.polygon(&segment.pose_at(time));
                own.separation(&hull.polygon(&pose))
            };
            let scan = (0..=5000)
                .map(|k| at(f64::from(k) * 0.002))
                .fold(f64::INFINITY, f64::min);
            let found = clearance.settled();
            // a clear distance is the least one; an overlap is found, not measured
            if scan > 0.05 {
                passed += 1;
                assert!((found.metres - scan).abs() < 0.05, "{found:?} {scan}");
                assert!(found.contact.is_none() && !clearance.is_contact());
            } else if scan < -0.05 {
                met += 1;
                assert!(clearance.is_contact() && found.metres < 0.0, "{scan}");
            }
        }
        assert!(met > 30 && passed > 100, "{met} {passed}");
    }

    #[test]
    fn a_place_that_is_no_number_is_a_contact() {
        let lost = Vector::new(f64::NAN, 0.0);
        let line = Segment::straight(Pose::new(lost, 0.0), 0.0, 1.0, 5.0);
        let own = [GroundSegment::from(line)];
        let target = SteadyShip::new(Pose::new(Vector::new(1e4, 0.0), 0.0), 1.0);
        let hull = Hull::new(30.0, 8.0);
        let mut clearance = Clearance::new(hull, Shape::Hull(hull));
        clearance.add((3.0, 1.0), &own, &target);
        assert!(clearance.is_contact() && clearance.settled().metres.is_nan());
    }
}
