//! The section of an obstacle at one time.

use crate::frame::Vector;
use crate::geometry::{ConvexPolygon, Ellipse};

/// A section `O_t`, metres.
///
/// # Examples
///
/// ```
/// use searoom::frame::Vector;
/// use searoom::geometry::ConvexPolygon;
/// use searoom::obstacle::{Obstacle, PolytopeObstacle, Section};
///
/// let square = |half: f64, center: Vector| {
///     ConvexPolygon::hull(&[(-half, -half), (half, -half), (half, half), (-half, half)].map(|(x, y)| center + Vector::new(x, y)))
/// };
/// // within 10 m of the origin, on the way east at 4 to 6 m/s and at most 1 m/s north or south
/// let target = PolytopeObstacle::new("ferry", square(10.0, Vector::zeros())?, square(1.0, Vector::new(5.0, 0.0))?);
/// let section: Section = Obstacle::from(target).section(10.0);
/// assert!((section.support(Vector::new(1.0, 0.0)) - 70.0).abs() < 1e-9);
/// assert!(matches!(section, Section::Polygon(_)));
/// # Ok::<(), searoom::geometry::GeometryError>(())
/// ```
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
