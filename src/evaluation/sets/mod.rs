//! The checker's own form of the sets that a plan must stay outside of.

pub(crate) mod moving_ellipse;
pub(crate) mod moving_slabs;
pub(crate) mod space_time_set;
