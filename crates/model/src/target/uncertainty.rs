//! Everything that is known of a target's motion: its possible positions at t = 0 and its possible
//! velocities over time.

use searoom_geometry::frame::Vector;
use searoom_geometry::tolerance::ELLIPSE_SIDES;
use searoom_geometry::{ConvexPolygon, ConvexSet};

/// A velocity set that holds until some time, one of a sequence.
#[derive(Debug, Clone, PartialEq)]
pub struct TimedVelocitySet {
    /// Seconds from the scenario's start; infinite for the last.
    pub until: f64,
    /// Every possible velocity until then, m/s.
    pub velocities: ConvexSet,
}

impl TimedVelocitySet {
    /// A velocity set that holds until `until`, seconds.
    pub fn new(until: f64, velocities: impl Into<ConvexSet>) -> Self {
        Self {
            until,
            velocities: velocities.into(),
        }
    }
}

/// A set of positions at t = 0 and the velocity sets from then on.
#[derive(Debug, Clone, PartialEq)]
pub struct Uncertainty {
    /// Possible positions at t = 0, metres.
    pub initial: ConvexSet,
    /// At least one, in order of time: the ends increase, and the last one is infinite.
    pub velocities: Vec<TimedVelocitySet>,
}

impl Uncertainty {
    /// From the positions at t = 0, metres, and the velocity sets in order of time.
    pub fn new(initial: impl Into<ConvexSet>, velocities: Vec<TimedVelocitySet>) -> Self {
        Self {
            initial: initial.into(),
            velocities,
        }
    }

    /// One velocity set for ever; metres and m/s.
    pub fn constant(initial: impl Into<ConvexSet>, velocities: impl Into<ConvexSet>) -> Self {
        let velocities = TimedVelocitySet::new(f64::INFINITY, velocities);
        Self::new(initial, vec![velocities])
    }

    /// The position at `time` of a target that starts at the centre of the initial set and always
    /// has the velocity at the centre of the velocity set.
    pub fn center_at(&self, time: f64) -> Vector {
        self.durations(time)
            .fold(self.initial.center(), |at, (duration, velocities)| {
                at + velocities.center() * duration
            })
    }

    /// A polygon that contains the possible positions at `time >= 0`, metres: the Minkowski sum of
    /// the sets, with the circumscribed 64-gons of ellipses.
    pub fn outer_section(&self, time: f64) -> ConvexPolygon {
        let initial = self.initial.outer_polygon(ELLIPSE_SIDES);
        self.durations(time)
            .fold(initial, |set, (duration, velocities)| {
                let velocities = velocities.outer_polygon(ELLIPSE_SIDES);
                set.minkowski_sum(&velocities.scaled(duration))
            })
    }

    /// The velocity sets that hold after `start`, seconds: the time at which each ends, and its
    /// circumscribed polygon, m/s.
    pub fn outer_velocities_from(&self, start: f64) -> impl Iterator<Item = (f64, ConvexPolygon)> {
        // negated so that a NaN is included
        let later = self
            .velocities
            .iter()
            .filter(move |set| !(set.until <= start));
        later.map(|set| (set.until, set.velocities.outer_polygon(ELLIPSE_SIDES)))
    }

    /// A polygon that contains every velocity after `time`, m/s: the convex hull of the sets, with
    /// the circumscribed 64-gons of ellipses.
    pub fn outer_velocities_after(&self, time: f64) -> ConvexPolygon {
        let later = self.outer_velocities_from(time).map(|(_, set)| set);
        let later: Vec<ConvexPolygon> = later.collect();
        if let [only] = &later[..] {
            return only.clone();
        }
        let points: Vec<Vector> = later
            .iter()
            .flat_map(|set| set.vertices().to_vec())
            .collect();
        ConvexPolygon::hull(&points).unwrap_or_else(|_| ConvexPolygon::point(Vector::zeros()))
    }

    /// Upper bound of the speed, m/s; exact for polygons.
    pub fn top_speed(&self) -> f64 {
        let sets = self.velocities.iter();
        let speeds = sets.map(|set| set.velocities.outer_polygon(ELLIPSE_SIDES).reach());
        speeds.fold(0.0, f64::max)
    }

    /// Each velocity set before `time` with its duration, seconds; NaN for a NaN.
    fn durations(&self, time: f64) -> impl Iterator<Item = (f64, &ConvexSet)> {
        let starts = std::iter::once(0.0).chain(self.velocities.iter().map(|set| set.until));
        starts
            .zip(&self.velocities)
            .map(move |(start, set)| {
                // ordered so that a NaN remains
                let end = if set.until <= time { set.until } else { time };
                (end - start, &set.velocities)
            })
            .filter(|(duration, _)| !(*duration <= 0.0))
    }
}
