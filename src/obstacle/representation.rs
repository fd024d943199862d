//! An obstacle of any kind.

use super::closest_approach::ClosestApproach;
use super::risk::PeakRisk;
use super::slabs::SlabError;
use super::{
    EllipsoidObstacle, PolytopeObstacle, SlabObstacle, SpaceTimeObstacle, Support, VelocityObstacle,
};
use crate::frame::Vector;
use crate::geometry::{ConvexPolygon, ConvexSet, SignedDistance};
use crate::target::{TimedVelocitySet, Uncertainty};
use crate::trajectory::{Segment, Trajectory};

/// Sides of the polygon around an elliptic section.
const SECTION_SIDES: usize = 64;

/// An obstacle of any kind. It is an enum and not a trait object because planners match on the
/// kind, documents write each kind with its own keys, and a level set has the kind of its obstacle.
#[derive(Debug, Clone, PartialEq)]
pub enum Obstacle {
    /// Exact, paper eqs. (2)-(9).
    Polytope(PolytopeObstacle),
    /// Outer set, paper eqs. (12)-(19). Boxed because it is several times larger than the others.
    Ellipsoid(Box<EllipsoidObstacle>),
    /// Consecutive velocity sets.
    Slabs(SlabObstacle),
}

impl Obstacle {
    /// From the sets of a target: a polytope, an ellipsoid where both sets are ellipses, or slabs
    /// where the velocity set changes.
    pub fn new(name: impl Into<String>, sets: Uncertainty) -> Result<Self, SlabError> {
        use ConvexSet::{Ellipse, Polygon};
        Ok(match (&sets.initial, &sets.velocities[..]) {
            (
                Polygon(initial),
                [
                    TimedVelocitySet {
                        velocities: Polygon(velocity),
                        ..
                    },
                ],
            ) => PolytopeObstacle::new(name, initial.clone(), velocity.clone()).into(),
            (
                Ellipse(initial),
                [
                    TimedVelocitySet {
                        velocities: Ellipse(velocity),
                        ..
                    },
                ],
            ) => EllipsoidObstacle::new(name, *initial, *velocity).into(),
            _ => SlabObstacle::new(name, sets)?.into(),
        })
    }

    /// The set at t = 0 and the velocity sets.
    pub fn sets(&self) -> Uncertainty {
        match self {
            Self::Polytope(o) => Uncertainty::constant(o.initial().clone(), o.velocity().clone()),
            Self::Ellipsoid(o) => Uncertainty::constant(*o.initial(), *o.velocity()),
            Self::Slabs(o) => o.sets().clone(),
        }
    }

    fn object(&self) -> &dyn SpaceTimeObstacle {
        match self {
            Self::Polytope(o) => o,
            Self::Ellipsoid(o) => o.as_ref(),
            Self::Slabs(o) => o,
        }
    }

    /// The polytope, if it is one.
    pub fn as_polytope(&self) -> Option<&PolytopeObstacle> {
        match self {
            Self::Polytope(o) => Some(o),
            Self::Ellipsoid(_) | Self::Slabs(_) => None,
        }
    }

    /// Kind of the sections: `"polytope"` or `"ellipsoid"`.
    pub fn representation(&self) -> &'static str {
        match self {
            Self::Polytope(_) => "polytope",
            Self::Ellipsoid(_) => "ellipsoid",
            Self::Slabs(o) => match o.sets().initial {
                ConvexSet::Polygon(_) => "polytope",
                ConvexSet::Ellipse(_) => "ellipsoid",
            },
        }
    }

    /// The section `O_t`, `time >= 0`.
    pub fn section(&self, time: f64) -> ConvexSet {
        match self {
            Self::Polytope(o) => ConvexSet::Polygon(o.section(time)),
            Self::Ellipsoid(o) => ConvexSet::Ellipse(o.outer_section(time)),
            Self::Slabs(o) => o.section(time),
        }
    }

    /// Polygon that contains the section, metres: exact for polygons, the circumscribed
    /// 64-gon of an ellipse.
    pub fn outer_section(&self, time: f64) -> ConvexPolygon {
        self.section(time).outer_polygon(SECTION_SIDES)
    }

    /// The obstacle from `time` on, with a clock that starts then.
    ///
    /// Exact for polygons; an outer set for ellipses. A time below 0 or NaN counts as
    /// 0.
    pub fn remainder(&self, time: f64) -> Self {
        // negated so that a NaN counts as 0
        if !(time > 0.0) {
            return self.clone();
        }
        // the last set never ends, so one remains, and the ends increase
        Self::new(self.name(), self.remaining_sets(time)).unwrap_or_else(|_| self.clone())
    }

    /// The sets of [`Self::remainder`], for a finite time.
    pub(crate) fn remaining_sets(&self, time: f64) -> Uncertainty {
        let sets = self.sets();
        // negated so that a NaN counts as 0
        if !(time > 0.0) {
            return sets;
        }
        let later = sets.velocities.into_iter().filter(|set| set.until > time);
        let mut later: Vec<TimedVelocitySet> = later
            .map(|set| TimedVelocitySet::new(set.until - time, set.velocities))
            .collect();
        // two ends may round to one
        later.dedup_by(|next, set| !(next.until > set.until));
        Uncertainty::new(self.section(time), later)
    }

    /// The velocity obstacle as a union of convex regions.
    ///
    /// `None` for ellipsoids that are not flat: their velocity obstacle is one convex region without
    /// corners, [`EllipsoidObstacle::outer_velocities_within`].
    pub fn velocity_obstacles(
        &self,
        position: Vector,
        horizon: f64,
    ) -> Option<Vec<VelocityObstacle>> {
        match self {
            Self::Polytope(o) => Some(vec![o.velocity_obstacle(position, horizon)]),
            Self::Slabs(o) => Some(o.outer_velocity_obstacles(position, horizon)),
            // for parallel segments and points the sixteen sides of the outer polygon coincide
            Self::Ellipsoid(o) if o.is_flat() => Some(vec![
                o.sum_outer_polytope().velocity_obstacle(position, horizon),
            ]),
            Self::Ellipsoid(_) => None,
        }
    }
}

impl From<PolytopeObstacle> for Obstacle {
    fn from(obstacle: PolytopeObstacle) -> Self {
        Self::Polytope(obstacle)
    }
}

impl From<EllipsoidObstacle> for Obstacle {
    fn from(obstacle: EllipsoidObstacle) -> Self {
        Self::Ellipsoid(Box::new(obstacle))
    }
}

impl From<SlabObstacle> for Obstacle {
    fn from(obstacle: SlabObstacle) -> Self {
        Self::Slabs(obstacle)
    }
}

impl SpaceTimeObstacle for Obstacle {
    fn name(&self) -> &str {
        self.object().name()
    }

    fn support(&self, normal: Vector, time: f64) -> Support {
        self.object().support(normal, time)
    }

    fn signed_distance(&self, position: Vector, time: f64) -> SignedDistance {
        self.object().signed_distance(position, time)
    }

    fn contains(&self, position: Vector, time: f64) -> bool {
        self.object().contains(position, time)
    }

    fn first_contact(&self, segment: &Segment, depth: f64) -> Option<f64> {
        self.object().first_contact(segment, depth)
    }

    fn alpha(&self, position: Vector, time: f64) -> f64 {
        self.object().alpha(position, time)
    }

    fn peak_risk(&self, segment: &Segment) -> PeakRisk {
        self.object().peak_risk(segment)
    }

    fn peak_risk_along(&self, trajectory: &Trajectory) -> PeakRisk {
        self.object().peak_risk_along(trajectory)
    }

    fn at_risk(&self, risk: f64) -> Self {
        match self {
            Self::Polytope(o) => o.at_risk(risk).into(),
            Self::Ellipsoid(o) => o.at_risk(risk).into(),
            Self::Slabs(o) => o.at_risk(risk).into(),
        }
    }

    fn closest_approach(
        &self,
        position: Vector,
        velocity: Vector,
        horizon: f64,
    ) -> ClosestApproach {
        self.object().closest_approach(position, velocity, horizon)
    }

    fn in_velocity_obstacle(&self, position: Vector, velocity: Vector, horizon: f64) -> bool {
        self.object()
            .in_velocity_obstacle(position, velocity, horizon)
    }
}
