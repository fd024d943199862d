//! Figure of an assessment.

use super::field::{self, VelocityWindow, dcpa_panel, risk_panel};
use super::outline::mark;
use super::panel::{name_lines, window_around};
use super::plan::{LAND, land_areas};
use super::sections::{seconds, sections_beside};
use super::{Figure, FigureError, FigureOptions, Panel, Stroke, Style};
use crate::frame::Vector;
use crate::labels::Needed;
use crate::obstacle::SpaceTimeObstacle;
use crate::scenario::Land;
use crate::study::assess::OwnSituation;

/// Limit of the velocity panel as a multiple of the maximum speed.
const FASTEST: f64 = 1.3;
const OWN: Stroke = Stroke::solid("#000000", 1.6);
const COLUMNS: usize = 2;

/// Draws the sections at `times` in seconds, dCPA over the velocities, and the risk at each time.
/// Without times: the start, a third, two thirds and the end of the horizon.
pub fn assessment_figure(
    situation: &OwnSituation,
    land: Option<&Land>,
    times: &[f64],
    options: &FigureOptions,
    title: &str,
) -> Result<Figure, FigureError> {
    options.draw(situation.horizon, |style| {
        let figure = Figure::new(COLUMNS, assessment_panels(situation, land, times, style));
        // titles tell the risks apart
        figure.titled(title).with_titles()
    })
}

fn assessment_panels(
    situation: &OwnSituation,
    land: Option<&Land>,
    times: &[f64],
    style: &Style,
) -> Vec<Panel> {
    let thirds: Vec<f64> = (0..4)
        .map(|i| situation.horizon * f64::from(i) / 3.0)
        .collect();
    let times = if times.is_empty() { &thirds[..] } else { times };
    let targets = situation.obstacles;
    let (start, velocity) = (situation.pose.position, situation.velocity());
    let last = times.iter().copied().fold(0.0, f64::max);
    let track = [start, start + velocity * last];
    let mut sections = sections_beside("Sections", targets, times, &track).sized(style.area);
    sections.curve(&track, false, OWN);
    sections.line_key("own course held", OWN);
    name(&mut sections, situation);
    let window = sections.window();
    let inside = sections.inside();
    let areas = || land_areas(land, inside);
    let limit = FASTEST * situation.max_speed.max(situation.speed).max(1.0);
    let velocities = VelocityWindow {
        window: window_around([Vector::repeat(-limit), Vector::repeat(limit)], 0.0),
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
    if style.is_small() {
        panels[1].rename_axes(["East [m/s]", "North [m/s]"]);
    }
    panels[0].plots.splice(0..0, areas());
    if land.is_some() {
        panels[0].area_key("land", LAND, 1.0);
    }
    panels.extend(times.iter().map(|time| {
        let title = format!("Risk at {} s", seconds(*time));
        let mut panel = risk_panel(&title, targets, *time, window);
        // above the colour of no risk
        panel.plots.splice(1..1, areas());
        let now = start + velocity * *time;
        panel.curve(&[start, now], false, OWN_ON_FIELD);
        panel.plots.push(mark(now, field::OWN));
        panel.area_key("own ship, course held", field::OWN, 1.0);
        panel
    }));
    panels
}

const OWN_ON_FIELD: Stroke = Stroke {
    colour: field::OWN,
    ..OWN
};

/// Writes the targets' names beside their first sections.
fn name(panel: &mut Panel, situation: &OwnSituation) {
    for target in situation.obstacles {
        let section = target.section(0.0);
        let reach = |x: f64, y: f64| section.support(Vector::new(x, y));
        let [east, north] = [reach(1.0, 0.0), reach(0.0, 1.0)];
        let [west, south] = [-reach(-1.0, 0.0), -reach(0.0, -1.0)];
        let middle = 0.5 * Vector::new(east + west, north + south);
        let sides = [
            Vector::new(middle.x, north),
            Vector::new(middle.x, south),
            Vector::new(west, middle.y),
            Vector::new(east, middle.y),
        ];
        let name = name_lines(target.name());
        panel.label(
            &sides.map(|side| (name.clone(), side)),
            OWN.colour,
            Needed::Always,
        );
    }
}
