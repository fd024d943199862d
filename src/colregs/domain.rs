//! Shapes of the initial set.
