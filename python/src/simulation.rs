//! The closed loop.

use numpy::{IntoPyArray, PyArray1};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use searoom::colregs::SteadyShip;
use searoom::frame::{course_deg_from_heading, heading_from_course_deg};
use searoom::simulation::Command;

use crate::error::{detached, faults};
use crate::scenario::Scenario;
use crate::value::{objects, rows};

/// A scenario that is sailed step by step in the closed loop.
///
/// With `commanded` own ship does not plan: it holds course and speed until `command`.
#[pyclass(module = "searoom")]
pub struct Simulation {
    inner: searoom::simulation::Simulation,
}

#[pymethods]
impl Simulation {
    #[new]
    #[pyo3(signature = (scenario, *, measured_delay = false, commanded = false))]
    fn new(
        py: Python,
        scenario: &Scenario,
        measured_delay: bool,
        commanded: bool,
    ) -> PyResult<Self> {
        Self::begun(py, scenario.inner.clone(), measured_delay, commanded)
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

    /// The states of the targets as own ship's sensors and tracker have them.
    #[getter]
    fn estimates<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let targets = PyDict::new(py);
        for (name, ship) in self.inner.estimates() {
            targets.set_item(name, state(py, &ship)?)?;
        }
        Ok(targets)
    }

    /// Where the desired trajectory has own ship now.
    #[getter]
    fn desired<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        state(py, &self.inner.desired())
    }

    /// The end of the simulation.
    #[getter]
    fn duration_s(&self) -> f64 {
        self.inner.duration()
    }

    /// The largest speed of a command.
    #[getter]
    fn max_speed_mps(&self) -> f64 {
        self.inner.max_speed()
    }

    /// True where own hull has touched a target's, or land since `since_s`.
    #[pyo3(signature = (since_s = 0.0))]
    fn contact(&self, py: Python, since_s: f64) -> PyResult<bool> {
        detached(py, || self.inner.is_contact(since_s))
    }

    /// From now on own ship turns to a course, the shorter way at its turning radius, and holds
    /// course and speed. Only where `commanded`. The speed changes at once, as in plans.
    fn command(&mut self, course_deg: f64, speed_mps: f64) -> PyResult<()> {
        let given = self.inner.command(command([course_deg, speed_mps]));
        given.map_err(|fault| faults(None, &[fault]))
    }

    /// For the command that own ship follows, and for each row of a course and a speed: true where
    /// it keeps own ship clear of the hard set of every target, and of land, to the end of the
    /// simulation. The first entry is that of the command that is followed.
    fn clear_commands<'py>(
        &mut self,
        py: Python<'py>,
        commands: &Bound<'py, PyAny>,
    ) -> PyResult<Bound<'py, PyArray1<bool>>> {
        let commands = rows::<2>(commands, "commands")?;
        let commands: Vec<Command> = commands.into_iter().map(command).collect();
        let (held, each) = detached(py, || self.inner.clear_commands(&commands))?;
        let all: Vec<bool> = std::iter::once(held).chain(each).collect();
        Ok(all.into_pyarray(py))
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

impl Simulation {
    pub fn begun(
        py: Python,
        scenario: searoom::scenario::Scenario,
        measured_delay: bool,
        commanded: bool,
    ) -> PyResult<Self> {
        use searoom::simulation::Simulation;
        let begun = detached(py, || match commanded {
            true => Simulation::commanded(scenario),
            false => Simulation::new(scenario, measured_delay),
        })?;
        match begun {
            Ok(inner) => Ok(Self { inner }),
            Err(found) => Err(faults(None, &found)),
        }
    }
}

fn command([course_deg, speed]: [f64; 2]) -> Command {
    let heading = heading_from_course_deg(course_deg);
    Command { heading, speed }
}

/// A ship's state as Python sees it.
fn state<'py>(py: Python<'py>, ship: &SteadyShip) -> PyResult<Bound<'py, PyAny>> {
    let state = py.import("searoom._views")?.getattr("ShipState")?;
    let place = ship.pose.position;
    let course = course_deg_from_heading(ship.pose.heading);
    state.call1((place.x, place.y, course, ship.speed))
}
