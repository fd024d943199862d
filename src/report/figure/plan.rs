//! Figure of a plan: the chart, the diagram of a path-time plan, and the forces of a plan under
//! forces.

use kuva::render::plots::Plot;

use super::forces::force_panels;
use super::outline::{area, curve, sampled_boundary};
use super::panel::{AREA, LETTERS, window_around};
use super::path_time::{run_panel, target_colour};
use super::render::shortened;
use super::sections::{PLAN, minutes, sections_beside};
use super::{Figure, FigureError, FigureOptions, Panel, Stroke, Style};
use crate::document::{self, PlanDocument};
use crate::frame::{Pose, Vector};
use crate::geometry::{ConvexPolygon, Window};
use crate::obstacle::Obstacle;
use crate::pipeline::Run;
use crate::planner::EdgeVerdict;
use crate::scenario::{Land, Scenario};
use crate::text::significant;
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

pub(super) const OTHER_SETS: Stroke = Stroke::dashed("#777777", 0.8);

/// Opacity of a filled set, of the hard set in it, and of both.
pub(super) const FILLED: f64 = 0.25;
const HARD: f64 = 0.35;
const BOTH: f64 = 1.0 - (1.0 - FILLED) * (1.0 - HARD);

/// Margin of a chart, and the reach in which it shows sets, as fractions of own ship's tracks.
const AIR: f64 = 0.07;
const REACH: f64 = 0.3;

/// Interval in seconds to which the times of panels are rounded.
const ROUND: f64 = 10.0;

/// Most letters of a name beside a ship.
pub(super) const NAME_LETTERS: usize = 14;

/// Targets outside the chart that the legend names.
const MOST_OUTSIDE: usize = 4;

/// Least interval between a round time and the closest approach, as a fraction of the interval
/// between round times.
const TIMES_APART: f64 = 0.25;

/// Most instants after the start at which the sets are drawn.
const INSTANTS: f64 = 4.0;

/// Least distance between two ships with a time each, as a fraction of the width of the chart.
const LABELS_APART: f64 = 0.04;

/// Seconds between instants that are drawn.
const INTERVALS: [f64; 13] = [
    5.0, 10.0, 20.0, 30.0, 60.0, 120.0, 300.0, 600.0, 900.0, 1200.0, 1800.0, 3600.0, 7200.0,
];

/// Round times from 0 to `end` seconds, at most `most` of them after the start.
fn round_times(end: f64, most: f64) -> Vec<f64> {
    let interval = INTERVALS.into_iter().find(|i| end <= most * i);
    let interval = interval.unwrap_or(end / most);
    (0..=(end / interval) as usize)
        .map(|k| k as f64 * interval)
        .collect()
}

/// The times that a chart marks: those asked for, or round ones, and the closest approach; and the
/// index of the closest approach, of 0 without one. For panels: those asked for, or the start, the
/// closest approach, the end and the middles between them; the index is beyond them without one.
pub(super) fn marked_times(
    style: &Style,
    end: f64,
    most: f64,
    closest: Option<f64>,
) -> (Vec<f64>, usize) {
    let asked = !style.times.is_empty();
    let closest = closest.filter(|time| time.is_finite());
    if style.panels {
        let middle = closest.unwrap_or(0.5 * end);
        let round = |time: f64| (time / ROUND).round() * ROUND;
        let mut times = match asked {
            true => style.times.clone(),
            false => vec![
                0.0,
                round(0.5 * middle),
                middle,
                round(0.5 * (middle + end)).min(end),
            ],
        };
        times.sort_by(f64::total_cmp);
        times.dedup();
        let is_closest = |time: &f64| closest.is_some_and(|c| minutes(c) == minutes(*time));
        let place = times.iter().position(is_closest);
        return (times.clone(), place.unwrap_or(times.len()));
    }
    let mut times = match asked {
        true => style.times.clone(),
        // a small chart has room for fewer
        false => round_times(end, most * (style.area[0] / AREA[0]).clamp(0.5, 1.0)),
    };
    let Some(closest) = closest else {
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

/// Draws the chart of a run, with its path-time diagram or its velocities and forces if present, or
/// a chart for each of several times. The title is that of the scenario; the verdict is above the
/// chart.
pub fn plan_figure(
    run: &Run,
    document: &PlanDocument,
    options: &FigureOptions,
) -> Result<Figure, FigureError> {
    options.draw(end(run), |style| {
        let figure = if style.panels {
            moments(&run.scenario, style, &traffic(run, style))
        } else {
            Figure::new(2, plan_panels(run, document, style))
        };
        figure.titled(&run.scenario.title)
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
    let mut title = document::verdict_line(document);
    if let Some(departure) = document.departure_of_motion() {
        let headlines = [departure.to_string(), departure.brief()];
        let mut headlines = headlines.map(|text| format!("{title}: {text}")).into_iter();
        let fits = |headline: &String| headline.chars().count() <= LETTERS;
        title = headlines.find(fits).unwrap_or(title);
    }
    let mut panels = vec![chart(&title, run, style, Vec::new())];
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
    let traffic = traffic(run, style);
    traffic_chart(title, &run.scenario, style, &traffic, None, others)
}

/// Own ship of a run and its targets.
fn traffic(run: &Run, style: &Style) -> Traffic {
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
    let sections = |set: &Obstacle| -> Vec<Vec<Vector>> {
        let section = |time: &f64| sampled_boundary(&set.section(*time));
        times.iter().map(section).collect()
    };
    let targets = scenario.targets.iter().zip(&run.targets);
    let targets = targets.map(|(target, sets)| Charted {
        name: target.name.clone(),
        hull: target.ship().map(|ship| ship.hull),
        track: sampled
            .iter()
            .map(|time| target.position_at(*time))
            .collect(),
        poses: (times.iter())
            .map(|time| target.ship().map(|ship| ship.pose_at(*time)))
            .collect(),
        areas: sections(&sets.obstacle),
        hard: match sets.obstacle.sets() == sets.sets.hard.sets() {
            true => Vec::new(),
            false => sections(&sets.sets.hard),
        },
    });
    let targets: Vec<Charted> = targets.collect();
    let pose = |time: &f64| trajectory.map(|t| t.pose_at(*time));
    let closest = nearest.and_then(|(passage, target)| {
        let ends = [
            pose(&passage.tcpa)?.position,
            target.position_at(passage.tcpa),
        ];
        Some((ends, format!("{} m", significant(passage.dcpa))))
    });
    Traffic {
        own: times.iter().filter_map(pose).collect(),
        track: (sampled.iter().filter_map(pose))
            .map(|pose| pose.position)
            .collect(),
        times,
        filled,
        targets,
        words: ["planned", "nominal tracks"],
        closest,
    }
}

pub(super) struct Charted {
    pub name: String,
    /// Its hull, if it has one.
    pub hull: Option<Hull>,
    /// Its track, which may be empty.
    pub track: Vec<Vector>,
    /// Where it is at each of the times, if it is known.
    pub poses: Vec<Option<Pose>>,
    /// The boundary of its set at each of the times; empty without one.
    pub areas: Vec<Vec<Vector>>,
    /// The boundary of its hard set at each of the times; empty where the set is the hard one.
    pub hard: Vec<Vec<Vector>>,
}

impl Charted {
    /// Where it is at one of the times, or the middle of its set.
    fn place(&self, k: usize) -> Option<Vector> {
        let pose = self.poses.get(k).copied().flatten();
        let area = self.areas.get(k).filter(|area| !area.is_empty());
        pose.map(|pose| pose.position)
            .or_else(|| Some(area?.iter().sum::<Vector>() / area?.len() as f64))
    }
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
    /// The legend's words for own ship's track and for those of the targets.
    pub words: [&'static str; 2],
    /// Where own ship and a target are closest, and how close.
    pub closest: Option<([Vector; 2], String)>,
}

/// Draws one chart per time, all of the same window.
pub(super) fn moments(scenario: &Scenario, style: &Style, traffic: &Traffic) -> Figure {
    let count = traffic.times.len();
    let charts = (0..count).map(|k| {
        let title = minutes(traffic.times[k]);
        traffic_chart(&title, scenario, style, traffic, Some(k), Vec::new())
    });
    let columns = (count as f64).sqrt().ceil() as usize;
    let figure = Figure::new(columns, charts.collect());
    figure.with_shared_axes().with_titles()
}

/// The part of the plane that shows own ship's tracks, and of the filled sets what is near them.
fn shown(scenario: &Scenario, style: &Style, traffic: &Traffic) -> Window {
    let waypoints = scenario.desired.waypoints();
    let paths = scenario.alternatives.iter().flatten();
    let mut shown: Vec<Vector> = (waypoints.iter().chain(&traffic.track).chain(paths))
        .copied()
        .collect();
    let reach = window_around(shown.iter().copied(), REACH);
    let filled = |k: usize| style.panels || k == traffic.filled;
    for k in (0..traffic.times.len()).filter(|k| filled(*k)) {
        for target in &traffic.targets {
            let area = target.areas.get(k).into_iter().flatten().copied();
            shown.extend(area.chain(target.place(k)).filter(|p| reach.contains(*p)));
        }
    }
    window_around(shown, AIR)
}

/// Colour and name of a ship, and its texts with their places.
type Labelled = (&'static str, String, Vec<(String, Vector)>);

/// Draws the mission, land, the targets and own ship, with the times beside the ships; in a panel
/// of one time, at that one alone. `others` are above the sets and below own ship.
pub(super) fn traffic_chart(
    title: &str,
    scenario: &Scenario,
    style: &Style,
    traffic: &Traffic,
    only: Option<usize>,
    others: Vec<Plot>,
) -> Panel {
    let instants = only.map_or(0..traffic.times.len(), |k| k..k + 1);
    let filled = only.unwrap_or(traffic.filled);
    let content = shown(scenario, style, traffic);
    let mut panel = Panel::plan(title.to_owned(), PLAN, content).sized(style.area);
    let window = panel.window();
    let land = scenario.land.as_ref();
    panel.plots.extend(land_areas(land, panel.inside()));
    let outlined = only.is_none() && !style.is_small();
    for (index, target) in traffic.targets.iter().enumerate() {
        let colour = target_colour(index);
        for (k, area) in target.areas.iter().enumerate() {
            // sets of other times are no place that own ship has to avoid at this one
            if k == filled {
                panel.fill_set(area, colour, FILLED);
                if let Some(hard) = target.hard.get(k) {
                    panel.fill_hull(hard, colour, HARD);
                }
            } else if outlined {
                panel
                    .plots
                    .push(curve(area, true, Stroke::dashed(colour, 0.5)));
            }
        }
    }
    for path in &scenario.alternatives {
        panel.curve(path, false, ALTERNATIVE);
    }
    panel.plots.extend(others);
    panel.curve(&scenario.desired.waypoints(), false, DESIRED);
    for (index, target) in traffic.targets.iter().enumerate() {
        let stroke = Stroke::solid(target_colour(index), 1.2);
        panel.curve(&target.track, false, stroke);
    }
    let closest = traffic
        .closest
        .as_ref()
        .filter(|_| filled == traffic.filled);
    // that of the closest approach stands there
    let time = |k: usize| match only.is_some() || (k == filled && closest.is_some()) {
        true => String::new(),
        false => minutes(traffic.times[k]),
    };
    let mut ships: Vec<Labelled> = Vec::new();
    let mut outside: Vec<(Stroke, String)> = Vec::new();
    for (index, target) in traffic.targets.iter().enumerate() {
        let name = shortened(&target.name, NAME_LETTERS);
        let mut places = Vec::new();
        for k in instants.clone() {
            if let Some(place) = target.place(k).filter(|place| window.contains(*place)) {
                if let Some((hull, pose)) = target.hull.zip(target.poses[k]) {
                    panel.ship(&hull, &pose, target_colour(index));
                }
                places.push((time(k), place));
            }
        }
        if places.is_empty() && only.is_none() {
            let stroke = Stroke::solid(target_colour(index), 1.2);
            outside.push((stroke, format!("{name}: outside the chart")));
        }
        // small charts of one time have each name once
        let seen = |k: usize| target.place(k).is_some_and(|place| window.contains(place));
        let again = only.is_some() && style.is_small() && (0..instants.start).any(seen);
        let name = if again { String::new() } else { name };
        ships.push((target_colour(index), name, places));
    }
    // no hull hides own ship
    if let Some((ends, _)) = closest {
        panel.curve(ends, false, CLOSEST);
    }
    panel.curve(&traffic.track, false, PLANNED);
    let mut places = Vec::new();
    for (k, pose) in traffic.own.iter().enumerate() {
        if instants.contains(&k) && window.contains(pose.position) {
            panel.ship(&scenario.own_ship.hull, pose, PLANNED.colour);
            places.push((time(k), pose.position));
        }
    }
    let again = only.is_some() && style.is_small() && instants.start > 0;
    let name = if again { "" } else { "own ship" };
    // its labels go first
    ships.insert(0, (PLANNED.colour, name.to_owned(), places));
    if let Some((ends, apart)) = closest {
        let text = match only.is_some() {
            true => apart.clone(),
            false => format!("{apart}, {}", minutes(traffic.times[filled])),
        };
        let middle = 0.5 * (ends[0] + ends[1]);
        panel.label(
            &[(text.clone(), middle), (text, ends[0])],
            CLOSEST.colour,
            true,
        );
    }
    // names first
    let mut labelled: Vec<Vector> = Vec::new();
    for (colour, name, places) in ships.iter().filter(|(_, name, _)| !name.is_empty()) {
        let named = |(time, place): &(String, Vector)| match time.is_empty() {
            true => (name.clone(), *place),
            false => (format!("{name}, {time}"), *place),
        };
        let named: Vec<(String, Vector)> = places.iter().map(named).collect();
        labelled.extend(panel.label(&named, colour, true));
    }
    // a ship that hardly moves has one label, own ship first
    let apart = LABELS_APART * window.size().x;
    for (colour, _, places) in ships {
        for (time, place) in places {
            if !time.is_empty() && labelled.iter().all(|p| (p - place).norm() > apart) {
                panel.label(&[(time, place)], colour, !style.times.is_empty());
                labelled.push(place);
            }
        }
    }
    if !traffic.track.is_empty() {
        panel.line_key(traffic.words[0], PLANNED);
    }
    panel.line_key("desired", DESIRED);
    let colour = target_colour(0);
    if traffic.targets.iter().any(|target| target.track.len() > 1) {
        panel.line_key(traffic.words[1], Stroke::solid(colour, 1.2));
    }
    if land.is_some() {
        panel.area_key("land", LAND, 1.0);
    }
    if closest.is_some() {
        panel.line_key("closest approach", CLOSEST);
    }
    let has_sets = |k: usize| {
        let mut areas = traffic
            .targets
            .iter()
            .filter_map(|target| target.areas.get(k));
        areas.any(|area| !area.is_empty())
    };
    if has_sets(filled) {
        let label = match closest {
            _ if only.is_some() => "sets".to_owned(),
            Some(_) => "sets at the closest approach".to_owned(),
            None => format!("sets at {}", minutes(traffic.times[filled])),
        };
        panel.area_key(&label, colour, FILLED);
        if traffic.targets.iter().any(|target| !target.hard.is_empty()) {
            panel.area_key("hard sets", colour, BOTH);
        }
        if outlined && traffic.times.len() > 1 {
            panel.line_key("sets at other times", OTHER_SETS);
        }
    }
    let more = outside.split_off(outside.len().min(MOST_OUTSIDE));
    if !more.is_empty() {
        let label = format!("{} more: outside the chart", more.len());
        outside.push((ALTERNATIVE, label));
    }
    for (stroke, label) in outside {
        panel.line_key(&label, stroke);
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
