//! File → [`Scenario`], noting every fault.

use super::control::control_settings;
use super::file::{Entry, Source, TEXT, Word};
use super::section::Section;
use super::targets::targets;
use super::{Compliance, Scenario, limits};
use crate::frame::{Pose, Vector, heading_from_course_deg};
use crate::planner::{PlannerKind, SearchKind};
use crate::trajectory::DesiredTrajectory;
use crate::vessel::{Hull, OwnShip};

/// Own ship's speeds where the file names none, as fractions of her own speed.
const DEFAULT_SPEEDS: [f64; 3] = [0.5, 1.0, 1.2];

/// Seconds of wall clock for one plan where the file names none.
const DEFAULT_DEADLINE: f64 = 5.0;

/// The scenario of a file's outermost table. `None` only when a fault was noted; a scenario that
/// comes with faults is of no use.
pub(super) fn scenario(mut root: Section) -> Option<Scenario> {
    let title = root.require("title", TEXT).and_then(|entry| entry.text());
    let horizon = root.required_number("horizon_s", limits::DURATION);
    root.not_built("origin");
    root.not_built("map");
    let own_ship = root
        .require("own_ship", "a table")
        .and_then(|entry| entry.section("a table"))
        .map(own_ship);
    let speed = own_ship.as_ref().and_then(|own| own.speed);
    let own_ship = own_ship.and_then(|own| own.ship);
    let desired = root
        .require("mission", "a table")
        .and_then(|entry| entry.section("a table"))
        .and_then(|section| mission(section, speed));
    let planner = root
        .take("planner")
        .and_then(|entry| entry.section("a table"))
        .map(planner)
        .unwrap_or_default();
    let targets = targets(&mut root);
    root.finish();
    let (desired, own_ship) = (desired?, own_ship?);
    let mean_speed = desired.length() / desired.duration();
    Some(Scenario {
        title: title?,
        horizon: horizon?,
        time_weight: planner.time_weight.unwrap_or(mean_speed * mean_speed),
        own_ship,
        desired,
        targets: targets?,
        kind: planner.kind.unwrap_or(PlannerKind::SpaceTime),
        search: planner.search.unwrap_or(SearchKind::AStar),
        compliance: planner.compliance.unwrap_or(Compliance::Shape),
        max_risk: planner.max_risk.unwrap_or(0.0),
        deadline: planner.deadline.unwrap_or(DEFAULT_DEADLINE),
    })
}

/// A point in metres from a table of east and north.
pub(super) fn position(entry: &Entry) -> Option<Vector> {
    let mut section = entry.section("a table { east_m, north_m }")?;
    let geographic = section.not_built("lat_deg") | section.not_built("lon_deg");
    let mut component = |key: &str| {
        if geographic {
            section.number(key, limits::COORDINATE)
        } else {
            section.required_number(key, limits::COORDINATE)
        }
    };
    let (east, north) = (component("east_m"), component("north_m"));
    section.finish();
    Some(Vector::new(east?, north?))
}

/// A pose from the keys `position` and `course_deg`.
pub(super) fn pose(section: &mut Section) -> Option<Pose> {
    let position = section
        .require("position", "a table { east_m, north_m }")
        .and_then(|entry| position(&entry));
    let course = section.required_number("course_deg", limits::COURSE);
    Some(Pose::new(position?, heading_from_course_deg(course?)))
}

/// A hull from the keys `length_m` and `beam_m`.
pub(super) fn hull(section: &mut Section) -> Option<Hull> {
    let length = section.required_number("length_m", limits::LENGTH);
    let beam = section.required_number("beam_m", limits::LENGTH);
    Some(Hull {
        length: length?,
        beam: beam?,
    })
}

/// Own ship, and her speed even where the rest of her is faulty.
struct OwnShipFields {
    ship: Option<OwnShip>,
    speed: Option<f64>,
}

fn own_ship(mut section: Section) -> OwnShipFields {
    let pose = pose(&mut section);
    let speed = section.required_speed("speed", limits::SPEED);
    let hull = hull(&mut section);
    let turning_radius = section.required_number("turning_radius_m", limits::LENGTH);
    let speeds = own_speeds(&mut section, speed);
    let margin = section.number("safety_margin_m", limits::DISTANCE);
    section.only_zero("land_margin_m");
    section.finish();
    let ship = || {
        let hull = hull?;
        Some(OwnShip {
            pose: pose?,
            speed: speed?,
            hull,
            turning_radius: turning_radius?,
            speeds: speeds?,
            safety_margin: margin.unwrap_or(hull.length),
        })
    };
    OwnShipFields {
        ship: ship(),
        speed,
    }
}

/// The finite set of speeds, increasing, each once; the largest is positive.
fn own_speeds(section: &mut Section, speed: Option<f64>) -> Option<Vec<f64>> {
    let mut speeds = match section.speeds("speeds", limits::CHOSEN_SPEED) {
        Some((entry, speeds)) => {
            let speeds = speeds?;
            if !speeds.iter().any(|speed| *speed > 0.0) {
                entry.fault("only zeros", "a list with at least one speed above 0");
                return None;
            }
            if speeds.len() > limits::SPEEDS {
                let found = format_args!("{} speeds", speeds.len());
                entry.fault(found, format_args!("at most {}", limits::SPEEDS));
                return None;
            }
            speeds
        }
        None if section.has_speed("speeds") => return None,
        None => {
            let speed = speed?;
            if limits::CHOSEN_SPEED.contains(speed * DEFAULT_SPEEDS[0]) && speed > 0.0 {
                DEFAULT_SPEEDS.map(|factor| factor * speed).to_vec()
            } else {
                section.require_speed(
                    "speeds",
                    "a list of speeds, because own ship's speed is too small to derive them from",
                );
                return None;
            }
        }
    };
    speeds.sort_by(f64::total_cmp);
    speeds.dedup();
    Some(speeds)
}

fn mission(mut section: Section, own_speed: Option<f64>) -> Option<DesiredTrajectory> {
    section.not_built("alternatives");
    let entries = section
        .require("waypoints", "a list of at least 2 positions")
        .and_then(|entry| {
            let entries = entry.list(2, "positions")?;
            if entries.len() > limits::WAYPOINTS {
                let found = format_args!("{} positions", entries.len());
                entry.fault(found, format_args!("at most {}", limits::WAYPOINTS));
                return None;
            }
            Some(entries)
        });
    let legs = entries.as_ref().map(|entries| entries.len() - 1);
    let waypoints = entries.and_then(|entries| waypoints(&entries));
    let speeds = leg_speeds(&mut section, legs, own_speed);
    section.finish();
    // every leg is long and fast enough by now
    DesiredTrajectory::new(&waypoints?, &speeds?).ok()
}

fn waypoints(entries: &[Entry]) -> Option<Vec<Vector>> {
    let points: Vec<Option<Vector>> = entries.iter().map(position).collect();
    let mut sound = true;
    for (pair, entry) in points.windows(2).zip(&entries[1..]) {
        if let [Some(before), Some(here)] = pair
            && (here - before).norm() < limits::LENGTH.low
        {
            entry.fault(
                "the waypoint before it again",
                format_args!("a point at least {} m away", limits::LENGTH.low),
            );
            sound = false;
        }
    }
    let points: Option<Vec<Vector>> = points.into_iter().collect();
    points.filter(|_| sound)
}

fn leg_speeds(
    section: &mut Section,
    legs: Option<usize>,
    own_speed: Option<f64>,
) -> Option<Vec<f64>> {
    let one = section.speed("speed", limits::WAY);
    let per_leg = section.speeds("leg_speeds", limits::WAY);
    if let Some((entry, speeds)) = per_leg {
        if section.has_speed("speed") {
            entry.fault(
                "leg speeds beside a speed of the whole mission",
                "one of the two, not both",
            );
            return None;
        }
        let (speeds, legs) = (speeds?, legs?);
        if speeds.len() != legs {
            entry.fault(
                format_args!("{} speeds", speeds.len()),
                format_args!("{legs}, one for each leg between two waypoints"),
            );
            return None;
        }
        return Some(speeds);
    }
    if section.has_speed("speed") {
        return Some(vec![one?; legs?]);
    }
    if section.has_speed("leg_speeds") {
        return None;
    }
    let own_speed = own_speed?;
    if limits::WAY.contains(own_speed) {
        Some(vec![own_speed; legs?])
    } else {
        section.require_speed("speed", limits::WAY);
        None
    }
}

/// What a file says of planning.
#[derive(Debug, Default)]
struct PlannerFields {
    kind: Option<PlannerKind>,
    search: Option<SearchKind>,
    compliance: Option<Compliance>,
    time_weight: Option<f64>,
    max_risk: Option<f64>,
    deadline: Option<f64>,
}

fn planner(mut section: Section) -> PlannerFields {
    let forces = section.choice(
        "kind",
        &[
            ("space-time", Word::Means(false)),
            ("path-time", Word::NotBuilt),
            ("optimal-control", Word::Means(true)),
        ],
    );
    let kind = if forces == Some(true) {
        control_settings(&mut section).map(PlannerKind::OptimalControl)
    } else {
        section.forbid(
            "optimal_control",
            "nothing: it is for kind = \"optimal-control\"",
        );
        forces.map(|_| PlannerKind::SpaceTime)
    };
    section.choice(
        "objective",
        &[
            ("space-time-error", Word::Means(())),
            ("time", Word::NotBuilt),
            ("length", Word::NotBuilt),
            ("length-risk", Word::NotBuilt),
        ],
    );
    section.not_built("risk_weight_m");
    let fields = PlannerFields {
        kind,
        search: section.choice(
            "search",
            &[
                ("a-star", Word::Means(SearchKind::AStar)),
                ("dijkstra", Word::Means(SearchKind::Dijkstra)),
            ],
        ),
        compliance: section.choice(
            "compliance",
            &[
                ("none", Word::Means(Compliance::None)),
                ("shape", Word::Means(Compliance::Shape)),
                ("rules", Word::NotBuilt),
            ],
        ),
        time_weight: section.number("time_weight_m2_per_s2", limits::TIME_WEIGHT),
        max_risk: section.number("max_risk", limits::RISK),
        deadline: section.number("deadline_s", limits::DURATION),
    };
    section.finish();
    fields
}

/// Reads a whole text; the faults say what is wrong with it.
pub(super) fn text(source: &Source, text: &str) -> Option<Scenario> {
    let (document, errors) = toml::de::DeTable::parse_recoverable(text);
    if errors.is_empty() {
        return scenario(Section::new(
            source,
            String::new(),
            None,
            document.get_ref(),
        ));
    }
    // what could be recovered may be in the wrong table: only the grammar is judged
    for error in errors {
        let offset = error.span().map(|span| span.start);
        source.fault("", offset, error.message(), "TOML 1.0 without errors");
    }
    None
}
