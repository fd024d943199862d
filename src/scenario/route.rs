//! The mission of a route file for navigation systems: RTZ 1.0 to 1.2 (IEC 61174, annex S).

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use chrono::{DateTime, Utc};

use super::import::xml::{self, Xml};
use super::limits;
use crate::frame::{Geographic, mps_from_knots};
use crate::input::{
    DATE_TIME, Fault, Faults, InputError, abbreviated, date_time, every, read_text,
};

/// The versions of RTZ that are read.
const VERSIONS: [&str; 3] = ["1.0", "1.1", "1.2"];

/// The elements of a schedule that give speeds, the first before the second at each waypoint.
const SCHEDULES: [&str; 2] = ["calculated", "manual"];

#[derive(Debug, Clone, PartialEq)]
pub(super) struct Route {
    /// The waypoints, in the order of the file.
    pub places: Vec<Geographic>,
    /// The speed of each leg, m/s, where the file has one.
    pub speeds: Vec<Option<f64>>,
    /// The departure from the first waypoint, where the schedule has it in UTC.
    pub departs: Option<DateTime<Utc>>,
}

impl Route {
    /// Reads a file. The speed of a leg is that of the schedule at the waypoint where it ends, else
    /// the highest that the leg allows. Radii and everything else are left out, and later dates, which
    /// only must not run backwards. A stay is a fault, as a desired trajectory does not wait.
    pub fn read(file: &Path) -> Result<Self, InputError> {
        let text = read_text(file, limits::FILE_MEBIBYTES, "a route file")?;
        Self::parse(&text).map_err(|faults| InputError::faults(file, faults))
    }

    fn parse(text: &str) -> Result<Self, Vec<Fault>> {
        let document = xml::parse(text).map_err(|fault| vec![fault])?;
        let faults = Faults::default();
        match route(&Xml::root(&document, &faults)) {
            Some(route) if faults.is_empty() => Ok(route),
            _ => Err(faults.take()),
        }
    }
}

fn route(root: &Xml) -> Option<Route> {
    if root.name() != "route" {
        let found = format_args!("the element {}", abbreviated(root.name()));
        return root.reject(found, "route, as in RTZ 1.0 to 1.2");
    }
    if let Some(version) = root.attribute("version").filter(|v| !VERSIONS.contains(v)) {
        let found = format_args!("version {}", abbreviated(version));
        root.fault(found, VERSIONS.join(", "));
    }
    refuse_second(root, &["waypoints", "schedules"]);
    let list = root.require("waypoints", "the waypoints of the route")?;
    refuse_second(&list, &["defaultWaypoint"]);
    let waypoints: Vec<Xml> = list.numbered("waypoint").collect();
    let count = waypoints.len();
    if !(2..=limits::WAYPOINTS).contains(&count) {
        let allowed = format_args!("2 to {}", limits::WAYPOINTS);
        return list.reject(format_args!("{count} waypoints"), allowed);
    }
    let mut ids = BTreeSet::new();
    for waypoint in &waypoints {
        refuse_second(waypoint, &["position", "leg"]);
        if waypoint.attribute("id").is_some_and(|id| !ids.insert(id)) {
            return waypoint.reject("the id of a waypoint before", "an id of its own");
        }
    }
    let places = every(waypoints.iter().map(place));
    let by_default = list.take("defaultWaypoint");
    let by_default = by_default.and_then(|waypoint| waypoint.take("leg"));
    let Schedule {
        speeds: planned,
        departs,
    } = schedule(root, &waypoints)?;
    let speed = |waypoint: &Xml| {
        if let Some(speed) = waypoint.attribute("id").and_then(|id| planned.get(id)) {
            return Some(Some(*speed));
        }
        let own = waypoint.take("leg");
        let mut legs = own.iter().chain(&by_default);
        match legs.find(|leg| leg.attribute("speedMax").is_some()) {
            Some(leg) => in_mps(leg, "speedMax").map(Some),
            None => Some(None),
        }
    };
    let speeds = every(waypoints[1..].iter().map(speed));
    Some(Route {
        places: places?,
        speeds: speeds?,
        departs,
    })
}

fn place(waypoint: &Xml) -> Option<Geographic> {
    let position = waypoint.require("position", "its latitude and longitude")?;
    let lat_deg = position.attribute_number("lat", limits::LATITUDE);
    let lon_deg = position.attribute_number("lon", limits::LONGITUDE);
    Some(Geographic {
        lat_deg: lat_deg?,
        lon_deg: lon_deg?,
    })
}

/// Refuses a second element of a name, which could contradict the first.
fn refuse_second(element: &Xml, names: &[&str]) {
    for name in names {
        if let Some(second) = element.all(name).nth(1) {
            second.fault(format_args!("a second {name}"), format_args!("one {name}"));
        }
    }
}

/// What a schedule says of the legs.
#[derive(Debug, Default, PartialEq)]
struct Schedule<'a> {
    /// Speeds, m/s, by the waypoint at which the leg ends.
    speeds: BTreeMap<&'a str, f64>,
    /// The departure from the first waypoint.
    departs: Option<DateTime<Utc>>,
}

/// The schedule of a route; a second one that says anything else is a fault.
fn schedule<'a>(root: &Xml<'a>, waypoints: &[Xml<'a>]) -> Option<Schedule<'a>> {
    let mut first: Option<Schedule> = None;
    for element in root
        .take("schedules")
        .iter()
        .flat_map(|all| all.all("schedule"))
    {
        refuse_second(&element, &SCHEDULES);
        let read = schedule_of(&element, waypoints)?;
        if read == Schedule::default() {
            continue;
        }
        match &first {
            Some(first) if *first != read => {
                let allowed = "one schedule, or several that say the same";
                return element
                    .reject("other speeds or dates than in the schedule before", allowed);
            }
            _ => first = Some(read),
        }
    }
    Some(first.unwrap_or_default())
}

/// Reads one schedule. The first waypoint has no leg before it, and at the last one the mission is
/// over.
fn schedule_of<'a>(element: &Xml<'a>, waypoints: &[Xml<'a>]) -> Option<Schedule<'a>> {
    let id = |waypoint: Option<&Xml<'a>>| waypoint.and_then(|waypoint| waypoint.attribute("id"));
    let ends = [id(waypoints.first()), id(waypoints.last())];
    let mut schedule = Schedule::default();
    for kind in SCHEDULES.into_iter().filter_map(|kind| element.take(kind)) {
        refuse_backward(&kind, waypoints);
        let mut known = BTreeSet::new();
        for element in kind.all("scheduleElement") {
            let Some(at) = element.attribute("waypointId") else {
                refuse_stay(&element)?;
                continue;
            };
            if waypoints.iter().all(|w| id(Some(w)) != Some(at)) {
                let found = format_args!("waypointId {}", abbreviated(at));
                element.fault(found, "the id of a waypoint");
                continue;
            }
            if !known.insert(at) {
                let found = format_args!("waypointId {} again", abbreviated(at));
                element.fault(found, "one element for each waypoint");
            }
            if Some(at) != ends[1] {
                refuse_stay(&element)?;
            }
            if Some(at) == ends[0] {
                let times = ["etd", "eta"].map(|name| element.attribute(name));
                let departs = times.into_iter().flatten().find_map(date_time);
                schedule.departs = schedule.departs.or(departs);
            } else if element.attribute("speed").is_some() {
                let speed = in_mps(&element, "speed")?;
                schedule.speeds.entry(at).or_insert(speed);
            }
        }
    }
    Some(schedule)
}

/// `None` for an element that waits.
fn refuse_stay(element: &Xml) -> Option<()> {
    match element.attribute("stay").filter(|stay| is_stay(stay)) {
        Some(stay) => element.reject(
            format_args!("a stay of {}", abbreviated(stay)),
            "none: a desired trajectory does not wait",
        ),
        None => Some(()),
    }
}

/// Refuses times of arrival and departure that run backwards along the route. Those without an
/// offset from UTC are not compared.
fn refuse_backward(kind: &Xml, waypoints: &[Xml]) {
    let elements: Vec<Xml> = kind.all("scheduleElement").collect();
    let mut last: Option<(DateTime<Utc>, &str)> = None;
    for waypoint in waypoints {
        let id = waypoint.attribute("id");
        let of_it = |element: &&Xml| id.is_some() && element.attribute("waypointId") == id;
        for element in elements.iter().filter(of_it) {
            let times = ["eta", "etd"].map(|name| element.attribute(name));
            for text in times.into_iter().flatten() {
                let Some(time) = date_time(text) else {
                    if text.trim_end().ends_with('Z') {
                        element.fault(abbreviated(text), DATE_TIME);
                    }
                    continue;
                };
                if let Some((_, before)) = last.filter(|(last, _)| time < *last) {
                    let found = format_args!("{} after {}", abbreviated(text), abbreviated(before));
                    let allowed = "times that do not run backwards along the route";
                    return element.fault(found, allowed);
                }
                last = Some((time, text));
            }
        }
    }
}

/// True for a stay of any length: a time of day, the duration of RTZ 1.2, or what cannot be read.
fn is_stay(stay: &str) -> bool {
    !stay
        .trim()
        .chars()
        .all(|letter| "0:.+-PDTHMS".contains(letter))
}

/// A speed in knots, in m/s.
fn in_mps(element: &Xml, attribute: &str) -> Option<f64> {
    let range = limits::WAY.in_knots().in_unit("kn");
    let knots = element.attribute_number(attribute, range)?;
    Some(mps_from_knots(knots))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::text::rows;

    /// A route of a navigation system. Changes are `old => new`, and what the fault names.
    const ROUTE: &str = r#"<?xml version="1.0" encoding="UTF-8"?>
<route version="1.1" xmlns="http://www.cirm.org/RTZ/1/1">
  <routeInfo routeName="To the pilot" vesselName="Any"/>
  <waypoints>
    <defaultWaypoint radius="0.3"><leg speedMax="8" geometryType="Loxodrome"/></defaultWaypoint>
    <waypoint id="7" radius="0.3"><position lat="59.00" lon="10.50"/></waypoint>
    <waypoint id="3" radius="0.3"><position lat="59.02" lon="10.50"/><leg speedMax="10"/></waypoint>
    <waypoint id="9" radius="0.3"><position lat="59.02" lon="10.54"/></waypoint>
    <waypoint id="4" radius="0.3"><position lat="59.04" lon="10.54"/><leg speedMax="10"/></waypoint>
  </waypoints>
  <schedules><schedule id="1"><calculated>
    <scheduleElement waypointId="7" etd="2026-05-01T08:00:00Z" speed="0"/>
    <scheduleElement waypointId="4" speed="6" stay="00:10:00"/>
  </calculated><manual>
    <scheduleElement waypointId="4" speed="7"/>
    <scheduleElement waypointId="9" speed="9" stay="00:00:00"/>
  </manual></schedule></schedules>
</route>
"#;

    #[test]
    fn a_leg_has_the_speed_of_its_schedule_or_its_own_or_that_of_all() {
        let route = Route::parse(ROUTE).expect("a route");
        assert_eq!(route.places.len(), 4);
        assert_eq!(route.places[2].lon_deg, 10.54);
        let knots = [10.0, 9.0, 6.0].map(|speed| Some(mps_from_knots(speed)));
        assert_eq!(route.speeds, knots);
        assert_eq!(route.departs, date_time("2026-05-01T08:00:00Z"));
        // an empty schedule and one that says the same contradict nothing
        let (_, own) = ROUTE.split_once("<schedules>").expect("schedules");
        let (own, _) = own.split_once("</schedules>").expect("an end");
        let twice = ROUTE.replace(own, &format!("<schedule id=\"0\"/>{own}{own}"));
        assert_eq!(Route::parse(&twice), Ok(route));
        // no date, one in local time, and one with its offset
        for (etd, departs) in [
            ("", None),
            ("etd=\"2026-05-01T08:00:00\"", None),
            (
                "eta=\"2026-05-01T10:00:00+02:00\"",
                date_time("2026-05-01T08:00:00Z"),
            ),
        ] {
            let text = ROUTE.replace("etd=\"2026-05-01T08:00:00Z\"", etd);
            assert_eq!(Route::parse(&text).expect("a route").departs, departs);
        }
    }

    /// A part of the route, its replacement, and the line and the text of the fault.
    const MISTAKES: &str = r#"
        lat="59.02" | lat="95" | 7 | waypoint[2]/position: found
        lon="10.50" | | 6 | no attribute lon
        speed="6" | speed="-6" | 13 | scheduleElement: found "-6"
        Max="10" | Max="fast" | 7 | waypoint[2]/leg: found "fast"
        etd="2026-05-01T08:00:00Z" | stay="00:10:00" | 12 | a stay of "00:10:00"
        etd="2026-05-01T08:00:00Z" | stay="long" | 12 | a stay of "long"
        </waypoints> | | 18 | expected 'waypoints' tag
        waypoints> | points> | 2 | route: found no waypoints
        id="9" | id="3" | 8 | the id of a waypoint before
        lat="59.00" | lat=" 99 " | 6 | position: found
        waypointId="9" | waypointId="8" | 16 | scheduleElement: found waypointId "8"
        waypointId="4" speed="6" | waypointId="4" eta="2026-05-01T07:59:59Z" | 13 | found "2026-05-01T07:59:59Z" after "2026-05-01T08:00:00Z"
        waypointId="4" speed="6" | waypointId="4" eta="2026-13-01T07:59:59Z" | 13 | found "2026-13-01T07:59:59Z"; allowed: a date
        <waypoint id="9" radius="0.3"> | <waypoint id="9" radius="0.3"><position lat="1" lon="1"/> | 8 | found a second position
        waypointId="9" speed="9" | waypointId="4" speed="9" | 16 | waypointId "4" again
        <schedule id="1"> | <schedule id="2"><manual><scheduleElement waypointId="4" speed="5"/></manual></schedule><schedule id="1"> | 11 | other speeds or dates than
        </manual> | </manual><manual/> | 17 | a second manual
        version="1.1" | version="2.0" | 2 | route: found version "2.0"
        route | track | 2 | the element "track"
    "#;

    #[test]
    fn faults_name_the_element_and_its_line() {
        for [old, new, line, named] in rows(MISTAKES) {
            assert!(ROUTE.contains(old), "{old}");
            let faults = Route::parse(&ROUTE.replace(old, new)).expect_err(new);
            assert_eq!(faults[0].line, line.parse().ok(), "{new}: {faults:?}");
            assert!(faults[0].to_string().contains(named), "{}", faults[0]);
        }
        let (all, rest) = ROUTE
            .split_once("    <waypoint id=\"3\"")
            .expect("a waypoint");
        let (_, end) = rest.split_once("  </waypoints>").expect("an end");
        let faults = Route::parse(&format!("{all}  </waypoints>{end}")).expect_err("one");
        assert_eq!(faults[0].found, "1 waypoints");
    }
}
