//! Representations of space-time sets in the checker, separate from those of the planners.

pub(crate) mod moving_ellipse;
pub(crate) mod moving_slabs;
pub(crate) mod space_time_set;
