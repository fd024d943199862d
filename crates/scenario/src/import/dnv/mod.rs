//! DNV traffic situations (maritime-schema 0.1 and 0.2, JSON). Degrees of WGS84, knots, degrees
//! clockwise from true north, metres; turn radii in nautical miles. A waypoint describes the leg
//! that ends there.

mod ship;

use std::collections::BTreeSet;

use super::assumed::{Assumed, TURNING_LENGTHS, USUAL_HULL};
use super::situation::{Declared, GivenHull, Other, Own, OwnRoute, Situation};
use crate::status;
use crate::{limits, plane};
use searoom_geometry::frame::{
    Geographic, Georeference, NAUTICAL_MILE_M, Pose, Side, Vector, heading_of, mps_from_knots,
    radians_from_deg, wrap,
};
use searoom_input::{Fault, Faults, Field, Range, Remarks};
use searoom_model::target::Status;
use searoom_model::target::route::{RouteLeg, RoutePoint, TightTurn, Track};
use ship::{Initial, fixed, initial};

/// Degrees: a heading nearer to the first leg's course than this is that course, rounded.
const ROUNDED_DEG: f64 = 1.0;

/// Keys that are read, or that mean nothing to a planner.
const ROOT_KEYS: [&str; 8] = [
    "version",
    "schemaVersion",
    "trafficgenVersion",
    "title",
    "description",
    "startTime",
    "ownShip",
    "targetShips",
];
const SHIP_KEYS: [&str; 3] = ["waypoints", "static", "initial"];

/// The situation of a file; an error with every fault.
pub(super) fn situation(
    root: &Field,
    faults: &Faults,
    assumed: &Assumed,
) -> Result<Situation, Vec<Fault>> {
    if let Some(fault) = other_version(root) {
        return Err(vec![fault]);
    }
    let mut remarks = Remarks::default();
    unused(root, &ROOT_KEYS, &mut remarks);
    let name = match root.get("title") {
        Some(title) => title.line_of_text().map(str::trim),
        None => Some("Traffic situation"),
    };
    let field = root.require("ownShip", "an object: own ship");
    let earth = field.as_ref().and_then(origin);
    let own = field
        .zip(earth)
        .and_then(|(field, earth)| own(&field, &earth, assumed.own_speed, &mut remarks));
    let ships = match (root.get("targetShips"), earth) {
        (Some(list), Some(earth)) => list
            .list(0..=limits::SHIPS, "ships")
            .and_then(|list| others(&list, &earth, &mut remarks)),
        (Some(_), None) => None,
        (None, _) => {
            remarks
                .notes
                .push("targetShips: none in the file".to_owned());
            Some(Vec::new())
        }
    };
    // own ship's first position is read twice
    let mut noted: Vec<Fault> = Vec::new();
    for fault in faults.take() {
        if !noted.contains(&fault) {
            noted.push(fault);
        }
    }
    let (Some(own), Some(others), Some(name), true) = (own, ships, name, noted.is_empty()) else {
        return Err(noted);
    };
    Ok(Situation {
        name: name.to_owned(),
        id: None,
        start_utc: None,
        own,
        others,
        earth,
        declared: declared(name),
        remarks,
    })
}

/// Statements of a title like "HO, CR-GW": a kind of encounter for each target.
fn declared(title: &str) -> Declared {
    let sides: Option<Vec<Option<Side>>> = title
        .split(',')
        .map(|kind| match kind.trim() {
            "HO" | "OT-GW" | "OT-SO" => Some(None),
            "CR-GW" => Some(Some(Side::Starboard)),
            "CR-SO" => Some(Some(Side::Port)),
            _ => None,
        })
        .collect();
    match sides {
        Some(sides) => Declared {
            ships: Some(sides.len()),
            sides,
        },
        None => Declared::default(),
    }
}

/// A fault for maritime-schema 0.0, whose positions have other keys. It is no small slip: speeds,
/// sizes and dates have other places, too.
fn other_version(root: &Field) -> Option<Fault> {
    let own = root.get("ownShip").filter(Field::is_table)?;
    let initial = own.get("initial").filter(Field::is_table);
    let initial = initial.and_then(|initial| initial.get("position"));
    let waypoints = own.get("waypoints");
    let waypoints = waypoints.and_then(|list| list.list(0..=usize::MAX, "waypoints"));
    let first = waypoints.and_then(|list| list.into_iter().next());
    let first = first
        .filter(Field::is_table)
        .and_then(|first| first.get("position"));
    let mut places = initial.into_iter().chain(first);
    let old = places.find(|place| place.keys().any(|key| key == "latitude"))?;
    Some(Fault::new(
        old.path(),
        "latitude and longitude, as maritime-schema 0.0 has them",
        "lat and lon, as in a situation of maritime-schema 0.1 or 0.2",
    ))
}

/// The navigational status, a word or a code; one that is not known is a note.
fn nav_status(ship: &Field, name: &str, remarks: &mut Remarks) -> Option<Status> {
    let initial = ship.get("initial").filter(Field::is_table);
    let status = initial.and_then(|initial| initial.get("navStatus"))?;
    let code = status.any_number().map(|code| code.to_string());
    let word = status.any_text().map(str::to_owned).or(code);
    let word = word.unwrap_or_default();
    let known = status::of_word(&word);
    if known.is_none() {
        remarks.note(name, format_args!("navStatus \"{word}\" not used"));
    }
    known
}

fn unused(field: &Field, known: &[&str], remarks: &mut Remarks) {
    for key in field.keys().filter(|key| !known.contains(key)) {
        let dot = if field.path().is_empty() { "" } else { "." };
        remarks
            .notes
            .push(format!("{}{dot}{key}: not used", field.path()));
    }
}

fn place(field: &Field) -> Option<Geographic> {
    let lat_deg = field.required_number("lat", limits::LATITUDE.in_unit("degrees north"));
    let lon_deg = field.required_number("lon", limits::LONGITUDE.in_unit("degrees east"));
    Some(Geographic::new(lat_deg?, lon_deg?))
}

fn waypoints<'a>(ship: &Field<'a>, least: usize) -> Option<Vec<Field<'a>>> {
    ship.require("waypoints", "a list of waypoints")?
        .list(least..=limits::ROUTE_POINTS, "waypoints")
}

/// The plane about own ship's first position.
fn origin(own: &Field) -> Option<Georeference> {
    let start = own
        .get("initial")
        .and_then(|initial| initial.get("position"));
    let field = match start {
        Some(start) => start,
        None => waypoints(own, 1)?
            .first()?
            .require("position", "an object { lat, lon }")?,
    };
    let place = place(&field)?;
    let earth = Georeference::new(place);
    if earth.is_none() {
        field.fault(
            place,
            format_args!("a latitude of {} degrees", limits::ORIGIN_LATITUDE),
        );
    }
    earth
}

fn near(field: &Field, earth: &Georeference) -> Option<Vector> {
    plane::near(field, place(field)?, earth)
}

/// A speed in m/s from one in knots.
fn knots(field: &Field, range: Range) -> Option<f64> {
    field
        .number(range.in_knots().in_unit("knots"))
        .map(mps_from_knots)
}

fn own(
    field: &Field,
    earth: &Georeference,
    assumed_speed: Option<f64>,
    remarks: &mut Remarks,
) -> Option<Own> {
    unused(field, &SHIP_KEYS, remarks);
    let initial = initial(field, earth, remarks);
    let fixed = fixed(field, remarks);
    let fields = waypoints(field, 2);
    let known = initial.unwrap_or_default();
    let speed = assumed_speed.map(|speed| (speed, "taken, by --own-speed-mps"));
    let route = fields.and_then(|fields| route(&fields, &known, speed, earth, remarks));
    let (initial, fixed, route) = (initial?, fixed?, route?);
    if let Some(status) = nav_status(field, "own ship", remarks) {
        status::remark("own ship", status, remarks);
    }
    if fixed.delay > 0.0 {
        return field.reject(
            format_args!("own ship {} s late (static.initDelay)", fixed.delay),
            "own ship from the start",
        );
    }
    if route.points.iter().any(|p| p.turn_radius.is_some()) {
        remarks.notes.push(format!(
            "{}: turn radii of own ship's waypoints not used; \
             its radius is {TURNING_LENGTHS} lengths",
            field.path()
        ));
    }
    let points: Vec<Vector> = route.points.iter().map(|p| p.position).collect();
    let first = heading_of(points[1] - points[0]);
    Some(Own {
        pose: Pose::new(points[0], initial.heading.unwrap_or(first)),
        speed: initial.speed.unwrap_or(route.speeds[0]),
        hull: fixed.hull,
        route: OwnRoute::Points {
            points,
            leg_speeds: route.speeds,
        },
        horizon: None,
    })
}

fn others(list: &[Field], earth: &Georeference, remarks: &mut Remarks) -> Option<Vec<Other>> {
    let mut names = BTreeSet::new();
    let mut others = Vec::with_capacity(list.len());
    for (index, field) in list.iter().enumerate() {
        let ship = other(field, earth, remarks);
        others.push(ship.map(|(name, hull, track, status)| {
            let wanted = name.unwrap_or_else(|| format!("target {}", index + 1));
            let mut name = wanted.clone();
            let mut count = 2;
            while !names.insert(name.clone()) {
                name = format!("{wanted} ({count})");
                count += 1;
            }
            Other::Ship {
                name,
                hull,
                track,
                off: 0.0,
                status,
            }
        }));
    }
    others.into_iter().collect()
}

fn other(
    field: &Field,
    earth: &Georeference,
    remarks: &mut Remarks,
) -> Option<(Option<String>, GivenHull, Track, Option<Status>)> {
    unused(field, &SHIP_KEYS, remarks);
    let initial = initial(field, earth, remarks);
    let fixed = fixed(field, remarks);
    let fields = waypoints(field, 1);
    let known = initial.unwrap_or_default();
    let route = fields
        .as_ref()
        .and_then(|fields| route(fields, &known, None, earth, remarks));
    let (initial, fixed, fields, route) = (initial?, fixed?, fields?, route?);
    let track = match route.points.as_slice() {
        [only] => steady(field, only.position, &initial)?,
        _ => along(field, &fields, &route, &initial, &fixed.hull)?,
    };
    let track = if fixed.delay > 0.0 {
        remarks.notes.push(format!(
            "{}: appears after {} s; taken to stand at its start until then",
            field.path(),
            fixed.delay
        ));
        track.appearing(fixed.delay)
    } else {
        track
    };
    let place = field.path();
    let status = nav_status(field, fixed.name.as_deref().unwrap_or(&place), remarks);
    Some((fixed.name, fixed.hull, track, status))
}

/// A track from one point, with constant course and speed.
fn steady(field: &Field, start: Vector, initial: &Initial) -> Option<Track> {
    match (initial.speed, initial.course) {
        (Some(speed), course) if speed == 0.0 => {
            Some(Track::straight(start, course.unwrap_or(0.0), speed))
        }
        (Some(speed), Some(course)) => Some(Track::straight(start, course, speed)),
        _ => field.reject(
            "one waypoint, and no speed and course at the start",
            "two waypoints, or initial.sog and initial.cog",
        ),
    }
}

fn along(
    field: &Field,
    fields: &[Field],
    route: &Route,
    initial: &Initial,
    hull: &GivenHull,
) -> Option<Track> {
    let first = heading_of(route.points[1].position - route.points[0].position);
    let turned = |heading: &f64| wrap(first - heading).abs() > radians_from_deg(ROUNDED_DEG);
    let mut legs: Vec<RouteLeg> = route
        .speeds
        .iter()
        .map(|v| RouteLeg { slow: *v, fast: *v })
        .collect();
    let mut reach = |leg: usize, speed: f64| {
        legs[leg].slow = legs[leg].slow.min(speed);
        legs[leg].fast = legs[leg].fast.max(speed);
    };
    if let Some(speed) = initial.speed {
        reach(0, speed);
    }
    for (leg, blend) in route.blends.iter().enumerate().take(route.speeds.len() - 1) {
        let sides = [(leg, route.speeds[leg + 1]), (leg + 1, route.speeds[leg])];
        for ((side, speed), metres) in sides.into_iter().zip(blend) {
            let length = (route.points[side + 1].position - route.points[side].position).norm();
            if !(*metres <= length) {
                return fields[leg + 1].reject(
                    format_args!("a change of speed over {metres:.0} m of a leg of {length:.0} m"),
                    "changes within the legs beside the waypoint",
                );
            }
            if *metres > 0.0 {
                reach(side, speed);
            }
        }
    }
    let length = match hull {
        GivenHull::Known(hull) => hull.length,
        GivenHull::NotInFormat | GivenHull::Missing(_) | GivenHull::Unknown { .. } => {
            USUAL_HULL.length
        }
    };
    let start = initial.heading.filter(turned);
    match Track::along(&route.points, &legs, TURNING_LENGTHS * length, start) {
        Ok(track) => Some(track),
        Err(TightTurn { point, begins }) => {
            let place = fields.get(point).unwrap_or(field);
            place.reject(
                format_args!("a turnRadius whose turn begins {begins:.0} m before the waypoint"),
                "a turn that fits into the legs beside it",
            )
        }
    }
}

/// Nautical miles: radii of turns, distances over which the speed changes.
const MILES: Range = Range::between(0.0, 100.0);

#[derive(Debug, Default)]
struct Route {
    points: Vec<RoutePoint>,
    /// m/s, one per leg.
    speeds: Vec<f64>,
    /// Metres before and after the waypoint at the end of each leg over which the speed changes.
    blends: Vec<[f64; 2]>,
}

/// A route. A leg without a speed has that of the initial state, else that of the first waypoint,
/// else the `assumed` one, which has its reason.
fn route(
    fields: &[Field],
    start: &Initial,
    assumed: Option<(f64, &str)>,
    earth: &Georeference,
    remarks: &mut Remarks,
) -> Option<Route> {
    let mut route = Route::default();
    let mut sound = true;
    let usual = match start
        .speed
        .filter(|speed| limits::SHIP_WAY.contains(*speed))
    {
        Some(speed) => Some((speed, None)),
        None => {
            let first = fields.first().and_then(first_speed);
            let first = first.map(|speed| (speed, "that of the first waypoint taken"));
            first
                .or(assumed)
                .map(|(speed, reason)| (speed, Some(reason)))
        }
    };
    for (index, field) in fields.iter().enumerate() {
        unused(field, &["position", "turnRadius", "leg"], remarks);
        let position = field
            .require("position", "an object { lat, lon }")
            .and_then(|place| near(&place, earth));
        let position = if index == 0 {
            start.position.or(position)
        } else {
            position
        };
        let radius = field.optional_number("turnRadius", MILES.in_unit("nautical miles"));
        let leg = if index == 0 {
            None
        } else {
            Some(leg(field, usual, remarks))
        };
        let (Some(position), Some(radius)) = (position, radius) else {
            sound = false;
            continue;
        };
        let before = route.points.last().map(|p: &RoutePoint| p.position);
        if before.is_some_and(|before| !((position - before).norm() >= limits::LENGTH.low)) {
            field.fault("the waypoint before it again", "a place of its own");
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

/// Speed at the first waypoint, m/s, where no leg ends: trafficgen 0.9.1 writes a leg's speed there
/// alone where own ship was asked for with one waypoint.
fn first_speed(waypoint: &Field) -> Option<f64> {
    let speed = waypoint.get("leg").filter(Field::is_table)?.get("sog")?;
    let knots = speed.any_number()?;
    Some(mps_from_knots(knots)).filter(|speed| limits::SHIP_WAY.contains(*speed))
}

/// Speed of the leg that ends at a waypoint, m/s, and the metres before and after the waypoint over
/// which the speed changes.
fn leg(
    waypoint: &Field,
    usual: Option<(f64, Option<&str>)>,
    remarks: &mut Remarks,
) -> Option<(f64, [f64; 2])> {
    let leg = waypoint.get("leg");
    if let Some(leg) = &leg {
        unused(leg, &["sog", "data"], remarks);
    }
    let data = leg.as_ref().and_then(|leg| leg.get("data"));
    if let Some(data) = &data {
        unused(data, &["sog"], remarks);
    }
    if let Some(point) = data.and_then(|data| data.get("sog")) {
        let speed = point
            .require("value", "a speed in knots")
            .and_then(|value| knots(&value, limits::SHIP_WAY));
        let blend = ["interpStart", "interpEnd"].map(|key| {
            let miles = point.optional_number(key, MILES.in_unit("nautical miles"))?;
            Some(miles.unwrap_or(0.0) * NAUTICAL_MILE_M)
        });
        return Some((speed?, [blend[0]?, blend[1]?]));
    }
    let speed = match (leg.as_ref().and_then(|leg| leg.get("sog")), usual) {
        (Some(speed), _) => knots(&speed, limits::SHIP_WAY)?,
        (None, Some((speed, reason))) => {
            if let Some(reason) = reason {
                remarks.notes.push(format!(
                    "{}: no speed of this leg; {reason}",
                    waypoint.path()
                ));
            }
            speed
        }
        (None, None) => {
            let allowed = "leg.sog in knots; or --own-speed-mps for own ship";
            return waypoint.reject("no speed of the leg that ends here", allowed);
        }
    };
    Some((speed, [0.0; 2]))
}
