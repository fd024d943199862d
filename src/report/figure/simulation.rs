//! Figure of a simulation: what was sailed, and the closest approach.

use super::outline::{curve, marks};
use super::path_time::target_colour;
use super::plan::{Traffic, round_times, traffic_chart};
use super::sections::seconds;
use super::{Figure, Panel, Stroke};
use crate::document::SimulationDocument;
use crate::frame::{Pose, Vector, to_port};
use crate::report::simulation::headline;
use crate::scenario::Scenario;
use crate::text::tenths;

/// Stroke between the centres of the hulls at the closest approach.
const CLOSEST: Stroke = Stroke::solid("#b3001b", 1.6);

/// Most instants after the start at which hulls are drawn.
const INSTANTS: f64 = 6.0;

/// Seconds between the points of a curve, and the most points of it.
const STEP: f64 = 1.0;
const MOST_POINTS: f64 = 5_000.0;

/// Draws the tracks of all ships, their hulls at round times and the closest approach.
pub fn simulation_figure(scenario: &Scenario, simulation: &SimulationDocument) -> Figure {
    let title = match simulation.safe {
        true => simulation.scenario.clone(),
        false => headline(simulation),
    };
    let panel = simulation_panel(scenario, simulation);
    Figure::new(1, vec![panel]).titled(&title)
}

/// Panel of [`simulation_figure`].
pub fn simulation_panel(scenario: &Scenario, simulation: &SimulationDocument) -> Panel {
    let end = simulation.duration_s;
    let step = STEP.max(end / MOST_POINTS);
    let steps = (end / step).ceil() as usize;
    let sampled = (0..=steps).map(|k| (k as f64 * step).min(end));
    let sampled: Vec<f64> = sampled.collect();
    let times = round_times(end, INSTANTS);
    let own = |time: &f64| simulation.own_at(*time).map(|own| own.pose.position);
    let targets = &simulation.targets;
    let mut others = Vec::new();
    for (index, target) in targets.iter().enumerate() {
        let track: Vec<Vector> = (sampled.iter())
            .filter_map(|time| target.at(*time).map(|ship| ship.pose.position))
            .collect();
        let stroke = Stroke::solid(target_colour(index), 1.2);
        others.push(curve(&track, false, stroke));
        let places = times.iter().filter_map(|time| target.at(*time));
        let places: Vec<Vector> = places.map(|ship| ship.pose.position).collect();
        others.push(marks(&places, stroke.colour));
    }
    let nearest = targets.iter().min_by(|a, b| {
        // a distance that is no number is a contact
        let [a, b] = [a, b].map(|t| t.least_clearance_m.unwrap_or(f64::NEG_INFINITY));
        a.total_cmp(&b)
    });
    let closest = nearest.and_then(|target| {
        let time = target.least_clearance_t_s;
        Some((target, [own(&time)?, target.at(time)?.pose.position]))
    });
    let closest_line = closest.map(|(_, ends)| curve(&ends, false, CLOSEST));
    let traffic = Traffic {
        track: sampled.iter().filter_map(own).collect(),
        own: times.iter().filter_map(own).collect(),
        times: times.clone(),
        targets: targets.iter().map(|target| target.name.as_str()).collect(),
        area: &|index, time| {
            let (target, ship) = (&targets[index], targets[index].at(time));
            ship.map_or(Vec::new(), |s| {
                target.hull().polygon(&s.pose).vertices().to_vec()
            })
        },
        words: ["track of own ship", "hulls", "hull and track of "],
        dashed: false,
        others: others.into_iter().chain(closest_line).collect(),
    };
    let mut panel = traffic_chart("Sailed", scenario, traffic);
    for time in &times {
        let Some(own) = simulation.own_at(*time).map(|own| own.pose) else {
            continue;
        };
        let label = format!("{} s", seconds(*time));
        let ships: Vec<Pose> = (targets.iter())
            .filter_map(|target| Some(target.at(*time)?.pose))
            .filter(|ship| panel.window().contains(ship.position))
            .collect();
        let apart = |ship: &&Pose| (ship.position - own.position).norm();
        let nearest = (ships.iter()).min_by(|a, b| apart(a).total_cmp(&apart(b)));
        let other = nearest.map_or(own.position, |ship| ship.position);
        panel.note_beside(&label, own.position, side_away(&own, other));
        for ship in &ships {
            panel.note_beside(&label, ship.position, side_away(ship, own.position));
        }
    }
    if let Some((target, _)) = closest {
        let apart = target
            .least_clearance_m
            .filter(|_| target.contact_t_s.is_none());
        let apart = apart.map_or("CONTACT with".to_owned(), |m| format!("{} m to", tenths(m)));
        let (name, time) = (&target.name, target.least_clearance_t_s);
        let label = format!("closest approach: {apart} {name} at {time:.0} s");
        panel.line_key(&label, CLOSEST);
    }
    panel
}

/// The side of a ship that is away from another position, as a unit vector.
fn side_away(ship: &Pose, other: Vector) -> Vector {
    let port = to_port(ship.ahead());
    if port.dot(&(other - ship.position)) > 0.0 {
        -port
    } else {
        port
    }
}
