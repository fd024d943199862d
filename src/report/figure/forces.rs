//! Velocities and forces over time of a plan under forces.

use super::outline::{Stroke, curve};
use super::{Panel, PlotWindow};
use crate::frame::{Vector, deg_from_radians};
use crate::trajectory::{ForceNode, Steered};
use crate::vessel::ForceVector;

const ZERO: Stroke = Stroke {
    colour: "#bbbbbb",
    width: 1.0,
    dashed: false,
};

const SURGE: &str = "#0072b2";
const SWAY: &str = "#009e73";
const YAW: &str = "#d55e00";

/// Minimum span of a panel, as a fraction of the maximum speed or of the force limit.
const LEAST_SPAN: f64 = 0.02;

/// Minimum span of the turn rate panel, in degrees per second.
const LEAST_TURN_DEG_PER_S: f64 = 0.05;

/// Threshold above which numbers are written in thousands.
const LONG: f64 = 1e4;

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
    /// Minimum span in this unit.
    least_span: f64,
    curves: Vec<Curve>,
}

/// Builds panels for speeds, turn rate, forces and moment, because their units differ. Starboard
/// and clockwise are positive.
pub(super) fn force_panels(motion: &Steered, limits: &ForceVector) -> Vec<Panel> {
    let states = |value: fn(&ForceNode) -> f64| -> Vec<Vector> {
        let nodes = motion.nodes().iter();
        nodes.map(|n| Vector::new(n.time, value(n))).collect()
    };
    // each held until the next node
    let forces = |value: fn(&ForceNode) -> f64| -> Vec<Vector> {
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

/// Selects the unit prefix that gives short numbers; the three units differ by factors of a
/// thousand.
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
    let shown = PlotWindow::around(all, 0.0);
    let size = shown.size();
    let wider = 0.5 * (least_span - size.y).max(0.0);
    let air = Vector::new(0.02 * size.x, wider + 0.08 * size.y.max(least_span));
    let window = PlotWindow {
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
