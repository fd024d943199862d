//! The obstacle of one target, whichever of the three kinds it is.

use crate::frame::Vector;
use crate::geometry::{ConvexPolygon, Ellipse};
use crate::obstacle::{
    EllipsoidObstacle, Obstacle, PolytopeObstacle, SlabObstacle, SpaceTimeObstacle,
    VelocityObstacle,
};

/// A section `O_t`, metres.
#[derive(Debug, Clone, PartialEq)]
pub enum Section {
    /// Of polygons, exact.
    Polygon(ConvexPolygon),
    /// Of ellipses, an outer set.
    Ellipse(Ellipse),
}

impl Section {
    /// `h(n) = max over the section of n . x`, metres.
    pub fn support(&self, normal: Vector) -> f64 {
        match self {
            Self::Polygon(polygon) => polygon.support(normal),
            Self::Ellipse(ellipse) => ellipse.support(normal),
        }
    }
}

/// The obstacle of one target.
#[derive(Debug, Clone, PartialEq)]
#[expect(
    clippy::large_enum_variant,
    reason = "a scenario has a few, and they are lent"
)]
pub enum TargetObstacle {
    /// Two polygons.
    Polytope(PolytopeObstacle),
    /// Two ellipses.
    Ellipsoid(EllipsoidObstacle),
    /// Velocity sets that follow one another.
    Slabs(SlabObstacle),
}

impl TargetObstacle {
    /// What every obstacle answers.
    pub fn as_obstacle(&self) -> &dyn SpaceTimeObstacle {
        match self {
            Self::Polytope(obstacle) => obstacle,
            Self::Ellipsoid(obstacle) => obstacle,
            Self::Slabs(obstacle) => obstacle,
        }
    }

    /// The target's name.
    pub fn name(&self) -> &str {
        self.as_obstacle().name()
    }

    /// `"polytope"` or `"ellipsoid"`: what the sections are made of.
    pub fn representation(&self) -> &'static str {
        match self {
            Self::Polytope(_) | Self::Slabs(_) => "polytope",
            Self::Ellipsoid(_) => "ellipsoid",
        }
    }

    /// The section `O_t` for `time >= 0`.
    pub fn section(&self, time: f64) -> Section {
        match self {
            Self::Polytope(obstacle) => Section::Polygon(obstacle.section(time)),
            Self::Ellipsoid(obstacle) => Section::Ellipse(obstacle.outer_section(time)),
            Self::Slabs(obstacle) => Section::Polygon(obstacle.section(time)),
        }
    }

    /// The set `O_alpha` with `alpha = 1 - risk`: where the risk is at least that. Risk 0 is the set itself.
    pub fn at_risk(&self, risk: f64) -> Self {
        match self {
            Self::Polytope(obstacle) => Self::Polytope(obstacle.at_risk(risk)),
            Self::Ellipsoid(obstacle) => Self::Ellipsoid(obstacle.at_risk(risk)),
            Self::Slabs(obstacle) => Self::Slabs(obstacle.at_risk(risk)),
        }
    }

    /// The velocity obstacle as convex regions of half-planes, of which it is the union; `None` for ellipses,
    /// whose velocity obstacle is one convex region without corners.
    pub fn velocity_obstacles(
        &self,
        position: Vector,
        horizon: f64,
    ) -> Option<Vec<VelocityObstacle>> {
        match self {
            Self::Polytope(obstacle) => Some(vec![obstacle.velocity_obstacle(position, horizon)]),
            Self::Slabs(obstacle) => Some(obstacle.velocity_obstacles(position, horizon)),
            // parallel segments and points: the sixteen sides of an outer polygon fall together
            Self::Ellipsoid(obstacle) if obstacle.is_flat() => Some(vec![
                obstacle
                    .sum_outer_polytope()
                    .velocity_obstacle(position, horizon),
            ]),
            Self::Ellipsoid(_) => None,
        }
    }
}

impl From<Obstacle> for TargetObstacle {
    fn from(obstacle: Obstacle) -> Self {
        match obstacle {
            Obstacle::Polytope(polytope) => Self::Polytope(polytope),
            Obstacle::Ellipsoid(ellipsoid) => Self::Ellipsoid(*ellipsoid),
            Obstacle::Slabs(slabs) => Self::Slabs(slabs),
        }
    }
}

impl From<PolytopeObstacle> for TargetObstacle {
    fn from(obstacle: PolytopeObstacle) -> Self {
        Self::Polytope(obstacle)
    }
}

impl From<EllipsoidObstacle> for TargetObstacle {
    fn from(obstacle: EllipsoidObstacle) -> Self {
        Self::Ellipsoid(obstacle)
    }
}

impl From<SlabObstacle> for TargetObstacle {
    fn from(obstacle: SlabObstacle) -> Self {
        Self::Slabs(obstacle)
    }
}
