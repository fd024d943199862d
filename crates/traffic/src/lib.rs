//! Reports of real ships: every field of a [`Report`] is a set or unknown, never a number that stands for
//! "unknown".
//!
//! ```text
//! bytes ─► lines ─► sentence: tag block, check sum ─► parts of a message ─► bits ─► Report
//! ```
//!
//! What does not become a report is counted by its reason ([`Counts`]), so that nothing vanishes silently.
//! The reader takes sentences of NMEA 0183:
//!
//! - AIS: VDM and VDO with messages 1 to 5, 9, 11, 18, 19, 21, 24 and 27 of Recommendation ITU-R M.1371-5;
//! - own ship: RMC, GGA, GNS, GLL, HDT, THS and VTG;
//! - radar targets: TTM, TLL and TLB.
//!
//! It also reads tables of AIS reports as CSV, by the names of their columns, and Signal K: deltas, and the
//! full model. The first line decides.
//!
//! What each code means, and what it does to a set, is a table in docs/reference/traffic.md.

mod ais;
mod assembly;
mod bits;
mod counts;
mod documents;
mod fields;
mod own;
#[cfg(feature = "parquet")]
mod parquet;
mod picture;
mod radar;
mod reader;
mod report;
mod sentence;
mod settings;
mod signalk;
mod table;
mod time;

pub use counts::{Counts, Dropped};
pub use picture::{
    Listed, OFF_PLANE, OwnPosition, Picture, PictureSettings, Reach, STALE, Ship, Taken, View,
    WITHOUT_PLACE,
};
pub use reader::Reader;
pub use report::{
    Directions, Fix, HullSet, Identity, Interval, Kind, Name, Note, Notes, PositionSet, Report,
    SourceId, Status, VelocitySet,
};
pub use settings::{RelativeMotion, Settings};
pub use table::MissingColumn;
