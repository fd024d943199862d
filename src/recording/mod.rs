//! Writes a run as a Rerun recording (`.rrd`) and reads recordings back.
//!
//! - `canvas`: what all views share, such as times, bounds and colours
//! - `views`: one file per view, which logs its entities
//! - `layout`: how the viewer arranges the views
//! - `write`: a run, a comparison or a simulation → one file
//! - `recorder`: collects what is logged
//! - `read`: one file → entities, tables, documents
//! - `checksum`: how a cut or damaged file is detected
//!
//! What plans, comparisons and simulations log alike is described once: ships and the kinds of sets
//! in `views/ships`, plots in `views/curves`. The panels of plots follow from these descriptions.
//!
//! The only timeline is `sim_time`: seconds from the start of the scenario, as a duration.
//! Positions are metres east and north. Entities that do not move are static, and so are colours
//! and names. Without a plan the desired motion is shown in its place and named so.
//!
//! `docs/reference/inspect.md` lists the entities. The layout is a store of its own in the same
//! file. The stores are named after their contents.

mod canvas;
mod checksum;
mod layout;
mod read;
mod recorder;
mod views;
mod write;

pub use read::{Checksum, EntityRow, EntityTable, ReadError, Recorded, is_recording};
pub use write::{Compared, RecordingError, Simulated, write, write_comparison, write_simulation};

use rerun::{EntityPath, EntityPathPart, RecordingStreamResult};

type Logged<T = ()> = RecordingStreamResult<T>;

const APPLICATION: &str = "searoom";
const TIMELINE: &str = "sim_time";
const SUMMARY: &str = "summary";
const LEGS: &str = "legs";
const DOCUMENT: &str = "plan_document";
const COMPARISON: &str = "comparison_document";
const SIMULATION: &str = "simulation_document";
const CHART: &str = "chart";
const MAP: &str = "chart/map";
/// Latitudes and longitudes, where the scenario has an origin.
const EARTH: &str = "geographic";
const TRAILS: &str = "chart/map/trails";
const EXPLORED: &str = "chart/map/explored";
const VOLUME: &str = "space_time";
const VELOCITIES: &str = "velocities";
const PLANE: &str = "velocities/plane";
const ROLES: &str = "roles";
const EVENTS: &str = "events";

/// An entity path. The first part may hold slashes; the others are taken literally, as targets may
/// have any name.
fn path(parts: &[&str]) -> EntityPath {
    let (first, others) = parts.split_first().map_or(("", &[][..]), |(f, o)| (*f, o));
    let root = first.split('/').filter(|part| !part.is_empty());
    let parts: Vec<EntityPathPart> = root
        .map(EntityPathPart::new)
        .chain(others.iter().map(|part| EntityPathPart::new(*part)))
        .collect();
    EntityPath::from(parts)
}

#[cfg(test)]
mod tests;
