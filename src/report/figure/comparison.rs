//! Figure of a comparison: tracks, distances to targets, and in a sweep the cost over accepted
//! risk.

use super::outline::{marks, sampled_boundary};
use super::panel::window_around;
use super::path_time::run_panel;
use super::plan::{DESIRED, INSTANTS, LAND, land_areas, round_times};
use super::sections::{PLAN, minutes_list};
use super::{Figure, FigureError, FigureOptions, Panel, Stroke, Style};
use crate::evaluation::{Safety, outcome_word};
use crate::frame::Vector;
use crate::geometry::Window;
use crate::scenario::Scenario;
use crate::study::compare::{Candidate, Entry, Method};

const SETS: &str = "#888888";

/// Time step of a curve in seconds.
const STEP: f64 = 2.0;

/// Maximum of the distance axis as a multiple of the largest minimum distance.
const SHOWN: f64 = 4.0;

/// Draws one row of panels per scenario: the chart, the distance to the nearest target over time,
/// and in a sweep the cost over the accepted risk.
pub fn comparison_figure(
    compared: &[(&Scenario, &[Entry])],
    options: &FigureOptions,
) -> Result<Figure, FigureError> {
    let sweep = compared.iter().any(|(_, entries)| is_sweep(entries));
    let ends = compared.iter().map(|(scenario, _)| scenario.horizon);
    options.draw(ends.fold(f64::INFINITY, f64::min), |style| {
        let rows = compared
            .iter()
            .flat_map(|(scenario, entries)| comparison_panels(scenario, entries, sweep, style));
        Figure::new(if sweep { 3 } else { 2 }, rows.collect())
    })
}

/// Builds the chart, the distance to the nearest target over time, and in a sweep the cost over
/// risk.
pub(in crate::report) fn comparison_panels(
    scenario: &Scenario,
    entries: &[Entry],
    sweep: bool,
    style: &Style,
) -> Vec<Panel> {
    let mut panels = vec![
        chart(scenario, entries, style),
        distances(scenario, entries),
    ];
    if sweep {
        panels.push(pareto(scenario, entries));
    }
    panels
}

/// Builds the path-time diagrams of the candidates that have one.
pub fn diagram_panels(entries: &[Entry]) -> Vec<Panel> {
    let diagram = |entry: &Entry| {
        let Candidate { method, max_risk } = entry.candidate;
        let title = match max_risk {
            risk if risk > 0.0 => format!("Path and time: {method} at risk {risk}"),
            _ => format!("Path and time: {method}"),
        };
        let label = named(method, std::slice::from_ref(entry));
        run_panel(&title, entry.run.as_deref()?, &label, Stroke::of(method))
    };
    entries.iter().filter_map(diagram).collect()
}

fn is_sweep(entries: &[Entry]) -> bool {
    let risk = |e: &Entry| e.candidate.max_risk;
    entries.iter().any(|e| risk(e) != risk(&entries[0]))
}

fn times(entry: &Entry) -> Vec<f64> {
    let end = entry.trajectory().map_or(0.0, |t| t.end_time());
    let steps = (end / STEP).ceil().max(1.0) as usize;
    (0..=steps).map(|k| (k as f64 * STEP).min(end)).collect()
}

fn keys(panel: &mut Panel, entries: &[Entry]) {
    let mut last = None;
    for entry in entries.iter().filter(|e| e.trajectory().is_some()) {
        let method = entry.candidate.method;
        if last != Some(method) {
            panel.line_key(&named(method, entries), Stroke::of(method));
            last = Some(method);
        }
    }
}

/// Name of a method, with its worst result if one of its motions is not safe.
fn named(method: Method, entries: &[Entry]) -> String {
    let own = entries.iter().filter(|e| e.candidate.method == method);
    let unsafe_ones = own.filter(|e| e.safety() > Some(Safety::Safe));
    match unsafe_ones.max_by_key(|e| e.safety()) {
        Some(entry) => {
            let word = outcome_word("relaxed", entry.safety(), entry.largest_risk());
            format!("{method}: {word}")
        }
        None => method.to_string(),
    }
}

/// Draws all motions, the desired trajectory, and the sets of the first candidate with a motion at
/// some instants.
fn chart(scenario: &Scenario, entries: &[Entry], style: &Style) -> Panel {
    let ways: Vec<(Stroke, Vec<Vector>)> = entries
        .iter()
        .map(|entry| {
            let at = |time| entry.position_at(time);
            let way = times(entry).into_iter().filter_map(at).collect();
            (Stroke::of(entry.candidate.method), way)
        })
        .collect();
    let waypoints = scenario.desired.waypoints();
    let end = scenario.desired.duration();
    // a motion that continues to the horizon would shrink all others
    let reach = window_around(waypoints.iter().copied(), 0.35);
    let within = |p: &Vector| reach.contains(*p);
    let mut shown: Vec<Vector> = waypoints.clone();
    shown.extend(ways.iter().flat_map(|(_, way)| way).copied().filter(within));
    let mut sets: Vec<Vec<Vector>> = Vec::new();
    let times = match &style.times[..] {
        [] => round_times(end, INSTANTS),
        asked => asked.to_vec(),
    };
    let first = entries.iter().find_map(|e| e.motion.as_ref());
    for obstacle in first.iter().flat_map(|motion| &motion.obstacles) {
        for time in &times {
            let boundary = sampled_boundary(&obstacle.section(time.min(scenario.horizon)));
            if boundary.iter().any(within) {
                shown.extend(boundary.iter().copied().filter(within));
                sets.push(boundary);
            }
        }
    }
    let title = format!("{}: trajectories", scenario.title);
    let mut panel = Panel::plan(title, PLAN, window_around(shown, 0.06)).sized(style.area);
    let land = scenario.land.as_ref();
    panel.plots.extend(land_areas(land, panel.window()));
    for boundary in &sets {
        panel.fill_hull(boundary, SETS, 0.18);
    }
    panel.curve(&waypoints, false, DESIRED);
    // the first row on top
    for (stroke, way) in ways.iter().rev() {
        panel.curve(way, false, *stroke);
    }
    keys(&mut panel, entries);
    panel.line_key("desired", DESIRED);
    let wide = |colour| Stroke::solid(colour, 3.0);
    if !sets.is_empty() {
        panel.line_key(&format!("sets at {}", minutes_list(&times)), wide(SETS));
    }
    if land.is_some() {
        panel.line_key("land", wide(LAND));
    }
    panel
}

/// Draws the distance to the nearest target on its nominal motion: between the hulls, or from own
/// position to the set.
fn distances(scenario: &Scenario, entries: &[Entry]) -> Panel {
    let own = &scenario.own_ship.hull;
    let lines: Vec<(Stroke, Vec<Vector>)> = entries
        .iter()
        .map(|entry| {
            let line = times(entry).into_iter().filter_map(|time| {
                let pose = entry.trajectory()?.pose_at(time);
                let targets = scenario.targets.iter();
                let apart = targets.map(|target| target.distance_from(own, &pose, time));
                let nearest = apart.fold(f64::INFINITY, f64::min);
                nearest.is_finite().then(|| Vector::new(time, nearest))
            });
            (Stroke::of(entry.candidate.method), line.collect())
        })
        .collect();
    let least = |line: &[Vector]| line.iter().map(|p| p.y).fold(f64::INFINITY, f64::min);
    let farthest = lines.iter().map(|(_, line)| least(line));
    let top = SHOWN * farthest.filter(|d| d.is_finite()).fold(0.0, f64::max);
    let points = lines.iter().flat_map(|(_, line)| line);
    let near = points.filter(|p| p.y <= top);
    let end = near.map(|p| p.x).fold(1.0, f64::max);
    let high = Vector::new(end, if top > 0.0 { top } else { 1.0 });
    let window = Window::new(Vector::zeros(), high);
    let title = format!("{}: distance from the nearest target", scenario.title);
    let mut panel = Panel::free(title, ["Time [s]", "Distance [m]"], window);
    for (stroke, line) in lines.iter().rev() {
        panel.curve(line, false, *stroke);
    }
    panel
}

/// Draws the cost over accepted risk, one line per planner. Baselines are omitted because their
/// costs would flatten the lines. A plan that exceeds the accepted risk has no point.
fn pareto(scenario: &Scenario, entries: &[Entry]) -> Panel {
    let mut lines: Vec<(Method, Vec<Vector>)> = Vec::new();
    let is_planned = |e: &&Entry| matches!(e.candidate.method, Method::Planner { .. });
    for entry in entries.iter().filter(is_planned) {
        let method = entry.candidate.method;
        let known = lines.iter().position(|(m, _)| *m == method);
        let index = known.unwrap_or_else(|| {
            lines.push((method, Vec::new()));
            lines.len() - 1
        });
        let cost = cost_within_risk(entry);
        lines[index]
            .1
            .extend(cost.map(|cost| Vector::new(entry.candidate.max_risk, cost)));
    }
    for (_, line) in &mut lines {
        line.sort_by(|a, b| a.x.total_cmp(&b.x));
    }
    let points = lines.iter().flat_map(|(_, line)| line).copied();
    let (mut right, mut top) = (0.0_f64, 0.0_f64);
    for p in points {
        right = right.max(p.x);
        top = top.max(p.y);
    }
    let right = if right > 0.0 { right * 1.05 } else { 1.0 };
    let top = if top > 0.0 { top * 1.08 } else { 1.0 };
    let window = Window::new(Vector::zeros(), Vector::new(right, top));
    let title = format!("{}: cost of safety", scenario.title);
    let axes = ["Accepted risk [-]", "Space-time error J [m²]"];
    let mut panel = Panel::free(title, axes, window);
    for (method, line) in lines.iter().rev() {
        let stroke = Stroke::of(*method);
        panel.curve(line, false, stroke);
        panel.plots.push(marks(line, stroke.colour));
    }
    for (method, line) in &lines {
        // show the costs, because lines may coincide
        let label = match (line.first(), line.last()) {
            (Some(first), Some(last)) => format!("{method}: {:.0} to {:.0} m²", first.y, last.y),
            _ => format!("{method}: none within the risk"),
        };
        panel.line_key(&label, Stroke::of(*method));
    }
    panel
}

/// Cost of a verified plan that respects the accepted risk and arrives.
fn cost_within_risk(entry: &Entry) -> Option<f64> {
    let run = entry.run.as_deref()?;
    let enters = run.enters();
    let is_left = run.planned.outcome.plan().is_some_and(|p| p.to_go > 0.0);
    if enters || is_left || run.max_risk > entry.candidate.max_risk {
        return None;
    }
    let verified = run.evaluation.as_ref().filter(|e| e.verified());
    verified
        .map(|e| e.space_time_error)
        .filter(|c| c.is_finite())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::planner::path_time::PathTimePlanner;
    use crate::planner::space_time::SpaceTimePlanner;
    use crate::planner::{Planner, SearchKind};
    use crate::target::Representation;

    /// In the head-on scenario no path is clear at any accepted risk.
    #[test]
    fn what_goes_beyond_the_risk_has_no_point() {
        let read = |name: &str| Scenario::read(name.as_ref()).expect(name);
        let scenario = read("scenarios/colregs/head-on.toml");
        let planners: [&dyn Planner; 2] = [&SpaceTimePlanner, &PathTimePlanner];
        let entries: Vec<Entry> = planners
            .into_iter()
            .flat_map(|planner| [0.1, 0.0].map(|max_risk| (planner, max_risk)))
            .map(|(planner, max_risk)| {
                let method = Method::Planner {
                    planner,
                    search: SearchKind::AStar,
                    representation: Some(Representation::Polytope),
                };
                Candidate { method, max_risk }.run(&scenario)
            })
            .collect();
        let costs: Vec<Option<f64>> = entries.iter().map(cost_within_risk).collect();
        let (Some(risked), Some(clear)) = (costs[0], costs[1]) else {
            panic!("{costs:?}");
        };
        assert!(clear > risked && costs[2..] == [None, None], "{costs:?}");
        // a plan that does not arrive has no point either
        let forces = read("scenarios/forces/give-way.toml");
        let along = Candidate {
            max_risk: 0.2,
            ..entries[2].candidate
        };
        assert_eq!(cost_within_risk(&along.run(&forces)), None);
        let svg = comparison_figure(&[(&scenario, &entries)], &FigureOptions::default());
        let svg = svg.expect("drawn").svg();
        assert!(svg.contains("path-time: none within the risk"));
        // sorted from the least risk, independent of the requested order
        assert!(svg.contains(&format!("space-time, A*: {clear:.0} to {risked:.0} m²")));
    }
}
