//! Land of a scenario as an obstacle of the planners.

use crate::geometry::{ConvexPolygon, Window};
use crate::obstacle::LandObstacle;
use crate::scenario::Scenario;

/// The convex pieces of land that own ship could reach before the horizon.
///
/// Own ship is never farther than half its greatest sailing distance from the midpoint between its
/// start and its end.
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

/// Radius of water that own ship's centre needs on every heading, metres.
fn footprint(scenario: &Scenario) -> f64 {
    let margin = scenario.land.as_ref().map_or(0.0, |land| land.margin);
    scenario.own_ship.hull.half_diagonal() + margin
}

/// The pieces from [`land_within_reach`], grown by own ship's footprint.
pub fn land_obstacle(scenario: &Scenario, land: &[ConvexPolygon]) -> LandObstacle {
    LandObstacle::around(land, footprint(scenario))
}
