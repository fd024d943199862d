//! Velocities and forces over time of a plan under forces.

use super::panel::window_around;
use super::{Panel, Stroke};
use crate::frame::{Vector, clockwise_deg_per_s};
use crate::geometry::Window;
use crate::trajectory::{ForceNode, Steered};

const SURGE: Stroke = Stroke::solid("#0072b2", 1.8);
const SWAY: Stroke = Stroke::solid("#009e73", 1.8);
const YAW: Stroke = Stroke::solid("#d55e00", 1.8);

/// Least span of a panel in its unit, so that rounding is not drawn in full size.
const LEAST_SPAN: f64 = 0.01;

/// Value from which on a panel has thousands of its unit.
const THOUSANDS: f64 = 1e4;

type Quantity = (&'static str, Stroke, fn(&ForceNode) -> f64);

/// Builds panels for speeds, turn rate, forces and moment, because their units differ. Starboard
/// and clockwise are positive.
pub(super) fn force_panels(motion: &Steered) -> Vec<Panel> {
    let speeds: &[Quantity] = &[
        ("surge", SURGE, |n| n.velocity.x),
        ("sway to starboard", SWAY, |n| -n.velocity.y),
    ];
    let turn: &[Quantity] = &[("yaw rate clockwise", YAW, |n| {
        clockwise_deg_per_s(n.yaw_rate)
    })];
    let forces: &[Quantity] = &[
        ("surge", SURGE, |n| n.force.x),
        ("sway to starboard", SWAY, |n| -n.force.y),
    ];
    let moment: &[Quantity] = &[("yaw moment clockwise", YAW, |n| -n.moment)];
    vec![
        over_time(motion, "Speed through water", "m/s", speeds, false),
        over_time(motion, "Rate of turn", "°/s", turn, false),
        over_time(motion, "Force", "N", forces, true),
        over_time(motion, "Moment", "Nm", moment, true),
    ]
}

/// Draws quantities of one unit; those that are `held` keep their value until the next node.
fn over_time(
    motion: &Steered,
    title: &str,
    unit: &str,
    quantities: &[Quantity],
    held: bool,
) -> Panel {
    let points = |value: fn(&ForceNode) -> f64| -> Vec<Vector> {
        let pairs = motion.nodes().windows(2);
        pairs
            .flat_map(|pair| {
                let last = if held { &pair[0] } else { &pair[1] };
                [(pair[0].time, value(&pair[0])), (pair[1].time, value(last))]
            })
            .map(|(time, value)| Vector::new(time, value))
            .collect()
    };
    let mut curves: Vec<Vec<Vector>> = quantities
        .iter()
        .map(|(.., value)| points(*value))
        .collect();
    let largest = curves
        .iter()
        .flatten()
        .map(|p| p.y.abs())
        .fold(0.0, f64::max);
    let thousands = largest >= THOUSANDS;
    if thousands {
        curves.iter_mut().flatten().for_each(|p| p.y *= 1e-3);
    }
    let prefix = if thousands { "k" } else { "" };
    let shown = window_around(curves.iter().flatten().copied(), 0.0);
    let size = shown.size();
    let air = Vector::new(0.02 * size.x, 0.08 * size.y.max(LEAST_SPAN));
    let window = Window::new(shown.low - air, shown.high + air);
    let axis = format!("{title} [{prefix}{unit}]");
    let mut panel = Panel::free(title.to_owned(), ["Time [s]", &axis], window);
    for ((label, stroke, _), points) in quantities.iter().zip(&curves) {
        panel.curve(points, false, *stroke);
        panel.line_key(label, *stroke);
    }
    panel
}
