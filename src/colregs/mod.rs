//! The rules of the road: encounters and the shapes that answer them.

mod bevelled_box;
mod domain;
mod encounter;
mod role;
mod sweep;

pub use domain::{Shapes, shapes};
pub use encounter::{Encounter, Risk, encounter, first_risk, risk_distance};
pub use role::{Role, SteadyShip, raw_role};
pub use sweep::sweep;
