//! Scenarios.

use std::path::{Path, PathBuf};

use pyo3::prelude::*;
use pyo3::types::PyDict;
use searoom::input::{Fault, read_text};
use searoom::planner::{SearchKind, planner_words};
use searoom::scenario::import::{Assumed, Assumption, Contents};
use searoom::scenario::{Compliance, FILE_MEBIBYTES, ScenarioError};

use crate::error::{argument, detached, faults, scenario};
use crate::value::toml_text;

/// Names of the options for an imported file.
const ASSUMPTIONS: [(&str, Assumption); 6] = [
    ("speed_spread_mps", Assumption::SpeedSpread),
    ("course_spread_deg", Assumption::CourseSpread),
    ("margin_m", Assumption::SafetyMargin),
    ("length_m", Assumption::Length),
    ("beam_m", Assumption::Beam),
    ("own_speed_mps", Assumption::OwnSpeed),
];

/// A checked scenario. It never changes; `replace` makes another.
#[pyclass(frozen, module = "searoom")]
#[derive(Debug, Clone)]
pub struct Scenario {
    pub inner: searoom::scenario::Scenario,
    /// The text of its file, and the folder from where its map is searched.
    text: String,
    folder: PathBuf,
    notes: Vec<String>,
}

impl Scenario {
    fn parsed(text: String, folder: PathBuf) -> Result<Self, Vec<Fault>> {
        // where a map was found stays so when the program changes its folder
        let folder = std::env::current_dir().map_or(folder.clone(), |here| here.join(&folder));
        let inner = searoom::scenario::Scenario::parse_beside(&text, &folder)?;
        Ok(Self {
            notes: inner.remarks.all(),
            inner,
            text,
            folder,
        })
    }
}

#[pymethods]
impl Scenario {
    /// Reads a scenario file, or a file of another program with one situation.
    ///
    /// `assumed` are values that such files do not have: `speed_spread_mps`,
    /// `course_spread_deg`, `margin_m`, `length_m`, `beam_m`.
    #[staticmethod]
    #[pyo3(signature = (file, **assumed))]
    fn read(py: Python, file: PathBuf, assumed: Option<&Bound<PyDict>>) -> PyResult<Self> {
        let mut all = Self::read_all(py, file.clone(), assumed)?;
        match (all.pop(), all.len()) {
            (Some(one), 0) => Ok(one),
            (_, more) => Err(argument(
                file.display().to_string(),
                format!("{} situations", more + 1),
                "a file with one; Scenario.read_all reads all",
            )),
        }
    }

    /// Reads every situation of a file.
    #[staticmethod]
    #[pyo3(signature = (file, **assumed))]
    fn read_all(py: Python, file: PathBuf, assumed: Option<&Bound<PyDict>>) -> PyResult<Vec<Self>> {
        let assumed = of_options(assumed)?;
        let all = detached(py, || read_all(&file, &assumed))?;
        all.map_err(|error| scenario(&error))
    }

    /// Reads the text of a scenario file. Its map is searched from `folder`, by default from where
    /// the program runs.
    #[staticmethod]
    #[pyo3(signature = (text, folder = None))]
    fn parse(py: Python, text: String, folder: Option<PathBuf>) -> PyResult<Self> {
        let parsed = detached(py, || Self::parsed(text, folder.unwrap_or_default()))?;
        parsed.map_err(|found| faults(None, &found))
    }

    /// A scenario of a dict with the keys of a scenario file. Arrays count as lists.
    #[staticmethod]
    #[pyo3(signature = (values, folder = None))]
    fn from_dict(py: Python, values: &Bound<PyDict>, folder: Option<PathBuf>) -> PyResult<Self> {
        let text = toml_text(values)?;
        let parsed = detached(py, || Self::parsed(text, folder.unwrap_or_default()))?;
        parsed.map_err(|mut found| {
            // lines of a text that the caller has never seen
            found.iter_mut().for_each(|fault| fault.line = None);
            faults(None, &found)
        })
    }

    /// The scenario with other settings, as the options of the command line do it.
    #[pyo3(signature = (*, planner = None, search = None, compliance = None, max_risk = None, deadline_s = None, seed = None))]
    fn replace(
        &self,
        planner: Option<&str>,
        search: Option<&str>,
        compliance: Option<&str>,
        max_risk: Option<f64>,
        deadline_s: Option<f64>,
        seed: Option<&Bound<PyAny>>,
    ) -> PyResult<Self> {
        let mut asked = self.clone();
        let scenario = &mut asked.inner;
        if let Some(found) = planner {
            scenario.set_planner(word("planner", &planner_words(), found)?);
        }
        if let Some(found) = search {
            scenario.search = word("search", SearchKind::WORDS, found)?;
        }
        if let Some(found) = compliance {
            scenario.compliance = word("compliance", Compliance::WORDS, found)?;
        }
        if let Some(risk) = max_risk {
            if !searoom::scenario::Scenario::allows_max_risk(risk) {
                let allowed = searoom::scenario::Scenario::max_risk_allowed();
                return Err(argument("max_risk", risk, allowed));
            }
            scenario.max_risk = risk;
        }
        if let Some(seconds) = deadline_s {
            if !(1e-3..=1e6).contains(&seconds) {
                return Err(argument(
                    "deadline_s",
                    seconds,
                    "a number from 0.001 to 1000000",
                ));
            }
            scenario.deadline = seconds;
        }
        if let Some(found) = seed {
            let seed = found.extract();
            let refused = |_| argument("seed", found, "an integer from 0 to 2^64 - 1");
            scenario.simulation.seed = seed.map_err(refused)?;
        }
        match scenario.unfit() {
            found if found.is_empty() => Ok(asked),
            found => Err(faults(None, &found)),
        }
    }

    #[getter]
    fn title(&self) -> &str {
        &self.inner.title
    }

    #[getter]
    fn planner(&self) -> &str {
        self.inner.planner.facts().name
    }

    #[getter]
    fn compliance(&self) -> &str {
        self.inner.compliance.word()
    }

    #[getter]
    fn horizon_s(&self) -> f64 {
        self.inner.horizon
    }

    /// The names of the targets.
    #[getter]
    fn targets(&self) -> Vec<&str> {
        let targets = self.inner.targets.iter();
        targets.map(|target| target.name.as_str()).collect()
    }

    /// The assumptions made for an imported file.
    #[getter]
    fn notes(&self) -> Vec<String> {
        self.notes.clone()
    }

    /// The scenario of a pickle.
    #[staticmethod]
    fn _restored(text: String, folder: PathBuf, notes: Vec<String>) -> PyResult<Self> {
        let parsed = Self::parsed(text, folder).map_err(|found| faults(None, &found))?;
        Ok(Self { notes, ..parsed })
    }

    /// The scenario as the text of a scenario file, without the settings of `replace`.
    #[getter]
    fn text(&self) -> &str {
        &self.text
    }

    /// The scenario as a dict with the keys of a scenario file, without the settings of `replace`: what
    /// `from_dict` reads.
    fn to_dict<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        py.import("tomllib")?.call_method1("loads", (&self.text,))
    }

    /// The scenario with these targets in place of its own, each a dict with the keys of a scenario file,
    /// and with the settings of `replace`.
    fn with_targets<'py>(
        slf: Bound<'py, Self>,
        targets: Bound<'py, PyAny>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let views = slf.py().import("searoom._views")?;
        views.call_method1("with_targets", (slf, targets))
    }

    /// For `pickle`: text and settings. The map has to be there where it is read again.
    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyAny>)> {
        let scenario = &self.inner;
        let settings = PyDict::new(py);
        settings.set_item("planner", self.planner())?;
        settings.set_item("search", scenario.search.word())?;
        settings.set_item("compliance", self.compliance())?;
        settings.set_item("max_risk", scenario.max_risk)?;
        settings.set_item("deadline_s", scenario.deadline)?;
        settings.set_item("seed", scenario.simulation.seed)?;
        let restored = py.import("searoom._views")?.getattr("restored")?;
        let arguments = (&self.text, &self.folder, settings, &self.notes).into_pyobject(py)?;
        Ok((restored, arguments.into_any()))
    }

    fn __repr__(&self) -> String {
        let (title, targets) = (self.title(), self.inner.targets.len());
        format!("<searoom.Scenario {title:?}, {targets} targets>")
    }
}

fn read_all(file: &Path, assumed: &Assumed) -> Result<Vec<Scenario>, ScenarioError> {
    let fault = |found: &str| {
        let fault = Fault::new("", found, "a scenario");
        ScenarioError::faults(file, vec![fault])
    };
    let situations = match Contents::read(file, assumed)? {
        Contents::Scenario => {
            let text = read_text(file, FILE_MEBIBYTES, "a scenario file")?;
            let folder = file.parent().unwrap_or(Path::new(""));
            let read = Scenario::parsed(text, folder.to_owned());
            return match read {
                Ok(one) => Ok(vec![one]),
                Err(faults) => Err(ScenarioError::faults(file, faults)),
            };
        }
        Contents::Situations(situations) => situations,
        Contents::Other(what) => return Err(fault(what)),
    };
    let imported = situations.into_iter().map(|situation| {
        let imported = situation.and_then(|situation| situation.scenario(assumed));
        let imported = imported.map_err(|faults| ScenarioError::faults(file, faults))?;
        Ok(Scenario {
            inner: imported.scenario,
            text: imported.text,
            folder: PathBuf::new(),
            notes: imported.notes,
        })
    });
    imported.collect()
}

fn of_options(options: Option<&Bound<PyDict>>) -> PyResult<Assumed> {
    let mut assumed = Assumed::default();
    for (key, value) in options.into_iter().flatten() {
        let key: String = key.extract()?;
        let what = word("assumption", &ASSUMPTIONS, &key)?;
        let number = value.extract().unwrap_or(f64::NAN);
        if !what.allows(number) {
            return Err(argument(key, value.repr()?, what.allowed()));
        }
        assumed = assumed.with(what, number);
    }
    Ok(assumed)
}

/// The value of a word.
fn word<T: Copy>(argument_name: &str, words: &[(&str, T)], found: &str) -> PyResult<T> {
    let known = words.iter().find(|(word, _)| *word == found);
    known.map(|(_, value)| *value).ok_or_else(|| {
        let allowed: Vec<&str> = words.iter().map(|(word, _)| *word).collect();
        argument(argument_name, format!("{found:?}"), allowed.join(", "))
    })
}
