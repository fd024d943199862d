//! A planning problem: own ship, its goal, and the time of arrival.

use super::super::situation::{GivenHull, Own};
use super::super::xml::Xml;
use super::geometry::{point, shapes, state};
use crate::frame::{Pose, Vector, wrap};
use crate::input::Range;
use crate::scenario::limits;

/// Steps of a goal; it may begin before the scenario.
const STEPS: Range = Range::within(1e9);

/// Own ship of a problem. Its route leads over the waypoints to the middle of the goal, at its
/// speed, or at the speed that fits the goal's time.
pub(super) fn own(entry: &Xml, step: f64, notes: &mut Vec<String>) -> Option<Own> {
    let initial = entry
        .require("initialState", "position, orientation, time, velocity")
        .and_then(|entry| state(&entry));
    let goal = entry.require("goalState", "the goal").and_then(|goal| {
        let place = goal.require("position", "a point or a shape")?;
        Some((middle(&place)?, times(&goal, step)?))
    });
    if entry.all("goalState").count() > 1 {
        notes.push(format!(
            "{}: the first of several goals taken",
            entry.path()
        ));
    }
    let through: Option<Vec<Vector>> = entry
        .all("waypoint")
        .map(|waypoint| middle(&waypoint.require("position", "a point or a shape")?))
        .collect();
    let (initial, (goal, [earliest, latest]), through) = (initial?, goal?, through?);
    if initial.time > 0.0 {
        return entry.reject(
            format_args!("own ship at step {}", initial.time),
            "own ship from step 0",
        );
    }
    let mut route = vec![initial.position];
    route.extend(through);
    route.push(goal);
    if let Some(index) = route
        .windows(2)
        .position(|pair| !((pair[1] - pair[0]).norm() >= limits::LENGTH.low))
    {
        return entry.reject(
            format_args!(
                "point {} of the route where the one before it is",
                index + 1
            ),
            "places of their own",
        );
    }
    let length: f64 = route
        .windows(2)
        .map(|pair| (pair[1] - pair[0]).norm())
        .sum();
    let speed = initial.velocity.unwrap_or(0.0);
    if !(speed >= 0.0) {
        return entry.reject(format_args!("own ship at {speed} m/s"), "a speed ahead");
    }
    let took = if speed > 0.0 {
        length / speed
    } else {
        f64::INFINITY
    };
    let took = took.min(latest).max(earliest.max(0.0));
    let desired = length / took;
    if !limits::SHIP_WAY.contains(desired) {
        return entry.reject(
            format_args!("{length:.0} m to the goal in {took:.0} s"),
            "a speed at the start, or a goal in time, so that a ship can run it",
        );
    }
    notes.push(format!(
        "{}: of the goal its middle and its time are used",
        entry.path()
    ));
    Some(Own {
        pose: Pose::new(initial.position, wrap(initial.orientation)),
        speed,
        hull: GivenHull::NotInFormat,
        leg_speeds: vec![desired; route.len() - 1],
        route,
        horizon: latest.is_finite().then_some(latest),
    })
}

fn middle(place: &Xml) -> Option<Vector> {
    if let Some(at) = place.take("point") {
        return point(&at);
    }
    if let Some(water) = place.take("water") {
        return water.reject(
            "a goal in a waterway",
            "a point, a rectangle, a circle or a polygon",
        );
    }
    Some(shapes(place)?.first()?.outline.centroid())
}

/// The earliest and the latest second of a goal.
fn times(goal: &Xml, step: f64) -> Option<[f64; 2]> {
    let Some(entry) = goal.take("time") else {
        return Some([0.0, f64::INFINITY]);
    };
    if entry.take("exact").is_some() {
        let time = entry.exact(STEPS.in_unit("steps"))? * step;
        return Some([time; 2]);
    }
    let start = entry.required_number("intervalStart", STEPS.in_unit("steps"));
    let end = entry.required_number("intervalEnd", STEPS.in_unit("steps"));
    let [start, end] = [start?, end?];
    if !(end > 0.0 && end >= start) {
        return entry.reject(
            format_args!("steps {start} to {end}"),
            "an interval that ends after the start",
        );
    }
    Some([start * step, end * step])
}
