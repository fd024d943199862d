//! Writes a run as a Rerun recording (`.rrd`) and reads recordings back.
//!
//! - `canvas`: what all views share, such as times, bounds and colours
//! - `views`: one file per view, which logs its entities
//! - `layout`: how the viewer arranges the views
//! - `write`: a run or a comparison → one file
//! - `read`: one file → entities, tables, documents
//! - `checksum`: how a cut or damaged file is detected
//!
//! The only timeline is `sim_time`: seconds from the start of the scenario, as a duration.
//! Positions are metres east and north. What does not move is static, and so are colours and names.
//! Without a plan the desired motion is shown in its place and named so.
//!
//! # Entities of a run
//!
//! - `summary`: the plan in the lines of `plan`, and what is claimed, as markdown
//! - `plan_document`: the plan document, as JSON
//!
//! Chart, east and north; `chart/map` turns north up, as views of Rerun are y-down:
//!
//! - `chart/map/grid`: scale and north
//! - `chart/map/land`: outlines of the land, where there is a map
//! - `chart/map/desired`: the desired trajectory, dashed
//! - `chart/map/planned`: the plan, one line per segment. It is thin and blue below the desired
//!   speed, white at it, thick and yellow above it
//! - `chart/map/time_marks`: own ship every round number of seconds
//! - `chart/map/tracks/<target>`: the target's expected track with the same time marks
//! - `chart/map/closest_points`: own ship and each target at their closest approach
//! - `chart/map/conflict`: without a plan, where the desired trajectory first enters a set
//! - `chart/map/violations`: where the independent check found a fault
//! - `chart/map/rules`: where own ship breaks a rule, and where it stops standing on
//! - `chart/map/own_ship`, `own_ship/hull`: place and name, hull and speed vector at the cursor
//! - `chart/map/targets/<target>`: expected place, hull and speed vector at the cursor
//! - `chart/map/trails`: where the ships have been up to the cursor
//! - `chart/map/hard_sets/<target>`, `domain_sets/<target>`: sections of the sets at the cursor;
//!   the set with the ship domain only where it differs
//! - `chart/map/explored/free`, `blocked`: edges that the search tested; hidden until switched on.
//!   Blocked edges carry as labels what they meet, when, and by which rule or limit
//!
//! Space-time volume, time upward:
//!
//! - `space_time/axes`: the sea at t = 0, the time axis
//! - `space_time/land`: the land within the bounds, at t = 0
//! - `space_time/desired`, `planned`, `targets`: the motions; the plan's shadow lies on the sea
//! - `space_time/hard_sets/<target>`, `domain_sets/<target>`: the translucent bodies of the sets
//! - `space_time/rules`: as on the chart
//! - `space_time/now`: the plane of the cursor and the ships in it
//! - `space_time/explored/free`, `blocked`: as on the chart
//!
//! Plots; the scalars of a row are named in `SeriesLines:names`:
//!
//! - `curves/clearance_m`: metres between own hull and each expected hull; the safety margin
//! - `curves/margin_m`: metres from own ship's centre to the nearest set of each kind; negative
//!   inside
//! - `curves/risk`: the risk at own ship's centre against each set that was planned against, as the
//!   plan document reports it; the risk against the hard set where that differs; the accepted risk
//! - `curves/speed_kn`: desired and own speed, knots
//! - `curves/course_deg`: desired and own course, degrees clockwise from true north, continuous
//! - `curves/states`, `curves/forces`: for a plan of forces, surge, sway and yaw rate at its nodes,
//!   and the forces between them; starboard and clockwise are positive
//!
//! Others:
//!
//! - `rules/roles`: lanes with own ship's roles over time, the rules that it breaks, and its hold
//!   and escape where it stands on
//! - `velocities/plane/axes`, `own_ship`: the plane of velocities, m/s
//! - `velocities/plane/obstacles/<target>`: velocities that, kept from the cursor on, meet the hard
//!   set within 300 s or by the end
//!
//! # Entities of a comparison
//!
//! [`write_comparison`] shows the same sea and the same targets in grey. In place of own ship:
//!
//! - `summary`: the table of the comparison, as markdown
//! - `comparison_document`: its document, as JSON
//! - `chart/map/methods/<method>/way`, `space_time/methods/<method>/way`: the motion
//! - `chart/map/methods/<method>/own_ship`, `own_ship/hull`: as for a run
//! - `…/methods/<method>/sets/<target>`: the set that the method avoids, where it is not one of the
//!   scenario's
//! - `…/explored/<method>/free`, `blocked`: as for a run
//! - `curves/clearance_m/<method>`: metres to the nearest target
//! - `curves/speed_kn`: speeds, knots
//!
//! The layout is a store of its own in the same file. The stores are named after their contents.

mod canvas;
mod checksum;
mod layout;
mod read;
mod views;
mod write;

pub use read::{
    EntityContents, EntityRow, EntityTable, ReadError, Recorded, TimelineContents, is_recording,
};
pub use write::{Compared, RecordingError, write, write_comparison};

use rerun::{EntityPath, EntityPathPart};

const APPLICATION: &str = "searoom";
const TIMELINE: &str = "sim_time";
const SUMMARY: &str = "summary";
const DOCUMENT: &str = "plan_document";
const COMPARISON: &str = "comparison_document";
const CHART: &str = "chart";
const MAP: &str = "chart/map";
const TRAILS: &str = "chart/map/trails";
const EXPLORED: &str = "chart/map/explored";
const VOLUME: &str = "space_time";
const VELOCITIES: &str = "velocities";
const PLANE: &str = "velocities/plane";
const RULES: &str = "rules";

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
