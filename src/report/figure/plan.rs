//! Figure of a plan: the chart, the diagram of a path-time plan, and the forces of a plan under
//! forces.

use kuva::render::plots::Plot;

use super::forces::force_panels;
use super::outline::{area, curve, mark, sampled_boundary};
use super::panel::window_around;
use super::path_time::{run_panel, target_colour};
use super::sections::{PLAN, seconds, seconds_list, sections_beside};
use super::{Figure, Panel, Stroke};
use crate::document;
use crate::evaluation::Safety;
use crate::frame::Vector;
use crate::geometry::{ConvexPolygon, Window};
use crate::obstacle::{Obstacle, SpaceTimeObstacle};
use crate::pipeline::Run;
use crate::planner::EdgeVerdict;
use crate::scenario::{Land, Scenario};
use crate::trajectory::Trajectory;

/// Stroke of the desired trajectory.
pub(super) const DESIRED: Stroke = Stroke::dashed("#777777", 1.4);

/// Stroke of the planned trajectory.
pub(super) const PLANNED: Stroke = Stroke::solid("#000000", 2.4);

/// Stroke of alternative paths.
const ALTERNATIVE: Stroke = Stroke::solid("#b0b0b0", 1.4);

/// Stroke of motions found by a search.
const FOUND: Stroke = Stroke::solid("#009e73", 0.8);

/// Colour of land.
pub(super) const LAND: &str = "#d9cba3";

/// Outline of land.
const LAND_OUTLINE: Stroke = Stroke::solid(LAND, 0.8);

/// Most instants after the start at which the sets are drawn.
pub(super) const INSTANTS: f64 = 4.0;

/// Least distance between the times of two sets, as a fraction of the width of the chart.
const LABELS_APART: f64 = 0.04;

/// Seconds between instants that are drawn.
const INTERVALS: [f64; 13] = [
    5.0, 10.0, 20.0, 30.0, 60.0, 120.0, 300.0, 600.0, 900.0, 1200.0, 1800.0, 3600.0, 7200.0,
];

/// Round times from 0 to `end` seconds, at most `most` of them after the start.
pub(super) fn round_times(end: f64, most: f64) -> Vec<f64> {
    let interval = INTERVALS.into_iter().find(|i| end <= most * i);
    let interval = interval.unwrap_or(end / most);
    (0..=(end / interval) as usize)
        .map(|k| k as f64 * interval)
        .collect()
}

/// Time step of a curve in seconds, and the maximum number of points besides its joints.
const STEP: f64 = 1.0;
const MOST_POINTS: u32 = 5_000;

/// Draws the chart of a run, with its path-time diagram or its velocities and forces if present.
/// The title is that of the scenario; it marks a plan that is not safe.
pub fn plan_figure(run: &Run) -> Figure {
    let title = match run.safety() {
        None | Some(Safety::Safe) => run.scenario.title.clone(),
        Some(_) => run.headline(),
    };
    Figure::new(2, plan_panels(run)).titled(&title)
}

/// Panels of [`plan_figure`].
pub fn plan_panels(run: &Run) -> Vec<Panel> {
    let scenario = &run.scenario;
    let plan = run.planned.outcome.plan();
    let mut panels = vec![chart_panel("Chart", run)];
    if let Some(motion) = plan.and_then(|plan| plan.trajectory.steered()) {
        panels.extend(force_panels(motion));
    }
    if let Some(diagram) = run.planned.path_time.as_deref() {
        let title = if scenario.alternatives.is_empty() {
            "Path and time".to_owned()
        } else {
            format!("Path and time: {}", document::paths(diagram))
        };
        panels.extend(run_panel(&title, run, "planned", PLANNED));
    }
    panels
}

/// Draws sections of obstacles at `times` in seconds, and a path with waypoints in metres.
pub fn path_panel(title: &str, obstacles: &[Obstacle], times: &[f64], path: &[Vector]) -> Panel {
    let mut panel = sections_beside(title, obstacles, times, path);
    panel.curve(path, false, PLANNED);
    panel.line_key("path", PLANNED);
    panel
}

/// Draws the desired and the planned trajectory. Sets are drawn at several times, with own ship's
/// position at the same time.
pub fn chart_panel(title: &str, run: &Run) -> Panel {
    chart(title, run, Vec::new())
}

/// Draws the chart with `others` above the sets and below the plan.
fn chart(title: &str, run: &Run, others: Vec<Plot>) -> Panel {
    let trajectory = run.planned.outcome.plan().map(|plan| &plan.trajectory);
    let desired = run.scenario.desired.duration();
    let end = trajectory.map_or(desired, |t| t.end_time());
    let end = end.min(run.scenario.horizon);
    let times = round_times(end, INSTANTS);
    let at = |t: &Trajectory, time: f64| t.pose_at(time).position;
    let sampled = trajectory.map(|t| t.sample_times(STEP, MOST_POINTS));
    let track = trajectory.zip(sampled);
    let track = track.map(|(t, sampled)| sampled.into_iter().map(|time| at(t, time)).collect());
    let own = trajectory.map(|t| times.iter().map(|time| at(t, *time)).collect());
    let obstacles: Vec<&Obstacle> = run.obstacles().collect();
    let own: Vec<Vector> = own.unwrap_or_default();
    let traffic = Traffic {
        track: track.unwrap_or_default(),
        own: own.clone(),
        times: times.clone(),
        targets: obstacles.iter().map(|o| o.name()).collect(),
        area: &|target, time| sampled_boundary(&obstacles[target].section(time)),
        words: ["planned", "sets", "set of "],
        dashed: true,
        others,
    };
    let mut panel = traffic_chart(title, &run.scenario, traffic);
    let apart = LABELS_APART * panel.window().size().x;
    let mut labelled: Vec<Vector> = Vec::new();
    for (k, time) in times.iter().enumerate() {
        let label = format!("{} s", seconds(*time));
        let sections = obstacles
            .iter()
            .map(|o| middle(&sampled_boundary(&o.section(*time))));
        let sections: Vec<Vector> = sections.filter(|p| panel.window().contains(*p)).collect();
        if let Some(own) = own.get(k) {
            let distance = |p: &&Vector| (**p - own).norm();
            let nearest = sections
                .iter()
                .min_by(|a, b| distance(a).total_cmp(&distance(b)));
            // above or below, so that no frame cuts it
            let north = nearest.map_or(1.0, |p| (own.y - p.y).signum());
            panel.note_beside(&label, *own, Vector::new(0.0, north));
            labelled.push(*own);
        }
        for section in sections {
            // a set that hardly moves is named once
            if labelled.iter().all(|p| (p - section).norm() > apart) {
                panel.note(&label, section);
                labelled.push(section);
            }
        }
    }
    panel
}

/// Mean of the points of a boundary.
fn middle(boundary: &[Vector]) -> Vector {
    boundary.iter().sum::<Vector>() / boundary.len() as f64
}

/// Own ship's track and the area of each target at the same times.
pub(super) struct Traffic<'a> {
    /// Own ship's track; empty without one.
    pub track: Vec<Vector>,
    /// Times in seconds.
    pub times: Vec<f64>,
    /// Own ship's positions at these times; empty without a track.
    pub own: Vec<Vector>,
    /// Names of the targets.
    pub targets: Vec<&'a str>,
    /// Boundary of a target's area, by its index, at a time.
    pub area: &'a dyn Fn(usize, f64) -> Vec<Vector>,
    /// Legend: the track, all areas, the area of one target.
    pub words: [&'static str; 3],
    /// True where areas after the first time are dashed.
    pub dashed: bool,
    /// Drawn above the areas and below own ship.
    pub others: Vec<Plot>,
}

/// Draws the mission, land, the targets and own ship.
pub(super) fn traffic_chart(title: &str, scenario: &Scenario, traffic: Traffic) -> Panel {
    let [sailed, all, area_of] = traffic.words;
    let waypoints = scenario.desired.waypoints();
    let paths = scenario.alternatives.iter().flatten();
    let mut shown: Vec<Vector> = (waypoints.iter().chain(&traffic.track).chain(paths))
        .copied()
        .collect();
    let reach = window_around(shown.iter().copied(), 0.3);
    // distant areas are clipped
    let within = |p: &Vector| reach.contains(*p);
    let mut areas: Vec<(usize, usize, Vec<Vector>)> = Vec::new();
    for index in 0..traffic.targets.len() {
        for (k, time) in traffic.times.iter().enumerate() {
            let boundary = (traffic.area)(index, *time);
            if boundary.iter().any(within) {
                shown.extend(boundary.iter().copied().filter(within));
                areas.push((index, k, boundary));
            }
        }
    }
    let mut panel = Panel::plan(title.to_owned(), PLAN, window_around(shown, 0.06));
    let land = scenario.land.as_ref();
    panel.plots.extend(land_areas(land, panel.window()));
    for (index, k, boundary) in &areas {
        let colour = target_colour(*index);
        let opacity = 0.10 + 0.30 * (1.0 - *k as f64 / traffic.times.len() as f64);
        panel.fill_hull(boundary, colour, opacity);
        let outline = Stroke {
            dashed: traffic.dashed && *k > 0,
            ..Stroke::solid(colour, 1.0)
        };
        panel.curve(boundary, true, outline);
    }
    for path in &scenario.alternatives {
        panel.curve(path, false, ALTERNATIVE);
    }
    panel.plots.extend(traffic.others);
    panel.curve(&waypoints, false, DESIRED);
    if !traffic.track.is_empty() {
        panel.curve(&traffic.track, false, PLANNED);
        for at in &traffic.own {
            panel.plots.push(mark(*at, PLANNED.colour));
        }
        panel.line_key(sailed, PLANNED);
        let list = seconds_list(&traffic.times);
        let label = format!("own ship, and {all}, at {list} s");
        panel.point_key(&label, PLANNED.colour);
    }
    panel.line_key("desired", DESIRED);
    if land.is_some() {
        panel.line_key("land", Stroke::solid(LAND, 3.0));
    }
    for (index, name) in traffic.targets.iter().enumerate() {
        let stroke = Stroke::solid(target_colour(index), 3.0);
        panel.line_key(&format!("{area_of}{name}"), stroke);
    }
    panel
}

/// Chart of a run of the space-time planner with every collision-free motion found by its search.
pub fn explored_panel(title: &str, run: &Run) -> Panel {
    let edges = run.planned.explored.edge_weights();
    let free = edges.filter(|edge| edge.verdict == EdgeVerdict::Free);
    let ways = free.filter_map(|edge| {
        let trajectory = Trajectory::new(edge.segments.clone()).ok()?;
        let times = trajectory.sample_times(STEP, MOST_POINTS).into_iter();
        let way: Vec<Vector> = times.map(|t| trajectory.pose_at(t).position).collect();
        Some(curve(&way, false, FOUND))
    });
    let mut panel = chart(title, run, ways.collect());
    panel.line_key("found clear of all sets", FOUND);
    panel
}

/// Filled land within a window, piece by piece. Each piece has an outline, to hide gaps between
/// adjacent pieces.
pub(super) fn land_areas(land: Option<&Land>, window: Window) -> Vec<Plot> {
    land.into_iter()
        .flat_map(|land| land.map.pieces_within(&window))
        .filter_map(|piece| ConvexPolygon::hull(&window.part_of(piece)).ok())
        .filter_map(|piece| {
            let outline = curve(piece.vertices(), true, LAND_OUTLINE);
            area(&piece, LAND, 1.0).map(|filled| [filled, outline])
        })
        .flatten()
        .collect()
}
