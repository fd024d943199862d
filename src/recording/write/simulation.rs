//! Writes a simulation as one recording: what was sailed, and the plan at every time.

use std::path::Path;

use rerun::{TextLog, TextLogLevel, TimeColumn};

use super::{RecordingError, encoding_error, put};
use crate::document::{PlanDocument, SimulationDocument};
use crate::recording::canvas::ClosedLoop;
use crate::recording::recorder::Recorder;
use crate::recording::views::{chart, closed_loop, curves, land, rules, ships};
use crate::recording::{EVENTS, Logged, SIMULATION, SUMMARY, TIMELINE, layout, path};
use crate::scenario::Scenario;
use crate::text::{clock, rounded};

/// A simulation, with the text of its recording.
#[derive(Debug, Clone, Copy)]
pub struct Simulated<'a> {
    /// The scenario that was sailed.
    pub scenario: &'a Scenario,
    /// The record of the simulation.
    pub document: &'a SimulationDocument,
    /// The plans that own ship followed: [`crate::simulation::Simulation::plans`] of a simulation
    /// that kept them from the start.
    pub plans: &'a [PlanDocument],
    /// The result as markdown.
    pub text: &'a str,
}

/// Writes a simulation as one recording, in full or not at all, as [`super::write`] does a run.
///
/// # Examples
///
/// ```
/// use searoom::recording::{Recorded, Simulated, write_simulation};
/// use searoom::scenario::Scenario;
/// use searoom::simulation::Simulation;
///
/// let scenario = Scenario::read("scenarios/colregs/head-on.toml".as_ref())?;
/// let simulation = Simulation::keeping_plans(scenario.clone(), false);
/// let mut simulation = simulation.expect("a closed loop");
/// for _ in 0..100 {
///     simulation.step();
/// }
/// # let folder = tempfile::tempdir()?;
/// let file = folder.path().join("sailed.rrd");
/// let simulated = Simulated {
///     scenario: &scenario,
///     document: &simulation.record(),
///     plans: simulation.plans(),
///     text: "Head-on: sailed for 50 s",
/// };
/// write_simulation(&simulated, &file)?;
/// assert!(Recorded::read(&file)?.table("curves/off_plan_m").is_some());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn write_simulation(simulated: &Simulated, path: &Path) -> Result<(), RecordingError> {
    let text = serde_json::to_string(&without_motions(simulated.document));
    let text = text.map_err(|source| encoding_error(path, source))?;
    let title = &simulated.scenario.title;
    put(path, title, (SIMULATION, &text), |rec| log(rec, simulated))
}

/// The document without the parts that grow with the time sailed and are drawn.
fn without_motions(document: &SimulationDocument) -> SimulationDocument {
    let mut short = document.clone();
    short.sailed.clear();
    if let Some(land) = &mut short.land {
        land.polygons_m.clear();
    }
    for target in &mut short.targets {
        target.track.clear();
    }
    for replan in &mut short.replans {
        replan.estimates.clear();
    }
    short
}

fn log(rec: &mut Recorder, simulated: &Simulated) -> Logged<Recorder> {
    let Simulated {
        scenario,
        document,
        plans,
        text,
    } = *simulated;
    let model = ClosedLoop::new(scenario, document, plans);
    let text = format!("{text}\n\n{}", key(&model));
    rec.log_markdown(SUMMARY, text)?;
    let judged = closed_loop::judged(&model);
    let lanes = rules::lanes(&judged, None, model.canvas.end);
    land::log_on_chart(rec, &model.canvas)?;
    closed_loop::log_chart(rec, &model, &judged)?;
    let plots = closed_loop::plots(&model);
    curves::log_plots(rec, &plots)?;
    rules::log_lanes(rec, &lanes)?;
    let marks = rules::marks(&judged, None, |t| model.own_at(t).0.position);
    rules::log_marks(rec, &marks)?;
    log_events(rec, document)?;
    layout::of_simulation(&model.canvas, lanes.len(), &plots)
}

fn key(model: &ClosedLoop) -> String {
    format!(
        "Chart at the cursor: own ship is white, and so is its plan where it has the desired \
         speed; yellow and thick is faster, blue and thin slower. Each target has a colour for its \
         true hull, its track, and thick for the hard set that the plan assumes; grey is the hull \
         that the plan assumes. Sets apply to own ship's centre. The green line is the closest \
         approach. Speed vectors are of {:.0} s, dots every {:.0} s; the grid has {} m.",
        ships::vector_seconds(&model.canvas),
        model.canvas.cursor_times.get(1).copied().unwrap_or(0.0),
        rounded(chart::grid_spacing(&model.canvas)),
    )
}

struct Event {
    time: f64,
    level: &'static str,
    text: String,
}

fn log_events(rec: &mut Recorder, document: &SimulationDocument) -> Logged {
    let mut events = outcomes(document);
    events.extend(manoeuvres(document));
    events.extend(alarms(document));
    for target in &document.targets {
        events.extend(target.contact_t_s.map(|time| Event {
            time,
            level: TextLogLevel::ERROR,
            text: format!("CONTACT with {}", target.name),
        }));
    }
    events.push(Event {
        time: document.duration_s,
        level: TextLogLevel::INFO,
        text: if document.arrived {
            "arrived"
        } else {
            "end, not arrived"
        }
        .to_owned(),
    });
    // a stable sort: a plan comes before its alarms
    events.sort_by(|a, b| a.time.total_cmp(&b.time));
    let columns = TextLog::update_fields()
        .with_many_text(events.iter().map(|event| event.text.as_str()))
        .with_many_level(events.iter().map(|event| event.level))
        .columns_of_unit_batches()?;
    let times = TimeColumn::new_duration_secs(TIMELINE, events.iter().map(|event| event.time));
    rec.send_columns(path(&[EVENTS]), Some(times), columns)
}

/// The plans that are not the remainder of the one before with the same outcome.
fn outcomes(document: &SimulationDocument) -> Vec<Event> {
    let mut events = Vec::new();
    let mut before = None;
    for replan in &document.replans {
        let mut relaxed: Vec<&str> = replan.relaxations.iter().map(|kind| kind.word()).collect();
        relaxed.sort_unstable();
        relaxed.dedup();
        let outcome = Some((replan.verdict.as_str(), relaxed.clone()));
        if replan.followed && replan.keeps_plan && before == outcome {
            continue;
        }
        before = outcome;
        let kind = match (replan.followed, replan.keeps_plan) {
            (false, _) => "not followed",
            (true, true) => "plan kept",
            (true, false) => "new plan",
        };
        let mut text = format!(
            "{kind} from {}: {}",
            clock(replan.start_t_s),
            replan.verdict
        );
        if !relaxed.is_empty() {
            text += &format!("; relaxed: {}", relaxed.join(", "));
        }
        let level = if replan.safe && replan.followed {
            TextLogLevel::INFO
        } else {
            TextLogLevel::WARN
        };
        events.push(Event {
            time: replan.t_s,
            level,
            text,
        });
    }
    events
}

/// Events of the sailed manoeuvres: each one, and the turn back from it.
fn manoeuvres(document: &SimulationDocument) -> impl Iterator<Item = Event> {
    let sailed = document.conduct.manoeuvres.iter();
    let events = sailed.flat_map(|manoeuvre| {
        let departure = manoeuvre.departure;
        let begins = (departure.begins_s(), departure.brief());
        let returns = manoeuvre
            .returns_s
            .map(|time| (time, "turns back".to_owned()));
        std::iter::once(begins).chain(returns)
    });
    events.map(|(time, text)| Event {
        time,
        level: TextLogLevel::INFO,
        text,
    })
}

/// The alarms; one that goes on from plan to plan is there once.
fn alarms(document: &SimulationDocument) -> impl Iterator<Item = Event> {
    let lasting = document.lasting_alarms().into_iter();
    lasting.map(|alarm| Event {
        time: alarm.first.t_s,
        level: TextLogLevel::WARN,
        text: format!("alarm: {}", alarm.first.words()),
    })
}
