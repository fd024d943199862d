//! DNV traffic situations (maritime-schema 0.1 and 0.2, JSON): degrees of WGS84, knots, degrees clockwise from true north,
//! metres; turn radii in nautical miles; the leg that ends at a waypoint is described there.

mod route;
mod ship;

use std::cell::RefCell;
use std::collections::BTreeSet;

use super::super::fault::Fault;
use super::super::file::Range;
use super::super::limits;
use super::assumed::{TURNING_LENGTHS, USUAL_HULL};
use super::json::Json;
use super::situation::{Declared, HullSaid, Other, Own, Situation};
use super::track::{RouteLeg, Track, TrackError};
use crate::frame::{
    GEOREFERENCE_REACH_M, Geographic, Georeference, Pose, Side, Vector, heading_of, mps_from_knots,
    radians_from_deg, wrap,
};
use route::{Route, route};
use ship::{Initial, fixed, initial};

/// Degrees. A heading nearer to the first leg's course than this is that course, rounded.
const ROUNDED_DEG: f64 = 1.0;

/// Keys that are read, and keys that mean nothing to a planner.
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
    root: &Json,
    faults: &RefCell<Vec<Fault>>,
) -> Result<Situation, Vec<Fault>> {
    let mut notes = Vec::new();
    unused(root, &ROOT_KEYS, &mut notes);
    let name = match root.take("title") {
        Some(title) => title.text(),
        None => Some("Traffic situation"),
    };
    let entry = root.require("ownShip", "an object: own ship");
    let earth = entry.as_ref().and_then(origin);
    let own = entry
        .zip(earth)
        .and_then(|(entry, earth)| own(&entry, &earth, &mut notes));
    let ships = match (root.take("targetShips"), earth) {
        (Some(list), Some(earth)) => list
            .list(0, limits::SHIPS, "ships")
            .and_then(|list| others(&list, &earth, &mut notes)),
        (Some(_), None) => None,
        (None, _) => {
            notes.push("targetShips: none in the file".to_owned());
            Some(Vec::new())
        }
    };
    // own ship's first place is looked at twice
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
        own,
        others,
        earth,
        declared: declared(name),
        notes,
    })
}

/// What a title like "HO, CR-GW" says: a kind of encounter per target, in their order.
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

/// Notes every key that is not read and may mean something.
fn unused(entry: &Json, known: &[&str], notes: &mut Vec<String>) {
    for key in entry.keys().filter(|key| !known.contains(key)) {
        let dot = if entry.path().is_empty() { "" } else { "." };
        notes.push(format!("{}{dot}{key}: not used", entry.path()));
    }
}

fn place(entry: &Json) -> Option<Geographic> {
    let lat_deg = entry.required_number("lat", limits::LATITUDE, "degrees north");
    let lon_deg = entry.required_number("lon", limits::LONGITUDE, "degrees east");
    Some(Geographic {
        lat_deg: lat_deg?,
        lon_deg: lon_deg?,
    })
}

fn waypoints<'a>(ship: &Json<'a>, least: usize) -> Option<Vec<Json<'a>>> {
    ship.require("waypoints", "a list of waypoints")?
        .list(least, limits::ROUTE_POINTS, "waypoints")
}

/// The plane about own ship's first place.
fn origin(own: &Json) -> Option<Georeference> {
    let start = own
        .take("initial")
        .and_then(|initial| initial.take("position"));
    let entry = match start {
        Some(start) => start,
        None => waypoints(own, 1)?
            .first()?
            .require("position", "an object { lat, lon }")?,
    };
    let place = place(&entry)?;
    let earth = Georeference::new(place);
    if earth.is_none() {
        entry.fault(
            place,
            format_args!("a latitude of {} degrees", limits::ORIGIN_LATITUDE),
        );
    }
    earth
}

fn near(entry: &Json, earth: &Georeference) -> Option<Vector> {
    let place = place(entry)?;
    let point = earth.to_near_plane(place);
    if point.is_none() {
        let far = earth.to_plane(place).norm() / 1000.0;
        let reach = GEOREFERENCE_REACH_M / 1000.0;
        entry.fault(
            format_args!("{place}, {far:.0} km from own ship's start"),
            format_args!("a place within {reach:.0} km of it"),
        );
    }
    point
}

/// A speed in m/s from one in knots.
fn knots(entry: &Json, range: Range) -> Option<f64> {
    entry
        .number(limits::in_knots(range), "knots")
        .map(mps_from_knots)
}

fn own(entry: &Json, earth: &Georeference, notes: &mut Vec<String>) -> Option<Own> {
    unused(entry, &SHIP_KEYS, notes);
    let initial = initial(entry, earth, notes);
    let fixed = fixed(entry, notes);
    let entries = waypoints(entry, 2);
    let known = initial.unwrap_or_default();
    let route = entries.and_then(|entries| route(&entries, &known, earth, notes));
    let (initial, fixed, route) = (initial?, fixed?, route?);
    if fixed.delay > 0.0 {
        entry.fault(
            format_args!("own ship {} s late (static.initDelay)", fixed.delay),
            "own ship from the start",
        );
        return None;
    }
    if route.points.iter().any(|p| p.turn_radius.is_some()) {
        notes.push(format!(
            "{}: turn radii of own ship's waypoints not used; hers is {TURNING_LENGTHS} lengths",
            entry.path()
        ));
    }
    let points: Vec<Vector> = route.points.iter().map(|p| p.position).collect();
    let first = heading_of(points[1] - points[0]);
    Some(Own {
        pose: Pose::new(points[0], initial.heading.unwrap_or(first)),
        speed: initial.speed.unwrap_or(route.speeds[0]),
        hull: fixed.hull,
        route: points,
        leg_speeds: route.speeds,
        horizon: None,
    })
}

fn others(list: &[Json], earth: &Georeference, notes: &mut Vec<String>) -> Option<Vec<Other>> {
    let mut names = BTreeSet::new();
    let mut others = Vec::with_capacity(list.len());
    for (index, entry) in list.iter().enumerate() {
        let ship = other(entry, earth, notes);
        others.push(ship.map(|(name, hull, track)| {
            let wanted = name.unwrap_or_else(|| format!("target {}", index + 1));
            let mut name = wanted.clone();
            let mut count = 2;
            while !names.insert(name.clone()) {
                name = format!("{wanted} ({count})");
                count += 1;
            }
            Other::Ship { name, hull, track }
        }));
    }
    others.into_iter().collect()
}

fn other(
    entry: &Json,
    earth: &Georeference,
    notes: &mut Vec<String>,
) -> Option<(Option<String>, HullSaid, Track)> {
    unused(entry, &SHIP_KEYS, notes);
    let initial = initial(entry, earth, notes);
    let fixed = fixed(entry, notes);
    let entries = waypoints(entry, 1);
    let known = initial.unwrap_or_default();
    let route = entries
        .as_ref()
        .and_then(|entries| route(entries, &known, earth, notes));
    let (initial, fixed, entries, route) = (initial?, fixed?, entries?, route?);
    let track = match route.points.as_slice() {
        [only] => steady(entry, only.position, &initial)?,
        _ => along(entry, &entries, &route, &initial, &fixed.hull)?,
    };
    let track = if fixed.delay > 0.0 {
        notes.push(format!(
            "{}: appears after {} s; taken to stand at her start until then",
            entry.path(),
            fixed.delay
        ));
        track.appearing(fixed.delay)
    } else {
        track
    };
    Some((fixed.name, fixed.hull, track))
}

/// One place, and on from there.
fn steady(entry: &Json, start: Vector, initial: &Initial) -> Option<Track> {
    match (initial.speed, initial.course) {
        (Some(speed), course) if speed == 0.0 => {
            Some(Track::straight(start, course.unwrap_or(0.0), speed))
        }
        (Some(speed), Some(course)) => Some(Track::straight(start, course, speed)),
        _ => {
            entry.fault(
                "one waypoint, and no speed and course at the start",
                "two waypoints, or initial.sog and initial.cog",
            );
            None
        }
    }
}

fn along(
    entry: &Json,
    entries: &[Json],
    route: &Route,
    initial: &Initial,
    hull: &HullSaid,
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
                entries[leg + 1].fault(
                    format_args!("a change of speed over {metres:.0} m of a leg of {length:.0} m"),
                    "changes within the legs beside the waypoint",
                );
                return None;
            }
            if *metres > 0.0 {
                reach(side, speed);
            }
        }
    }
    let length = match hull {
        HullSaid::Is(hull) => hull.length,
        HullSaid::Unsaid | HullSaid::Missing(_) => USUAL_HULL.length,
    };
    let start = initial.heading.filter(turned);
    match Track::along(&route.points, &legs, TURNING_LENGTHS * length, start) {
        Ok(track) => Some(track),
        Err(TrackError::Turn { point, begins }) => {
            let place = entries.get(point).unwrap_or(entry);
            place.fault(
                format_args!("a turnRadius whose turn begins {begins:.0} m before the waypoint"),
                "a turn that fits into the legs beside it",
            );
            None
        }
    }
}
