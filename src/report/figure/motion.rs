//! A planned motion: where own ship is among the sets, at the start and at the closest approach to each; and the forces
//! that take her there.

use super::outline::{Stroke, area, curve, mark, sampled_boundary};
use super::sections::{PLAN, seconds};
use super::{Figure, Panel, Window, field};
use crate::frame::{Pose, Vector};
use crate::geometry::ConvexPolygon;
use crate::pipeline::Run;
use crate::trajectory::{Steered, Trajectory};

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

/// Of the desired way: the shown part of the plane goes this far beyond it.
const MARGIN: f64 = 0.12;

/// Where own ship is among the obstacles at the start and at the closest approach to each target, in order of time, and
/// her velocities and forces over time. `None` without a plan of forces.
pub fn control_figure(run: &Run) -> Option<Figure> {
    let trajectory = &run.planned.outcome.plan()?.trajectory;
    let motion = trajectory.steered()?;
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
    let mut panels: Vec<Panel> = times
        .iter()
        .map(|time| moment_panel(run, trajectory, *time))
        .collect();
    panels.push(velocity_panel(motion));
    panels.push(force_panel(motion));
    Some(Figure::new(COLUMNS, panels))
}

/// Tracks and sets at one moment.
fn moment_panel(run: &Run, trajectory: &Trajectory, time: f64) -> Panel {
    let step = (trajectory.end_time() - trajectory.start_time()) / TRACK as f64;
    let track: Vec<Vector> = (0..=TRACK)
        .map(|k| {
            trajectory
                .pose_at(trajectory.start_time() + step * k as f64)
                .position
        })
        .collect();
    let wanted = run.scenario.desired.waypoints();
    let shown = track.iter().chain(&wanted).copied();
    let mut panel = Panel::plan(
        format!("At {} s", seconds(time)),
        PLAN,
        Window::around(shown, MARGIN),
    );
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
        .push(curve(&track, false, Stroke { width: 1.0, ..OWN }));
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

/// One of three quantities over time.
struct Curve {
    label: &'static str,
    colour: &'static str,
    values: Vec<Vector>,
}

/// Surge, sway and yaw rate; starboard and clockwise are positive.
fn velocity_panel(motion: &Steered) -> Panel {
    let of = |value: fn(&crate::trajectory::Node) -> f64| -> Vec<Vector> {
        let nodes = motion.nodes().iter();
        nodes.map(|n| Vector::new(n.time, value(n))).collect()
    };
    over_time(
        "Velocity",
        "Surge, sway [m/s], yaw rate [rad/s]",
        [
            ("surge", of(|n| n.velocity.x)),
            ("sway to starboard", of(|n| -n.velocity.y)),
            ("yaw rate clockwise", of(|n| -n.yaw_rate)),
        ],
    )
}

/// Forces, each held until the next node; starboard and clockwise are positive.
fn force_panel(motion: &Steered) -> Panel {
    let of = |value: fn(&crate::trajectory::Node) -> f64| -> Vec<Vector> {
        let pairs = motion.nodes().windows(2);
        pairs
            .flat_map(|p| [p[0].time, p[1].time].map(|t| Vector::new(t, value(&p[0]))))
            .collect()
    };
    over_time(
        "Forces",
        "Surge, sway [N], yaw moment [Nm]",
        [
            ("surge", of(|n| n.force.x)),
            ("sway to starboard", of(|n| -n.force.y)),
            ("yaw moment clockwise", of(|n| -n.moment)),
        ],
    )
}

fn over_time(title: &str, axis: &str, curves: [(&'static str, Vec<Vector>); 3]) -> Panel {
    let colours = ["#0072b2", "#009e73", "#d55e00"];
    let curves: Vec<Curve> = curves
        .into_iter()
        .zip(colours)
        .map(|((label, values), colour)| Curve {
            label,
            colour,
            values,
        })
        .collect();
    let all = curves.iter().flat_map(|c| c.values.iter().copied());
    let shown = Window::around(all, 0.0);
    let air = Vector::new(0.02 * shown.size().x, 0.08 * shown.size().y.max(1e-9));
    let window = Window {
        low: shown.low - air,
        high: shown.high + air,
    };
    let mut panel = Panel::free(title.to_owned(), ["Time [s]", axis], window);
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
