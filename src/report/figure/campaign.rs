//! Distributions over the rows of a campaign.

use super::path_time::target_colour;
use super::{Panel, Stroke};
use crate::frame::Vector;
use crate::geometry::Window;

/// Points of a curve; its ends are the extremes.
const POINTS: usize = 200;

/// Quantile of all values at which the axis ends: a few far values must not hide the others.
const SHOWN: f64 = 0.99;

/// Draws for each stratum the fraction of rows with at most a value. Values are in order.
pub(in crate::report) fn distribution_panel(
    title: &str,
    axis: &str,
    strata: &[(&str, &[f64])],
) -> Panel {
    let mut all: Vec<f64> = strata.iter().flat_map(|(_, v)| *v).copied().collect();
    all.sort_by(f64::total_cmp);
    let at = |share: f64| {
        let index = share * all.len().saturating_sub(1) as f64;
        all.get(index as usize).copied().unwrap_or(0.0)
    };
    let least = at(1.0 - SHOWN).min(0.0);
    let most = at(SHOWN).max(least + 1e-6);
    let window = Window::new(Vector::new(least, 0.0), Vector::new(most, 100.0));
    let mut panel = Panel::free(
        title.to_owned(),
        [axis, "Rows with at most this [%]"],
        window,
    );
    for (index, (name, values)) in strata.iter().enumerate() {
        let Some(last) = values.len().checked_sub(1) else {
            continue;
        };
        let point = |k: usize| {
            let own = k * last / POINTS;
            Vector::new(values[own], 100.0 * (own + 1) as f64 / values.len() as f64)
        };
        let mut points: Vec<Vector> = (0..=POINTS).map(point).collect();
        points.dedup();
        let stroke = Stroke::solid(target_colour(index), 1.4);
        panel.curve(&points, false, stroke);
        panel.line_key(name, stroke);
    }
    panel
}
