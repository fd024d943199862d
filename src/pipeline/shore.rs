//! The land of a scenario as a planner meets it.

use crate::geometry::{ConvexPolygon, Window};
use crate::obstacle::Coast;
use crate::scenario::Scenario;

/// The convex pieces of land that own ship could reach before the horizon, whatever she does: she is at most half of
/// the way that she can sail from the middle between her start and the end.
pub fn land_within_reach(scenario: &Scenario) -> Vec<ConvexPolygon> {
    let Some(land) = &scenario.land else {
        return Vec::new();
    };
    let own = &scenario.own_ship;
    let (start, end) = (own.pose.position, scenario.desired.end());
    let way = (own.max_speed() * scenario.horizon).max((end - start).norm());
    let window = Window::at((start + end) * 0.5).grown(0.5 * way + footprint(scenario));
    let pieces = land.map.pieces_within(&window);
    pieces.into_iter().cloned().collect()
}

/// Metres from own ship's centre that have to be water on every heading, where there is land.
fn footprint(scenario: &Scenario) -> f64 {
    let margin = scenario.land.as_ref().map_or(0.0, |land| land.margin);
    scenario.own_ship.hull.half_diagonal() + margin
}

/// The land as own ship's centre sees it, from [`land_within_reach`].
pub fn coast(scenario: &Scenario, land: &[ConvexPolygon]) -> Coast {
    Coast::around(land, footprint(scenario))
}
