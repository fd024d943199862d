//! Distances between own hull along its motion, and hulls and sets of targets.

pub(crate) mod clearance;
pub(crate) mod least;
pub(crate) mod piece;
pub(crate) mod turn;
pub(crate) mod turned_hull;
pub(crate) mod waypoints;
