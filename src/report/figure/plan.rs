//! Figure of a plan: the chart, the diagram of a path-time plan, and the forces of a plan under
//! forces.

use kuva::render::plots::Plot;

use super::forces::force_panels;
use super::outline::{area, curve, sampled_boundary};
use super::panel::{AREA, window_around};
use super::path_time::{run_panel, target_colour};
use super::render::shortened;
use super::sections::{PLAN, minutes, sections_beside};
use super::{Figure, FigureError, FigureOptions, Panel, Stroke, Style};
use crate::colregs::Role;
use crate::document::{self, PlanDocument};
use crate::frame::{Pose, Vector};
use crate::geometry::{ConvexPolygon, Window};
use crate::obstacle::Obstacle;
use crate::pipeline::Run;
use crate::planner::EdgeVerdict;
use crate::scenario::{Land, Scenario};
use crate::text::tenths;
use crate::trajectory::Trajectory;
use crate::vessel::Hull;

pub(super) const DESIRED: Stroke = Stroke::dashed("#777777", 1.4);
pub(super) const PLANNED: Stroke = Stroke::solid("#000000", 2.4);

/// Stroke between the centres of the hulls at the closest approach.
const CLOSEST: Stroke = Stroke::solid("#b3001b", 1.6);
const ALTERNATIVE: Stroke = Stroke::solid("#b0b0b0", 1.4);
const FOUND: Stroke = Stroke::solid("#009e73", 0.8);
pub(super) const LAND: &str = "#d9cba3";
const LAND_OUTLINE: Stroke = Stroke::solid(LAND, 0.8);

const OTHER_SETS: Stroke = Stroke::dashed("#777777", 0.8);

/// Most letters of a name beside a ship.
const NAME_LETTERS: usize = 14;

/// Least interval between a round time and the closest approach, as a fraction of the interval
/// between round times.
const TIMES_APART: f64 = 0.25;

/// Most instants after the start at which the sets are drawn.
pub(super) const INSTANTS: f64 = 4.0;

/// Least distance between two ships with a time each, as a fraction of the width of the chart.
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

/// The times that a chart marks: those asked for, or round ones, and the closest approach; and the
/// index of the closest approach, of 0 without one.
pub(super) fn marked_times(
    style: &Style,
    end: f64,
    most: f64,
    closest: Option<f64>,
) -> (Vec<f64>, usize) {
    let asked = !style.times.is_empty();
    let mut times = match asked {
        true => style.times.clone(),
        // a small chart has room for fewer
        false => round_times(end, most * (style.area[0] / AREA[0]).clamp(0.5, 1.0)),
    };
    let Some(closest) = closest.filter(|time| time.is_finite()) else {
        return (times, 0);
    };
    let apart = match (asked, &times[..]) {
        (false, [first, second, ..]) => TIMES_APART * (second - first),
        _ => 0.0,
    };
    // hulls on one another hide which is which; the start stays
    times.retain(|time| *time != closest && (*time == 0.0 || (time - closest).abs() > apart));
    let place = times.partition_point(|time| *time < closest);
    times.insert(place, closest);
    (times, place)
}

/// Time step of a curve in seconds, and the maximum number of points besides its joints.
const STEP: f64 = 1.0;
const MOST_POINTS: u32 = 5_000;

/// Draws the chart of a run, with its path-time diagram or its velocities and forces if present.
/// The title is that of the scenario; the verdict is above the chart.
pub fn plan_figure(
    run: &Run,
    document: &PlanDocument,
    options: &FigureOptions,
) -> Result<Figure, FigureError> {
    options.draw(end(run), |style| {
        Figure::new(2, plan_panels(run, document, style)).titled(&run.scenario.title)
    })
}

/// Time in seconds at which a chart ends: that of the plan, or of the desired trajectory.
fn end(run: &Run) -> f64 {
    let plan = run.planned.outcome.plan();
    let end = plan.map_or(run.scenario.desired.duration(), |p| p.trajectory.end_time());
    end.min(run.scenario.horizon)
}

/// Panels of [`plan_figure`].
pub(in crate::report) fn plan_panels(
    run: &Run,
    document: &PlanDocument,
    style: &Style,
) -> Vec<Panel> {
    let scenario = &run.scenario;
    let plan = run.planned.outcome.plan();
    let mut panels = vec![chart(
        &document::verdict_line(document),
        run,
        style,
        Vec::new(),
    )];
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
    chart(title, run, &Style::default(), Vec::new())
}

/// Draws the chart with `others` above the sets and below the plan.
fn chart(title: &str, run: &Run, style: &Style, others: Vec<Plot>) -> Panel {
    let scenario = &run.scenario;
    let trajectory = run.planned.outcome.plan().map(|plan| &plan.trajectory);
    let end = end(run);
    let passages = run.evaluation.iter().flat_map(|judged| &judged.passages);
    let nearest = passages
        .zip(&scenario.targets)
        .min_by(|(a, _), (b, _)| a.dcpa.total_cmp(&b.dcpa));
    let tcpa = nearest.map(|(passage, _)| passage.tcpa);
    let (times, filled) = marked_times(style, end, INSTANTS, tcpa);
    let sampled = match trajectory {
        Some(trajectory) => trajectory.sample_times(STEP, MOST_POINTS),
        None => vec![0.0, end],
    };
    let obstacles: Vec<&Obstacle> = run.obstacles().collect();
    let targets = scenario.targets.iter().zip(&obstacles).zip(&run.targets);
    let targets = targets.map(|((target, obstacle), outcome)| Charted {
        name: target.name.clone(),
        key: match outcome.sets.encounter.role {
            Role::None => format!("{}: nominal track", target.name),
            role => format!("{}, {}: nominal track", target.name, role.word()),
        },
        hull: target.ship().map(|ship| ship.hull),
        track: sampled
            .iter()
            .map(|time| target.position_at(*time))
            .collect(),
        poses: (times.iter())
            .map(|time| target.ship().map(|ship| ship.pose_at(*time)))
            .collect(),
        areas: (times.iter())
            .map(|time| sampled_boundary(&obstacle.section(*time)))
            .collect(),
    });
    let targets: Vec<Charted> = targets.collect();
    let pose = |time: &f64| trajectory.map(|t| t.pose_at(*time));
    let closest = nearest.and_then(|(passage, target)| {
        let ends = [
            pose(&passage.tcpa)?.position,
            target.position_at(passage.tcpa),
        ];
        let (apart, time) = (tenths(passage.dcpa), passage.tcpa);
        let label = format!(
            "closest approach: {apart} m to {} at {}",
            target.name,
            minutes(time)
        );
        Some((ends, label))
    });
    let traffic = Traffic {
        own: times.iter().filter_map(pose).collect(),
        track: (sampled.iter().filter_map(pose))
            .map(|pose| pose.position)
            .collect(),
        times,
        filled,
        targets,
        planned: "planned",
        closest,
        others,
    };
    traffic_chart(title, scenario, style, traffic)
}

pub(super) struct Charted {
    /// Its name.
    pub name: String,
    /// The words of the legend.
    pub key: String,
    /// Its hull, if it has one.
    pub hull: Option<Hull>,
    /// Its track, which may be empty.
    pub track: Vec<Vector>,
    /// Where it is at each of the times, if it is known.
    pub poses: Vec<Option<Pose>>,
    /// The boundary of its set at each of the times; empty without one.
    pub areas: Vec<Vec<Vector>>,
}

/// Own ship and the targets at the same times, as a chart shows them.
pub(super) struct Traffic {
    /// Own ship's track; empty without one.
    pub track: Vec<Vector>,
    /// Times in seconds.
    pub times: Vec<f64>,
    /// The one of these times whose sets are filled; those of other times are outlined.
    pub filled: usize,
    /// Own ship at these times; empty without a track.
    pub own: Vec<Pose>,
    pub targets: Vec<Charted>,
    /// The legend's word for own ship's track.
    pub planned: &'static str,
    /// Where own ship and a target are closest, and the words of the legend.
    pub closest: Option<([Vector; 2], String)>,
    /// Drawn above the areas and below own ship.
    pub others: Vec<Plot>,
}

/// Draws the mission, land, the targets and own ship, with the times beside the ships.
pub(super) fn traffic_chart(
    title: &str,
    scenario: &Scenario,
    style: &Style,
    traffic: Traffic,
) -> Panel {
    let waypoints = scenario.desired.waypoints();
    let paths = scenario.alternatives.iter().flatten();
    let mut shown: Vec<Vector> = (waypoints.iter().chain(&traffic.track).chain(paths))
        .copied()
        .collect();
    let reach = window_around(shown.iter().copied(), 0.3);
    // distant areas and ships are clipped
    let within = |p: &Vector| reach.contains(*p);
    for target in &traffic.targets {
        let areas = target.areas.iter().filter(|area| area.iter().any(within));
        shown.extend(areas.flatten().copied().filter(within));
        let places = target.poses.iter().flatten().map(|pose| pose.position);
        shown.extend(places.filter(within));
    }
    let mut panel =
        Panel::plan(title.to_owned(), PLAN, window_around(shown, 0.09)).sized(style.area);
    let window = panel.window();
    let land = scenario.land.as_ref();
    panel.plots.extend(land_areas(land, window));
    for (index, target) in traffic.targets.iter().enumerate() {
        let colour = target_colour(index);
        for (k, area) in target.areas.iter().enumerate() {
            // sets of other times are no place that own ship has to avoid at this one
            if k == traffic.filled {
                panel.fill_hull(area, colour, 0.25);
                panel.curve(area, true, Stroke::solid(colour, 1.0));
            } else {
                panel
                    .plots
                    .push(curve(area, true, Stroke::dashed(colour, 0.5)));
            }
        }
    }
    for path in &scenario.alternatives {
        panel.curve(path, false, ALTERNATIVE);
    }
    panel.plots.extend(traffic.others);
    panel.curve(&waypoints, false, DESIRED);
    for (index, target) in traffic.targets.iter().enumerate() {
        panel.curve(
            &target.track,
            false,
            Stroke::solid(target_colour(index), 1.2),
        );
    }
    if let Some((ends, _)) = &traffic.closest {
        panel.curve(ends, false, CLOSEST);
    }
    panel.curve(&traffic.track, false, PLANNED);
    let times: Vec<String> = traffic.times.iter().map(|time| minutes(*time)).collect();
    // with several targets their numbers stand before the times
    let number = |index: usize| match traffic.targets.len() {
        1 => String::new(),
        _ => format!("{}: ", index + 1),
    };
    // the first place of a ship has its name, too
    let named = |k: usize, name: &str, number: &str, time: &str| match k {
        0 => format!("{number}{}, {time}", shortened(name, NAME_LETTERS)),
        _ => format!("{number}{time}"),
    };
    let mut labels: Vec<(String, Vector)> = Vec::new();
    for (k, (pose, time)) in traffic.own.iter().zip(&times).enumerate() {
        panel.ship(&scenario.own_ship.hull, pose, PLANNED.colour);
        labels.push((named(k, "own ship", "", time), pose.position));
    }
    for (index, target) in traffic.targets.iter().enumerate() {
        for (k, (place, time)) in target.poses.iter().zip(&times).enumerate() {
            let place = match (place, target.hull, target.areas.get(k)) {
                (Some(pose), Some(hull), _) => {
                    panel.ship(&hull, pose, target_colour(index));
                    pose.position
                }
                (_, _, Some(area)) if !area.is_empty() => middle(area),
                _ => continue,
            };
            if window.contains(place) {
                labels.push((named(k, &target.name, &number(index), time), place));
            }
        }
    }
    // a ship that hardly moves is named once, own ship first
    let apart = LABELS_APART * window.size().x;
    let mut labelled: Vec<Vector> = Vec::new();
    for (label, place) in labels {
        if labelled.iter().all(|p| (p - place).norm() > apart) {
            panel.label(&label, place);
            labelled.push(place);
        }
    }
    if !traffic.track.is_empty() {
        panel.line_key(&format!("own ship, {}", traffic.planned), PLANNED);
    }
    panel.line_key("desired", DESIRED);
    if land.is_some() {
        panel.line_key("land", Stroke::solid(LAND, 3.0));
    }
    for (index, target) in traffic.targets.iter().enumerate() {
        let stroke = Stroke::solid(target_colour(index), 3.0);
        let places = target.poses.iter().flatten().map(|pose| pose.position);
        let all = target.areas.iter().flatten().copied().chain(places);
        let place = match all.into_iter().any(|place| window.contains(place)) {
            true => "",
            false => ", outside the chart",
        };
        panel.line_key(&format!("{}{}{place}", number(index), target.key), stroke);
    }
    if let Some((_, label)) = &traffic.closest {
        panel.line_key(label, CLOSEST);
    }
    let sets = |target: &Charted| {
        target
            .areas
            .get(traffic.filled)
            .is_some_and(|a| !a.is_empty())
    };
    if traffic.targets.iter().any(sets) {
        let now = &times[traffic.filled];
        panel.line_key(&format!("sets: filled at {now}, else dashed"), OTHER_SETS);
    }
    panel
}

fn middle(boundary: &[Vector]) -> Vector {
    boundary.iter().sum::<Vector>() / boundary.len() as f64
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
    let mut panel = chart(title, run, &Style::default(), ways.collect());
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
