//! Campaigns: one shard at a time, and what its rows say.

use std::num::NonZero;
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use pyo3::exceptions::PyRuntimeWarning;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use searoom::campaign::{
    CampaignError, Done, Folder, Progress, Row, RowScenario, Shard, Specification as Checked,
    differing,
};
use searoom::simulation::Simulation;

use crate::error::{DocumentError, InternalError, argument, detached, faults};
use crate::value::objects;

/// Time between two looks for Ctrl-C.
const LOOK: Duration = Duration::from_millis(20);

/// A checked specification of a campaign. It never changes.
#[pyclass(frozen, from_py_object, module = "searoom.campaign")]
#[derive(Clone)]
pub struct Specification {
    inner: Checked,
    /// Where its scenario files are.
    folder: PathBuf,
}

fn refused(error: CampaignError) -> PyErr {
    match &error {
        CampaignError::Input(input) => crate::error::scenario(input),
        CampaignError::Write(write) => DocumentError::new_err(write.to_string()),
    }
}

#[pymethods]
impl Specification {
    /// Reads a specification file (docs/guide/campaigns.md). The error has every fault.
    #[staticmethod]
    fn read(py: Python, file: PathBuf) -> PyResult<Self> {
        let read = detached(py, || Checked::read(&file))?;
        let inner = read.map_err(|error| refused(error.into()))?;
        Ok(Self::beside(inner, file.parent()))
    }

    /// Reads the text of a specification. Its scenario files are searched from `folder`, by default
    /// from where the program runs.
    #[staticmethod]
    #[pyo3(signature = (text, folder = None))]
    fn parse(py: Python, text: &str, folder: Option<PathBuf>) -> PyResult<Self> {
        let folder = folder.unwrap_or_default();
        let read = detached(py, || Checked::parse(text, &folder))?;
        let inner = read.map_err(|found| faults(None, &found))?;
        Ok(Self::beside(inner, Some(&folder)))
    }

    #[getter]
    fn name(&self) -> &str {
        &self.inner.name
    }

    #[getter]
    fn seed(&self) -> u64 {
        self.inner.seed
    }

    #[getter]
    fn rows(&self) -> u64 {
        self.inner.rows
    }

    /// SHA-256 of its text and of all that it names, in hexadecimal digits.
    #[getter]
    fn hash(&self) -> &str {
        &self.inner.hash
    }

    #[getter]
    fn text(&self) -> &str {
        &self.inner.text
    }

    /// Where its scenario files are.
    #[getter]
    fn _folder(&self) -> &Path {
        &self.folder
    }

    /// The names of the strata.
    #[getter]
    fn strata(&self) -> Vec<&str> {
        let strata = self.inner.strata.iter();
        strata.map(|stratum| stratum.name.as_str()).collect()
    }

    /// For `pickle`: text and folder. The scenario files have to be there where it is read again.
    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<(Bound<'py, PyAny>, (&str, &PathBuf))> {
        let parse = py.get_type::<Self>().getattr("parse")?;
        Ok((parse, (&self.inner.text, &self.folder)))
    }

    /// The simulation of a row, from 0 on. `commanded` is that of `Simulation`.
    #[pyo3(signature = (row, *, commanded = false))]
    fn simulation(
        &self,
        py: Python,
        row: u64,
        commanded: bool,
    ) -> PyResult<crate::simulation::Simulation> {
        let drawn = drawn(&self.inner, row)?;
        crate::simulation::Simulation::begun(py, drawn.scenario, false, commanded)
    }

    /// Makes the folder of a campaign, or checks that it is of this specification.
    fn _prepare(&self, out: PathBuf) -> PyResult<()> {
        let file = self.folder.join("specification");
        let made = Folder::of(&self.inner, &file, &out);
        made.map(|_| ()).map_err(refused)
    }

    /// Sails the rows of a shard that are not in the folder yet. Ctrl-C finishes the rows under way.
    fn _sail<'py>(
        &self,
        py: Python<'py>,
        number: u64,
        of: u64,
        out: PathBuf,
        threads: Option<usize>,
    ) -> PyResult<Bound<'py, PyDict>> {
        let numbers = NonZero::new(number).zip(NonZero::new(of));
        let shard = numbers.filter(|(number, of)| number <= of);
        let Some((number, of)) = shard else {
            let found = format!("{number}/{of}");
            return Err(argument("shard", found, "a number from 1 to the shards"));
        };
        let shard = Shard { number, of };
        let threads = match threads.map(NonZero::new) {
            Some(None) => return Err(argument("threads", 0, "at least 1")),
            threads => threads.flatten(),
        };
        let (done, damaged) = self.sail(py, shard, &out, threads)?;
        for text in damaged {
            let text = std::ffi::CString::new(text).unwrap_or_default();
            PyErr::warn(py, &py.get_type::<PyRuntimeWarning>(), &text, 2)?;
        }
        let found = PyDict::new(py);
        found.set_item("rows", done.sailed)?;
        found.set_item("there", done.there)?;
        found.set_item("faults", done.faults)?;
        Ok(found)
    }

    fn __repr__(&self) -> String {
        let (name, rows) = (self.name(), self.rows());
        format!("<searoom.campaign.Specification {name:?}, {rows} rows>")
    }
}

impl Specification {
    /// With an absolute folder: workers run elsewhere.
    fn beside(inner: Checked, folder: Option<&Path>) -> Self {
        let given = folder.filter(|folder| !folder.as_os_str().is_empty());
        let given = given.unwrap_or(Path::new("."));
        let folder = std::path::absolute(given).unwrap_or(given.to_owned());
        Self { inner, folder }
    }

    /// The work is done on another thread, so that this one hears of Ctrl-C.
    fn sail(
        &self,
        py: Python,
        shard: Shard,
        out: &Path,
        threads: Option<NonZero<usize>>,
    ) -> PyResult<(Done, Vec<String>)> {
        let file = self.folder.join("specification");
        let stop = AtomicBool::new(false);
        let damaged = Mutex::new(Vec::new());
        let progress = |progress| match progress {
            Progress::Damaged(text) => damaged.lock().expect("no panic while held").push(text),
            Progress::Row | Progress::Begins(..) => {}
        };
        let mut signal = None;
        let done = std::thread::scope(|scope| {
            let work = || {
                let run = searoom::campaign::run;
                run(&self.inner, &file, shard, out, threads, &stop, &progress)
            };
            let worker = scope.spawn(work);
            while !worker.is_finished() {
                py.detach(|| std::thread::sleep(LOOK));
                if let Err(raised) = py.check_signals() {
                    stop.store(true, Ordering::Relaxed);
                    signal = signal.take().or(Some(raised));
                }
            }
            worker.join()
        });
        if let Some(signal) = signal {
            return Err(signal);
        }
        let done = done.map_err(|_| InternalError::new_err("internal fault: a campaign"))?;
        let damaged = damaged.into_inner().unwrap_or_default();
        Ok((done.map_err(refused)?, damaged))
    }
}

fn drawn(specification: &Checked, row: u64) -> PyResult<RowScenario> {
    if row >= specification.rows {
        let allowed = format!("a row from 0 to {}", specification.rows - 1);
        return Err(argument("row", row, allowed));
    }
    let drawn = specification.scenario(row);
    drawn.ok_or_else(|| argument("row", row, "a row of which a draw is of its class"))
}

fn opened(folder: &Path) -> PyResult<Folder> {
    Folder::open(folder).map_err(refused)
}

/// Counts the rows of a campaign that are there, with bounds on each probability.
///
/// `folder` is that of the campaign. Returns the document of `searoom campaign summarise --json`.
#[pyfunction]
#[pyo3(name = "summarise", signature = (folder, *, allow_other_builds = false))]
pub fn py_summarise(
    py: Python,
    folder: PathBuf,
    allow_other_builds: bool,
) -> PyResult<Bound<PyAny>> {
    let folder = opened(&folder)?;
    let counted = detached(py, || {
        searoom::campaign::summarise(&folder, allow_other_builds)
    })?;
    objects(py, &counted.map_err(refused)?)
}

/// Joins all parts of a campaign as `campaign.parquet` in its folder, and returns that file.
///
/// Damaged, foreign, missing and double rows are refused; the error names them.
#[pyfunction]
#[pyo3(name = "merge", signature = (folder, *, allow_other_builds = false))]
pub fn py_merge(py: Python, folder: PathBuf, allow_other_builds: bool) -> PyResult<PathBuf> {
    let folder = opened(&folder)?;
    let merged = detached(py, || searoom::campaign::merge(&folder, allow_other_builds))?;
    merged.map_err(refused)
}

/// The simulation document of a row that is sailed again, and the columns of the kept row from
/// which it differs.
#[pyfunction]
pub fn _replay(
    py: Python,
    folder: PathBuf,
    row: u64,
) -> PyResult<(Bound<PyAny>, Option<Vec<&'static str>>)> {
    let folder = opened(&folder)?;
    let specification = folder.specification().map_err(refused)?;
    let drawn = drawn(&specification, row)?;
    let begun = detached(py, || Simulation::new(drawn.scenario.clone(), false))?;
    let mut simulation = begun.map_err(|found| faults(None, &found))?;
    while !simulation.finished() {
        detached(py, || simulation.step())?;
        py.check_signals()?;
    }
    let document = detached(py, || simulation.record())?;
    let found = objects(py, &document)?;
    let again = Row::of(&specification, row, Some(&drawn), Some(document), 0.0);
    let kept = detached(py, || folder.row(row))?.map_err(refused)?;
    Ok((found, kept.map(|kept| differing(&kept, &again.cells))))
}
