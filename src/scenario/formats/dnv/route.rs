//! The route of a ship of a DNV situation.

use super::super::super::file::Range;
use super::super::super::limits;
use super::super::json::Json;
use super::super::track::RoutePoint;
use super::ship::Initial;
use super::{knots, near, unused};
use crate::frame::{Georeference, NAUTICAL_MILE_M};

/// Nautical miles: radii of turns, stretches of changing speed.
const MILES: Range = Range::between(0.0, 100.0);

/// Points of a route and the speeds between them.
#[derive(Debug, Default)]
pub(super) struct Route {
    pub(super) points: Vec<RoutePoint>,
    /// m/s, one per leg.
    pub(super) speeds: Vec<f64>,
    /// Metres before and after the waypoint at the end of each leg over which the speed changes.
    pub(super) blends: Vec<[f64; 2]>,
}

pub(super) fn route(
    entries: &[Json],
    start: &Initial,
    earth: &Georeference,
    notes: &mut Vec<String>,
) -> Option<Route> {
    let mut route = Route::default();
    let mut sound = true;
    for (index, entry) in entries.iter().enumerate() {
        unused(entry, &["position", "turnRadius", "leg"], notes);
        let position = entry
            .require("position", "an object { lat, lon }")
            .and_then(|place| near(&place, earth));
        let position = if index == 0 {
            start.position.or(position)
        } else {
            position
        };
        let radius = entry.optional_number("turnRadius", MILES, "nautical miles");
        let leg = if index == 0 {
            None
        } else {
            Some(leg(entry, start.speed, notes))
        };
        let (Some(position), Some(radius)) = (position, radius) else {
            sound = false;
            continue;
        };
        let before = route.points.last().map(|p: &RoutePoint| p.position);
        if before.is_some_and(|before| !((position - before).norm() >= limits::LENGTH.low)) {
            entry.fault("the waypoint before it again", "a place of its own");
            sound = false;
        }
        match leg {
            None => {}
            Some(None) => sound = false,
            Some(Some((speed, blend))) => {
                route.speeds.push(speed);
                route.blends.push(blend);
            }
        }
        route.points.push(RoutePoint {
            position,
            turn_radius: radius.map(|miles| miles * NAUTICAL_MILE_M),
        });
    }
    sound.then_some(route)
}

/// Speed of the leg that ends at a waypoint, m/s, and the metres before and after the waypoint over which it changes.
fn leg(
    waypoint: &Json,
    initial_speed: Option<f64>,
    notes: &mut Vec<String>,
) -> Option<(f64, [f64; 2])> {
    let leg = waypoint.take("leg");
    if let Some(leg) = &leg {
        unused(leg, &["sog", "data"], notes);
    }
    let data = leg.as_ref().and_then(|leg| leg.take("data"));
    if let Some(data) = &data {
        unused(data, &["sog"], notes);
    }
    if let Some(point) = data.and_then(|data| data.take("sog")) {
        let speed = point
            .require("value", "a speed in knots")
            .and_then(|value| knots(&value, limits::SHIP_WAY));
        let blend = ["interpStart", "interpEnd"].map(|key| {
            let miles = point.optional_number(key, MILES, "nautical miles")?;
            Some(miles.unwrap_or(0.0) * NAUTICAL_MILE_M)
        });
        return Some((speed?, [blend[0]?, blend[1]?]));
    }
    let speed = match (leg.as_ref().and_then(|leg| leg.take("sog")), initial_speed) {
        (Some(speed), _) => knots(&speed, limits::SHIP_WAY)?,
        (None, Some(speed)) if limits::SHIP_WAY.contains(speed) => speed,
        (None, _) => {
            waypoint.fault("no speed of the leg that ends here", "leg.sog in knots");
            return None;
        }
    };
    Some((speed, [0.0; 2]))
}
