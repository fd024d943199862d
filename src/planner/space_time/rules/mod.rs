//! What the collision regulations ask of a manoeuvre: the right side, an alteration that is readily
//! apparent, and holding course and speed as the stand-on ship.

pub(crate) mod compliance;
pub(crate) mod readily_apparent;
pub(crate) mod stand_on;
