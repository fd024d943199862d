//! Figure of a simulation: what was sailed, and the closest approach.

use super::plan::{Charted, Meeting, Moment, Traffic, marked_times, moments, traffic_chart};
use super::{Figure, FigureError, FigureOptions, Panel, Style};
use crate::colregs::Role;
use crate::document::{SimulatedTargetDocument, SimulationDocument, chart_role};
use crate::frame::{Pose, Vector};
use crate::report::simulation::{headline, headline_parts};
use crate::scenario::Scenario;
use crate::text::{Times, significant};

/// Most instants after the start at which hulls are drawn.
const INSTANTS: f64 = 6.0;

/// Seconds between the points of a curve, and the most points of it.
const STEP: f64 = 1.0;
const MOST_POINTS: f64 = 5_000.0;

/// Draws the tracks of all ships, their hulls at round times and the closest approaches.
pub fn simulation_figure(
    scenario: &Scenario,
    simulation: &SimulationDocument,
    options: &FigureOptions,
) -> Result<Figure, FigureError> {
    options.draw(simulation.duration_s, |style| {
        if style.panels {
            let figure = moments(scenario, style, &traffic(simulation, style));
            return figure.titled(&headline(simulation, Times::Clock));
        }
        let panel = simulation_panel(scenario, simulation, style);
        Figure::new(1, vec![panel]).titled(&simulation.scenario)
    })
}

/// Panel of [`simulation_figure`], under how it ended.
pub(in crate::report) fn simulation_panel(
    scenario: &Scenario,
    simulation: &SimulationDocument,
    style: &Style,
) -> Panel {
    let traffic = traffic(simulation, style);
    let parts = headline_parts(simulation, Times::Clock).into_iter();
    let parts: Vec<String> = parts.map(|(text, _)| text).collect();
    traffic_chart(
        &parts.join("; "),
        scenario,
        style,
        &traffic,
        None,
        Vec::new(),
    )
}

fn corners(target: &SimulatedTargetDocument, pose: &Pose) -> Vec<Vector> {
    (target.outline(pose)).map_or_else(Vec::new, |outline| outline.vertices().to_vec())
}

fn traffic(simulation: &SimulationDocument, style: &Style) -> Traffic {
    let end = simulation.duration_s;
    let step = STEP.max(end / MOST_POINTS);
    let steps = (end / step).ceil() as usize;
    let sampled = (0..=steps).map(|k| (k as f64 * step).min(end));
    let sampled: Vec<f64> = sampled.collect();
    // a distance that is no number is a contact
    let apart =
        |target: &SimulatedTargetDocument| target.least_clearance_m.unwrap_or(f64::NEG_INFINITY);
    let closest = simulation.targets.iter();
    let closest = closest.map(|target| [apart(target), target.least_clearance_t_s]);
    let times = marked_times(style, end, INSTANTS, closest);
    let own = |time: &f64| simulation.own_at(*time).map(|own| own.0);
    let targets = simulation.targets.iter().map(|target| {
        let moment = |time: f64| {
            let pose = target.at(time).map(|ship| ship.pose);
            let is_set = target.set_m.is_some();
            let area = pose.filter(|_| is_set).map(|pose| corners(target, &pose));
            Moment {
                pose,
                area: area.unwrap_or_default(),
                hard: Vec::new(),
            }
        };
        let time = target.least_clearance_t_s;
        let text = match target.contact_t_s {
            None if apart(target).is_finite() => format!("{} m", significant(apart(target))),
            _ => "CONTACT".to_owned(),
        };
        Charted {
            name: target.name.clone(),
            role: chart_role(&target.conduct.roles, Role::None),
            hull: target.set_m.is_none().then(|| target.hull()),
            track: (sampled.iter())
                .filter_map(|time| target.at(*time).map(|ship| ship.pose.position))
                .collect(),
            moments: times.iter().map(|time| moment(*time)).collect(),
            closest: own(&time).map(|own| Meeting {
                time,
                own,
                target: moment(time),
                apart: apart(target),
                text,
            }),
        }
    });
    Traffic {
        targets: targets.collect(),
        track: (sampled.iter().filter_map(own))
            .map(|pose| pose.position)
            .collect(),
        own: times.iter().filter_map(own).collect(),
        words: ["sailed", "targets"].map(str::to_owned),
        times,
    }
}
