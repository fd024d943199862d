//! Space-time obstacles: sets that contain every position a target may reach, at every time.
//!
//! [`PolytopeObstacle`] is exact for its sets. [`EllipsoidObstacle`] is an outer set. Both are
//! convex in space-time. An [`Obstacle`] is one of these, or a sequence where the velocity set
//! changes with time. All three implement [`SpaceTimeObstacle`]. [`LandObstacle`] is land: many
//! static convex sets.

mod closest_approach;
pub mod contact;
mod ellipsoid;
mod interior;
mod land;
mod polytope;
mod projection;
mod risk;
mod slabs;
mod space_time_obstacle;
mod velocity_obstacle;

pub use closest_approach::ClosestApproach;
pub use ellipsoid::EllipsoidObstacle;
pub(crate) use land::window_of;
pub use land::{LAND, LandObstacle};
pub use polytope::{HalfSpace, MovingVertex, PolytopeObstacle, Slack};
pub use projection::{PathTime, Track, along_track};
pub(crate) use projection::{PathTimeObstacle, outer_faces_along};
pub use risk::{PeakRisk, level_sets};
pub use slabs::{ConvexObstacle, Obstacle, Slab, SlabError};
pub use space_time_obstacle::{SpaceTimeObstacle, Support};
pub use velocity_obstacle::{HalfPlane, VelocityObstacle};
