//! The rules of the road: encounters and the shapes that answer them.

mod bevelled_box;
pub mod conduct;
mod domain;
mod duty;
mod encounter;
mod role;
mod sweep;

pub use domain::{Shapes, shapes};
pub(crate) use duty::Duty;
pub use duty::{
    APPARENT_SPEED, APPARENT_TIME, APPARENT_TURN, Encountered, MOST_SMALL_TURNS, ON_COURSE,
    SMALL_TURN,
};
pub use encounter::{Encounter, Risk, encounter, first_risk, risk_distance};
pub use role::{Role, Sectors, SteadyShip, raw_role, role_within};
pub use sweep::sweep;
