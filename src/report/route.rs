//! The legs of a plan as a file for spreadsheets, charts and navigation systems.

use std::f64::consts::FRAC_PI_2;
use std::fmt::Write;
use std::path::Path;

use chrono::{DateTime, SecondsFormat, Utc};
use geojson::{Feature, FeatureCollection, Geometry, GeometryValue, JsonObject, Position};

use crate::document::{CLOSEST, PlanDocument, PlannedLeg, planned_legs};
use crate::frame::{
    GEOREFERENCE_REACH_M, Geographic, Georeference, NAUTICAL_MILE_M, Vector, knots_from_mps,
};
use crate::scenario::after;
use crate::text::printable;
use crate::trajectory::Segment;

/// Largest turn between two points of a GeoJSON line, degrees.
const POINT_DEG: f64 = 5.0;

/// Longest turning radius of RTZ, nautical miles.
const RTZ_RADIUS_NMI: f64 = 5.0;

/// RTZ stays are shorter, seconds.
const RTZ_STAY_S: f64 = 86_400.0;

/// Format of a route, by the ending of its file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum RouteFormat {
    /// A row per leg; places also in degrees where the scenario has an origin within reach.
    Csv,
    /// A line per leg (RFC 7946). Needs an origin.
    GeoJson,
    /// Waypoints with turning radii and speeds for navigation systems: RTZ 1.1 of IEC 61174. Needs
    /// an origin. Legs are orthodromes, as straight lines of the plane nearly are; a wait is a
    /// stay. Times of arrival need the date of the scenario.
    Rtz,
}

/// Why there is no route.
#[derive(Debug, thiserror::Error)]
pub enum RouteError {
    /// There is no plan.
    #[error("there is no plan, so no route is written")]
    NoPlan,
    /// The plan enters a hard set, a hull or land.
    #[error("the plan is not safe, so no route is written; `--json` writes any plan")]
    NotSafe,
    /// The plan has no segments.
    #[error("there are no legs: only a plan of segments has them; `--json` writes any plan")]
    NoLegs,
    /// The scenario has no origin.
    #[error(
        "found a scenario without 'origin'; allowed: one with it, or a route that ends in .csv"
    )]
    NoOrigin,
    /// The plane is no map of the Earth so far from its origin.
    #[error("the plan goes farther than 100 km from 'origin'; allowed: a nearer one, or .csv")]
    TooFar,
    /// A radius or a stay beyond what the format can state.
    #[error("RTZ states radii up to 5 nmi and stays below a day; allowed: .csv or .geojson")]
    BeyondRtz,
    /// The rows of a CSV file could not be made.
    #[error(transparent)]
    Csv(#[from] csv::Error),
}

impl RouteFormat {
    /// The endings, for messages.
    pub const ENDINGS: &str = ".csv, .geojson or .rtz";

    /// The format of a file; `None` for any other ending.
    pub fn of(path: &Path) -> Option<Self> {
        match path.extension()?.to_str()? {
            "csv" => Some(Self::Csv),
            "geojson" => Some(Self::GeoJson),
            "rtz" => Some(Self::Rtz),
            _ => None,
        }
    }

    /// The whole file. Where the date and time of the present is known, each place has its own.
    pub fn write(
        self,
        plan: &PlanDocument,
        earth: Option<&Georeference>,
        present: Option<DateTime<Utc>>,
    ) -> Result<String, RouteError> {
        if plan.trajectory.is_none() {
            return Err(RouteError::NoPlan);
        }
        if !plan.is_safe() {
            return Err(RouteError::NotSafe);
        }
        let legs = planned_legs(plan);
        if legs.is_empty() {
            return Err(RouteError::NoLegs);
        }
        let ends = legs
            .iter()
            .flat_map(|leg| [leg.motion.start, leg.motion.end()]);
        let far = |place: Vector| place.norm() > GEOREFERENCE_REACH_M;
        let is_far = ends.into_iter().any(|end| far(end.position));
        match (self, earth) {
            (Self::Csv, _) => Ok(csv(&legs, earth.filter(|_| !is_far), present)?),
            (_, None) => Err(RouteError::NoOrigin),
            (_, Some(_)) if is_far => Err(RouteError::TooFar),
            (Self::GeoJson, Some(earth)) => Ok(geojson(&legs, earth, present)),
            (Self::Rtz, Some(earth)) => rtz(plan, &waypoints(&legs), earth, present),
        }
    }
}

/// The date and time so many seconds after the present, as in `2026-05-01T12:00:13.300Z`.
fn date(present: DateTime<Utc>, seconds: f64) -> String {
    let time = after(present, seconds);
    time.map_or(String::new(), |time| {
        time.to_rfc3339_opts(SecondsFormat::Millis, true)
    })
}

fn csv(
    legs: &[PlannedLeg],
    earth: Option<&Georeference>,
    present: Option<DateTime<Utc>>,
) -> csv::Result<String> {
    let mut header = vec!["leg", "from_s", "to_s"];
    if present.is_some() {
        header.extend(["from_utc", "to_utc"]);
    }
    header.extend(["from_east_m", "from_north_m", "to_east_m", "to_north_m"]);
    if earth.is_some() {
        header.extend(["from_lat_deg", "from_lon_deg", "to_lat_deg", "to_lon_deg"]);
    }
    header.extend(["course_deg", "corner_deg", "turn_deg", "radius_m"]);
    header.extend(["speed_mps", "length_m"]);
    header.push("events");
    let mut writer = csv::Writer::from_writer(Vec::new());
    writer.write_record(&header)?;
    for (index, leg) in legs.iter().enumerate() {
        let motion = &leg.motion;
        let ends = [motion.start.position, motion.end().position];
        let mut row = vec![(index + 1).to_string()];
        let times = [motion.start_time, motion.end_time()];
        row.extend(times.map(fixed::<3>));
        if let Some(present) = present {
            row.extend(times.map(|time| date(present, time)));
        }
        row.extend(ends.iter().flat_map(|p| [p.x, p.y]).map(fixed::<3>));
        if let Some(earth) = earth {
            let places = ends.map(|p| earth.to_geographic(p));
            let degrees = places.iter().flat_map(|p| [p.lat_deg, p.lon_deg]);
            row.extend(degrees.map(fixed::<8>));
        }
        row.extend([leg.course_deg(), leg.corner_deg, leg.turn_deg()].map(fixed::<4>));
        row.push(match motion.is_arc() {
            true => fixed::<3>(motion.radius().abs()),
            false => String::new(),
        });
        row.extend([motion.speed, motion.length()].map(fixed::<3>));
        row.push(leg.events.join("; "));
        writer.write_record(&row)?;
    }
    let bytes = writer.into_inner().map_err(|error| error.into_error())?;
    Ok(String::from_utf8_lossy(&bytes).into_owned())
}

/// Decimals without a negative zero.
fn fixed<const DECIMALS: usize>(value: f64) -> String {
    let text = format!("{value:.DECIMALS$}");
    match text.trim_matches(['-', '0', '.']) {
        "" => text.trim_start_matches('-').to_owned(),
        _ => text,
    }
}

fn geojson(legs: &[PlannedLeg], earth: &Georeference, present: Option<DateTime<Utc>>) -> String {
    let features = legs.iter().enumerate().map(|(index, leg)| {
        let motion = &leg.motion;
        let steps = (leg.turn_deg().abs() / POINT_DEG).ceil().max(1.0) as u32;
        let points = (0..=steps).map(|k| {
            let elapsed = motion.duration * f64::from(k) / f64::from(steps);
            let place = earth.to_geographic(motion.pose_after(elapsed).position);
            // on past 180° without a jump
            let west = earth.origin().lon_deg;
            let east = (place.lon_deg - west + 540.0).rem_euclid(360.0) - 180.0;
            Position::from([west + east, place.lat_deg])
        });
        let mut properties = JsonObject::new();
        for (key, value) in [
            ("from_s", motion.start_time),
            ("to_s", motion.end_time()),
            ("course_deg", leg.course_deg()),
            ("corner_deg", leg.corner_deg),
            ("turn_deg", leg.turn_deg()),
            ("speed_mps", motion.speed),
            ("length_m", motion.length()),
        ] {
            properties.insert(key.to_owned(), value.into());
        }
        if let Some(present) = present {
            for (key, time) in [
                ("from_utc", motion.start_time),
                ("to_utc", motion.end_time()),
            ] {
                properties.insert(key.to_owned(), date(present, time).into());
            }
        }
        if motion.is_arc() {
            properties.insert("radius_m".to_owned(), motion.radius().abs().into());
        }
        properties.insert("leg".to_owned(), (index + 1).into());
        properties.insert("events".to_owned(), leg.events.clone().into());
        let line = GeometryValue::LineString {
            coordinates: points.collect(),
        };
        Feature {
            geometry: Some(Geometry::new(line)),
            properties: Some(properties),
            ..Feature::default()
        }
    });
    let collection = FeatureCollection {
        features: features.collect(),
        bbox: None,
        foreign_members: None,
    };
    format!("{collection}\n")
}

/// A waypoint of RTZ: where two lines meet, and the arc that rounds the corner.
#[derive(Debug, Clone, PartialEq)]
struct Waypoint {
    /// The manoeuvre of a leg, at the first waypoint of that leg.
    name: Option<String>,
    place: Vector,
    /// Metres; 0 where the course or the speed changes at once.
    radius: f64,
    /// m/s on the way to it.
    speed: f64,
    /// When own ship arrives, or is in the middle of the turn here, seconds.
    time: f64,
    /// Seconds that own ship lies here.
    stay: f64,
}

/// A turn is one corner, and one per quarter turn where it is longer. Where the speed or the course
/// changes at once is a waypoint of its own. At least two waypoints, as RTZ requires.
fn waypoints(legs: &[PlannedLeg]) -> Vec<Waypoint> {
    let first = &legs[0].motion;
    let mut named = 0;
    let mut at = |leg: usize, place, radius, speed, time| Waypoint {
        name: match leg < named {
            true => None,
            false => {
                named = leg + 1;
                manoeuvre(legs.get(leg))
            }
        },
        place,
        radius,
        speed,
        time,
        stay: 0.0,
    };
    let moves = legs.iter().find(|leg| !leg.waits());
    let speed = moves.map_or(0.0, |leg| leg.motion.speed);
    let mut all = vec![at(0, first.start.position, 0.0, speed, first.start_time)];
    for (index, leg) in legs.iter().enumerate() {
        let motion = &leg.motion;
        if leg.waits() {
            let last = all.len() - 1;
            all[last].stay += motion.duration;
            continue;
        }
        if motion.is_arc() {
            let corners = corners(motion);
            all.extend(
                corners.map(|(place, radius, time)| at(index, place, radius, motion.speed, time)),
            );
        }
        // the tangents of an arc lead on
        let leads_on = legs.get(index + 1).is_some_and(|next| {
            let curved = motion.is_arc() || next.motion.is_arc();
            curved && next.motion.speed == motion.speed && next.corner_deg == 0.0
        });
        if !leads_on {
            let end = motion.end().position;
            all.push(at(index + 1, end, 0.0, motion.speed, motion.end_time()));
        }
    }
    if let [only] = &all[..] {
        let end = Waypoint {
            name: None,
            stay: 0.0,
            ..only.clone()
        };
        all.push(end);
    }
    all
}

/// Name of the manoeuvre that begins on a leg, such as "turns for 'tanker', starboard 30°".
fn manoeuvre(leg: Option<&PlannedLeg>) -> Option<String> {
    let leg = leg?;
    let mut events = leg.events.iter();
    let event = events.find(|event| !event.starts_with(CLOSEST))?;
    let turn = leg.turn_words().filter(|_| !leg.waits());
    Some(turn.map_or(event.clone(), |turn| format!("{event}, {turn}")))
}

/// The corners whose lines touch a turn, its radius, and the times in the middle of its parts.
fn corners(turn: &Segment) -> impl Iterator<Item = (Vector, f64, f64)> {
    let (radius, angle) = (turn.radius().abs(), turn.turn_rate * turn.duration);
    let parts = (angle.abs() / FRAC_PI_2).ceil().max(1.0);
    let ahead = radius * (0.5 * angle.abs() / parts).tan();
    (0..parts as u32).map(move |k| {
        let part = turn.duration / parts;
        let begun = turn.pose_after(part * f64::from(k));
        let middle = turn.start_time + part * (f64::from(k) + 0.5);
        (begun.position + begun.ahead() * ahead, radius, middle)
    })
}

fn rtz(
    plan: &PlanDocument,
    all: &[Waypoint],
    earth: &Georeference,
    present: Option<DateTime<Utc>>,
) -> Result<String, RouteError> {
    // own ship may be off its plan by this much to either side
    let off = match plan.own_ship.tracking_margin_m / NAUTICAL_MILE_M {
        off if off > 0.0 => format!(" starboardXTD=\"{off:.6}\" portsideXTD=\"{off:.6}\""),
        _ => String::new(),
    };
    let orthodrome = format!("<leg{off} geometryType=\"Orthodrome\"/>");
    let mut text = format!(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n\
         <route xmlns=\"http://www.cirm.org/RTZ/1/1\" version=\"1.1\">\n  \
         <routeInfo routeName=\"{}\"/>\n  <waypoints>\n",
        in_xml(&plan.scenario)
    );
    let mut schedule = String::new();
    for (id, waypoint) in (1..).zip(all) {
        let Geographic { lat_deg, lon_deg } = earth.to_geographic(waypoint.place);
        // the easternmost meridian is the westernmost
        let lon_deg = if lon_deg >= 180.0 {
            lon_deg - 360.0
        } else {
            lon_deg
        };
        let radius = waypoint.radius / NAUTICAL_MILE_M;
        if radius > RTZ_RADIUS_NMI || waypoint.stay.round() >= RTZ_STAY_S {
            return Err(RouteError::BeyondRtz);
        }
        let leg = if id == 1 { "" } else { &orthodrome };
        let name = waypoint.name.as_deref().map(in_xml);
        let name = name.unwrap_or_else(|| format!("WP {id}"));
        // writing into a text does not fail
        let _ = writeln!(
            text,
            "    <waypoint id=\"{id}\" name=\"{name}\" radius=\"{radius:.6}\"><position lat=\"{lat_deg:.11}\" \
             lon=\"{lon_deg:.11}\"/>{leg}</waypoint>"
        );
        let speed = knots_from_mps(waypoint.speed);
        let stay = match waypoint.stay {
            0.0 => String::new(),
            seconds => format!(" stay=\"{}\"", time_of_day(seconds)),
        };
        let arrives = (id > 1).then_some(("eta", waypoint.time));
        let leaves = waypoint.time + waypoint.stay;
        let leaves = (id == 1 || waypoint.stay > 0.0).then_some(("etd", leaves));
        let times: String = (arrives
            .into_iter()
            .chain(leaves)
            .zip(present.iter().cycle()))
        .map(|((name, time), present)| format!(" {name}=\"{}\"", date(*present, time)))
        .collect();
        let _ = writeln!(
            schedule,
            "      <scheduleElement waypointId=\"{id}\" speed=\"{speed:.4}\"{stay}{times}/>"
        );
    }
    let _ = write!(
        text,
        "  </waypoints>\n  <schedules><schedule id=\"1\"><calculated>\n{schedule}    \
         </calculated></schedule></schedules>\n</route>\n"
    );
    Ok(text)
}

/// Hours, minutes and seconds.
fn time_of_day(seconds: f64) -> String {
    let seconds = seconds.round() as u32;
    let (minutes, seconds) = (seconds / 60, seconds % 60);
    format!("{:02}:{:02}:{seconds:02}", minutes / 60, minutes % 60)
}

fn in_xml(text: &str) -> String {
    let escaped = printable(text).replace('&', "&amp;").replace('<', "&lt;");
    escaped.replace('>', "&gt;").replace('"', "&quot;")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::ConvexPolygon;
    use crate::pipeline;
    use crate::scenario::Scenario;

    fn planned(text: &str) -> (PlanDocument, Georeference) {
        let text = format!("origin = {{ lat_deg = 59.0, lon_deg = 10.5 }}\n{text}");
        let scenario = Scenario::parse(&text).expect("valid");
        let earth = scenario.earth.expect("an origin");
        (PlanDocument::of(&pipeline::run(scenario)), earth)
    }

    fn give_way() -> (PlanDocument, Georeference) {
        planned(include_str!("../../scenarios/colregs/give-way.toml"))
    }

    /// The lines between the waypoints, with their corners rounded, are as long as the plan.
    #[test]
    fn waypoints_and_their_radii_are_the_plan() {
        let (plan, earth) = give_way();
        let text = RouteFormat::Rtz
            .write(&plan, Some(&earth), None)
            .expect("a route");
        let read = roxmltree::Document::parse(&text).expect("XML");
        let number = |node: roxmltree::Node, key: &str| -> f64 {
            let value = node.attribute(key).expect("an attribute");
            value.parse().expect("a number")
        };
        let named = |name: &'static str| {
            let nodes = read.descendants();
            nodes
                .filter(move |n| n.has_tag_name(name))
                .collect::<Vec<_>>()
        };
        let places: Vec<Vector> = (named("position").into_iter())
            .map(|n| {
                earth.to_plane(Geographic {
                    lat_deg: number(n, "lat"),
                    lon_deg: number(n, "lon"),
                })
            })
            .collect();
        let radii = named("waypoint").into_iter().map(|n| number(n, "radius"));
        let radii: Vec<f64> = radii.map(|radius| radius * NAUTICAL_MILE_M).collect();
        let mut length: f64 = places.windows(2).map(|p| (p[1] - p[0]).norm()).sum();
        for (corner, radius) in places.windows(3).zip(&radii[1..]) {
            let [before, after] = [corner[1] - corner[0], corner[2] - corner[1]];
            let turn = before.angle(&after);
            length -= radius * (2.0 * (0.5 * turn).tan() - turn);
        }
        let cost = plan.cost.as_ref().expect("a plan");
        assert!(
            (length - cost.length_m).abs() < 0.1,
            "{length} {}",
            cost.length_m
        );
        let speeds = named("scheduleElement")
            .into_iter()
            .map(|n| number(n, "speed"));
        let speeds: Vec<f64> = speeds.collect();
        assert_eq!(speeds.len(), places.len());
        let fastest = speeds.iter().copied().fold(0.0, f64::max);
        assert!((fastest - knots_from_mps(6.0)).abs() < 1e-3);
        let end = plan.mission.waypoints.last().expect("a mission");
        let off = places[places.len() - 1] - Vector::new(end.east_m, end.north_m);
        assert!(off.norm() < 0.01, "{off}");
    }

    /// At the corner of a turn own ship is in the middle of it.
    #[test]
    fn times_of_arrival_are_those_of_the_plan() {
        let (plan, earth) = give_way();
        let present = DateTime::parse_from_rfc3339("2026-12-31T23:59:00Z").expect("a date");
        let text = RouteFormat::Rtz.write(&plan, Some(&earth), Some(present.to_utc()));
        let text = text.expect("a route");
        let read = roxmltree::Document::parse(&text).expect("XML");
        let elements = read.descendants();
        let elements = elements.filter(|node| node.has_tag_name("scheduleElement"));
        let mut last = 0.0;
        let waypoints = waypoints(&planned_legs(&plan));
        for (index, (element, waypoint)) in elements.zip(&waypoints).enumerate() {
            let [eta, etd] = ["eta", "etd"].map(|name| element.attribute(name));
            assert_eq!([eta.is_some(), etd.is_some()], [index > 0, index == 0]);
            let time = eta.or(etd).expect("a time");
            let time = DateTime::parse_from_rfc3339(time).expect("a date") - present;
            let time = time.num_milliseconds() as f64 / 1e3;
            assert!(
                (time - waypoint.time).abs() < 1e-3 && time >= last,
                "{text}"
            );
            last = time;
        }
        let cost = plan.cost.as_ref().expect("a plan");
        assert!((last - cost.duration_s).abs() < 2e-3, "{last}");
        assert!(
            text.contains(" etd=\"2026-12-31T23:59:00.000Z\"/>") && text.contains("2027-01-01T")
        );
        for format in [RouteFormat::Csv, RouteFormat::GeoJson] {
            let [with, without] = [Some(present.to_utc()), None]
                .map(|present| format.write(&plan, Some(&earth), present).expect("a route"));
            assert!(
                with.contains("2027-01-01T00:0") && with.contains("to_utc"),
                "{with}"
            );
            assert!(!without.contains("utc"), "{without}");
        }
    }

    #[test]
    fn rows_and_lines_are_the_legs() {
        let (plan, earth) = give_way();
        let legs = planned_legs(&plan);
        let text = RouteFormat::Csv
            .write(&plan, Some(&earth), None)
            .expect("a route");
        let mut reader = csv::Reader::from_reader(text.as_bytes());
        let column = |name: &str, reader: &mut csv::Reader<&[u8]>| {
            let header = reader.headers().expect("a header");
            header.iter().position(|n| n == name).expect("a column")
        };
        let length = column("length_m", &mut reader);
        let rows: Vec<csv::StringRecord> = reader.records().map(|r| r.expect("a row")).collect();
        assert_eq!(rows.len(), legs.len());
        let sum: f64 = rows
            .iter()
            .map(|r| r[length].parse::<f64>().expect("a number"))
            .sum();
        assert!((sum - plan.cost.as_ref().expect("a plan").length_m).abs() < 0.01);
        let text = RouteFormat::GeoJson
            .write(&plan, Some(&earth), None)
            .expect("a route");
        let read: FeatureCollection = text.parse().expect("GeoJSON");
        assert_eq!(read.features.len(), legs.len());
        let plain = RouteFormat::Csv
            .write(&plan, None, None)
            .expect("without an origin");
        assert!(!plain.contains("lat_deg"));
        let refused = RouteFormat::GeoJson.write(&plan, None, None);
        assert!(matches!(refused, Err(RouteError::NoOrigin)));
    }

    /// Along a path the course changes at once at the corners.
    #[test]
    fn every_leg_begins_where_the_last_one_ends() {
        for name in [
            "harbour/alternative-path",
            "harbour/canal-transit",
            "colregs/stand-on",
        ] {
            let file = format!("scenarios/{name}.toml");
            let scenario = Scenario::read(file.as_ref()).expect("valid");
            let plan = PlanDocument::of(&pipeline::run(scenario));
            let legs = planned_legs(&plan);
            let mut way = legs[0].motion.start.position;
            for leg in &legs {
                assert!((leg.motion.start.position - way).norm() < 1e-3, "{leg:?}");
                assert!(leg.motion.duration > 0.0);
                way = leg.motion.end().position;
            }
            // a place between two waypoints of a line is on it
            let corners = waypoints(&legs);
            let off = |p: Vector| {
                let lines = corners.windows(2).map(|ends| {
                    let line = ends.iter().map(|w| w.place).collect::<Vec<_>>();
                    ConvexPolygon::hull(&line)
                        .expect("finite")
                        .signed_distance(p)
                });
                lines.fold(f64::INFINITY, f64::min)
            };
            for leg in legs.iter().filter(|leg| !leg.motion.is_arc()) {
                let middle = leg.motion.pose_after(0.5 * leg.motion.duration);
                assert!(off(middle.position) < 0.01, "{leg:?} {corners:?}");
            }
        }
    }

    /// A turn of more than half a circle has no single corner.
    #[test]
    fn a_long_turn_has_a_corner_per_quarter() {
        let start = crate::frame::Pose::new(Vector::zeros(), 0.0);
        let turn = Segment::new(start, 0.0, 60.0, 5.0, 1.5 * std::f64::consts::PI / 60.0);
        let all: Vec<(Vector, f64, f64)> = corners(&turn).collect();
        assert_eq!(all.len(), 3);
        let radius = turn.radius();
        for (k, expected) in [(1.0, 0.0), (1.0, 2.0), (-1.0, 2.0)]
            .into_iter()
            .enumerate()
        {
            let expected = Vector::new(expected.0, expected.1) * radius;
            assert!((all[k].0 - expected).norm() < 1e-9 * radius, "{all:?}");
            assert!(
                (all[k].2 - (10.0 + 20.0 * k as f64)).abs() < 1e-9,
                "{all:?}"
            );
        }
        let leg = PlannedLeg {
            motion: turn,
            corner_deg: 0.0,
            because_of: None,
            events: vec!["turns for 'a'".to_owned()],
        };
        let named = waypoints(&[leg]).into_iter().map(|waypoint| waypoint.name);
        assert_eq!(named.flatten().count(), 1);
        assert_eq!(time_of_day(3725.4), "01:02:05");
        assert_eq!(
            in_xml("<a & \"b\">\u{7}"),
            "&lt;a &amp; &quot;b&quot;&gt;\\u0007"
        );
    }
}
