//! The section of an obstacle at one time.

use crate::frame::Vector;
use crate::geometry::{ConvexPolygon, Ellipse};

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
