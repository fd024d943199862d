//! The files that a command writes: recordings and plan documents.

use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context, anyhow, bail};
use searoom::pipeline::Run;
use searoom::report::document::PlanDocument;
use searoom::report::write_atomically;

use super::files::{Found, refuse_clashes};
use super::output::json;
use super::runner::guarded;
use super::status::Status;

/// Where recordings and plans go.
#[derive(Debug)]
pub struct Products {
    recordings: Option<Place>,
    plans: Option<PathBuf>,
}

#[derive(Debug)]
enum Place {
    File(PathBuf),
    Folder(PathBuf),
}

impl Products {
    /// Makes the folders, before anything is planned. `--rrd` means a file when it ends in `.rrd` and
    /// is no folder.
    pub fn prepare(
        found: &[Found],
        recordings: Option<&Path>,
        plans: Option<&Path>,
    ) -> anyhow::Result<Self> {
        if recordings.is_some() && !cfg!(feature = "recording") {
            bail!(
                "--rrd: this program was built without recordings; \
                 build it with its default features, `cargo build`"
            );
        }
        if recordings.is_some() || plans.is_some() {
            refuse_clashes(found)?;
        }
        let recordings = match recordings {
            Some(path) if path.extension().is_some_and(|e| e == "rrd") && !path.is_dir() => {
                if found.len() > 1 {
                    bail!(
                        "--rrd {}: a file, but there are {} scenarios; name a folder",
                        path.display(),
                        found.len()
                    );
                }
                if let Some(folder) = path.parent().filter(|p| !p.as_os_str().is_empty()) {
                    make(folder)?;
                }
                Some(Place::File(path.to_owned()))
            }
            Some(path) => {
                make(path)?;
                Some(Place::Folder(path.to_owned()))
            }
            None => None,
        };
        if let Some(folder) = plans {
            make(folder)?;
        }
        Ok(Self {
            recordings,
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
        match &self.recordings {
            Some(Place::File(file)) => record(run, file)?,
            Some(Place::Folder(folder)) => record(run, &folder.join(format!("{stem}.rrd")))?,
            None => {}
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

fn make(folder: &Path) -> anyhow::Result<()> {
    fs::create_dir_all(folder)
        .with_context(|| format!("{}: the folder cannot be made", folder.display()))
}

#[cfg(feature = "recording")]
fn record(run: &Run, file: &Path) -> anyhow::Result<()> {
    // the message names its cause already
    searoom::recording::write(run, file).map_err(|error| anyhow!("{error}"))
}

#[cfg(not(feature = "recording"))]
fn record(_: &Run, file: &Path) -> anyhow::Result<()> {
    bail!("{}: built without recordings", file.display())
}
