//! Run → `.rrd`: one planned and judged scenario as a Rerun recording that explains itself.
//!
//! The only timeline is `sim_time`: seconds from the scenario's start, as a duration. Positions are
//! metres, east and north. What does not move is static. Without a plan the desired motion is shown in
//! its place and named so.
//!
//! | entity | what it is |
//! | --- | --- |
//! | `summary` | verdict, manoeuvre, encounters, rules, costs, claims, as markdown |
//! | `plan_document` | the plan document as JSON, compressed, but for the time that planning took: that is in a store of its own |
//! | `chart/map` | turns north up (views of Rerun are y-down); everything below is east, north |
//! | `chart/map/grid`, `legend` | scale, north, line styles |
//! | `chart/map/land` | outlines of the land, where there is a map |
//! | `chart/map/desired` | the desired trajectory, dashed |
//! | `chart/map/planned` | the plan, one line per segment: thin and blue below the desired speed, white at it, thick and yellow above it |
//! | `chart/map/time_marks` | own ship every round number of seconds |
//! | `chart/map/tracks/<target>` | the target's expected track with the same time marks |
//! | `chart/map/closest_points` | own ship and each target at their CPA, joined; the least distance in words |
//! | `chart/map/conflict` | without a plan: where the desired trajectory first is in a set |
//! | `chart/map/violations` | where the independent check found something wrong |
//! | `chart/map/rules`, `space_time/rules` | where own ship breaks a rule of the road, and where the hold of a ship that stands on ends |
//! | `chart/map/own_ship`, `own_ship/hull` | own ship's place and name, her hull and speed vector at the cursor |
//! | `chart/map/targets/<target>` | expected place, hull and speed vector at the cursor |
//! | `chart/map/trails` | where the ships have been up to the cursor |
//! | `chart/map/hard_sets/<target>`, `shaped_sets/<target>` | sections of the sets at the cursor; the shaped one only where it differs |
//! | `chart/map/explored/free`, `blocked` | edges that the search tested; hidden until asked for |
//! | `space_time/axes` | the sea at t = 0, the time axis (upward) |
//! | `space_time/land` | the land within the sea that is shown, at t = 0 |
//! | `space_time/desired`, `planned`, `targets` | the motions as lines; the plan's shadow lies on the sea |
//! | `space_time/hard_sets/<target>`, `shaped_sets/<target>` | the bodies, translucent, from t = 0 to the end |
//! | `space_time/now` | the plane of the cursor and the ships in it |
//! | `space_time/explored/free`, `blocked` | edges that the search tested; the blocked ones hidden until asked for |
//! | `curves/clearance_m` | per target: metres between own hull and the expected hull; the safety margin |
//! | `curves/margin_m` | metres from own ship's centre to the nearest hard and shaped set, and to the nearest set that was kept out of where that is neither (an accepted risk, ellipsoids around polygons), negative inside; zero |
//! | `curves/risk` | per target: risk at own ship's centre against the whole set that was planned against, as the plan document reports it, with its largest value in it; where that is a shaped set also the risk against the hard one; the accepted risk |
//! | `velocities/plane` | turns north up; everything below is east, north, m/s |
//! | `velocities/plane/axes`, `own_ship` | the plane of velocities, m/s; own ship's velocity at the cursor |
//! | `velocities/plane/obstacles/<target>` | velocities that, kept from the cursor on, meet the hard set within 300 s or by the end: outline, clipped to the view |
//! | `path_time/plane` | of a path-time plan: the diagram it was found in, time upward; everything below is metres along the path and seconds, these drawn to fit |
//! | `path_time/plane/axes`, `profile` | the grid with its units and the joints of legs; the planned speeds |
//! | `path_time/plane/obstacles/<target>` | the set along the path |
//! | `path_time/plane/now`, `own_ship` | the cursor's instant, and own ship in it |
//! | `curves/speed_kn` | desired and own speed, knots; a row where one changes, 0 where one has ended |
//! | `curves/states`, `curves/forces` | of a plan of forces: surge, sway and yaw rate at its nodes, and the forces held between them; starboard and clockwise are positive |
//! | `rules/roles` | lanes: own ship's role toward each target over time, the rules that she breaks from the moment on at which she does, her hold and her escape where she stands on |
//! | `curves/course_deg` | desired and own course, degrees clockwise from true north, continuous |
//!
//! A comparison ([`write_comparison`]) shows the same sea, the same targets in grey, and in the place of own ship and her plan:
//!
//! | entity | what it is |
//! | --- | --- |
//! | `summary` | the table of the comparison, as markdown |
//! | `comparison_document` | its JSON document, compressed |
//! | `chart/map/methods/<method>/way`, `space_time/methods/<method>/way` | her motion, in the colour that the method has in figures |
//! | `chart/map/methods/<method>/own_ship`, `own_ship/hull` | her place, hull and speed vector at the cursor |
//! | `…/methods/<method>/sets/<target>` | the set that it keeps out of: sections at the cursor, bodies; hidden where it is one of the scenario's |
//! | `…/methods/<method>/explored/free`, `blocked` | edges that the search tested; hidden until asked for |
//! | `curves/clearance_m/<method>` | metres between own hull and the nearest expected hull, or her centre and the nearest set |
//! | `curves/speed_kn` | speeds, knots |
//!
//! Edges in `blocked` carry as labels what they meet, when, and by which rule or limit.
//!
//! Lines have the points that it takes to draw them: outlines of sets and coasts are within a 3000th part of the sea that is shown.
//! What holds from the first moment on, colours and names, is in the first row of what moves. A plot is one entity; its curves are the scalars of each row, named in `SeriesLines:names`.
//! The blueprint, a store of its own in the same file, lays this out. Two recordings of one run have the same bytes, but for the time that
//! planning took.

mod blueprint;
mod body;
mod chart;
mod columns;
mod comparison;
mod curves;
mod digest;
mod document;
mod explored;
mod forces;
mod frames;
mod ipc;
mod land;
mod layout;
mod messages;
mod movers;
mod packing;
mod path_time;
mod payload;
mod reading;
mod recorder;
mod rules;
mod scene;
mod space_time;
mod style;
mod summary;
mod table;
mod thinning;
mod velocities;

pub use comparison::{Compared, write_comparison};
pub use frames::is_recording;
pub use reading::{EntityContents, ReadError, Recorded, TimelineContents};
pub use table::{Columns, EntityRow, EntityTable};

use std::path::{Path, PathBuf};

use rayon::prelude::*;
use rerun::{EntityPath, EntityPathPart, RecordingInfo, RecordingStreamResult};

use crate::output::{folder_of, write_whole};
use crate::pipeline::Run;
use curves::Curves;
use recorder::Recorder;
use scene::Scene;

const APPLICATION: &str = "searoom";
const TIMELINE: &str = "sim_time";
const SUMMARY: &str = "summary";
const DOCUMENT: &str = "plan_document";
const COMPARISON: &str = "comparison_document";
const TIMING: &str = "plan_s";
const CHART: &str = "chart";
const MAP: &str = "chart/map";
const TRAILS: &str = "chart/map/trails";
const EXPLORED: &str = "chart/map/explored";
const VOLUME: &str = "space_time";
const VELOCITIES: &str = "velocities";
const PLANE: &str = "velocities/plane";
const RULES: &str = "rules";
const PATH_TIME: &str = "path_time";
const PATH_TIME_PLANE: &str = "path_time/plane";

/// Why there is no recording.
///
/// # Examples
///
/// ```
/// # use searoom::{pipeline, scenario::Scenario};
/// use searoom::recording::{RecordingError, write};
///
/// let scenario = Scenario::read("scenarios/colregs/head-on.toml".as_ref())?;
/// let error = write(&pipeline::run(scenario), None, "Cargo.toml/a.rrd".as_ref()).expect_err("no folder");
/// assert!(matches!(error, RecordingError::Write { .. }));
/// # Ok::<(), searoom::scenario::ScenarioError>(())
/// ```
#[derive(Debug, thiserror::Error)]
pub enum RecordingError {
    /// The run could not be turned into a recording.
    #[error("cannot encode the recording {}: {source}", path.display())]
    Encode {
        /// The file that was to be written.
        path: PathBuf,
        /// What Rerun says.
        source: Box<dyn std::error::Error + Send + Sync>,
    },
    /// The file could not be written; nothing was left of it.
    #[error("cannot write the recording {}: {source}", path.display())]
    Write {
        /// The file that was to be written.
        path: PathBuf,
        /// What the system says.
        source: std::io::Error,
    },
}

/// Writes `run` as a recording with its blueprint to `path`, in full or not at all: to a temporary name
/// in the same folder first, then renamed. Missing parent folders are made, an older file is replaced.
/// One target makes about 200 kB; more sets have longer steps of the cursor, so that 300 kB are hardly ever exceeded. `document`, the text of the plan document, is kept in it: [`Recorded::document`] gives it back.
pub fn write(run: &Run, document: Option<&str>, path: &Path) -> Result<(), RecordingError> {
    let document = document.map(|text| (DOCUMENT, text));
    put(path, &run.scenario.title, document, || {
        log_run(&Scene::new(run))
    })
}

/// What is shown, and how it is laid out.
struct Logged {
    recording: Recorder,
    layout: Recorder,
}

/// Encodes what `log` logs, and a document at its entity, and writes the file.
fn put(
    path: &Path,
    title: &str,
    document: Option<(&str, &str)>,
    log: impl FnOnce() -> RecordingStreamResult<Logged> + Send,
) -> Result<(), RecordingError> {
    let bytes = encode(title, document, log).map_err(|source| RecordingError::Encode {
        path: path.to_owned(),
        source,
    })?;
    let written = std::fs::create_dir_all(folder_of(path)).and_then(|()| write_whole(path, &bytes));
    written.map_err(|source| RecordingError::Write {
        path: path.to_owned(),
        source,
    })
}

fn encode(
    title: &str,
    document: Option<(&str, &str)>,
    log: impl FnOnce() -> RecordingStreamResult<Logged> + Send,
) -> Result<Vec<u8>, Box<dyn std::error::Error + Send + Sync>> {
    let packed = || document.map(|(_, text)| document::packed(text)).transpose();
    let (packed, logged) = rayon::join(packed, log);
    let Logged { recording, layout } = logged?;
    let mut whole = Recorder::of_section(0);
    let name = RecordingInfo::update_fields().with_name(title);
    whole.log_static(EntityPath::properties(), &name)?;
    whole.append(recording);
    let mut aside = None;
    if let (Some((entity, document)), Some(packed)) = (document, packed?) {
        // the last of all, so that a recording that was cut short is without it
        let mut last = Recorder::of_section(LAST_SECTION);
        document::log_document(&mut last, entity, packed)?;
        whole.append(last);
        aside = Some(document::timing(document)?);
    }
    packing::packed(packing::Stores {
        recording: whole,
        layout,
        aside,
    })
}

/// Behind those of a run and of a comparison.
const LAST_SECTION: usize = 1 << 16;

/// A part of the pictures of a run.
type Section = fn(&mut Recorder, &Scene, &Curves) -> RecordingStreamResult<()>;

/// What is logged side by side, the longest first.
const SECTIONS: [Section; 6] = [
    |rec, scene, _| movers::log_movers(rec, scene),
    |rec, scene, _| velocities::log_velocities(rec, scene),
    |rec, scene, _| {
        land::log_land(rec, scene)?;
        chart::log_chart(rec, scene)?;
        space_time::log_volume(rec, scene)
    },
    |rec, scene, curves| {
        curves::log_curves(rec, scene, curves)?;
        forces::log_forces(rec, scene)
    },
    |rec, scene, _| {
        let folders = [path(&[EXPLORED]), path(&[VOLUME, "explored"])];
        let budget = explored::POINT_BUDGET;
        let drawn = explored::log_explored(rec, scene, scene.run, folders, budget)?;
        summary::log_summary(rec, scene, drawn)
    },
    |rec, scene, _| {
        path_time::log_path_time(rec, scene)?;
        rules::log_rules(rec, scene)
    },
];

fn log_run(scene: &Scene) -> RecordingStreamResult<Logged> {
    let curves = Curves::of(scene);
    let logged = |(index, log): (usize, &Section)| {
        let mut rec = Recorder::of_section(index + 1);
        log(&mut rec, scene, &curves)?;
        Ok(rec)
    };
    let sections = SECTIONS.par_iter().enumerate().map(logged);
    let sections: RecordingStreamResult<Vec<Recorder>> = sections.collect();
    let mut recording = Recorder::of_section(0);
    for section in sections? {
        recording.append(section);
    }
    let layout = blueprint::of_run(scene, &curves)?;
    Ok(Logged { recording, layout })
}

/// An entity path whose first part may hold slashes (ours do) and whose others are taken literally:
/// targets may be called anything.
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
