#![doc = include_str!("../README.md")]
#![forbid(unsafe_code)]
#![warn(missing_docs)]

// the file of fixtures names the crate as other crates do
#[cfg(test)]
extern crate self as searoom_geometry;

mod boxes;
mod convex;
mod convex_set;
mod disc;
mod ellipse;
pub mod frame;
#[cfg(test)]
mod geometry_fixtures;
mod nearness;
pub mod numerics;
mod parry;
mod polygon;
mod simplify;
pub mod tolerance;
#[doc(hidden)]
pub mod words;

pub use boxes::Window;
pub use boxes::clipped;
pub use convex::{ConvexPolygon, GeometryError};
pub use convex_set::ConvexSet;
pub use disc::{DISC_SIDES, outer_disc};
pub use ellipse::distance_in_frame;
pub use ellipse::{Ellipse, ShapeError, SignedDistance, outer_enclosing_ellipse};
pub use nearness::stretch_near;
pub use parry::{Between, BoxIndex, EdgeTree, NearEdge, shortest_between};
pub use polygon::{Crossing, DecompositionError, EdgeIndex, Polygon, PolygonError, convex_pieces};
pub use simplify::outer_simplified;

/// A number rounded to six digits, for error messages.
fn rounded(value: f64) -> f64 {
    format!("{value:.5e}").parse().unwrap_or(value)
}
