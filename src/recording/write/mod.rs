//! Writes a run, a comparison or a simulation as one Rerun recording (`.rrd`).

mod comparison;
mod encoding;
mod simulation;

pub use comparison::{Compared, write_comparison};
pub use simulation::{Simulated, write_simulation};

use std::path::{Path, PathBuf};

use rerun::components::MediaType;
use rerun::{EntityPath, RecordingInfo, TextDocument};

use super::canvas::ViewModel;
use super::views::rules::Judged;
use super::views::ships::Ships;
use super::views::{
    chart, curves, explored, geographic, land, rules, ships, space_time, summary, velocities,
};
use super::{DOCUMENT, EXPLORED, LEGS, SUMMARY, VOLUME, layout, path};
use crate::document::{self, PlanDocument, breaks};
use crate::output::{folder_of, write_whole};
use crate::pipeline::Run;
use crate::recording::Logged;
use crate::recording::recorder::Recorder;

/// Why there is no recording.
#[derive(Debug, thiserror::Error)]
pub enum RecordingError {
    /// The run could not be turned into a recording.
    #[error("cannot encode the recording {}: {source}", path.display())]
    Encode {
        /// The file that was to be written.
        path: PathBuf,
        /// Error of Rerun.
        source: Failure,
    },
    /// The file could not be written; nothing was left of it.
    #[error("cannot write the recording {}: {source}", path.display())]
    Write {
        /// The file that was to be written.
        path: PathBuf,
        /// Error of the system.
        source: std::io::Error,
    },
}

pub(super) type Failure = Box<dyn std::error::Error + Send + Sync>;

/// Writes `run` as a recording with its layout to `path`, in full or not at all.
///
/// The bytes go to a temporary name in the same folder first, which is then renamed. Missing parent
/// folders are made, an older file is replaced. The recording keeps the plan document of the run:
/// [`super::Recorded::document`] gives it back as JSON.
///
/// # Examples
///
/// ```
/// use searoom::document::PlanDocument;
/// use searoom::recording::{Recorded, write};
/// use searoom::{pipeline, scenario::Scenario};
///
/// let scenario = Scenario::read("scenarios/colregs/head-on.toml".as_ref())?;
/// # let folder = tempfile::tempdir()?;
/// let file = folder.path().join("head-on.rrd");
/// let run = pipeline::run(scenario);
/// write(&run, &PlanDocument::of(&run), &file)?;
/// let recorded = Recorded::read(&file)?;
/// assert!(recorded.document().is_some());
/// assert!(recorded.table("curves/speed_kn").is_some());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn write(run: &Run, plan: &PlanDocument, path: &Path) -> Result<(), RecordingError> {
    let text = document::json(plan).map_err(|source| encoding_error(path, source))?;
    put(path, &run.scenario.title, (DOCUMENT, &text), |rec| {
        log_run(rec, &ViewModel::new(run), plan)
    })
}

fn encoding_error(path: &Path, source: impl Into<Failure>) -> RecordingError {
    RecordingError::Encode {
        path: path.to_owned(),
        source: source.into(),
    }
}

/// Encodes what `log` logs, behind the title and a document at its entity, with the layout that it
/// returns, and writes the file.
fn put(
    path: &Path,
    title: &str,
    document: (&str, &str),
    log: impl FnOnce(&mut Recorder) -> Logged<Recorder>,
) -> Result<(), RecordingError> {
    let bytes = bytes(title, document, log).map_err(|source| encoding_error(path, source))?;
    let written = std::fs::create_dir_all(folder_of(path)).and_then(|()| write_whole(path, &bytes));
    written.map_err(|source| RecordingError::Write {
        path: path.to_owned(),
        source,
    })
}

fn bytes(
    title: &str,
    (entity, document): (&str, &str),
    log: impl FnOnce(&mut Recorder) -> Logged<Recorder>,
) -> Result<Vec<u8>, Failure> {
    let mut recording = Recorder::default();
    let name = RecordingInfo::update_fields().with_name(title);
    recording.log_static(EntityPath::properties(), &name)?;
    let document = TextDocument::new(document).with_media_type(MediaType::from(JSON));
    recording.log_static(entity, &document)?;
    let layout = log(&mut recording)?;
    encoding::encode(recording, layout)
}

const JSON: &str = "application/json";

fn log_run(rec: &mut Recorder, model: &ViewModel, plan: &PlanDocument) -> Logged<Recorder> {
    let judged = Judged::of_plan(model, plan);
    let escape = plan.escape.as_ref();
    let lanes = rules::lanes(&judged, escape, model.motion.end().min(model.end));
    let own = ships::own_ship(model);
    let ships = &Ships::expected(model, std::slice::from_ref(&own));
    ships::log_ships(rec, model, ships)?;
    velocities::log_velocities(rec, model)?;
    land::log_land(rec, model)?;
    let broken = breaks(&plan.encounters);
    let labels = chart::log_chart(rec, model, ships, broken.as_deref())?;
    let name = |_| own.name.clone();
    ships::log_names_with_roles(rec, model, &labels, ships, name, &judged)?;
    geographic::log_geographic(rec, model)?;
    space_time::log_volume(rec, model, ships)?;
    let plots = curves::plots(model);
    curves::log_plots(rec, &plots)?;
    let folders = [path(&[EXPLORED]), path(&[VOLUME, "explored"])];
    let drawn = explored::log_explored(rec, model, model.run, &folders)?;
    rec.log_markdown(SUMMARY, summary::text(model, plan, drawn))?;
    let legs = summary::legs(plan);
    let has_legs = legs.is_some();
    if let Some(legs) = legs {
        rec.log_markdown(LEGS, legs)?;
    }
    rules::log_lanes(rec, &lanes)?;
    let marks = rules::marks(&judged, escape, |t| model.motion.pose_at(t).position);
    rules::log_marks(rec, &marks)?;
    rules::log_marks_in_volume(rec, model, &marks)?;
    layout::of_run(model, lanes.len(), has_legs, &plots)
}
