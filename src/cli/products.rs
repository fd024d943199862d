//! The files that a command writes: recordings, figures and plan documents.

use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context, anyhow, bail};
use searoom::pipeline::Run;
use searoom::report::document::PlanDocument;
use searoom::report::figure::{FigureError, FigureFormat, plan_figure};
use searoom::report::write_atomically;

use super::files::{Found, refuse_clashes};
use super::output::json;
use super::runner::guarded;
use super::status::Status;

/// Where recordings, figures and plans go.
#[derive(Debug)]
pub struct Products {
    recordings: Option<Place>,
    figures: Option<Place>,
    plans: Option<PathBuf>,
}

/// What is asked for.
#[derive(Debug, Clone, Copy, Default)]
pub struct Wanted<'a> {
    pub recordings: Option<&'a Path>,
    pub figures: Option<&'a Path>,
    pub plans: Option<&'a Path>,
}

#[derive(Debug)]
enum Place {
    File(PathBuf),
    Folder(PathBuf),
}

impl Products {
    /// Makes the folders, before anything is planned. A path means a file when it ends as such files do and is no folder;
    /// one with another ending is no new folder, unless it says so with a slash.
    pub fn prepare(found: &[Found], wanted: Wanted) -> anyhow::Result<Self> {
        let Wanted {
            recordings,
            figures,
            plans,
        } = wanted;
        if recordings.is_some() && !cfg!(feature = "recording") {
            bail!(
                "--rrd: this program was built without recordings; \
                 build it with its default features, `cargo build`"
            );
        }
        if recordings.is_some() || figures.is_some() || plans.is_some() {
            refuse_clashes(found)?;
        }
        let is_recording = |path: &Path| path.extension().is_some_and(|e| e == "rrd");
        let is_figure = |path: &Path| FigureFormat::of(path).is_some();
        if let Some(path) = recordings.filter(|path| !is_recording(path) && is_another_file(path)) {
            let path = path.display();
            bail!("--rrd: {path}: a recording ends in .rrd, a folder that is to be made in '/'");
        }
        if let Some(path) = plans.filter(|path| is_another_file(path)) {
            let path = path.display();
            bail!("--plans: {path}: a folder; one with an ending that is to be made ends in '/'");
        }
        let recordings = recordings
            .map(|path| Place::prepare("--rrd", path, is_recording(path), found.len()))
            .transpose()?;
        if let Some(path) = figures.filter(|path| !is_figure(path) && is_another_file(path)) {
            let file = path.to_owned();
            bail!("--figure: {}", FigureError::Format { file });
        }
        let figures = figures
            .map(|path| Place::prepare("--figure", path, is_figure(path), found.len()))
            .transpose()?;
        if let Some(folder) = plans {
            make(folder)?;
        }
        Ok(Self {
            recordings,
            figures,
            plans: plans.map(Path::to_owned),
        })
    }

    /// Writes what was asked for; on failure the status and the reason.
    pub fn write(&self, stem: &str, run: &Run) -> Result<(), (Status, String)> {
        match guarded(|| self.try_write(stem, run)) {
            Ok(Ok(())) => Ok(()),
            Ok(Err(error)) => Err((Status::BadInput, format!("{error:#}"))),
            Err(fault) => Err((Status::InternalFault, fault)),
        }
    }

    fn try_write(&self, stem: &str, run: &Run) -> anyhow::Result<()> {
        if let Some(place) = &self.recordings {
            record(run, &place.file(stem, "rrd"))?;
        }
        if let Some(place) = &self.figures {
            let file = place.file(stem, "svg");
            // the message names its cause already
            plan_figure(run)
                .write(&file)
                .map_err(|error| anyhow!("{error}"))?;
        }
        if let Some(folder) = &self.plans {
            let file = folder.join(format!("{stem}.json"));
            let document = json(&PlanDocument::of(run))?;
            // the message names its cause already
            write_atomically(&file, document.as_bytes()).map_err(|error| anyhow!("{error}"))?;
        }
        Ok(())
    }
}

impl Place {
    /// `file` says that the path's name is one of such a file.
    fn prepare(option: &str, path: &Path, file: bool, scenarios: usize) -> anyhow::Result<Self> {
        if !file || path.is_dir() {
            make(path)?;
            return Ok(Self::Folder(path.to_owned()));
        }
        if scenarios > 1 {
            bail!(
                "{option} {}: a file, but there are {scenarios} scenarios; name a folder",
                path.display(),
            );
        }
        if let Some(folder) = path.parent().filter(|p| !p.as_os_str().is_empty()) {
            make(folder)?;
        }
        Ok(Self::File(path.to_owned()))
    }

    fn file(&self, stem: &str, ending: &str) -> PathBuf {
        match self {
            Self::File(file) => file.clone(),
            Self::Folder(folder) => folder.join(format!("{stem}.{ending}")),
        }
    }
}

/// A name with an ending that is no folder, nor asks for one with a slash.
fn is_another_file(path: &Path) -> bool {
    let asks = path.to_string_lossy().ends_with(std::path::is_separator);
    path.extension().is_some() && !path.is_dir() && !asks
}

fn make(folder: &Path) -> anyhow::Result<()> {
    fs::create_dir_all(folder)
        .with_context(|| format!("{}: the folder cannot be made", folder.display()))
}

#[cfg(feature = "recording")]
fn record(run: &Run, file: &Path) -> anyhow::Result<()> {
    // the message names its cause already
    let document = json(&PlanDocument::of(run))?;
    searoom::recording::write(run, Some(&document), file).map_err(|error| anyhow!("{error}"))
}

#[cfg(not(feature = "recording"))]
fn record(_: &Run, file: &Path) -> anyhow::Result<()> {
    bail!("{}: built without recordings", file.display())
}
