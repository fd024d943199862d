//! Plans.

use std::path::PathBuf;
use std::time::Instant;

use numpy::{IntoPyArray, PyArray1, PyArray2};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use searoom::document::PlanDocument;
use searoom::frame::course_deg_from_heading;
use searoom::obstacle::SpaceTimeObstacle;
use searoom::pipeline::Run;
use searoom::report::{Display, legs_text, plan_document_text, write_atomically};
use searoom::scenario::Scenario as Asked;
use searoom::trajectory::Trajectory;

use crate::error::{DocumentError, InternalError, NoPlanError, argument, detached};
use crate::scenario::Scenario;
use crate::value::{json, numbers, objects};

/// Seconds between samples that nobody asked for, and their greatest number.
const SAMPLE_S: f64 = 1.0;
const MOST_SAMPLES: u32 = 20_000;

/// The answer of a planner, with its independent check. It never changes.
#[pyclass(frozen, module = "searoom")]
pub struct Plan {
    scenario: Scenario,
    run: Run,
    document: PlanDocument,
    library_s: f64,
}

impl Plan {
    /// Plans a scenario, with the memory of an earlier plan in `asked`.
    pub fn new(py: Python, scenario: &Scenario, asked: Asked) -> PyResult<Self> {
        detached(py, || {
            let begun = Instant::now();
            let run = searoom::pipeline::run(asked);
            let document = PlanDocument::of(&run);
            let library_s = begun.elapsed().as_secs_f64();
            Self {
                scenario: scenario.clone(),
                document,
                run,
                library_s,
            }
        })
    }

    pub fn document(&self) -> &PlanDocument {
        &self.document
    }

    fn trajectory(&self) -> PyResult<&Trajectory> {
        let plan = self.run.planned.outcome.plan();
        plan.map(|plan| &plan.trajectory).ok_or_else(|| {
            let reason = self.document.reason.clone();
            NoPlanError::new_err(reason.unwrap_or_else(|| "there is no plan".to_owned()))
        })
    }
}

#[pymethods]
impl Plan {
    #[getter]
    fn scenario(&self) -> Scenario {
        self.scenario.clone()
    }

    /// The plan document. A new dict each time.
    #[getter(document)]
    fn py_document<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        objects(py, &self.document)
    }

    #[getter]
    fn outcome(&self) -> &str {
        self.document.outcome.word()
    }

    /// The word for the outcome: `solved`, `relaxed`, `at risk 0.20`, `NOT SAFE`, …
    #[getter]
    fn verdict(&self) -> &str {
        &self.document.verdict
    }

    #[getter]
    fn reason(&self) -> Option<&str> {
        self.document.reason.as_deref()
    }

    /// True where the document is what it claims.
    #[getter]
    fn verified(&self) -> bool {
        self.document.verified
    }

    /// True where no hard set, hull or land is entered from start to arrival.
    #[getter]
    fn safe(&self) -> bool {
        self.document.is_safe()
    }

    /// Seconds that planning took.
    #[getter]
    fn plan_s(&self) -> f64 {
        self.document.timing.plan_s
    }

    /// Seconds of the library for this plan, its check and its document.
    #[getter]
    fn _library_s(&self) -> f64 {
        self.library_s
    }

    #[getter]
    fn cost<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        objects(py, &self.document.cost)
    }

    #[getter]
    fn relaxations<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        objects(py, &self.document.relaxations)
    }

    #[getter]
    fn encounters<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        objects(py, &self.document.encounters)
    }

    /// Own ship at these times, by default every second and at every joint.
    ///
    /// Raises `NoPlanError` without a plan.
    #[pyo3(signature = (times_s = None))]
    fn sample<'py>(
        &self,
        py: Python<'py>,
        times_s: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let trajectory = self.trajectory()?;
        let times = match times_s {
            Some(times) => numbers(times, "times_s")?,
            None => trajectory.sample_times(SAMPLE_S, MOST_SAMPLES),
        };
        let (start, end) = (trajectory.start_time(), trajectory.end_time());
        if let Some(index) = times.iter().position(|t| !(start..=end).contains(t)) {
            let allowed = format!("{start} to {end}");
            return Err(argument(format!("times_s[{index}]"), times[index], allowed));
        }
        let poses: Vec<_> = times.iter().map(|t| trajectory.pose_at(*t)).collect();
        let speeds: Vec<f64> = times.iter().map(|t| trajectory.speed_at(*t)).collect();
        let east: Vec<f64> = poses.iter().map(|pose| pose.position.x).collect();
        let north: Vec<f64> = poses.iter().map(|pose| pose.position.y).collect();
        let courses = poses
            .iter()
            .map(|pose| course_deg_from_heading(pose.heading));
        let courses: Vec<f64> = courses.collect();
        let columns: [Bound<PyArray1<f64>>; 5] =
            [times, east, north, courses, speeds].map(|column| column.into_pyarray(py));
        let [times, east, north, courses, speeds] = columns;
        let samples = py.import("searoom._views")?.getattr("Samples")?;
        samples.call1((times, east, north, courses, speeds))
    }

    /// The sets that were planned against at a time: target → vertices, shape (n, 2), metres,
    /// counter-clockwise. Ellipses are given by a polygon around them.
    fn sections<'py>(&self, py: Python<'py>, time_s: f64) -> PyResult<Bound<'py, PyDict>> {
        let horizon = self.run.scenario.horizon;
        if !(0.0..=horizon).contains(&time_s) {
            return Err(argument("time_s", time_s, format!("0 to {horizon}")));
        }
        let sections = PyDict::new(py);
        for obstacle in self.run.obstacles() {
            let polygon = obstacle.outer_section(time_s);
            let rows: Vec<Vec<f64>> = polygon.vertices().iter().map(|v| vec![v.x, v.y]).collect();
            let array = PyArray2::from_vec2(py, &rows);
            let array = array.map_err(|error| InternalError::new_err(error.to_string()))?;
            sections.set_item(obstacle.name(), array)?;
        }
        Ok(sections)
    }

    /// The plan document as the command line writes it.
    fn to_json(&self) -> PyResult<String> {
        json(&self.document)
    }

    /// Writes the plan document. The file is whole or unchanged.
    fn save(&self, file: PathBuf) -> PyResult<()> {
        let written = write_atomically(&file, self.to_json()?.as_bytes());
        written.map_err(|error| DocumentError::new_err(error.to_string()))
    }

    /// The samples as a table, indexed by time. Needs pandas.
    fn to_dataframe<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let views = py.import("searoom._views")?;
        views.call_method1("dataframe", (self.sample(py, None)?,))
    }

    /// The samples as a dataset with units. Needs xarray.
    fn to_xarray<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let views = py.import("searoom._views")?;
        views.call_method1("dataset", (self.sample(py, None)?, &self.document.scenario))
    }

    /// For notebooks: a chart from above, and the text.
    fn _repr_html_<'py>(slf: Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        slf.py()
            .import("searoom._views")?
            .call_method1("html", (slf,))
    }

    fn __str__(&self) -> String {
        let display = Display::default();
        let text = plan_document_text(&self.document, display);
        format!("{text}\n{}", legs_text(&self.document, display))
    }

    fn __repr__(&self) -> String {
        let PlanDocument {
            scenario, verdict, ..
        } = &self.document;
        format!("<searoom.Plan {scenario:?}: {verdict}>")
    }
}
