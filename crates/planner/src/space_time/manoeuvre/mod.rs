//! Parts of manoeuvres, shared by all searches: parts of motions, speeds, ways to end, the conflicts
//! that a manoeuvre resolves, and turns and lines in closed form.

pub(crate) mod chain;
pub(crate) mod conflict;
pub(crate) mod ending;
pub(crate) mod interceptor;
pub(crate) mod motion;
pub(crate) mod return_to_line;
pub(crate) mod speeds;
