//! Convex sets and predicates in the plane. Knows no ship and no time.

mod convex;
mod disc;
mod ellipse;
mod enclosing_ellipse;
mod simplify;

pub use convex::{ConvexPolygon, GeometryError};
pub use disc::{DISC_SIDES, outer_disc};
pub(crate) use ellipse::distance_in_frame;
pub use ellipse::{Ellipse, ShapeError, SignedDistance};
pub use enclosing_ellipse::outer_enclosing_ellipse;
pub use simplify::outer_simplified;
