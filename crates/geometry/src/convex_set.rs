//! A convex set of the plane: a polygon or an ellipse.

use super::{ConvexPolygon, Ellipse, outer_enclosing_ellipse};
use crate::frame::Vector;

/// A closed convex set: of positions in metres, or of velocities in m/s.
#[derive(Debug, Clone, PartialEq)]
pub enum ConvexSet {
    /// The convex hull of points; a point or a segment as well.
    Polygon(ConvexPolygon),
    /// An ellipse; a point or a segment as well.
    Ellipse(Ellipse),
}

impl ConvexSet {
    /// Support function `h(n) = max over the set of n . x`, for a unit vector `n`.
    pub fn support(&self, normal: Vector) -> f64 {
        match self {
            Self::Polygon(polygon) => polygon.support(normal),
            Self::Ellipse(ellipse) => ellipse.support(normal),
        }
    }

    /// A polygon that contains the set: the set itself, or `sides` tangents of the ellipse.
    pub fn outer_polygon(&self, sides: usize) -> ConvexPolygon {
        match self {
            Self::Polygon(polygon) => polygon.clone(),
            Self::Ellipse(ellipse) => ellipse.outer_polygon(sides),
        }
    }

    /// An ellipse that contains the set: the smallest one around a polygon.
    pub fn outer_ellipse(&self) -> Ellipse {
        match self {
            Self::Polygon(polygon) => outer_enclosing_ellipse(polygon),
            Self::Ellipse(ellipse) => *ellipse,
        }
    }

    /// The polygon, if it is one.
    pub fn as_polygon(&self) -> Option<&ConvexPolygon> {
        match self {
            Self::Polygon(polygon) => Some(polygon),
            Self::Ellipse(_) => None,
        }
    }

    /// The ellipse, if it is one.
    pub fn as_ellipse(&self) -> Option<&Ellipse> {
        match self {
            Self::Polygon(_) => None,
            Self::Ellipse(ellipse) => Some(ellipse),
        }
    }

    /// The centroid of the polygon, or the centre of the ellipse.
    pub fn center(&self) -> Vector {
        match self {
            Self::Polygon(polygon) => polygon.centroid(),
            Self::Ellipse(ellipse) => ellipse.center(),
        }
    }

    /// The set moved by a vector.
    pub fn translated(&self, shift: Vector) -> Self {
        match self {
            Self::Polygon(polygon) => Self::Polygon(polygon.translated(shift)),
            Self::Ellipse(ellipse) => Self::Ellipse(ellipse.translated(shift)),
        }
    }

    /// `c + factor (x - c)` for every `x` of the set, with its centre `c`.
    pub fn scaled_about_center(&self, factor: f64) -> Self {
        match self {
            Self::Polygon(polygon) => Self::Polygon(polygon.scaled_about_center(factor)),
            Self::Ellipse(ellipse) => Self::Ellipse(ellipse.scaled_about_center(factor)),
        }
    }
}

impl From<ConvexPolygon> for ConvexSet {
    fn from(polygon: ConvexPolygon) -> Self {
        Self::Polygon(polygon)
    }
}

impl From<Ellipse> for ConvexSet {
    fn from(ellipse: Ellipse) -> Self {
        Self::Ellipse(ellipse)
    }
}
