//! Real traffic: from feeds and files to targets, around own ship.
//!
//! ```text
//! bytes ─► Reader ─► Report ─► Picture ─► View at a time ─► Situation ─► scenario file   (import)
//!                                                     └──► Watch: risk, plan, document  (watch)
//! ```

mod feed;
mod situation;

pub use feed::Feed;
pub use situation::{Own, Surroundings, surroundings};

pub use searoom_traffic::*;
