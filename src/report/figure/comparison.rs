//! Figure of a comparison: tracks, distances to targets, and the cost over accepted risk or over
//! planning time. Methods with equal motions share a curve.

use super::outline::{marks, sampled_boundary};
use super::panel::{name_lines, window_around};
use super::path_time::{run_panel, target_colour};
use super::plan::{DESIRED, FILLED, LAND, OTHER_SETS, land_areas};
use super::sections::{PLAN, minutes_list};
use super::{Figure, FigureError, FigureOptions, Panel, Stroke, Style};
use crate::evaluation::{PlanOutcome, Safety, outcome_word};
use crate::frame::Vector;
use crate::geometry::Window;
use crate::labels::Needed;
use crate::obstacle::Obstacle;
use crate::planner::Minimises;
use crate::scenario::Scenario;
use crate::study::compare::{Candidate, Entry, Method};

/// Width of a curve in a small panel, as a fraction of that in a large one.
const SMALL_SHARE: f64 = 0.6;

/// Time step of a curve in seconds.
const STEP: f64 = 2.0;

/// Maximum of the distance axis as a multiple of the largest minimum distance.
const SHOWN: f64 = 4.0;

/// Cost below which plans are alike, m².
const LEAST_COST_M2: f64 = 1e-6;

/// Draws one row of panels per scenario: the chart, the distance to the nearest target over time,
/// in a sweep the cost over the accepted risk, else the cost over the planning time where a thorough
/// search found several answers. A small figure has two panels in a row.
pub fn comparison_figure(
    compared: &[(&Scenario, &[Entry])],
    options: &FigureOptions,
) -> Result<Figure, FigureError> {
    let sweep = compared.iter().any(|(_, entries)| is_sweep(entries));
    let ends = compared.iter().map(|(scenario, _)| scenario.horizon);
    let is_improved = |(_, entries): &(_, &[Entry])| entries.iter().any(|e| steps(e).len() > 1);
    let improved = !sweep && compared.iter().any(is_improved);
    options.draw(ends.fold(f64::INFINITY, f64::min), |style| {
        let rows = compared.iter().flat_map(|(scenario, entries)| {
            let mut panels = comparison_panels(scenario, entries, sweep, style);
            if improved {
                panels.push(cost_over_time(scenario, entries, style));
            }
            panels
        });
        let third = (sweep || improved) && !style.is_small();
        let columns = if third { 3 } else { 2 };
        let figure = Figure::new(columns, rows.collect());
        // titles tell the scenarios apart
        if compared.len() > 1 {
            figure.with_titles()
        } else {
            figure
        }
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
    let curves = curves(entries, style);
    let mut panels = vec![
        chart(scenario, &curves, style),
        distances(scenario, &curves),
    ];
    if sweep {
        panels.push(pareto(scenario, &curves, style));
    }
    panels
}

/// The motions of a method and of those with the same ones.
struct Curve<'a> {
    name: String,
    stroke: Stroke,
    entries: Vec<&'a Entry>,
}

fn curves<'a>(entries: &'a [Entry], style: &Style) -> Vec<Curve<'a>> {
    let share = if style.is_small() { SMALL_SHARE } else { 1.0 };
    let mut groups: Vec<(Vec<String>, Vec<&Entry>)> = Vec::new();
    for of_one in entries.chunk_by(|a, b| a.candidate.method == b.candidate.method) {
        let all: Vec<&Entry> = of_one.iter().collect();
        let same = |(_, other): &&mut (Vec<String>, Vec<&Entry>)| {
            let equal = |(a, b): (&&Entry, &&Entry)| {
                a.trajectory().is_some()
                    && a.trajectory() == b.trajectory()
                    && a.candidate.max_risk == b.candidate.max_risk
                    && (a.safety(), a.largest_risk()) == (b.safety(), b.largest_risk())
            };
            other.len() == all.len() && other.iter().zip(&all).all(equal)
        };
        let mut name: Vec<String> = of_one.iter().map(Entry::name).collect();
        name.dedup();
        let name = joined(&name.iter().map(String::as_str).collect::<Vec<_>>());
        match groups.iter_mut().find(same) {
            Some((names, _)) => names.push(name),
            None => groups.push((vec![name], all)),
        }
    }
    let curves = groups.into_iter().map(|(names, entries)| Curve {
        name: joined(&names.iter().map(String::as_str).collect::<Vec<_>>()),
        stroke: {
            let stroke = Stroke::of(entries[0].candidate.method);
            let width = share * stroke.width;
            Stroke { width, ..stroke }
        },
        entries,
    });
    curves.collect()
}

/// The end of the name of a method that plans around ellipsoids.
const ELLIPSOIDS: &str = ", ellipsoids";

/// Names of methods as one: `space-time, A* and Dijkstra` where they differ in one part. With
/// `polytopes and ellipsoids` behind it where each of them occurs with both.
fn joined(methods: &[&str]) -> String {
    let (round, other): (Vec<&str>, Vec<&str>) =
        methods.iter().partition(|m| m.ends_with(ELLIPSOIDS));
    let plain = round.iter().map(|m| m.trim_end_matches(ELLIPSOIDS));
    if !other.is_empty() && plain.eq(other.iter().copied()) {
        return format!("{}, polytopes and ellipsoids", joined(&other));
    }
    let split: Vec<Vec<&str>> = methods.iter().map(|m| m.split(", ").collect()).collect();
    let first = &split[0];
    let differ = |part: &usize| split.iter().any(|m| m.get(*part) != first.get(*part));
    let parts: Vec<usize> = (0..first.len()).filter(differ).collect();
    match parts[..] {
        [part] if split.iter().all(|m| m.len() == first.len()) => {
            let other: Vec<&str> = split.iter().map(|m| m[part]).collect();
            let other = other.join(" and ");
            let mut all = first.clone();
            all[part] = &other;
            all.join(", ")
        }
        _ => methods.join(" and "),
    }
}

/// Builds the path-time diagrams of the candidates that have one.
pub fn diagram_panels(entries: &[Entry]) -> Vec<Panel> {
    let diagram = |entry: &Entry| {
        let Candidate { method, max_risk } = entry.candidate;
        let name = entry.name();
        let title = match max_risk {
            risk if risk > 0.0 => format!("Path and time: {name} at risk {risk}"),
            _ => format!("Path and time: {name}"),
        };
        let label = named(&name, [entry]);
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

/// A name, with the worst result if a motion is not safe.
fn named<'a>(name: &str, entries: impl IntoIterator<Item = &'a Entry>) -> String {
    let unsafe_ones = entries
        .into_iter()
        .filter(|e| e.safety() > Some(Safety::Safe));
    match unsafe_ones.max_by_key(|e| e.safety()) {
        Some(entry) => {
            let word = outcome_word(PlanOutcome::Relaxed, entry.safety(), entry.largest_risk());
            format!("{name}: {word}")
        }
        None => name.to_owned(),
    }
}

/// Draws all motions, the desired trajectory, and each target with its set at its closest approach
/// to the first candidate with a motion. At times that are asked for, sets are outlined.
fn chart(scenario: &Scenario, curves: &[Curve], style: &Style) -> Panel {
    let ways: Vec<(Stroke, Vec<Vector>)> = (curves.iter())
        .flat_map(|curve| curve.entries.iter().map(|entry| (curve.stroke, *entry)))
        .map(|(stroke, entry)| {
            let at = |time| entry.position_at(time);
            (stroke, times(entry).into_iter().filter_map(at).collect())
        })
        .collect();
    let waypoints = scenario.desired.waypoints();
    // a motion that continues to the horizon would shrink all others
    let reach = window_around(waypoints.iter().copied(), 0.35);
    let within = |p: &Vector| reach.contains(*p);
    let mut shown: Vec<Vector> = waypoints.clone();
    shown.extend(ways.iter().flat_map(|(_, way)| way).copied().filter(within));
    let first = (curves.iter().flat_map(|curve| &curve.entries)).find_map(|e| e.motion.as_ref());
    let passages = first.iter().flat_map(|motion| &motion.evaluation.passages);
    let closest: Vec<f64> = passages.map(|passage| passage.tcpa).collect();
    let obstacles = first.map_or(&[][..], |motion| &motion.obstacles);
    let section = |set: &Obstacle, time: f64| {
        let time = time.min(scenario.horizon);
        sampled_boundary(&set.section(time))
    };
    let each = obstacles.iter().zip(&closest);
    let filled: Vec<_> = each.map(|(set, time)| section(set, *time)).collect();
    shown.extend(filled.iter().flatten().copied().filter(within));
    let title = format!("{}: trajectories", scenario.title);
    let mut panel = Panel::plan(title, PLAN, window_around(shown, 0.06)).sized(style.area);
    let land = scenario.land.as_ref();
    panel.plots.extend(land_areas(land, panel.inside()));
    for (index, boundary) in filled.iter().enumerate() {
        panel.fill_set(boundary, target_colour(index), FILLED);
    }
    for time in &style.times {
        for set in obstacles {
            panel.curve(&section(set, *time), true, OTHER_SETS);
        }
    }
    panel.curve(&waypoints, false, DESIRED);
    // the first row on top
    for (stroke, way) in ways.iter().rev() {
        panel.curve(way, false, *stroke);
    }
    for (index, (target, time)) in scenario.targets.iter().zip(&closest).enumerate() {
        let place = target.position_at(*time);
        if let Some(ship) = target.ship() {
            panel.ship(&ship.hull, &ship.pose_at(*time), target_colour(index));
        }
        if panel.window().contains(place) {
            let name = name_lines(&target.name);
            panel.label(&[(name, place)], target_colour(index), Needed::Always);
        }
    }
    for curve in curves
        .iter()
        .filter(|c| c.entries.iter().any(|e| e.motion.is_some()))
    {
        let name = named(&curve.name, curve.entries.iter().copied());
        panel.line_key(&name, curve.stroke);
    }
    panel.line_key("desired", DESIRED);
    if !filled.is_empty() {
        panel.area_key("sets at their closest approach", target_colour(0), FILLED);
    }
    if !style.times.is_empty() {
        let label = format!("sets at {}", minutes_list(&style.times));
        panel.line_key(&label, OTHER_SETS);
    }
    if land.is_some() {
        panel.area_key("land", LAND, 1.0);
    }
    panel
}

/// Draws the distance to the nearest target on its nominal motion: between the hulls, or from own
/// position to the set.
fn distances(scenario: &Scenario, curves: &[Curve]) -> Panel {
    let own = &scenario.own_ship.hull;
    let lines: Vec<(Stroke, Vec<Vector>)> = (curves.iter())
        .flat_map(|curve| curve.entries.iter().map(|entry| (curve.stroke, *entry)))
        .map(|(stroke, entry)| {
            let line = times(entry).into_iter().filter_map(|time| {
                let pose = entry.trajectory()?.pose_at(time);
                let targets = scenario.targets.iter();
                let apart = targets.map(|target| target.distance_from(own, &pose, time));
                let nearest = apart.fold(f64::INFINITY, f64::min);
                nearest.is_finite().then(|| Vector::new(time, nearest))
            });
            (stroke, line.collect())
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

/// Seconds of planning and cost of the answers that led to a verified plan within the risk, in order
/// of time; empty for a planner with another objective.
fn steps(entry: &Entry) -> Vec<Vector> {
    let (Some(run), Some(_)) = (entry.run.as_deref(), cost_within_risk(entry)) else {
        return Vec::new();
    };
    if run.scenario.planner.facts().minimises != Minimises::SpaceTimeError {
        return Vec::new();
    }
    let improvements = run.planned.improvements.iter();
    let mut steps: Vec<Vector> = improvements
        .map(|improvement| Vector::new(improvement.after.as_secs_f64(), improvement.cost))
        .collect();
    if let (true, Some(plan)) = (steps.is_empty(), run.planned.outcome.plan()) {
        steps.push(Vector::new(run.plan_time.as_secs_f64(), plan.cost));
    }
    steps
}

/// Draws the cost over planning time, relative to the least: a step for each answer of a thorough
/// search, until it ended, and a point for each other one.
fn cost_over_time(scenario: &Scenario, entries: &[Entry], style: &Style) -> Panel {
    let curves = curves(entries, style);
    // that of the curve with the same motion
    let stroke = |entry: &Entry| {
        let is_same = |e: &&Entry| e.trajectory() == entry.trajectory();
        let curve = curves
            .iter()
            .find(|curve| curve.entries.iter().any(is_same));
        curve.map_or_else(|| Stroke::of(entry.candidate.method), |curve| curve.stroke)
    };
    let entries = entries.iter();
    let entries = entries.map(|entry| (stroke(entry), steps(entry), entry.run.as_deref()));
    let lines: Vec<(Stroke, Vec<Vector>, f64)> = entries
        .filter(|(_, steps, _)| !steps.is_empty())
        .filter_map(|(stroke, steps, run)| Some((stroke, steps, run?.plan_time.as_secs_f64())))
        .collect();
    let costs = lines
        .iter()
        .flat_map(|(_, steps, _)| steps.iter().map(|p| p.y));
    let least = costs
        .clone()
        .fold(f64::MAX / 2.0, f64::min)
        .max(LEAST_COST_M2);
    let most = costs.fold(1.01 * least, f64::max) / least;
    let end = lines.iter().map(|(.., end)| *end).fold(1e-3, f64::max);
    let edge = 0.1 * (most - 1.0);
    let low = Vector::new(-0.02 * end, 1.0 - edge);
    let window = Window::new(low, Vector::new(1.05 * end, most + edge));
    let title = format!("{}: cost over planning time", scenario.title);
    let mut panel = Panel::free(title, ["Planning time [s]", "J / least J [-]"], window);
    for (stroke, steps, end) in lines.iter().rev() {
        let relative = |p: &Vector| Vector::new(p.x, p.y / least);
        let steps: Vec<Vector> = steps.iter().map(relative).collect();
        let before = steps
            .windows(2)
            .map(|pair| Vector::new(pair[1].x, pair[0].y));
        let corners = steps[1..]
            .iter()
            .zip(before)
            .flat_map(|(p, corner)| [corner, *p]);
        let last = Vector::new(*end, steps[steps.len() - 1].y);
        let line: Vec<Vector> = [steps[0]]
            .into_iter()
            .chain(corners)
            .chain([last])
            .collect();
        panel.curve(&line, false, *stroke);
        panel.plots.push(marks(&steps, stroke.colour));
    }
    panel
}

/// Draws the cost over accepted risk, one line per planner. Baselines are omitted because their
/// costs would flatten the lines. A plan that exceeds the accepted risk has no point.
fn pareto(scenario: &Scenario, curves: &[Curve], style: &Style) -> Panel {
    let is_planned = |c: &&Curve| matches!(c.entries[0].candidate.method, Method::Planner { .. });
    let line = |curve: &'_ Curve| {
        let point = |entry: &&Entry| {
            Some(Vector::new(
                entry.candidate.max_risk,
                cost_within_risk(entry)?,
            ))
        };
        let mut line: Vec<Vector> = curve.entries.iter().filter_map(point).collect();
        line.sort_by(|a, b| a.x.total_cmp(&b.x));
        (curve.name.clone(), curve.stroke, line)
    };
    let lines: Vec<(String, Stroke, Vec<Vector>)> =
        curves.iter().filter(is_planned).map(line).collect();
    let points = lines.iter().flat_map(|(.., line)| line).copied();
    let (mut right, mut top) = (0.0_f64, 0.0_f64);
    for p in points {
        right = right.max(p.x);
        top = top.max(p.y);
    }
    let right = if right > 0.0 { right * 1.05 } else { 1.0 };
    let top = if top > 0.0 { top * 1.08 } else { 1.0 };
    let window = Window::new(Vector::zeros(), Vector::new(right, top));
    let title = format!("{}: cost of safety", scenario.title);
    let error = match style.is_small() {
        true => "J [m²]",
        false => "Space-time error J [m²]",
    };
    let axes = ["Accepted risk [-]", error];
    let mut panel = Panel::free(title, axes, window);
    for (_, stroke, line) in lines.iter().rev() {
        panel.curve(line, false, *stroke);
        panel.plots.push(marks(line, stroke.colour));
    }
    for (name, stroke, line) in lines.iter().filter(|_| !style.is_small()) {
        // show the costs, because lines may coincide
        let label = match (line.first(), line.last()) {
            (Some(first), Some(last)) => format!("{name}: {:.0} to {:.0} m²", first.y, last.y),
            _ => format!("{name}: none within the risk"),
        };
        panel.line_key(&label, *stroke);
    }
    panel
}

/// Cost of a verified plan that respects the accepted risk and arrives.
fn cost_within_risk(entry: &Entry) -> Option<f64> {
    let run = entry.run.as_deref()?;
    let enters = run.enters();
    let is_left = run.planned.outcome.plan().is_some_and(|p| !p.arrives());
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

    #[test]
    fn methods_with_one_plan_have_one_name() {
        for (methods, name) in [
            (&["space-time, A*"][..], "space-time, A*"),
            (
                &["space-time, A*", "space-time, Dijkstra"],
                "space-time, A* and Dijkstra",
            ),
            (
                &[
                    "space-time, A*, ellipsoids",
                    "space-time, Dijkstra, ellipsoids",
                ],
                "space-time, A* and Dijkstra, ellipsoids",
            ),
            (
                &["space-time, A*", "space-time, A*, ellipsoids"],
                "space-time, A*, polytopes and ellipsoids",
            ),
            (
                &["path-time", "optimal control"],
                "path-time and optimal control",
            ),
        ] {
            assert_eq!(joined(methods), name);
        }
    }

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
        assert!(svg.contains("least harm: none within the risk"));
        // sorted from the least risk, independent of the requested order
        assert!(svg.contains(&format!("by the rules: {clear:.0} to {risked:.0} m²")));
    }
}
