//! Requirements of the collision regulations on a manoeuvre: the permitted side, a readily apparent
//! alteration, and holding course and speed as the stand-on ship.

pub(crate) mod compliance;
pub(crate) mod manoeuvre;
pub(crate) mod readily_apparent;
