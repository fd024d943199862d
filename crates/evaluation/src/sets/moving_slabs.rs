//! Sequence of velocity sets in the checker: one moving set per time interval (slab).

use crate::distance::clearance::{Body, least_distance_below};
use crate::least::Least;
use crate::moving_set::{MovingDisc, MovingSet};
use crate::piece::Piece;
use crate::sets::moving_ellipse::MovingEllipse;
use searoom_geometry::ConvexPolygon;
use searoom_geometry::tolerance::{self, ELLIPSE_SIDES};
use searoom_model::target::{TimedVelocitySet, Uncertainty};

/// Bisection steps for the time at which sections become wide: to a nanosecond of the longest slab.
const NARROW_HALVINGS: usize = 60;

/// Moving set over one time interval. Its time counts from `start`.
#[derive(Debug, Clone)]
struct Slab {
    start: f64,
    end: f64,
    set: Moving,
}

#[derive(Debug, Clone)]
enum Moving {
    Polygon(MovingSet),
    Ellipse(Box<MovingEllipse>),
}

/// Slabs of a set, in order of time. Each begins with the final section of the previous one, or
/// with a larger section.
#[derive(Debug, Clone)]
pub struct MovingSlabs {
    slabs: Vec<Slab>,
}

impl MovingSlabs {
    /// Builds the slabs of a target's sets. Where some are polygons and some ellipses, polygons
    /// around the ellipses are used. O(slabs (n + m)²).
    pub fn new(sets: &Uncertainty) -> Self {
        Self::until(sets, f64::INFINITY)
    }

    /// [`Self::new`] without slabs of polygons that begin at `until` or later.
    pub fn until(sets: &Uncertainty, until: f64) -> Self {
        match Self::of_ellipses(sets) {
            Some(slabs) => slabs,
            None => Self::growing(
                |_| sets.initial.outer_polygon(ELLIPSE_SIDES),
                &sets.velocities,
                until,
            ),
        }
    }

    /// `None` unless all sets are ellipses.
    fn of_ellipses(sets: &Uncertainty) -> Option<Self> {
        let mut earlier = vec![(*sets.initial.as_ellipse()?, 1.0)];
        let mut start = 0.0;
        let mut slabs = Vec::with_capacity(sets.velocities.len());
        for set in &sets.velocities {
            let (end, velocity) = (set.until, *set.velocities.as_ellipse()?);
            slabs.push(Slab {
                start,
                end,
                set: Moving::Ellipse(Box::new(MovingEllipse::new(&earlier, &velocity))),
            });
            earlier.push((velocity, end - start));
            start = end;
        }
        Some(Self { slabs })
    }

    /// Slabs of polygons with one set at t = 0 per slab, as a function of the slab's end, which is
    /// infinite for the last one. Without slabs that begin at `until` or later.
    pub fn growing(
        initial: impl Fn(f64) -> ConvexPolygon,
        velocities: &[TimedVelocitySet],
        until: f64,
    ) -> Self {
        let mut slabs = Vec::with_capacity(velocities.len());
        let (mut start, mut way) = (0.0, None::<ConvexPolygon>);
        for (index, set) in velocities.iter().enumerate() {
            let last = index + 1 == velocities.len();
            let end = if last { f64::INFINITY } else { set.until };
            let initial = initial(end);
            let section = match &way {
                Some(way) => initial.minkowski_sum(way),
                None => initial,
            };
            let velocities = set.velocities.outer_polygon(ELLIPSE_SIDES);
            let set = Moving::Polygon(MovingSet::new(&section, &velocities));
            slabs.push(Slab { start, end, set });
            if end >= until {
                break;
            }
            let here = velocities.scaled(end - start);
            way = Some(match way {
                Some(way) => way.minkowski_sum(&here),
                None => here,
            });
            start = end;
        }
        Self { slabs }
    }

    /// Returns false when the sections are points or segments over some time interval.
    fn has_interior(&self) -> bool {
        self.slabs.iter().all(|slab| match &slab.set {
            Moving::Polygon(set) => set.has_interior(),
            Moving::Ellipse(set) => set.has_interior(),
        })
    }

    /// Depth at a time within which a motion is on the edge of the set, metres.
    pub fn edge(&self, time: f64) -> f64 {
        tolerance::DEPTH_M + self.rounding(time)
    }

    /// Largest effect of the rounding of the shape matrices of ellipses on a distance at a time,
    /// metres.
    pub fn rounding(&self, time: f64) -> f64 {
        let slab = self.slab_at(time);
        match &slab.set {
            Moving::Polygon(_) => 0.0,
            Moving::Ellipse(set) => set.rounding(time - slab.start),
        }
    }

    /// Least distance of a point while the sections are too narrow for the allowed depth: a motion
    /// across them would not be found by its depth. Infinite where they never are.
    pub fn least_distance_while_narrow<P: Piece>(&self, pieces: &[P]) -> Least {
        let end = self.narrow_until();
        let narrow: Vec<P> = (pieces.iter())
            // Negated on purpose: a NaN is included.
            .filter(|piece| !(piece.start_time() > end))
            .map(|piece| piece.part(piece.start_time(), end, 0.0))
            .collect();
        self.least_distance(&narrow, Body::POINT)
    }

    /// Time until which the sections are too narrow for the allowed depth: sections only widen.
    /// Negative where they never are.
    fn narrow_until(&self) -> f64 {
        if !self.has_interior() {
            return f64::INFINITY;
        }
        // Negated on purpose: a NaN is narrow.
        let narrow = |time: f64| !(self.half_width(time) > 2.0 * self.edge(time));
        if !narrow(0.0) {
            return -1.0;
        }
        let ends = self.slabs.iter().map(|slab| (slab.start, slab.end));
        let ends = ends.map(|(start, end)| (start, end.min(start + tolerance::FOREVER_S)));
        let Some((mut low, mut high)) = ends.into_iter().find(|(_, end)| !narrow(*end)) else {
            return f64::INFINITY;
        };
        for _ in 0..NARROW_HALVINGS {
            let middle = 0.5 * (low + high);
            if narrow(middle) {
                low = middle;
            } else {
                high = middle;
            }
        }
        high
    }

    /// Lower bound of half of the least width of the section at a time, metres; at least a quarter
    /// of it.
    pub fn half_width(&self, time: f64) -> f64 {
        let slab = self.slab_at(time);
        match &slab.set {
            Moving::Polygon(set) => {
                let section = set.section_at(time - slab.start);
                // A convex set is inside a rectangle of its least width and its diameter.
                0.5 * section.area() / section.across()
            }
            Moving::Ellipse(set) => set.semi_axes(time - slab.start)[1],
        }
    }

    fn slab_at(&self, time: f64) -> &Slab {
        let index = self.slabs.partition_point(|slab| slab.end < time);
        &self.slabs[index.min(self.slabs.len() - 1)]
    }

    /// The section at a time, as a fixed set; `None` for ellipses.
    pub(crate) fn section_at(&self, time: f64) -> Option<MovingSet> {
        let slab = self.slab_at(time);
        match &slab.set {
            Moving::Polygon(set) => Some(set.still_at(time - slab.start)),
            Moving::Ellipse(_) => None,
        }
    }

    /// Least distance over all slabs, each within its time. Beside ellipses own ship is a point.
    pub fn least_distance<P: Piece>(&self, pieces: &[P], own: Body) -> Least {
        let parts: Vec<Vec<P>> = (self.slabs.iter()).map(|slab| slab.parts(pieces)).collect();
        // The centres are in the sets, so no distance above the least of theirs matters.
        let mut nearest = f64::INFINITY;
        for (slab, parts) in self.slabs.iter().zip(&parts) {
            let disc = slab.disc();
            for part in parts {
                for time in [part.start_time(), part.end_time()] {
                    let here = part.pose_at(time).position;
                    // A NaN is ignored here and found below.
                    nearest = nearest.min((here - disc.center.at(time)).norm());
                }
            }
        }
        let nearest = nearest * (1.0 + tolerance::LIMIT) + tolerance::DEPTH_M;
        let mut least = Least::new();
        for (slab, parts) in self.slabs.iter().zip(&parts) {
            // Parts that are not nearer than in earlier slabs are not refined.
            let known = Least {
                value: least.value.min(nearest),
                ..Least::new()
            };
            let here = match &slab.set {
                Moving::Polygon(set) => least_distance_below(known, parts, own, set),
                Moving::Ellipse(set) => set.least_distance_below(known, parts),
            };
            // Negated on purpose: a NaN is seen.
            if !(here.value >= known.value) {
                least.see(here.value, here.time + slab.start);
            }
            least.certified &= here.certified;
            least.probes += here.probes;
        }
        least
    }
}

impl Slab {
    fn disc(&self) -> MovingDisc {
        match &self.set {
            Moving::Polygon(set) => set.disc,
            Moving::Ellipse(set) => set.disc(),
        }
    }

    /// Parts of a chain of pieces within the slab, with time measured from its start.
    fn parts<P: Piece>(&self, pieces: &[P]) -> Vec<P> {
        // A piece that ends at the start of a slab, up to rounding, belongs to the previous
        // slab: a growing set is still smaller there.
        let begun = self.start * (1.0 + 8.0 * f64::EPSILON);
        let fastest = match &self.set {
            Moving::Polygon(set) => set.fastest(),
            Moving::Ellipse(_) => f64::INFINITY,
        };
        let before = |s: &P| {
            let rounding = s.end_time() - self.start;
            let both = fastest + s.bounds().speed;
            s.end_time() < self.start
                || self.start > 0.0 && s.start_time() <= self.start && s.end_time() <= begun
                // Neither own ship nor the set moves by more than the margin meanwhile.
                && rounding * both <= tolerance::MARGIN_M
        };
        pieces
            .iter()
            // Negated on purpose: a NaN is included.
            .filter(|s| !(before(s) || s.start_time() > self.end))
            .map(|s| s.part(self.start, self.end, self.start))
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use searoom_geometry::frame::{Pose, Vector};
    use searoom_model::trajectory::Segment;

    /// A set 90 m abeam starts to move at up to 1e14 m/s some roundings before own ship arrives.
    #[test]
    fn a_slab_that_begins_by_a_rounding_before_the_end_is_looked_at_where_it_matters() {
        let end = 600.0_f64;
        let wait = Segment::straight(Pose::new(Vector::zeros(), 0.0), 0.0, end, 0.0);
        let least = |velocity: f64| {
            let timed = |until: f64, v: f64| {
                TimedVelocitySet::new(until, ConvexPolygon::point(Vector::new(0.0, -v)))
            };
            let begins = end * (1.0 - 3.0 * f64::EPSILON);
            let sets = Uncertainty::new(
                ConvexPolygon::point(Vector::new(0.0, 90.0)),
                vec![timed(begins, 0.0), timed(f64::INFINITY, velocity)],
            );
            MovingSlabs::new(&sets).least_distance(&[wait], Body::POINT)
        };
        assert_eq!(least(50.0).value, 90.0);
        assert!(least(1e14).value < 89.0, "{:?}", least(1e14));
    }

    /// Slabs that begin after the motion change nothing, wherever it ends: on the border of two
    /// slabs, a rounding beside it, or between.
    #[test]
    fn slabs_after_the_motion_are_left_out_and_no_others() {
        let velocity = |v: f64| ConvexPolygon::point(Vector::new(0.0, -v));
        let borders = [10.0, 20.0, 30.0];
        let mut sets: Vec<_> = (borders.iter().enumerate())
            .map(|(k, until)| TimedVelocitySet::new(*until, velocity(1.0 + k as f64)))
            .collect();
        sets.push(TimedVelocitySet::new(f64::INFINITY, velocity(9.0)));
        let sets = Uncertainty::new(ConvexPolygon::point(Vector::new(0.0, 500.0)), sets);
        for (end, count) in [
            (5.0, 1),
            (20.0_f64.next_down(), 2),
            (20.0, 2),
            (20.0_f64.next_up(), 3),
            (30.0, 3),
            (45.0, 4),
            (f64::INFINITY, 4),
        ] {
            let slabs = MovingSlabs::until(&sets, end);
            assert_eq!(slabs.slabs.len(), count, "{end}");
            let time = end.min(100.0);
            let wait = Segment::straight(Pose::new(Vector::zeros(), 0.0), 0.0, time, 0.0);
            let [cut, whole] = [slabs, MovingSlabs::new(&sets)]
                .map(|slabs| slabs.least_distance(&[wait], Body::POINT));
            assert_eq!((cut.value, cut.time), (whole.value, whole.time), "{end}");
        }
    }
}
