//! Tests of sets in space and time, each question against a slow definition or a known relation.

mod assessment;
mod changing_ellipses;
mod definitions;
#[path = "../campaigns/documents.rs"]
mod documents;
mod ellipsoid_velocity_obstacle;
#[path = "../campaigns/encounter_generator.rs"]
mod encounter_generator;
mod generators;
mod metamorphic;
mod obstacles;
mod outer_excess;
mod representations;
mod sums;
