//! Fields: risk over position at a time, and dCPA over velocities. They are drawn as bands, each of
//! which is an explicit set. A section is the region with at least a given risk. The velocities
//! within a distance form the velocity obstacle of a wider set.

use kuva::plot::{ColorMap, ContourPlot};
use kuva::render::plots::Plot;

use super::outline::{Approaching, mark, outer_velocities_within, sampled_boundary};
use super::panel::round_step;
use super::sections::PLAN;
use super::{Panel, Stroke};
use crate::frame::Vector;
use crate::geometry::{ConvexPolygon, Window};
use crate::obstacle::{Obstacle, SpaceTimeObstacle};

const RISK_BANDS: usize = 20;

/// Maximum number of bands of a distance field.
const DISTANCE_BANDS: f64 = 20.0;
const BOUNDARY: Stroke = Stroke::solid("#ffffff", 1.6);

/// Boundary of a velocity obstacle, which is white.
const VELOCITY_OBSTACLE: Stroke = Stroke::solid("#000000", 1.6);

/// Colour of own ship on dark and light backgrounds.
pub(super) const OWN: &str = "#d55e00";

/// Velocities shown by a panel, and own velocity.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct VelocityWindow {
    /// Window in m/s.
    pub window: Window,
    /// Own velocity in m/s, if it is marked.
    pub own: Option<Vector>,
}

/// Draws the largest risk of any target at `time` in seconds, in steps of 1/20, with the boundaries
/// of the sections. The colour scale always covers risk 0 to 1.
pub fn risk_panel(title: &str, targets: &[Obstacle], time: f64, window: Window) -> Panel {
    let mut panel = Panel::plan(title.to_owned(), PLAN, window);
    panel.plots.push(scale(panel.window(), 1.0, "risk"));
    let bands = RISK_BANDS as f64;
    for level in 0..=RISK_BANDS {
        let risk = level as f64 / bands;
        let shown = if level < RISK_BANDS {
            risk + 0.5 / bands
        } else {
            1.0
        };
        for target in targets {
            let boundary = sampled_boundary(&target.at_risk(risk).section(time));
            panel.fill_hull(&boundary, &ColorMap::Viridis.map(shown), 1.0);
        }
    }
    for target in targets {
        let boundary = sampled_boundary(&target.section(time));
        panel.curve(&boundary, true, BOUNDARY);
    }
    panel
}

/// Draws the least dCPA to any target for every velocity held from `position` over `[0, horizon]`
/// seconds. Velocity obstacles are white.
pub fn dcpa_panel(
    title: &str,
    targets: &[Obstacle],
    position: Vector,
    horizon: f64,
    shown: &VelocityWindow,
) -> Panel {
    let axes = ["East velocity [m/s]", "North velocity [m/s]"];
    let mut panel = Panel::plan(title.to_owned(), axes, shown.window);
    if !targets.is_empty() {
        let approach = Approaching { position, horizon };
        bands(&mut panel, targets, &approach);
        panel.line_key("velocity obstacle, white", VELOCITY_OBSTACLE);
    }
    if let Some(own) = shown.own {
        panel.plots.push(mark(own, OWN));
        panel.area_key("own velocity", OWN, 1.0);
    }
    panel
}

fn bands(panel: &mut Panel, targets: &[Obstacle], approach: &Approaching) {
    let window = panel.window();
    let limit = 2.0 * window.low.amax().max(window.high.amax());
    // dCPA is at most the distance at the start
    let most = targets
        .iter()
        .map(|t| t.signed_distance(approach.position, 0.0).distance)
        .fold(f64::INFINITY, f64::min);
    let step = round_step(most / DISTANCE_BANDS);
    let count = (most / step).ceil().max(1.0) as usize;
    let top = step * count as f64;
    panel.plots.push(scale(window, top, "dCPA [m]"));
    let far = ColorMap::Viridis.map(1.0 - 0.5 / count as f64);
    let everywhere = ConvexPolygon::rectangle(Vector::zeros(), limit, limit);
    panel.fill(&everywhere, &far, 1.0);
    for level in (0..count).rev() {
        for target in targets {
            let distance = step * level as f64;
            for set in outer_velocities_within(target, approach, distance, limit) {
                if level > 0 {
                    let colour = ColorMap::Viridis.map((level as f64 - 0.5) / count as f64);
                    panel.fill(&set, &colour, 1.0);
                } else {
                    panel.fill(&set, BOUNDARY.colour, 1.0);
                    panel.curve(set.vertices(), true, VELOCITY_OBSTACLE);
                }
            }
        }
    }
}

/// Colour bar from 0 to `top`, with the window filled in its first colour.
fn scale(window: Window, top: f64, name: &str) -> Plot {
    let Window { low, high } = window;
    let corners = ContourPlot::new()
        .with_grid(
            vec![vec![0.0, 0.0], vec![0.0, top]],
            vec![low.x, high.x],
            vec![low.y, high.y],
        )
        // above every corner, so that only the background is drawn
        .with_levels(&[2.0 * top])
        .with_filled()
        .with_colormap(ColorMap::Viridis)
        .with_legend(name);
    Plot::Contour(corners)
}
