//! Path-time diagram: distance along the path horizontally, time vertically, paper figures 5b and
//! 6b.

use super::{Panel, Stroke};
use crate::frame::Vector;
use crate::geometry::Window;
use crate::obstacle::{PathTime, SpaceTimeObstacle};
use crate::pipeline::Run;
use crate::planner::path_time::PathTimeDiagram;

const JOINT: Stroke = Stroke::dashed("#bbbbbb", 0.8);

/// Colours of successive targets; they also differ in lightness.
const COLOURS: [&str; 12] = [
    "#d55e00", "#0072b2", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#8c6d31", "#6a3d9a",
    "#9aa800", "#e7298a", "#1b4f3f", "#7a3b2e",
];

/// Time shown after the last arrival, as a fraction of the time until then.
const AFTER: f64 = 0.2;

pub(super) fn target_colour(index: usize) -> &'static str {
    COLOURS[index % COLOURS.len()]
}

/// Profile to draw.
pub struct ProfileLine<'a> {
    /// Label in the legend.
    pub label: String,
    /// Diagram in which the profile was planned.
    pub diagram: &'a PathTimeDiagram,
    /// Stroke of the profile.
    pub stroke: Stroke,
}

/// Draws the diagram of a run, if it has one; `planned` is the label of its profile.
pub(super) fn run_panel(title: &str, run: &Run, planned: &str, stroke: Stroke) -> Option<Panel> {
    let names: Vec<&str> = run.obstacles().map(|o| o.name()).collect();
    let plan = run.planned.outcome.plan();
    let line = ProfileLine {
        label: plan.map_or("no plan", |_| planned).to_owned(),
        diagram: run.planned.path_time.as_deref()?,
        stroke,
    };
    Some(path_time_panel(title, &names, &[line]))
}

/// Draws the obstacles of the first diagram, filled, and all profiles. `names` are the obstacle
/// names by index. Without a plan, the time axis extends to the horizon.
pub fn path_time_panel(title: &str, names: &[&str], profiles: &[ProfileLine]) -> Panel {
    let point = |p: &PathTime| Vector::new(p.distance, p.time);
    let arrival = profiles
        .iter()
        .filter(|line| line.diagram.profile.len() > 1)
        .filter_map(|line| line.diagram.profile.last())
        .map(|last| last.time)
        .fold(0.0, f64::max);
    let diagram = profiles.first().map(|line| line.diagram);
    let horizon = diagram.map_or(1.0, |d| d.horizon);
    let top = if arrival > 0.0 {
        (arrival * (1.0 + AFTER)).min(horizon)
    } else {
        horizon
    };
    let window = Window::new(
        Vector::zeros(),
        Vector::new(diagram.map_or(1.0, PathTimeDiagram::length), top),
    );
    let axes = ["Distance along the path [m]", "Time [s]"];
    let mut panel = Panel::free(title.to_owned(), axes, window);
    let mut named: Vec<usize> = Vec::new();
    for seen in diagram.iter().flat_map(|d| &d.obstacles) {
        let corners: Vec<Vector> = seen.corners.iter().map(point).collect();
        let colour = target_colour(seen.obstacle);
        panel.fill_hull(&corners, colour, 0.35);
        panel.curve(&corners, true, Stroke::solid(colour, 1.0));
        if corners.iter().any(|c| c.y < top) {
            named.push(seen.obstacle);
        }
    }
    for leg in diagram.iter().flat_map(|d| &d.legs).skip(1) {
        let line = [Vector::new(leg.begin, 0.0), Vector::new(leg.begin, top)];
        panel.curve(&line, false, JOINT);
    }
    for line in profiles {
        let points: Vec<Vector> = line.diagram.profile.iter().map(point).collect();
        panel.curve(&points, false, line.stroke);
        panel.line_key(&line.label, line.stroke);
    }
    named.sort_unstable();
    named.dedup();
    for index in named {
        let name = names.get(index).copied().unwrap_or_default();
        panel.area_key(name, target_colour(index), 0.35);
    }
    panel
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Measures by the formula "redmean", in which black and white are 765 apart.
    #[test]
    fn colours_of_targets_are_distinguishable() {
        let parts = |colour: &str| {
            [1, 3, 5].map(|at| u8::from_str_radix(&colour[at..at + 2], 16).expect("hexadecimal"))
        };
        let apart = |a: &str, b: &str| {
            let [a, b] = [a, b].map(|colour| parts(colour).map(f64::from));
            let [r, g, b2] = [0, 1, 2].map(|i| (a[i] - b[i]).powi(2));
            let red = 0.5 * (a[0] + b[0]) / 256.0;
            ((2.0 + red) * r + 4.0 * g + (3.0 - red) * b2).sqrt()
        };
        for (index, colour) in COLOURS.iter().enumerate() {
            for other in COLOURS[..index].iter().chain(&["#ffffff", "#000000"]) {
                assert!(apart(colour, other) > 100.0, "{colour} {other}");
            }
        }
    }
}
