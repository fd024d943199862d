//! Real traffic: from feeds and files to targets, around own ship.
//!
//! ```text
//! bytes ─► Reader ─► Report ─► Picture ─► View at a time ─► Situation ─► scenario file   (import)
//!                                                     └──► Watch: risk, plan, document  (watch)
//! ```

mod feed;
mod situation;
mod source;
mod watch;

pub use feed::Feed;
pub use situation::{Own, Surroundings, surroundings};
pub use source::{Arrival, Source};
pub use watch::{Moment, Watch};

pub use searoom_traffic::*;
