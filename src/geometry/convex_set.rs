//! A convex set of the plane: a polygon or an ellipse.

use super::{ConvexPolygon, Ellipse};
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
}
