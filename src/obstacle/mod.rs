//! Space-time obstacles: convex bodies that contain every position a target may reach, at every time.

pub mod contact;
mod meeting;
mod polytope;
mod projection;

pub use polytope::{HalfSpace, MovingVertex, PolytopeObstacle, Slack};
pub use projection::{PathTime, along_path};
