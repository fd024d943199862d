//! Convex sets, polygons and predicates in the plane. Knows no ship and no time.

mod boxes;
mod convex;
mod convex_set;
mod crossing;
mod decomposition;
mod disc;
mod ellipse;
mod enclosing_ellipse;
mod nearness;
mod parry;
mod polygon;
mod simplify;

pub(crate) use boxes::Window;
pub use convex::{ConvexPolygon, GeometryError};
pub use convex_set::ConvexSet;
pub use crossing::{Crossing, EdgeIndex};
pub use decomposition::{DecompositionError, convex_pieces};
pub use disc::{DISC_SIDES, outer_disc};
pub(crate) use ellipse::distance_in_frame;
pub use ellipse::{Ellipse, ShapeError, SignedDistance};
pub use enclosing_ellipse::outer_enclosing_ellipse;
pub(crate) use nearness::stretch_near;
pub(crate) use parry::{Between, BoxIndex, EdgeTree, shortest_between};
pub use polygon::{Polygon, PolygonError};
pub(crate) use simplify::outer_simplified;

/// A number to six digits, for an error to say.
fn rounded(value: f64) -> f64 {
    format!("{value:.5e}").parse().unwrap_or(value)
}
