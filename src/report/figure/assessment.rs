//! The figure of an assessment.

use super::field::{self, VelocityWindow, dcpa_panel, risk_panel};
use super::names::{Named, places};
use super::outline::{Stroke, curve, mark};
use super::sections::{seconds, sections_beside};
use super::{Figure, Panel, Window};
use crate::frame::Vector;
use crate::obstacle::SpaceTimeObstacle;
use crate::study::assess::Situation;

/// Velocities shown, of the greatest speed.
const FASTEST: f64 = 1.3;

/// Own ship's track.
const OWN: Stroke = Stroke {
    colour: "#000000",
    width: 1.6,
    dashed: false,
};

/// Points of the track that names keep clear of.
const TRACK: usize = 200;

/// Panels beside one another.
const COLUMNS: usize = 2;

/// Sections at `times`, seconds, dCPA over the velocities, and the risk at every one of the times. Without times: the
/// start, a third, two thirds and the end of the horizon.
pub fn assessment_figure(situation: &Situation, times: &[f64]) -> Figure {
    let thirds: Vec<f64> = (0..4)
        .map(|i| situation.horizon * f64::from(i) / 3.0)
        .collect();
    let times = if times.is_empty() { &thirds[..] } else { times };
    let targets = situation.obstacles;
    let (start, velocity) = (situation.pose.position, situation.velocity());
    let last = times.iter().copied().fold(0.0, f64::max);
    let track = [start, start + velocity * last];
    let mut sections = sections_beside("Sections", targets, times, &track);
    sections.plots.push(curve(&track, false, OWN));
    sections.line_key("own course held", OWN);
    name(&mut sections, situation, track);
    let window = sections.window();
    let limit = FASTEST * situation.max_speed.max(situation.speed).max(1.0);
    let velocities = VelocityWindow {
        window: Window::around([Vector::repeat(-limit), Vector::repeat(limit)], 0.0),
        own: Some(velocity),
    };
    let mut panels = vec![
        sections,
        dcpa_panel(
            "dCPA, velocity obstacle",
            targets,
            start,
            situation.horizon,
            &velocities,
        ),
    ];
    panels.extend(times.iter().map(|time| {
        let title = format!("Risk at {} s", seconds(*time));
        let mut panel = risk_panel(&title, targets, *time, window);
        let now = start + velocity * *time;
        panel.plots.push(curve(&[start, now], false, OWN_ON_FIELD));
        panel.plots.push(mark(now, field::OWN));
        panel.point_key("own ship, course held", field::OWN);
        panel
    }));
    Figure::new(COLUMNS, panels)
}

/// The same on dark.
const OWN_ON_FIELD: Stroke = Stroke {
    colour: field::OWN,
    ..OWN
};

/// The targets' names beside where they begin, rather on the side that they leave.
fn name(panel: &mut Panel, situation: &Situation, track: [Vector; 2]) {
    let [east, north] = [Vector::new(1.0, 0.0), Vector::new(0.0, 1.0)];
    let named = situation.obstacles.iter().map(|target| {
        let section = target.section(0.0);
        let rate = |n: Vector| target.support(n, 0.0).rate;
        Named {
            name: target.name(),
            extent: Window {
                low: -Vector::new(section.support(-east), section.support(-north)),
                high: Vector::new(section.support(east), section.support(north)),
            },
            below: rate(north) > rate(-north),
        }
    });
    let named: Vec<Named> = named.collect();
    let along = |k: usize| track[0].lerp(&track[1], k as f64 / TRACK as f64);
    let track: Vec<Vector> = (0..=TRACK).map(along).collect();
    for (set, at) in named.iter().zip(places(panel.window(), &named, &track)) {
        panel.note(set.name, at);
    }
}
