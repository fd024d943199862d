//! The mission of a route file for navigation systems: RTZ 1.0 to 1.2 (IEC 61174, annex S).

mod leg;

use std::collections::{BTreeMap, BTreeSet};
use std::fs::File;
use std::io::Read;
use std::path::Path;

use chrono::{DateTime, TimeDelta, Utc};

use super::import::xml::{self, Names, Xml};
use super::limits;
pub(super) use leg::RouteLeg;
use searoom_geometry::frame::{Geographic, NAUTICAL_MILE_M, mps_from_knots};
use searoom_input::text::counted;
use searoom_input::{
    DATE_TIME, Fault, Faults, InputError, Range, Remarks, abbreviated, date_time, every, read_text,
};

/// The versions of RTZ that are read.
const VERSIONS: [&str; 3] = ["1.0", "1.1", "1.2"];

/// The elements of a schedule that give speeds, the first before the second at each waypoint.
const SCHEDULES: [&str; 2] = ["calculated", "manual"];

/// Waypoints of a file. A mission has fewer, those within reach.
const WAYPOINTS: usize = 10_000;

/// Nautical miles: radii, cross-track limits.
const MILES: Range = Range::between(0.0, 1e4).in_unit("nautical miles");

/// Names that are read of each element, or say nothing about where and how fast a ship goes.
const NAMES: Names = &[
    (
        "route",
        &[
            "version",
            "schemaLocation",
            "routeInfo",
            "waypoints",
            "schedules",
        ],
    ),
    ("waypoints", &["defaultWaypoint", "waypoint"]),
    ("defaultWaypoint", &["radius", "leg"]),
    (
        "waypoint",
        &["id", "revision", "name", "radius", "position", "leg"],
    ),
    ("position", &["lat", "lon"]),
    (
        "leg",
        &[
            "starboardXTD",
            "portsideXTD",
            "speedMax",
            "geometryType",
            "legReport",
            "legInfo",
            "legNote1",
            "legNote2",
        ],
    ),
    ("schedules", &["schedule"]),
    ("schedule", &["id", "name", "calculated", "manual"]),
    ("calculated", &["scheduleElement"]),
    ("manual", &["scheduleElement"]),
    (
        "scheduleElement",
        &["waypointId", "etd", "eta", "stay", "speed", "note"],
    ),
];

#[derive(Debug, Clone, PartialEq)]
pub(super) struct Route {
    /// The waypoints, in the order of the file.
    pub places: Vec<Geographic>,
    /// The legs between them.
    pub legs: Vec<RouteLeg>,
    /// The departure from each waypoint, where the schedule has it in UTC.
    pub departs: Vec<Option<DateTime<Utc>>>,
    /// Content that is not used.
    pub remarks: Remarks,
}

impl Route {
    /// Reads a file, with the schedule of a name or an id, or the first one. The speed of a leg is
    /// that of the schedule at the waypoint where it ends, else the one that its times of departure
    /// and arrival give. Radii, cross-track limits and everything else are left out, with remarks.
    pub fn read(file: &Path, schedule: Option<&str>) -> Result<Self, InputError> {
        let mut begin = [0; 2];
        let read = File::open(file).and_then(|mut file| file.read_exact(&mut begin));
        if read.is_ok() && begin == *b"PK" {
            let allowed = "RTZ, which is XML: unzip it, and name the .rtz file in it";
            let fault = Fault::new("", "a zip archive, as RTZP is", allowed);
            return Err(InputError::faults(file, vec![fault]));
        }
        let text = read_text(file, limits::FILE_MEBIBYTES, "a route file")?;
        Self::parse(&text, schedule).map_err(|faults| InputError::faults(file, faults))
    }

    fn parse(text: &str, schedule: Option<&str>) -> Result<Self, Vec<Fault>> {
        let document = xml::parse(text).map_err(|fault| vec![fault])?;
        let faults = Faults::default();
        match route(&Xml::root(&document, &faults), schedule) {
            Some(route) if faults.is_empty() => Ok(route),
            _ => Err(faults.take()),
        }
    }
}

fn route(root: &Xml, wanted: Option<&str>) -> Option<Route> {
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
    if !(2..=WAYPOINTS).contains(&count) {
        return list.reject(
            format_args!("{count} waypoints"),
            format_args!("2 to {WAYPOINTS}"),
        );
    }
    let mut remarks = Remarks::default();
    let mut ids = BTreeSet::new();
    for waypoint in &waypoints {
        refuse_second(waypoint, &["position", "leg"]);
        if waypoint.attribute("id").is_some_and(|id| !ids.insert(id)) {
            return waypoint.reject("the id of a waypoint before", "an id of its own");
        }
    }
    if ids.len() < count {
        let without = counted(count - ids.len(), "waypoint");
        remarks.note(
            format_args!("{without} without id"),
            "no schedule is read for them",
        );
    }
    let places = every(waypoints.iter().map(place))?;
    let by_default = list.take("defaultWaypoint");
    radii(&waypoints, by_default.as_ref(), &mut remarks)?;
    let by_default = by_default.and_then(|waypoint| waypoint.take("leg"));
    let calls = schedule(root, &waypoints, wanted, &mut remarks)?;
    let of = |waypoint: &Xml| {
        let call = waypoint.attribute("id").and_then(|id| calls.get(id));
        call.copied().unwrap_or_default()
    };
    let calls: Vec<Call> = waypoints.iter().map(of).collect();
    let mut legs = Vec::with_capacity(count - 1);
    for (index, waypoint) in waypoints.iter().enumerate().skip(1) {
        let own = waypoint.take("leg");
        let has = |name: &str| {
            let mut legs = own.iter().chain(&by_default);
            legs.find(|leg| leg.attribute(name).is_some()).cloned()
        };
        let most = match has("speedMax") {
            Some(leg) => Some(in_mps(&leg, "speedMax")?),
            None => None,
        };
        let miles = ["portsideXTD", "starboardXTD"].map(|name| match has(name) {
            Some(leg) => leg.attribute_number(name, MILES).map(Some),
            None => Some(None),
        });
        let [port, starboard] = [miles[0]?, miles[1]?];
        let is_orthodrome = |leg: Xml| leg.attribute("geometryType") == Some("Orthodrome");
        legs.push(RouteLeg {
            from: places[index - 1],
            to: places[index],
            is_great_circle: has("geometryType").is_some_and(is_orthodrome),
            speed: calls[index].speed,
            most,
            limits: [port, starboard].map(|miles| miles.map(|miles| miles * NAUTICAL_MILE_M)),
            // at the last waypoint the mission is over
            wait: match index + 1 < count {
                true => calls[index].wait(),
                false => 0.0,
            },
        });
    }
    if calls[count - 1].stay.is_some_and(|stay| stay > 0.0) {
        remarks.note("stay at the last waypoint", "not used, the mission is over");
    }
    if calls[0].stay.is_some_and(|stay| stay > 0.0) && calls[0].arrives.is_none() {
        remarks.note(
            "stay at the first waypoint",
            "not used, the mission begins there",
        );
    }
    speeds_by_time(&mut legs, &calls, &mut remarks);
    leg::remark(&legs, &mut remarks);
    for name in root.unread(NAMES) {
        remarks.note(name, "not used");
    }
    Some(Route {
        places,
        legs,
        departs: calls.iter().map(|call| call.leaves()).collect(),
        remarks,
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

/// Remarks that turns have radii. At both ends of the route nothing turns.
fn radii(waypoints: &[Xml], by_default: Option<&Xml>, remarks: &mut Remarks) -> Option<()> {
    let corners = waypoints.get(1..waypoints.len() - 1).unwrap_or_default();
    let all = corners
        .iter()
        .chain(by_default.filter(|_| !corners.is_empty()));
    let given = all.filter(|waypoint| waypoint.attribute("radius").is_some());
    let radii = every(given.map(|waypoint| waypoint.attribute_number("radius", MILES)))?;
    let radii = radii.into_iter().filter(|miles| *miles > 0.0);
    if let Some(most) = radii.reduce(f64::max) {
        let metres = most * NAUTICAL_MILE_M;
        remarks.note(
            "radii of turns",
            format_args!("not used, up to {metres:.0} m; own ship turns by its turning_radius_m"),
        );
    }
    Some(())
}

/// Refuses a second element of a name, which could contradict the first.
fn refuse_second(element: &Xml, names: &[&str]) {
    for name in names {
        if let Some(second) = element.all(name).nth(1) {
            second.fault(format_args!("a second {name}"), format_args!("one {name}"));
        }
    }
}

/// Entry of a schedule at a waypoint.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
struct Call {
    /// Speed on the leg that ends here, m/s.
    speed: Option<f64>,
    arrives: Option<DateTime<Utc>>,
    departs: Option<DateTime<Utc>>,
    /// Seconds.
    stay: Option<f64>,
}

impl Call {
    /// The names of what another entry says otherwise.
    fn otherwise(&self, other: &Self) -> impl Iterator<Item = &'static str> {
        fn differ<T: PartialEq>(a: Option<T>, b: Option<T>) -> bool {
            a.zip(b).is_some_and(|(a, b)| a != b)
        }
        let all = [
            ("speed", differ(self.speed, other.speed)),
            ("eta", differ(self.arrives, other.arrives)),
            ("etd", differ(self.departs, other.departs)),
            ("stay", differ(self.stay, other.stay)),
        ];
        all.into_iter()
            .filter(|(_, differ)| *differ)
            .map(|(name, _)| name)
    }

    /// The other entry where this one says nothing.
    fn or(self, other: Self) -> Self {
        Self {
            speed: self.speed.or(other.speed),
            arrives: self.arrives.or(other.arrives),
            departs: self.departs.or(other.departs),
            stay: self.stay.or(other.stay),
        }
    }

    /// Seconds between arrival and departure.
    fn wait(&self) -> f64 {
        let between = self.arrives.zip(self.departs);
        let between = between.map(|(arrives, departs)| seconds(departs - arrives));
        self.stay.or(between).unwrap_or(0.0).max(0.0)
    }

    fn leaves(&self) -> Option<DateTime<Utc>> {
        self.departs.or_else(|| {
            let wait = TimeDelta::try_milliseconds((1e3 * self.wait()) as i64)?;
            self.arrives?.checked_add_signed(wait)
        })
    }

    fn comes(&self) -> Option<DateTime<Utc>> {
        self.arrives.or(self.departs)
    }
}

fn seconds(delta: TimeDelta) -> f64 {
    1e-3 * delta.num_milliseconds() as f64
}

/// Speeds of legs without one between two waypoints with times: one speed for all of them, so that
/// own ship arrives in time.
fn speeds_by_time(legs: &mut [RouteLeg], calls: &[Call], remarks: &mut Remarks) {
    let mut from = 0;
    let mut unused = false;
    for to in 1..calls.len() {
        let Some(comes) = calls[to].comes() else {
            continue;
        };
        let (leaves, between) = (calls[from].leaves(), &mut legs[from..to]);
        from = to;
        let Some(leaves) = leaves else {
            remarks.note(
                format_args!("times of waypoint {}", to + 1),
                "not used: no waypoint before it has a time",
            );
            continue;
        };
        let mut left = seconds(comes - leaves);
        let mut length = 0.0;
        for (index, leg) in between.iter().enumerate() {
            match leg.speed {
                Some(speed) => left -= leg.length() / speed,
                None => length += leg.length(),
            }
            if index + 1 < between.len() {
                left -= leg.wait;
            }
        }
        if length == 0.0 {
            unused = true;
            continue;
        }
        let speed = length / left;
        if !limits::WAY.contains(speed) {
            remarks.note(
                format_args!("times of waypoint {}", to + 1),
                format_args!("not used: {length:.0} m are left for {left:.0} s"),
            );
            continue;
        }
        for leg in between.iter_mut().filter(|leg| leg.speed.is_none()) {
            leg.speed = Some(speed);
        }
    }
    if unused {
        remarks.note("eta and etd", "not used where the schedule has speeds");
    }
}

/// The entries of the wanted schedule, or of the first one, by their waypoints.
fn schedule<'a>(
    root: &Xml<'a>,
    waypoints: &[Xml<'a>],
    wanted: Option<&str>,
    remarks: &mut Remarks,
) -> Option<BTreeMap<&'a str, Call>> {
    let list = root.take("schedules");
    let all: Vec<Xml> = list.iter().flat_map(|all| all.all("schedule")).collect();
    let mut read = Vec::with_capacity(all.len());
    let mut unused = Vec::with_capacity(all.len());
    for element in &all {
        refuse_second(element, &SCHEDULES);
        let (calls, otherwise) = schedule_of(element, waypoints, remarks)?;
        read.push(calls);
        unused.push(otherwise);
    }
    let named = |element: &Xml| {
        let name = element.attribute("name").or(element.attribute("id"));
        abbreviated(name.unwrap_or("without name"))
    };
    let names = || all.iter().map(named).collect::<Vec<_>>().join(", ");
    let chosen = match wanted {
        Some(wanted) => {
            let is_it = |element: &Xml| {
                ["name", "id"]
                    .map(|key| element.attribute(key))
                    .contains(&Some(wanted))
            };
            let Some(index) = all.iter().position(is_it) else {
                let found = format_args!("no schedule {}", abbreviated(wanted));
                return root.reject(found, format_args!("one of the schedules: {}", names()));
            };
            index
        }
        None => match read.iter().position(|calls| !calls.is_empty()) {
            Some(index) => index,
            None => return Some(BTreeMap::new()),
        },
    };
    let others = read
        .iter()
        .filter(|other| !other.is_empty() && **other != read[chosen]);
    if wanted.is_none() && others.count() > 0 {
        let statement = format_args!(
            "the first of {} is used; `schedule` in [mission] names another: {}",
            read.len(),
            names()
        );
        remarks.note(format_args!("schedule {}", named(&all[chosen])), statement);
    }
    if let [first, more @ ..] = &unused[chosen][..] {
        let more = match more.len() {
            0 => String::new(),
            more => format!(" and {}", counted(more, "more value")),
        };
        let statement =
            format_args!("{first}{more} not used, of which the calculated schedule says otherwise");
        remarks.note("manual schedule", statement);
    }
    Some(read.swap_remove(chosen))
}

/// Reads one schedule, and what of it is not used because the calculated one says otherwise. The
/// first waypoint has no leg before it.
fn schedule_of<'a>(
    element: &Xml<'a>,
    waypoints: &[Xml<'a>],
    remarks: &mut Remarks,
) -> Option<(BTreeMap<&'a str, Call>, Vec<String>)> {
    let first = waypoints
        .first()
        .and_then(|waypoint| waypoint.attribute("id"));
    let mut calls: BTreeMap<&str, Call> = BTreeMap::new();
    let mut unused = Vec::new();
    for kind in SCHEDULES.into_iter().filter_map(|kind| element.take(kind)) {
        refuse_backward(&kind, waypoints);
        let mut known = BTreeSet::new();
        for element in kind.all("scheduleElement") {
            let Some(at) = element.attribute("waypointId") else {
                remarks.note("scheduleElement without waypointId", "not used");
                continue;
            };
            if waypoints.iter().all(|w| w.attribute("id") != Some(at)) {
                let found = format_args!("waypointId {}", abbreviated(at));
                element.fault(found, "the id of a waypoint");
                continue;
            }
            if !known.insert(at) {
                let found = format_args!("waypointId {} again", abbreviated(at));
                element.fault(found, "one element for each waypoint");
            }
            let [arrives, departs] = ["eta", "etd"].map(|name| {
                let text = element.attribute(name)?;
                let time = date_time(text);
                if time.is_none() {
                    let statement = format_args!(
                        "not used, no offset from UTC: {name} {} of waypoint {}",
                        abbreviated(text),
                        abbreviated(at)
                    );
                    let subject = "times without a zone";
                    if !remarks.notes.iter().any(|note| note.starts_with(subject)) {
                        remarks.note(subject, statement);
                    }
                }
                time
            });
            let speed = match element.attribute("speed") {
                Some(_) if Some(at) != first => Some(in_mps(&element, "speed")?),
                _ => None,
            };
            let stay = match element.attribute("stay") {
                Some(text) => Some(stay(&element, text)?),
                None => None,
            };
            let call = Call {
                speed,
                arrives,
                departs,
                stay,
            };
            if call != Call::default() {
                let known = calls.remove(at).unwrap_or_default();
                let names = known.otherwise(&call);
                unused.extend(names.map(|n| format!("{n} of waypoint {}", abbreviated(at))));
                calls.insert(at, known.or(call));
            }
        }
    }
    Some((calls, unused))
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

/// Seconds of a stay: `hh:mm:ss`, or a duration of RTZ 1.2 such as `PT1H30M`.
fn stay(element: &Xml, text: &str) -> Option<f64> {
    let read = in_parts(text.trim()).or_else(|| duration(text.trim()));
    match read.filter(|seconds| limits::DURATION.high >= *seconds) {
        Some(seconds) => Some(seconds),
        None => element.reject(
            format_args!("a stay of {}", abbreviated(text)),
            format_args!(
                "hh:mm:ss, or a duration such as PT1H30M, of at most {} s",
                limits::DURATION.high
            ),
        ),
    }
}

/// Not negative, and finite.
fn amount(text: &str) -> Option<f64> {
    let digits = text
        .chars()
        .all(|letter| letter.is_ascii_digit() || letter == '.');
    text.parse().ok().filter(|_| digits)
}

fn in_parts(text: &str) -> Option<f64> {
    let parts: Vec<f64> = text.split(':').map(amount).collect::<Option<_>>()?;
    match parts[..] {
        [hours, minutes] => Some(3600.0 * hours + 60.0 * minutes),
        [hours, minutes, seconds] => Some(3600.0 * hours + 60.0 * minutes + seconds),
        _ => None,
    }
}

/// Days, hours, minutes and seconds of ISO 8601; months and years have no length.
fn duration(text: &str) -> Option<f64> {
    let text = text.strip_prefix('P')?;
    let (days, time) = text.split_once('T').unwrap_or((text, ""));
    let mut total = 0.0;
    for (part, units) in [(days, "D"), (time, "HMS")] {
        let mut rest = part;
        while !rest.is_empty() {
            let end = rest.find(|letter: char| letter.is_ascii_alphabetic())?;
            let unit = rest[end..]
                .chars()
                .next()
                .filter(|unit| units.contains(*unit))?;
            let size = match unit {
                'D' => 86_400.0,
                'H' => 3600.0,
                'M' => 60.0,
                _ => 1.0,
            };
            total += size * amount(&rest[..end])?;
            rest = &rest[end + 1..];
        }
    }
    Some(total)
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
    use crate::tests::rows;

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
        let route = Route::parse(ROUTE, None).expect("a route");
        assert_eq!(route.places.len(), 4);
        assert_eq!(route.places[2].lon_deg, 10.54);
        let knots = [None, Some(9.0), Some(6.0)].map(|speed| speed.map(mps_from_knots));
        let speeds: Vec<_> = route.legs.iter().map(|leg| leg.speed).collect();
        assert_eq!(speeds, knots);
        let most: Vec<_> = route.legs.iter().map(|leg| leg.most).collect();
        assert_eq!(
            most,
            [10.0, 8.0, 10.0].map(|speed| Some(mps_from_knots(speed)))
        );
        assert_eq!(route.departs[0], date_time("2026-05-01T08:00:00Z"));
        assert_eq!(
            route.remarks.notes,
            [
                "radii of turns: not used, up to 556 m; own ship turns by its turning_radius_m",
                "manual schedule: speed of waypoint \"4\" not used, of which the calculated schedule \
                 says otherwise",
                "stay at the last waypoint: not used, the mission is over",
            ]
        );
        // an empty schedule and one that says the same contradict nothing
        let (_, own) = ROUTE.split_once("<schedules>").expect("schedules");
        let (own, _) = own.split_once("</schedules>").expect("an end");
        let twice = ROUTE.replace(own, &format!("<schedule id=\"0\"/>{own}{own}"));
        assert_eq!(Route::parse(&twice, None), Ok(route));
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
            let route = Route::parse(&text, None).expect("a route");
            assert_eq!(route.departs[0], departs);
            let zone = route
                .remarks
                .notes
                .iter()
                .any(|note| note.starts_with("times without"));
            assert_eq!(zone, etd.ends_with("00:00\"") && !etd.contains('+'));
        }
    }

    /// Between two waypoints with times the legs without a speed share one, and a stay takes its
    /// part of the time.
    #[test]
    fn times_of_departure_and_arrival_give_speeds() {
        let (head, _) = ROUTE.split_once("<schedules>").expect("schedules");
        let entries = |first: &str| {
            format!(
                "{head}<schedules><schedule><manual>{first}<scheduleElement waypointId=\"3\" \
                 stay=\"PT5M\"/><scheduleElement waypointId=\"9\" \
                 eta=\"2026-05-01T09:05:00Z\"/></manual></schedule></schedules></route>"
            )
        };
        let first = "<scheduleElement waypointId=\"7\" etd=\"2026-05-01T08:00:00Z\"/>";
        let route = Route::parse(&entries(first), None).expect("a route");
        let [a, b, c] = &route.legs[..] else {
            panic!("three legs");
        };
        assert_eq!((a.wait, c.speed), (300.0, None));
        let took = (a.length() + b.length()) / a.speed.expect("a speed");
        assert!(a.speed == b.speed && (took - 3600.0).abs() < 1e-6, "{took}");
        // no time is left for the legs
        let late = first.replace("08:00:00Z", "09:04:00Z");
        let route = Route::parse(&entries(&late), None).expect("a route");
        assert!(route.legs.iter().all(|leg| leg.speed.is_none()));
        let notes = route.remarks.notes.join(" ");
        assert!(notes.contains("times of waypoint 3: not used"), "{notes}");
    }

    #[test]
    fn stays_are_times_of_day_or_durations() {
        for (text, seconds) in [
            ("00:01:51", Some(111.0)),
            ("01:30", Some(5400.0)),
            ("PT1H30M2.5S", Some(5402.5)),
            ("P1DT1M", Some(86_460.0)),
            ("P1M", None),
            ("PT1", None),
            ("long", None),
            ("-1:00", None),
            ("1:00:00:00", None),
        ] {
            let read = in_parts(text).or_else(|| duration(text));
            assert_eq!(read, seconds, "{text}");
        }
    }

    /// A part of the route, its replacement, and the line and the text of the fault.
    const MISTAKES: &str = r#"
        lat="59.02" | lat="95" | 7 | waypoint[2]/position: found
        lon="10.50" | | 6 | no attribute lon
        speed="6" | speed="-6" | 13 | scheduleElement: found "-6"
        Max="10" | Max="fast" | 7 | waypoint[2]/leg: found "fast"
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
        </manual> | </manual><manual/> | 17 | a second manual
        version="1.1" | version="2.0" | 2 | route: found version "2.0"
        route | track | 2 | the element "track"
    "#;

    #[test]
    fn faults_name_the_element_and_its_line() {
        for [old, new, line, named] in rows(MISTAKES) {
            assert!(ROUTE.contains(old), "{old}");
            let faults = Route::parse(&ROUTE.replace(old, new), None).expect_err(new);
            assert_eq!(faults[0].line, line.parse().ok(), "{new}: {faults:?}");
            assert!(faults[0].to_string().contains(named), "{}", faults[0]);
        }
        let (all, rest) = ROUTE
            .split_once("    <waypoint id=\"3\"")
            .expect("a waypoint");
        let (_, end) = rest.split_once("  </waypoints>").expect("an end");
        let faults = Route::parse(&format!("{all}  </waypoints>{end}"), None).expect_err("one");
        assert_eq!(faults[0].found, "1 waypoints");
    }
}
