//! Convex sets, polygons and predicates in the plane.

mod boxes;
mod convex;
mod convex_set;
mod disc;
mod ellipse;
#[cfg(test)]
pub(crate) mod fixtures;
mod labels;
mod nearness;
mod parry;
mod polygon;
mod simplify;

pub use boxes::Window;
pub(crate) use boxes::clipped;
pub use convex::{ConvexPolygon, GeometryError};
pub use convex_set::ConvexSet;
pub use disc::{DISC_SIDES, outer_disc};
pub(crate) use ellipse::distance_in_frame;
pub use ellipse::{Ellipse, ShapeError, SignedDistance, outer_enclosing_ellipse};
pub(crate) use labels::{Drawn, Label, Needed};
pub(crate) use nearness::stretch_near;
pub(crate) use parry::{Between, BoxIndex, EdgeTree, shortest_between};
pub use polygon::{Crossing, DecompositionError, EdgeIndex, Polygon, PolygonError, convex_pieces};
pub(crate) use simplify::outer_simplified;

/// A number rounded to six digits, for error messages.
fn rounded(value: f64) -> f64 {
    format!("{value:.5e}").parse().unwrap_or(value)
}
