//! Figure of a plan: the chart, the diagram of a path-time plan, and the forces of a plan under
//! forces.

use kuva::render::plots::Plot;

use super::forces::force_panels;
use super::outline::{area, curve, dots, sampled_boundary};
use super::panel::{AREA, LETTERS, name_lines, window_around};
use super::path_time::{run_panel, target_colour};
use super::sections::{PLAN, sections_beside};
use super::{Figure, FigureError, FigureOptions, Panel, Stroke, Style};
use crate::document::{self, EncounterDocument, PlanDocument, chart_role};
use crate::frame::{Pose, Vector};
use crate::geometry::{ConvexPolygon, Window};
use crate::labels::Needed;
use crate::obstacle::Obstacle;
use crate::pipeline::Run;
use crate::planner::EdgeVerdict;
use crate::scenario::{Land, Scenario};
use crate::text::{Times, clock, significant};
use crate::trajectory::Trajectory;
use crate::vessel::Hull;

/// Wide and pale, so that it is seen under the tracks that run along it.
pub(super) const DESIRED: Stroke = Stroke::solid("#c4c4c4", 5.0);
pub(super) const PLANNED: Stroke = Stroke::solid("#000000", 2.4);

/// Stroke between the centres of the hulls at the least closest approach, and at the others.
const CLOSEST: Stroke = Stroke::solid("#b3001b", 1.8);
const CLOSE: Stroke = Stroke::solid(CLOSEST.colour, 0.8);
const ALTERNATIVE: Stroke = Stroke::dashed("#888888", 1.2);
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

/// Interval in seconds to which the times of panels are rounded, how many are chosen, and the least
/// time between closest approaches of different encounters as a fraction of the whole.
const ROUND: f64 = 10.0;
const PANELS: usize = 4;
const DISTINCT: f64 = 0.025;

/// Targets outside the chart that the legend names.
const MOST_OUTSIDE: usize = 4;

/// Most closest approaches that a chart marks, and the radius in pixels of their dots on own ship.
const MOST_MET: usize = 4;
const MET_DOT: f64 = 2.6;

/// Least interval between a round time and a closest approach, as a fraction of the interval
/// between round times.
const TIMES_APART: f64 = 0.15;

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

/// The times that a chart marks: those asked for, or round ones; for panels, [`panel_times`].
/// `closest` are the distances and times of the closest approaches.
pub(super) fn marked_times(
    style: &Style,
    end: f64,
    most: f64,
    closest: impl Iterator<Item = [f64; 2]>,
) -> Vec<f64> {
    let mut closest: Vec<[f64; 2]> = closest.filter(|[_, time]| time.is_finite()).collect();
    closest.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let closest: Vec<f64> = closest.into_iter().map(|[_, time]| time).collect();
    match (style.times.is_empty(), style.panels) {
        (false, _) => style.times.clone(),
        (true, true) => panel_times(end, &closest),
        (true, false) => {
            // a small chart has room for fewer
            let mut times = round_times(end, most * (style.area[0] / AREA[0]).clamp(0.5, 1.0));
            let apart = TIMES_APART * times.get(1).copied().unwrap_or(0.0);
            // hulls on one another hide which is which; the start stays
            let is_near = |time: f64| {
                let mut marked = closest.iter().take(MOST_MET);
                marked.any(|closest| (time - closest).abs() < apart)
            };
            times.retain(|time| *time == 0.0 || !is_near(*time));
            times
        }
    }
}

/// The least closest approaches of different encounters, then the start, then the middles between
/// them.
fn panel_times(end: f64, closest: &[f64]) -> Vec<f64> {
    let round = |time: f64| (time / ROUND).round() * ROUND;
    let mut times: Vec<f64> = Vec::new();
    for time in closest.iter().filter(|time| 0.0 < **time && **time < end) {
        let is_other = times.iter().all(|t| (t - time).abs() > DISTINCT * end);
        if is_other && times.len() + 1 < PANELS {
            times.push(*time);
        }
    }
    if times.is_empty() {
        times.push(round(0.5 * end));
    }
    times.sort_by(f64::total_cmp);
    let all = [&[0.0], &times[..], &[end]].concat();
    let middle = |pair: &[f64]| round(0.5 * (pair[0] + pair[1])).min(end);
    let more: Vec<f64> = all.windows(2).map(middle).collect();
    let free = PANELS - times.len();
    times.extend([&[0.0], &more[..]].concat().iter().take(free));
    times.sort_by(f64::total_cmp);
    times.dedup();
    times
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
            moments(
                &run.scenario,
                style,
                &traffic(run, &document.encounters, style),
            )
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
        let headlines = [departure.words(Times::Clock), departure.brief()];
        let mut headlines = headlines.map(|text| format!("{title}: {text}")).into_iter();
        let fits = |headline: &String| headline.chars().count() <= LETTERS;
        title = headlines.find(fits).unwrap_or(title);
    }
    let mut panels = vec![chart(&title, run, &document.encounters, style, Vec::new())];
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

/// Draws the desired and the planned trajectory, and each target with its set at its closest
/// approach, with own ship's position at the same time.
pub fn chart_panel(title: &str, run: &Run) -> Panel {
    let met = document::encounters(run);
    chart(title, run, &met, &Style::default(), Vec::new())
}

/// Draws the chart with `others` above the sets and below the plan.
fn chart(
    title: &str,
    run: &Run,
    encounters: &[EncounterDocument],
    style: &Style,
    others: Vec<Plot>,
) -> Panel {
    let traffic = traffic(run, encounters, style);
    traffic_chart(title, &run.scenario, style, &traffic, None, others)
}

/// Own ship of a run and its targets.
fn traffic(run: &Run, encounters: &[EncounterDocument], style: &Style) -> Traffic {
    let scenario = &run.scenario;
    let trajectory = run.planned.outcome.plan().map(|plan| &plan.trajectory);
    let end = end(run);
    let passages = run.evaluation.as_ref().map(|judged| &judged.passages[..]);
    let passages = passages.unwrap_or_default();
    let closest = passages.iter().map(|passage| [passage.dcpa, passage.tcpa]);
    let times = marked_times(style, end, INSTANTS, closest);
    let sampled = match trajectory {
        Some(trajectory) => trajectory.sample_times(STEP, MOST_POINTS),
        None => vec![0.0, end],
    };
    let targets = scenario.targets.iter().zip(&run.targets).enumerate();
    let targets = targets.map(|(index, (target, sets))| {
        let is_hard = sets.obstacle.sets() == sets.sets.hard.sets();
        let section = |set: &Obstacle, time: f64| sampled_boundary(&set.section(time));
        let moment = |time: f64| Moment {
            pose: target.ship().map(|ship| ship.pose_at(time)),
            area: section(&sets.obstacle, time),
            hard: match is_hard {
                true => Vec::new(),
                false => section(&sets.sets.hard, time),
            },
        };
        let met = encounters.get(index);
        let roles = met
            .and_then(|met| met.conduct.as_ref())
            .map(|c| &c.roles[..]);
        let passage = passages.get(index).filter(|p| p.tcpa.is_finite());
        Charted {
            name: target.name.clone(),
            role: met.and_then(|met| chart_role(roles.unwrap_or_default(), met.role)),
            hull: target.ship().map(|ship| ship.hull),
            track: sampled
                .iter()
                .map(|time| target.position_at(*time))
                .collect(),
            moments: times.iter().map(|time| moment(*time)).collect(),
            closest: passage
                .zip(trajectory)
                .map(|(passage, trajectory)| Meeting {
                    time: passage.tcpa,
                    own: trajectory.pose_at(passage.tcpa),
                    target: moment(passage.tcpa),
                    apart: passage.dcpa,
                    text: format!("{} m", significant(passage.dcpa)),
                }),
        }
    });
    let pose = |time: &f64| trajectory.map(|t| t.pose_at(*time));
    let method = run.planned.method();
    Traffic {
        targets: targets.collect(),
        own: times.iter().filter_map(pose).collect(),
        track: (sampled.iter().filter_map(pose))
            .map(|pose| pose.position)
            .collect(),
        times,
        words: [
            method.map_or("planned".to_owned(), |made| {
                format!("planned, {}", made.label())
            }),
            "nominal tracks".to_owned(),
        ],
    }
}

/// A target as a chart shows it.
pub(super) struct Charted {
    pub name: String,
    /// Own ship's role toward it.
    pub role: Option<String>,
    /// Its hull, if it has one.
    pub hull: Option<Hull>,
    /// Its track, which may be empty.
    pub track: Vec<Vector>,
    /// The target at each of the times.
    pub moments: Vec<Moment>,
    pub closest: Option<Meeting>,
}

impl Charted {
    /// The moment whose set is filled: the closest approach, or the time of a panel.
    fn filled(&self, only: Option<usize>) -> Option<&Moment> {
        let closest = self.closest.as_ref().map(|met| &met.target);
        match only {
            Some(k) => self.moments.get(k),
            None => closest.or(self.moments.first()),
        }
    }
}

/// A target at a time.
pub(super) struct Moment {
    /// Where it is, if it is known.
    pub pose: Option<Pose>,
    /// The boundary of its set; empty without one.
    pub area: Vec<Vector>,
    /// The boundary of its hard set; empty where the set is the hard one.
    pub hard: Vec<Vector>,
}

impl Moment {
    /// Where it is, or the middle of its set.
    fn place(&self) -> Option<Vector> {
        let area = Some(&self.area).filter(|area| !area.is_empty());
        self.pose
            .map(|pose| pose.position)
            .or_else(|| Some(area?.iter().sum::<Vector>() / area?.len() as f64))
    }
}

/// Own ship and a target at their closest approach.
pub(super) struct Meeting {
    pub time: f64,
    pub own: Pose,
    pub target: Moment,
    /// Metres, of which the least is marked most.
    pub apart: f64,
    /// The distance in words.
    pub text: String,
}

/// Own ship and the targets at the same times, as a chart shows them.
pub(super) struct Traffic {
    /// Own ship's track; empty without one.
    pub track: Vec<Vector>,
    /// Times in seconds.
    pub times: Vec<f64>,
    /// Own ship at these times; empty without a track.
    pub own: Vec<Pose>,
    pub targets: Vec<Charted>,
    /// The legend's words for own ship's track and for those of the targets.
    pub words: [String; 2],
}

impl Traffic {
    /// The closest approaches within a window that a chart marks, the least first, with the index
    /// of the target; those at the time of a panel.
    fn met(&self, only: Option<usize>, window: Window) -> Vec<(usize, &Meeting)> {
        let all = self.targets.iter().enumerate();
        let all = all.filter_map(|(index, target)| Some((index, target.closest.as_ref()?)));
        let is_shown = |place: Option<Vector>| place.is_some_and(|place| window.contains(place));
        let mut met: Vec<_> = all
            .filter(|(_, met)| is_shown(met.target.place()) && window.contains(met.own.position))
            .collect();
        met.sort_by(|(_, a), (_, b)| a.apart.total_cmp(&b.apart));
        met.truncate(MOST_MET);
        let is_then = |time: f64| only.is_none_or(|k| clock(self.times[k]) == clock(time));
        met.retain(|(_, met)| is_then(met.time));
        met
    }
}

/// Draws one chart per time, all of the same window.
pub(super) fn moments(scenario: &Scenario, style: &Style, traffic: &Traffic) -> Figure {
    let count = traffic.times.len();
    let charts = (0..count).map(|k| {
        let title = clock(traffic.times[k]);
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
    for target in &traffic.targets {
        let closest = target.filled(None).filter(|_| !style.panels);
        let panels = target.moments.iter().filter(|_| style.panels);
        for moment in panels.chain(closest) {
            let area = moment.area.iter().copied();
            shown.extend(area.chain(moment.place()).filter(|p| reach.contains(*p)));
        }
    }
    window_around(shown, AIR)
}

/// Colour of a ship, its name with own ship's role toward it, and its times with their places.
type Labelled<'a> = (
    &'static str,
    &'a str,
    Option<&'a str>,
    Vec<(String, Vector)>,
);

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
    let content = shown(scenario, style, traffic);
    let mut panel = Panel::plan(title.to_owned(), PLAN, content).sized(style.area);
    let window = panel.window();
    let land = scenario.land.as_ref();
    panel.plots.extend(land_areas(land, panel.inside()));
    // own ship may cross a set of another time: of several targets they are drawn if asked for
    let clear = traffic.targets.len() == 1 || !style.times.is_empty();
    let outlined = only.is_none() && !style.is_small() && clear;
    for (index, target) in traffic.targets.iter().enumerate() {
        let colour = target_colour(index);
        for moment in target.moments.iter().filter(|_| outlined) {
            let stroke = Stroke::dashed(colour, 0.5);
            panel.plots.push(curve(&moment.area, true, stroke));
        }
        if let Some(moment) = target.filled(only) {
            panel.fill_set(&moment.area, colour, FILLED);
            panel.fill_hull(&moment.hard, colour, HARD);
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
    let met = traffic.met(only, window);
    let time = |k: usize| match only {
        Some(_) => String::new(),
        None => clock(traffic.times[k]),
    };
    let mut ships: Vec<Labelled> = Vec::new();
    let mut outside: Vec<(Stroke, String)> = Vec::new();
    for (index, target) in traffic.targets.iter().enumerate() {
        let closest = target.closest.as_ref().filter(|_| only.is_none());
        let all = instants.clone().map(|k| (time(k), &target.moments[k]));
        let all = all.chain(closest.map(|met| (String::new(), &met.target)));
        let mut places = Vec::new();
        for (time, moment) in all {
            if let Some(place) = moment.place().filter(|place| window.contains(*place)) {
                if let Some((hull, pose)) = target.hull.zip(moment.pose) {
                    panel.ship(&hull, &pose, target_colour(index));
                }
                places.push((time, place));
            }
        }
        if places.is_empty() && only.is_none() {
            let stroke = Stroke::solid(target_colour(index), 1.2);
            outside.push((stroke, format!("{}: outside the chart", target.name)));
        }
        // charts of one time have each role once, small ones each name
        let is_seen = |moment: &Moment| moment.place().is_some_and(|p| window.contains(p));
        let again = only.is_some() && target.moments[..instants.start].iter().any(is_seen);
        let name = &target.name[..if again && style.is_small() {
            0
        } else {
            target.name.len()
        }];
        let role = target.role.as_deref().filter(|_| !again);
        ships.push((target_colour(index), name, role, places));
    }
    for (rank, (_, met)) in met.iter().enumerate() {
        let ends = [met.own.position, met.target.place().unwrap_or_default()];
        panel.curve(&ends, false, if rank == 0 { CLOSEST } else { CLOSE });
    }
    // no hull hides own ship, and labels keep off its track more than off others
    panel.curve(&traffic.track, false, PLANNED);
    panel.keep_off(&traffic.track);
    let mut places = Vec::new();
    for (k, pose) in traffic.own.iter().enumerate() {
        if instants.contains(&k) && window.contains(pose.position) {
            panel.ship(&scenario.own_ship.hull, pose, PLANNED.colour);
            places.push((time(k), pose.position));
        }
    }
    for (index, met) in met.iter().filter(|_| only.is_none()) {
        panel.ship(&scenario.own_ship.hull, &met.own, PLANNED.colour);
        let dot = dots(&[met.own.position], target_colour(*index), MET_DOT);
        panel.plots.push(dot);
    }
    let again = only.is_some() && style.is_small() && instants.start > 0;
    let name = if again { "" } else { "own ship" };
    // its labels go first
    ships.insert(0, (PLANNED.colour, name, None, places));
    for (rank, (index, met)) in met.iter().enumerate() {
        let text = match only {
            Some(_) => met.text.clone(),
            None => format!("{}, {}", met.text, clock(met.time)),
        };
        let place = met.own.position;
        let middle = 0.5 * (place + met.target.place().unwrap_or(place));
        let (colour, needed) = match (rank, style.is_small()) {
            (0, _) => (CLOSEST.colour, Needed::Always),
            (_, true) => (target_colour(*index), panel.optional()),
            (_, false) => (target_colour(*index), Needed::Always),
        };
        panel.label(&[(text.clone(), middle), (text, place)], colour, needed);
    }
    // names before times
    let mut labelled: Vec<Vector> = Vec::new();
    for (colour, name, role, places) in ships.iter().filter(|(_, name, ..)| !name.is_empty()) {
        let mut add = |role: Option<&str>, needed: Needed| {
            let named = |(time, place): &(String, Vector)| {
                let name = match time.is_empty() {
                    true => name_lines(name),
                    false => name_lines(&format!("{name}, {time}")),
                };
                let text = role.map_or(name.clone(), |role| format!("{name}\n{role}"));
                (text, *place)
            };
            let named: Vec<(String, Vector)> = places.iter().map(named).collect();
            panel.label(&named, colour, needed)
        };
        // a small chart has roles where there is room
        let placed = match role {
            Some(_) if style.is_small() => {
                add(*role, Needed::OffFirst(4)).or_else(|| add(None, Needed::Always))
            }
            role => add(*role, Needed::Always),
        };
        labelled.extend(placed);
    }
    // a ship that hardly moves has one label, own ship first
    let apart = LABELS_APART * window.size().x;
    let needed = match style.times.is_empty() {
        true => panel.optional(),
        false => Needed::Always,
    };
    for (colour, _, _, places) in ships {
        for (time, place) in places {
            if !time.is_empty() && labelled.iter().all(|p| (p - place).norm() > apart) {
                panel.label(&[(time, place)], colour, needed);
                labelled.push(place);
            }
        }
    }
    if !traffic.track.is_empty() {
        panel.line_key(&traffic.words[0], PLANNED);
    }
    panel.line_key("desired", DESIRED);
    let colour = target_colour(0);
    if traffic.targets.iter().any(|target| target.track.len() > 1) {
        let word = if style.is_small() {
            "targets"
        } else {
            traffic.words[1].as_str()
        };
        panel.line_key(word, Stroke::solid(colour, 1.2));
    }
    if land.is_some() {
        panel.area_key("land", LAND, 1.0);
    }
    if !met.is_empty() {
        let several = if met.len() > 1 { "es" } else { "" };
        panel.line_key(&format!("closest approach{several}"), CLOSEST);
    }
    let filled = || {
        traffic
            .targets
            .iter()
            .filter_map(|target| target.filled(only))
    };
    if filled().any(|moment| !moment.area.is_empty()) {
        let is_met = traffic
            .targets
            .iter()
            .any(|target| target.closest.is_some());
        let label = match is_met {
            _ if only.is_some() => "sets".to_owned(),
            true if style.is_small() => "sets then".to_owned(),
            true => "sets at their closest approach".to_owned(),
            false => format!("sets at {}", clock(traffic.times[0])),
        };
        panel.area_key(&label, colour, FILLED);
        if filled().any(|moment| !moment.hard.is_empty()) {
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
    let met = document::encounters(run);
    let mut panel = chart(title, run, &met, &Style::default(), ways.collect());
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
