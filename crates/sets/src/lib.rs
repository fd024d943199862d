#![doc = include_str!("../README.md")]
#![forbid(unsafe_code)]
#![warn(missing_docs)]

#[cfg(test)]
#[path = "../../geometry/src/geometry_fixtures.rs"]
mod geometry_fixtures;

mod closest_approach;
pub mod contact;
mod ellipsoid;
mod interior;
mod land;
mod polytope;
mod polytope_queries;
mod projection;
mod risk;
mod slabs;
mod space_time_obstacle;
mod velocity_obstacle;

pub use closest_approach::ClosestApproach;
pub use ellipsoid::EllipsoidObstacle;
pub use land::window_of;
pub use land::{LAND, LandObstacle};
pub use polytope::{HalfSpace, MovingVertex, PolytopeObstacle, Slack};
pub use projection::{PathTime, Track, along_track};
pub use projection::{PathTimeObstacle, outer_faces_along};
pub use risk::{PeakRisk, level_sets};
pub use slabs::{ConvexObstacle, Obstacle, Slab, SlabError};
pub use space_time_obstacle::{SpaceTimeObstacle, Support};
pub use velocity_obstacle::{HalfPlane, VelocityObstacle};
