//! A planned motion: where own ship is among the sets, at the start and at the closest approach to each; and the forces
//! that take her there.

use super::outline::{Stroke, area, curve, mark, sampled_boundary};
use super::sections::{PLAN, seconds};
use super::{Figure, Panel, Window, field};
use crate::frame::{Pose, Vector, deg_from_radians};
use crate::geometry::ConvexPolygon;
use crate::pipeline::Run;
use crate::trajectory::{Node, Steered, Trajectory};
use crate::vessel::ForceVector;

/// Panels beside one another.
const COLUMNS: usize = 2;

/// Points of a track.
const TRACK: usize = 400;

/// Panels of closest approaches, at most.
const MOMENTS: usize = 7;

const OWN: Stroke = Stroke {
    colour: field::OWN,
    width: 2.2,
    dashed: false,
};

const DESIRED: Stroke = Stroke {
    colour: "#777777",
    width: 1.2,
    dashed: true,
};

const SET: Stroke = Stroke {
    colour: "#0072b2",
    width: 1.6,
    dashed: false,
};

const ZERO: Stroke = Stroke {
    colour: "#bbbbbb",
    width: 1.0,
    dashed: false,
};

const SURGE: &str = "#0072b2";
const SWAY: &str = "#009e73";
const YAW: &str = "#d55e00";

/// Of the greatest speed, or of what a force may be: a panel shows as much at least.
const LEAST_SPAN: f64 = 0.02;

/// Degrees per second, the same.
const LEAST_TURN_DEG_PER_S: f64 = 0.05;

/// A number from here on is written in thousands.
const LONG: f64 = 1e4;

/// Of the greater side: around what is shown.
const MARGIN: f64 = 0.06;

/// Of the greater side of the ways: sets are shown whole where they come this near at a shown moment.
const REACH: f64 = 0.3;

/// Where own ship is among the obstacles at the start and at the closest approach to each target, in order of time, and
/// where she is driven by forces, these over time. `None` without a plan.
pub fn moments_figure(run: &Run) -> Option<Figure> {
    let trajectory = &run.planned.outcome.plan()?.trajectory;
    Some(Figure::new(COLUMNS, moments_panels(run, trajectory)))
}

/// The panels of [`moments_figure`].
pub(super) fn moments_panels(run: &Run, trajectory: &Trajectory) -> Vec<Panel> {
    let mut times: Vec<f64> = run
        .evaluation
        .iter()
        .flat_map(|e| &e.passages)
        .map(|passage| passage.tcpa)
        .collect();
    times.sort_by(f64::total_cmp);
    times.insert(0, trajectory.start_time());
    times.dedup();
    times.truncate(MOMENTS + 1);
    let track = track(trajectory);
    let window = window(run, &track, &times);
    let mut panels: Vec<Panel> = times
        .iter()
        .map(|time| moment_panel(run, trajectory, &track, window, *time))
        .collect();
    if let Some(motion) = trajectory.steered() {
        panels.extend(driven(motion, &run.scenario.control.force_limits));
    }
    panels
}

/// Where own ship is, at times that are equally far apart.
fn track(trajectory: &Trajectory) -> Vec<Vector> {
    let step = (trajectory.end_time() - trajectory.start_time()) / TRACK as f64;
    let at = |k: usize| trajectory.start_time() + step * k as f64;
    (0..=TRACK)
        .map(|k| trajectory.pose_at(at(k)).position)
        .collect()
}

/// One for all moments, so that they compare: both ways, and every set that comes near them at one of the moments. Of a
/// set that is larger than the ways the part that is near.
fn window(run: &Run, track: &[Vector], times: &[f64]) -> Window {
    let wanted = run.scenario.desired.waypoints();
    let mut shown: Vec<Vector> = track.iter().chain(&wanted).copied().collect();
    let reach = Window::around(shown.iter().copied(), REACH);
    let sections = run
        .obstacles
        .iter()
        .flat_map(|o| times.iter().map(|time| o.section(*time)));
    for section in sections {
        let boundary = sampled_boundary(&section);
        let size = Window::around(boundary.iter().copied(), 0.0).size();
        if size.max() > reach.size().max() {
            shown.extend(boundary.iter().filter(|p| reach.contains(**p)));
        } else if boundary.iter().any(|p| reach.contains(*p)) {
            shown.extend(boundary);
        }
    }
    Window::around(shown, MARGIN)
}

/// Tracks and sets at one moment.
fn moment_panel(
    run: &Run,
    trajectory: &Trajectory,
    track: &[Vector],
    window: Window,
    time: f64,
) -> Panel {
    let wanted = run.scenario.desired.waypoints();
    let mut panel = Panel::plan(format!("At {} s", seconds(time)), PLAN, window);
    for obstacle in &run.obstacles {
        let boundary = sampled_boundary(&obstacle.section(time));
        let filled = ConvexPolygon::hull(&boundary).ok();
        panel
            .plots
            .extend(filled.and_then(|p| area(&p, SET.colour, 0.25)));
        panel.plots.push(curve(&boundary, true, SET));
    }
    panel.plots.push(curve(&wanted, false, DESIRED));
    panel
        .plots
        .push(curve(track, false, Stroke { width: 1.0, ..OWN }));
    let step = (trajectory.end_time() - trajectory.start_time()) / TRACK as f64;
    let sailed = ((time - trajectory.start_time()) / step)
        .floor()
        .clamp(0.0, TRACK as f64);
    let now: Pose = trajectory.pose_at(time);
    let mut behind: Vec<Vector> = track[..=sailed as usize].to_vec();
    behind.push(now.position);
    panel.plots.push(curve(&behind, false, OWN));
    let hull = run.scenario.own_ship.hull.polygon(&now);
    panel.plots.push(curve(hull.vertices(), true, OWN));
    panel.plots.push(mark(now.position, field::OWN));
    panel.line_key("plan", OWN);
    panel.line_key("desired", DESIRED);
    if !run.obstacles.is_empty() {
        panel.line_key("obstacles", SET);
    }
    panel
}

/// One quantity over time.
struct Curve {
    label: &'static str,
    colour: &'static str,
    values: Vec<Vector>,
}

/// Quantities of one unit over time.
struct Quantities<'a> {
    title: &'a str,
    unit: &'a str,
    /// In the unit: what varies by less is drawn as what hardly varies.
    least_span: f64,
    curves: Vec<Curve>,
}

/// Velocities and forces: speeds, turn, forces and moment have a panel each, as they have units each. Starboard and
/// clockwise are positive.
fn driven(motion: &Steered, limits: &ForceVector) -> Vec<Panel> {
    let states = |value: fn(&Node) -> f64| -> Vec<Vector> {
        let nodes = motion.nodes().iter();
        nodes.map(|n| Vector::new(n.time, value(n))).collect()
    };
    // each held until the next node
    let forces = |value: fn(&Node) -> f64| -> Vec<Vector> {
        let pairs = motion.nodes().windows(2);
        pairs
            .flat_map(|p| [p[0].time, p[1].time].map(|t| Vector::new(t, value(&p[0]))))
            .collect()
    };
    let curve = |label, colour, values| Curve {
        label,
        colour,
        values,
    };
    let speeds = vec![
        curve("surge", SURGE, states(|n| n.velocity.x)),
        curve("sway to starboard", SWAY, states(|n| -n.velocity.y)),
    ];
    let turn = vec![curve(
        "yaw rate clockwise",
        YAW,
        states(|n| -deg_from_radians(n.yaw_rate)),
    )];
    let pushes = vec![
        curve("surge", SURGE, forces(|n| n.force.x)),
        curve("sway to starboard", SWAY, forces(|n| -n.force.y)),
    ];
    let moment = vec![curve("yaw moment clockwise", YAW, forces(|n| -n.moment))];
    let fastest = largest(&speeds);
    [
        Quantities {
            title: "Speed through water",
            unit: "m/s",
            least_span: LEAST_SPAN * fastest,
            curves: speeds,
        },
        Quantities {
            title: "Rate of turn",
            unit: "°/s",
            least_span: LEAST_TURN_DEG_PER_S,
            curves: turn,
        },
        prefixed("Force", ["N", "kN", "MN"], limits.x.max(limits.y), pushes),
        prefixed("Moment", ["Nm", "kNm", "MNm"], limits.z, moment),
    ]
    .into_iter()
    .map(over_time)
    .collect()
}

fn largest(curves: &[Curve]) -> f64 {
    let values = curves.iter().flat_map(|c| &c.values);
    values.fold(0.0, |most, v| most.max(v.y.abs()))
}

/// In the unit of three, each a thousand times the one before, in which the numbers on the axis are short.
fn prefixed<'a>(
    title: &'a str,
    units: [&'a str; 3],
    limit: f64,
    mut curves: Vec<Curve>,
) -> Quantities<'a> {
    let least_span = LEAST_SPAN * limit;
    let most = largest(&curves).max(least_span);
    let (unit, size) = match most {
        m if m >= 1e3 * LONG => (units[2], 1e6),
        m if m >= LONG => (units[1], 1e3),
        _ => (units[0], 1.0),
    };
    for value in curves.iter_mut().flat_map(|c| &mut c.values) {
        value.y /= size;
    }
    Quantities {
        title,
        unit,
        least_span: least_span / size,
        curves,
    }
}

fn over_time(quantities: Quantities) -> Panel {
    let Quantities {
        title,
        unit,
        least_span,
        curves,
    } = quantities;
    let all = curves.iter().flat_map(|c| c.values.iter().copied());
    let shown = Window::around(all, 0.0);
    let size = shown.size();
    let wider = 0.5 * (least_span - size.y).max(0.0);
    let air = Vector::new(0.02 * size.x, wider + 0.08 * size.y.max(least_span));
    let window = Window {
        low: shown.low - air,
        high: shown.high + air,
    };
    let axis = format!("{title} [{unit}]");
    let mut panel = Panel::free(title.to_owned(), ["Time [s]", &axis], window);
    let none = [
        Vector::new(window.low.x, 0.0),
        Vector::new(window.high.x, 0.0),
    ];
    if window.low.y < 0.0 && window.high.y > 0.0 {
        panel.plots.push(curve(&none, false, ZERO));
    }
    for Curve {
        label,
        colour,
        values,
    } in &curves
    {
        let stroke = Stroke {
            colour,
            width: 1.8,
            dashed: false,
        };
        panel.plots.push(curve(values, false, stroke));
        panel.line_key(label, stroke);
    }
    panel
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pipeline;
    use crate::scenario::Scenario;

    const FIGURE_9: &str = include_str!("../../../scenarios/paper/figure_9.toml");

    #[test]
    fn the_window_holds_the_ways_and_whole_sets_that_come_near_and_no_others() {
        let run = pipeline::run(Scenario::parse(FIGURE_9).expect("valid"));
        let trajectory = &run.planned.outcome.plan().expect("a plan").trajectory;
        let track = track(trajectory);
        let times = [0.0, 30.0, 60.0];
        let near = window(&run, &track, &times);
        assert!(track.iter().all(|p| near.contains(*p)));
        for obstacle in &run.obstacles {
            for time in times {
                let boundary = sampled_boundary(&obstacle.section(time));
                assert!(boundary.iter().all(|p| near.contains(*p)), "{time}");
            }
        }
        // twenty times as far away as she sails, and larger than all that she sails in
        let size = Window::around(track.iter().copied(), REACH).size().max();
        let moved = |from: Vector, size: &str| {
            let center = format!("center_m = [{}, {}]", from.x, from.y);
            let text = FIGURE_9.replace("center_m = [13.0, 6.5]", &center);
            let text = text.replace("[[0.64, 0.0], [0.0, 0.64]]", size);
            let sets = pipeline::run(Scenario::parse(&text).expect("valid")).obstacles;
            let run = Run {
                obstacles: sets,
                ..run.clone()
            };
            window(&run, &track, &times)
        };
        let shown = near.size();
        let far = moved(Vector::new(0.0, 500.0), "[[0.64, 0.0], [0.0, 0.64]]");
        assert!(far.size().x <= shown.x && far.size().y <= shown.y);
        let large = moved(
            Vector::new(0.0, 500.0),
            "[[240000.0, 0.0], [0.0, 240000.0]]",
        );
        assert!(large.size().max() < 2.0 * size, "{:?}", large.size());
    }
}
