//! Distances between own hull along its motion, and hulls and sets of targets.

pub(crate) mod clearance;
pub(crate) mod turned_hull;
pub(crate) mod waypoints;
