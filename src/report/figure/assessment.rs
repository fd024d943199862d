//! The figure of an assessment.

use super::field::{self, VelocityWindow, dcpa_panel, risk_panel};
use super::outline::{Stroke, curve, mark};
use super::panel::{AREA, NOTE_SIZE};
use super::sections::{seconds, sections_beside};
use super::{Figure, Panel, Window};
use crate::assessment::Situation;
use crate::frame::Vector;
use crate::obstacle::SpaceTimeObstacle;

/// Velocities shown, of the greatest speed.
const FASTEST: f64 = 1.3;

/// Own ship's track.
const OWN: Stroke = Stroke {
    colour: "#000000",
    width: 1.6,
    dashed: false,
};

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
    name(&mut sections, situation);
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

/// The targets' names beside where they begin, on the side that they leave.
fn name(panel: &mut Panel, situation: &Situation) {
    // a word stands on its line
    let [above, below] = [0.02, 0.045].map(|share| share * panel.window().size().y);
    let [east, north] = [Vector::new(1.0, 0.0), Vector::new(0.0, 1.0)];
    // how wide a letter is and how high a line, about
    let letter = panel.window().size().x * 0.6 * f64::from(NOTE_SIZE) / AREA[0];
    let line = panel.window().size().y * 1.3 * f64::from(NOTE_SIZE) / AREA[1];
    let mut taken: Vec<(Vector, f64)> = Vec::new();
    for target in situation.obstacles {
        let section = target.section(0.0);
        let middle = |n: Vector| 0.5 * (section.support(n) - section.support(-n));
        let rate = |n: Vector| target.support(n, 0.0).rate;
        let northward = rate(north) > rate(-north);
        let height = if northward {
            -section.support(-north) - below
        } else {
            section.support(north) + above
        };
        // away from a name that stands there already
        let half = 0.5 * letter * target.name().chars().count() as f64;
        let way = if northward { -line } else { line };
        let mut at = Vector::new(middle(east), height);
        let meets = |at: Vector, (p, other): &(Vector, f64)| {
            (p.x - at.x).abs() < half + other && (p.y - at.y).abs() < 0.9 * line
        };
        for _ in 0..2 * taken.len() {
            if taken.iter().any(|other| meets(at, other)) {
                at.y += way;
            }
        }
        taken.push((at, half));
        panel.note(target.name(), at);
    }
}
