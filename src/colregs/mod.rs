//! The rules of the road: encounters and the shapes that answer them.

mod domain;
mod encounter;

pub use domain::{Shapes, shapes};
pub use encounter::{
    Encounter, Risk, Role, SteadyShip, encounter, first_risk, raw_role, risk_distance,
};
