//! Figures of target sets: the two sets, and sections over time.

use super::outline::sampled_boundary;
use super::panel::window_around;
use super::{Panel, Stroke};
use crate::frame::Vector;
use crate::geometry::{ConvexPolygon, ConvexSet, Window};
use crate::obstacle::Obstacle;
use crate::text::clock;

pub(super) const PLAN: [&str; 2] = ["East [m]", "North [m]"];
pub(super) const INITIAL: Stroke = Stroke::solid("#0072b2", 2.4);
pub(super) const LATER: Stroke = Stroke::solid("#009e73", 1.4);
const COVERED: Stroke = Stroke::dashed("#d55e00", 1.6);

/// Number of sections used to draw the area covered by ellipses; its sides are nearly straight
/// between them.
const SWEEP: usize = 12;

/// Number of pieces of a side of the space-time body; dashes need a minimum length.
const SIDE: usize = 25;

/// Margin as a fraction of the longer side, for a name.
const MARGIN: f64 = 0.1;

/// Draws one set, `O_0` or `V`, with its unit in `axes`.
pub fn set_panel(title: &str, axes: [&str; 2], set: &ConvexSet) -> Panel {
    let boundary = sampled_boundary(set);
    let window = window_around(boundary.iter().copied(), 0.25);
    let mut panel = Panel::plan(title.to_owned(), axes, window);
    panel.fill_hull(&boundary, INITIAL.colour, 0.25);
    panel.curve(&boundary, true, INITIAL);
    panel
}

/// Draws the sections of all targets at `times` in seconds; the first has its own style. The dashed
/// curve is the area covered until the last time, drawn as the hull of each slab.
pub fn sections_panel(title: &str, targets: &[Obstacle], times: &[f64]) -> Panel {
    sections_beside(title, targets, times, &[])
}

/// Draws [`sections_panel`] in a window that also contains `others`.
pub(super) fn sections_beside(
    title: &str,
    targets: &[Obstacle],
    times: &[f64],
    others: &[Vector],
) -> Panel {
    let last = times.iter().copied().fold(0.0, f64::max);
    let covered: Vec<Vec<Vector>> = targets.iter().flat_map(|t| covered(t, last)).collect();
    let shown = covered.iter().flatten().chain(others).copied();
    let mut panel = Panel::plan(title.to_owned(), PLAN, window_around(shown, MARGIN));
    for boundary in &covered {
        panel.curve(boundary, true, COVERED);
    }
    for target in targets {
        for (i, time) in times.iter().enumerate().rev() {
            let stroke = if i == 0 { INITIAL } else { LATER };
            let boundary = sampled_boundary(&target.section(*time));
            panel.curve(&boundary, true, stroke);
        }
    }
    if let Some((first, later)) = times.split_first()
        && !targets.is_empty()
    {
        panel.line_key(&format!("section at {} s", seconds(*first)), INITIAL);
        if !later.is_empty() {
            panel.line_key(&format!("sections at {} s", seconds_list(later)), LATER);
        }
        panel.line_key(&format!("covered from 0 to {} s", seconds(last)), COVERED);
    }
    panel
}

/// Draws the eastward extent of the sections over time, until `end` seconds: the side view of the
/// space-time body.
pub fn extent_panel(title: &str, target: &Obstacle, times: &[f64], end: f64) -> Panel {
    let reach = |time: f64| {
        let section = target.section(time);
        let side = |x: f64| x * section.support(Vector::new(x, 0.0));
        [side(-1.0), side(1.0)]
    };
    let sides: Vec<(f64, [f64; 2])> = (0..=SIDE)
        .map(|i| end * i as f64 / SIDE as f64)
        .map(|time| (time, reach(time)))
        .collect();
    let side = |i: usize| -> Vec<Vector> {
        sides
            .iter()
            .map(|(t, reach)| Vector::new(reach[i], *t))
            .collect()
    };
    let [west, east] = [side(0), side(1)];
    let shown = window_around(west.iter().chain(&east).copied(), 0.0);
    let margin = Vector::new(MARGIN * shown.size().x, 0.0);
    let window = Window::new(
        shown.low - margin,
        shown.high + margin + Vector::new(0.0, 0.04 * end),
    );
    let axes = ["East [m]", "Time [s]"];
    let mut panel = Panel::free(title.to_owned(), axes, window);
    for boundary in [&west, &east] {
        panel.curve(boundary, false, COVERED);
    }
    for (i, time) in times.iter().enumerate().rev() {
        let stroke = if i == 0 { INITIAL } else { LATER };
        let ends = reach(*time).map(|x| Vector::new(x, *time));
        panel.curve(&ends, false, stroke);
    }
    panel
}

/// Area that a target covers from 0 to `end` seconds, as boundaries of convex sets.
fn covered(target: &Obstacle, end: f64) -> Vec<Vec<Vector>> {
    let hull = |from: f64, to: f64, steps: usize| {
        let points: Vec<Vector> = (0..=steps)
            .map(|i| from + (to - from) * i as f64 / steps as f64)
            .flat_map(|time| sampled_boundary(&target.section(time)))
            .collect();
        let hull = ConvexPolygon::hull(&points).ok();
        hull.map(|hull| hull.vertices().to_vec())
    };
    let steps = match target.sets().initial {
        // linear between the ends
        ConvexSet::Polygon(_) => 1,
        ConvexSet::Ellipse(_) => SWEEP,
    };
    let slabs = target.slabs().iter();
    slabs
        .filter(|slab| slab.start() < end || slab.start() == 0.0)
        .filter_map(|slab| hull(slab.start(), slab.end().min(end), steps))
        .collect()
}

/// Formats seconds, rounded to a tenth.
pub(super) fn seconds(time: f64) -> String {
    ((time * 10.0).round() / 10.0).to_string()
}

/// Times as minutes and seconds.
pub(super) fn minutes_list(times: &[f64]) -> String {
    let list: Vec<String> = times.iter().map(|time| clock(*time)).collect();
    list.join(", ")
}

pub(super) fn seconds_list(times: &[f64]) -> String {
    let list: Vec<String> = times.iter().map(|time| seconds(*time)).collect();
    list.join(", ")
}
