//! The closed loop.

use pyo3::prelude::*;
use pyo3::types::PyDict;
use searoom::colregs::SteadyShip;
use searoom::frame::course_deg_from_heading;

use crate::error::{detached, faults};
use crate::scenario::Scenario;
use crate::value::objects;

/// A scenario that is sailed step by step in the closed loop.
#[pyclass(module = "searoom")]
pub struct Simulation {
    inner: searoom::simulation::Simulation,
}

#[pymethods]
impl Simulation {
    #[new]
    #[pyo3(signature = (scenario, *, measured_delay = false))]
    fn new(py: Python, scenario: &Scenario, measured_delay: bool) -> PyResult<Self> {
        let begun = detached(py, || {
            searoom::simulation::Simulation::new(scenario.inner.clone(), measured_delay)
        })?;
        match begun {
            Ok(inner) => Ok(Self { inner }),
            Err(found) => Err(faults(None, &found)),
        }
    }

    #[getter]
    fn finished(&self) -> bool {
        self.inner.finished()
    }

    #[getter]
    fn time_s(&self) -> f64 {
        self.inner.time()
    }

    #[getter]
    fn own<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        state(py, &self.inner.own())
    }

    /// The true states of the targets.
    #[getter]
    fn targets<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let targets = PyDict::new(py);
        for (name, ship) in self.inner.targets() {
            targets.set_item(name, state(py, &ship)?)?;
        }
        Ok(targets)
    }

    /// Moves all ships on to the next step or event. Without effect once finished.
    fn step(&mut self, py: Python) -> PyResult<()> {
        detached(py, || self.inner.step())
    }

    /// Steps until it is finished. Ctrl-C interrupts between two steps.
    fn run(slf: &Bound<Self>) -> PyResult<()> {
        let py = slf.py();
        // borrowed for each step alone, so that a signal's handler and other threads can look at it
        while !slf.try_borrow()?.inner.finished() {
            slf.try_borrow_mut()?.step(py)?;
            py.check_signals()?;
        }
        Ok(())
    }

    /// The simulation document so far.
    fn record<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let record = detached(py, || self.inner.record())?;
        objects(py, &record)
    }

    fn __repr__(&self) -> String {
        let state = if self.finished() {
            "finished"
        } else {
            "sailing"
        };
        format!("<searoom.Simulation, {state} at {:.1} s>", self.time_s())
    }
}

/// A ship's state as Python sees it.
fn state<'py>(py: Python<'py>, ship: &SteadyShip) -> PyResult<Bound<'py, PyAny>> {
    let state = py.import("searoom._views")?.getattr("ShipState")?;
    let place = ship.pose.position;
    let course = course_deg_from_heading(ship.pose.heading);
    state.call1((place.x, place.y, course, ship.speed))
}
