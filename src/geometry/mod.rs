//! Convex sets and predicates in the plane. Knows no ship and no time.

mod convex;
mod disc;
mod simplify;

pub use convex::{ConvexPolygon, GeometryError};
pub use disc::{DISC_SIDES, outer_disc};
pub use simplify::outer_simplified;
