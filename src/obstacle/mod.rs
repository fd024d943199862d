//! Space-time obstacles: sets that contain every position a target may reach, at every time.
//!
//! [`PolytopeObstacle`] is exact for its sets, [`EllipsoidObstacle`] is an outer set of its own,
//! [`SlabObstacle`] has velocities that change with time. All three answer [`SpaceTimeObstacle`];
//! [`Obstacle`] is any of them. [`Coast`] is land: many blocks that do not move.

mod coast;
mod conservative_advancement;
pub mod contact;
mod cpa;
mod ellipse_sum;
mod ellipsoid;
mod ellipsoid_contact;
mod ellipsoid_velocities;
mod interior;
mod meeting;
mod polytope;
mod projection;
mod representation;
mod risk;
mod section;
mod slabs;
mod space_time_obstacle;
mod velocity_obstacle;

pub(crate) use coast::window_of;
pub use coast::{Coast, LAND};
pub use cpa::ClosestApproach;
pub use ellipsoid::EllipsoidObstacle;
pub use ellipsoid_velocities::EllipsoidVelocityObstacle;
pub use polytope::{HalfSpace, MovingVertex, PolytopeObstacle, Slack};
pub use projection::{
    OUTER_EXCESS_M, PathTime, Track, along_path, along_track_from, ellipsoid_along_track_from,
};
pub(crate) use projection::{PathTimeObstacle, outer_faces_along};
pub use representation::Obstacle;
pub use risk::PeakRisk;
pub use section::Section;
pub use slabs::{Slab, SlabError, SlabObstacle};
pub use space_time_obstacle::{SpaceTimeObstacle, Support};
pub use velocity_obstacle::{HalfPlane, VelocityObstacle};
