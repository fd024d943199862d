//! A planning problem: own ship, its goal, and the time of arrival.

use super::super::situation::{GivenHull, Own, OwnRoute};
use super::super::xml::Xml;
use super::geometry::{point, shapes, state};
use crate::limits;
use searoom_geometry::frame::{Pose, Vector, wrap};
use searoom_input::{Range, Remarks, abbreviated};

/// Steps of a goal; it may begin before the scenario.
const STEPS: Range = Range::within(1e9);

/// Own ship of a problem. Its route leads over the waypoints to the middle of the goal, at its
/// speed, or at the speed that fits the goal's time.
///
/// Time begins at the step of its initial state, which is returned with it. Without a speed of its
/// own, and without a time of the goal, it has the `assumed` one.
pub(super) fn own(
    entry: &Xml,
    step: f64,
    assumed: Option<f64>,
    remarks: &mut Remarks,
) -> Option<(Own, f64)> {
    let initial = entry
        .require("initialState", "position, orientation, time, velocity")
        .and_then(|entry| state(&entry));
    let goal = entry.require("goalState", "the goal").and_then(|goal| {
        let place = goal.require("position", "a point or a shape")?;
        Some((middle(&place)?, goal))
    });
    if entry.all("goalState").count() > 1 {
        remarks.note(entry.path(), "the first of several goals taken");
    }
    let through: Option<Vec<Vector>> = entry
        .all("waypoint")
        .map(|waypoint| middle(&waypoint.require("position", "a point or a shape")?))
        .collect();
    let (initial, (goal, goal_state), through) = (initial?, goal?, through?);
    let begins = initial.time;
    let [earliest, latest] = times(&goal_state, step, begins)?;
    if begins > 0.0 {
        let statement = format_args!(
            "time begins at own ship's step {begins}, {} s after the first",
            begins * step
        );
        remarks.note(entry.path(), statement);
    }
    let apart = entry.attribute("maxLateralDeviation").map(str::to_owned);
    let apart = apart.or_else(|| Some(entry.take("maxLateralDeviation")?.text().to_owned()));
    if let Some(apart) = apart {
        let apart = apart
            .trim()
            .parse::<f64>()
            .map_or(abbreviated(&apart), |m| m.to_string());
        remarks.caution(
            "maxLateralDeviation",
            format_args!(
                "not kept; {} allows {} m to the side of the route, and a plan may leave it \
                 farther",
                entry.path(),
                apart
            ),
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
    let speed = match (initial.velocity, assumed) {
        (Some(speed), _) => speed,
        (None, Some(speed)) => {
            remarks.note(entry.path(), "no velocity; that of --own-speed-mps taken");
            speed
        }
        (None, None) => 0.0,
    };
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
            "a speed at the start, or a goal in time, so that a ship can run it; or --own-speed-mps \
             without a velocity",
        );
    }
    remarks.note(entry.path(), "of the goal its middle and its time are used");
    let own = Own {
        pose: Pose::new(initial.position, wrap(initial.orientation)),
        speed,
        hull: GivenHull::NotInFormat,
        route: OwnRoute::Points {
            leg_speeds: vec![desired; route.len() - 1],
            points: route,
        },
        horizon: latest.is_finite().then_some(latest),
    };
    Some((own, begins))
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
    Some(shapes(place)?.first()?.centroid())
}

/// The earliest and the latest second of a goal after the step at which own ship begins.
fn times(goal: &Xml, step: f64, begins: f64) -> Option<[f64; 2]> {
    let Some(entry) = goal.take("time") else {
        return Some([0.0, f64::INFINITY]);
    };
    if entry.take("exact").is_some() {
        let time = (entry.exact(STEPS.in_unit("steps"))? - begins) * step;
        return Some([time; 2]);
    }
    let start = entry.required_number("intervalStart", STEPS.in_unit("steps"));
    let end = entry.required_number("intervalEnd", STEPS.in_unit("steps"));
    let [start, end] = [start? - begins, end? - begins];
    if !(end > 0.0 && end >= start) {
        return entry.reject(
            format_args!("steps {} to {}", start + begins, end + begins),
            "an interval that ends after the start",
        );
    }
    Some([start * step, end * step])
}
