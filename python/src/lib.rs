//! The native part of the Python package `searoom`. `searoom/_searoom.pyi` describes it.

mod campaign;
mod error;
mod plan;
mod scenario;
mod simulation;
mod value;

use pyo3::prelude::*;
use searoom::document::{AssessedSets, ScenarioComparisonDocument, VerifiedPlanDocument};
use searoom::frame::Vector;
use searoom::obstacle::Obstacle;
use searoom::pipeline;
use searoom::replanning::{PreviousPlan, remember};
use searoom::study::assess::{OwnSituation, Query, SpaceTimePoint};
use searoom::study::compare::{Entry, candidates, methods, without_repeats};
use searoom::verification::{is_simulation, verified_plan, verify, verify_simulations};

use campaign::{_replay, Specification, py_merge, py_summarise};
use error::{
    DocumentError, InputError, InternalError, NoPlanError, SearoomError, argument, detached,
};
use plan::Plan;
use scenario::Scenario;
use simulation::Simulation;
use value::{AnyDocument, numbers, objects};

/// Plans a scenario.
///
/// `previous` is the plan that own ship follows: a plan, its document as dict or text, or a file.
/// The roles, sets and manoeuvres that it began go on.
#[pyfunction]
#[pyo3(name = "plan", signature = (scenario, *, previous = None))]
fn py_plan(py: Python, scenario: &Scenario, previous: Option<AnyDocument>) -> PyResult<Plan> {
    let mut asked = scenario.inner.clone();
    if let Some(previous) = previous {
        let before = match &previous {
            AnyDocument::Plan(plan) if plan.get().document().verified => {
                plan.get().document().clone()
            }
            AnyDocument::Plan(_) => {
                return Err(DocumentError::new_err("previous: not a plan that verifies"));
            }
            AnyDocument::Text(_) | AnyDocument::File(_) => {
                let document = previous.read()?;
                let read = detached(py, || verified_plan(&document.text))?;
                read.map_err(|error| document.error(error))?
            }
        };
        let kept = detached(py, || {
            PreviousPlan::try_from(&before).and_then(|before| remember(&before, &mut asked))
        })?;
        kept.map_err(|fault| DocumentError::new_err(fault.to_string()))?;
    }
    Plan::new(py, scenario, asked)
}

/// Checks a plan or simulation document from its own content, without the planner.
#[pyfunction]
#[pyo3(name = "verify")]
fn py_verify<'py>(py: Python<'py>, document: AnyDocument) -> PyResult<Bound<'py, PyAny>> {
    let document = document.read()?;
    let (name, text) = (document.name(), &document.text);
    let checked = detached(py, || {
        if !is_simulation(text) {
            return verify(text).map(|plan| vec![VerifiedPlanDocument::of(name, &plan)]);
        }
        let all = verify_simulations(text)?;
        let all = all.iter();
        let documents = all.map(|s| VerifiedPlanDocument::of_simulation(name.clone(), s));
        Ok(documents.collect())
    })?;
    let mut checked = checked.map_err(|error| document.error(error))?;
    match (checked.pop(), checked.len()) {
        (Some(one), 0) => objects(py, &one),
        (_, more) => {
            let found = format!("{} simulations", more + 1);
            Err(argument("document", found, "one; verify them one by one"))
        }
    }
}

/// Risk, closest approach and the least alteration, without planning.
///
/// `points` are rows of east, north and time, `velocities` rows of east and north, `sections_s`
/// times of the sets. With `domains` the sets include the ship domains.
#[pyfunction]
#[pyo3(name = "assess", signature = (scenario, *, points = None, velocities = None, sections_s = None, domains = false))]
fn py_assess<'py>(
    py: Python<'py>,
    scenario: &Scenario,
    points: Option<&Bound<'py, PyAny>>,
    velocities: Option<&Bound<'py, PyAny>>,
    sections_s: Option<&Bound<'py, PyAny>>,
    domains: bool,
) -> PyResult<Bound<'py, PyAny>> {
    let points = points.map(|rows| value::rows::<3>(rows, "points"));
    let velocities = velocities.map(|rows| value::rows::<2>(rows, "velocities"));
    let sections = sections_s.map(|times| numbers(times, "sections_s"));
    let query = Query {
        points: (points.transpose()?.into_iter().flatten())
            .map(|[east, north, time]| SpaceTimePoint {
                position: Vector::new(east, north),
                time,
            })
            .collect(),
        velocities: (velocities.transpose()?.into_iter().flatten())
            .map(|[east, north]| Vector::new(east, north))
            .collect(),
        sections: sections.transpose()?.unwrap_or_default(),
    };
    let times = query.sections.iter().copied();
    let times = times.chain(query.points.iter().map(|point| point.time));
    if let Some(time) = times.into_iter().find(|time| !(0.0..=1e6).contains(time)) {
        return Err(argument(
            "time",
            time,
            "times from 0 to 1000000, in seconds",
        ));
    }
    let mut places = query.points.iter().map(|point| point.position);
    if let Some(place) = places.find(|place| place.amax() > 1e7) {
        let allowed = "coordinates from -10000000 to 10000000, in metres";
        return Err(argument("points", format!("{:?}", place.amax()), allowed));
    }
    if let Some(velocity) = query.velocities.iter().find(|v| v.amax() > 100.0) {
        return Err(argument("velocities", velocity.amax(), "-100 to 100 m/s"));
    }
    let scenario = &scenario.inner;
    let assessment = detached(py, || {
        let obstacles: Vec<Obstacle> = pipeline::sets(scenario)
            .into_iter()
            .map(|sets| if domains { sets.with_domain } else { sets.hard })
            .collect();
        let situation = OwnSituation::of(scenario, &obstacles);
        let sets = match domains {
            true => AssessedSets::Domains,
            false => AssessedSets::Hard,
        };
        searoom::study::assess::assess(&scenario.title, sets, &situation, &query)
    })?;
    objects(py, &assessment)
}

/// Every planner that applies and two baselines on one scenario, at each accepted risk.
///
/// With `bound` each plan also has a lower bound of J around the sets of its method, which takes
/// some seconds.
#[pyfunction]
#[pyo3(name = "compare", signature = (scenario, *, max_risks = None, bound = false))]
fn py_compare<'py>(
    py: Python<'py>,
    scenario: &Scenario,
    max_risks: Option<&Bound<'py, PyAny>>,
    bound: bool,
) -> PyResult<Bound<'py, PyAny>> {
    let scenario = &scenario.inner;
    let risks = match max_risks {
        Some(risks) => numbers(risks, "max_risks")?,
        None => vec![scenario.max_risk],
    };
    let refused = |risk: &f64| !searoom::scenario::Scenario::allows_max_risk(*risk);
    if let Some(risk) = risks.iter().copied().find(|risk| refused(risk)) {
        let allowed = searoom::scenario::Scenario::max_risk_allowed();
        return Err(argument("max_risks", risk, allowed));
    }
    let found = methods(scenario);
    let mut entries: Vec<Entry> = Vec::new();
    for candidate in candidates(&found.methods, &risks) {
        let run = || match bound {
            true => candidate.run(scenario).with_bound(),
            false => candidate.run(scenario),
        };
        entries.push(detached(py, run)?);
        py.check_signals()?;
    }
    let entries = without_repeats(entries);
    let (file, others) = (String::new(), &found.inapplicable);
    let document = ScenarioComparisonDocument::of(file, scenario, &entries, others);
    objects(py, &document)
}

/// The native part of Searoom.
#[pymodule]
mod _searoom {
    #[pymodule_export]
    use super::{
        _replay, DocumentError, InputError, InternalError, NoPlanError, Plan, Scenario,
        SearoomError, Simulation, Specification, py_assess, py_compare, py_merge, py_plan,
        py_summarise, py_verify,
    };

    #[pymodule_export]
    #[allow(non_upper_case_globals)]
    const __version__: &str = env!("CARGO_PKG_VERSION");
}
