//! File → [`Scenario`], noting every fault.

use std::collections::BTreeSet;
use std::path::Path;

use toml::de::DeTable;

use super::control::control_settings;
use super::file::{Entry, Source};
use super::plane::{POSITION, Plane};
use super::section::Section;
use super::targets::targets;
use super::{Compliance, Land, Scenario, land, limits};
use crate::frame::{Pose, Vector, heading_from_course_deg};
use crate::planner::{ControlSettings, Objective, PlannerKind, SearchKind};
use crate::text::LINE;
use crate::trajectory::DesiredTrajectory;
use crate::vessel::{Hull, OwnShip, VesselKind};

/// What the reader of TOML says of brackets within too many brackets, and of those without an end.
const TOO_DEEP: &str = "max recursion depth";
const UNCLOSED: &str = "unclosed";

/// Own ship's speeds where the file names none, as fractions of her own speed.
const DEFAULT_SPEEDS: [f64; 3] = [0.5, 1.0, 1.2];

/// Seconds after arrival that are looked at where the file does not say.
const DEFAULT_ARRIVAL_HOLD: f64 = 60.0;

/// Seconds of wall clock for one plan where the file names none.
const DEFAULT_DEADLINE: f64 = 5.0;

/// The scenario of a file's outermost table. `None` only when a fault was noted; a scenario that
/// comes with faults is of no use.
pub(super) fn scenario(mut root: Section, folder: &Path) -> Option<Scenario> {
    let title = root.require("title", LINE).and_then(|entry| entry.text());
    let horizon = root.required_number("horizon_s", limits::DURATION);
    let arrival_hold = root.number("arrival_hold_s", limits::HOLD);
    let plane = Plane::new(&mut root);
    let map = land::map(&mut root, &plane, folder);
    let own_ship = root
        .require("own_ship", "a table")
        .and_then(|entry| entry.section("a table"))
        .map(|section| own_ship(section, &plane));
    let speed = own_ship.as_ref().and_then(|own| own.speed);
    let margin = own_ship.as_ref().and_then(|own| own.land_margin);
    let own_ship = own_ship.and_then(|own| own.ship);
    let mission = root
        .require("mission", "a table")
        .and_then(|entry| entry.section("a table"))
        .and_then(|section| mission(section, speed, &plane));
    let model = VesselKind::CyberShip2;
    // without a length the file is at fault: then any will do
    let length = own_ship
        .as_ref()
        .map_or(model.length(), |own| own.hull.length);
    let planner = root
        .take("planner")
        .and_then(|entry| entry.section("a table"))
        .map(|section| planner(section, length))
        .unwrap_or_default();
    let targets = targets(&mut root, &plane);
    let land = map.zip(margin).map(|(map, margin)| Land { map, margin });
    if let Some(land) = &land {
        let paths = mission
            .as_ref()
            .map(|m| (&m.desired, m.alternatives.as_slice()));
        land::check(&mut root, land, &plane, own_ship.as_ref(), paths);
    }
    plane.finish(&mut root);
    root.finish();
    let (
        Mission {
            desired,
            alternatives,
        },
        own_ship,
    ) = (mission?, own_ship?);
    let mean_speed = desired.length() / desired.duration();
    Some(Scenario {
        title: title?,
        horizon: horizon?,
        arrival_hold: arrival_hold.unwrap_or(DEFAULT_ARRIVAL_HOLD),
        time_weight: planner.time_weight.unwrap_or(mean_speed * mean_speed),
        own_ship,
        desired,
        alternatives,
        targets: targets?,
        planner: planner.kind.unwrap_or(PlannerKind::SpaceTime),
        objective: planner.objective.unwrap_or(Objective::SpaceTimeError),
        control: planner
            .control
            .unwrap_or(ControlSettings::at_length(model, length)),
        search: planner.search.unwrap_or(SearchKind::AStar),
        compliance: planner.compliance.unwrap_or(Compliance::Shape),
        max_risk: planner.max_risk.unwrap_or(0.0),
        deadline: planner.deadline.unwrap_or(DEFAULT_DEADLINE),
        thresholds: None,
        earth: plane.earth(),
        land,
    })
}

/// A pose from the keys `position` and `course_deg`.
pub(super) fn pose(section: &mut Section, plane: &Plane) -> Option<Pose> {
    let position = section
        .require("position", POSITION)
        .and_then(|entry| plane.position(&entry));
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
    /// Metres.
    land_margin: Option<f64>,
}

fn own_ship(mut section: Section, plane: &Plane) -> OwnShipFields {
    let pose = pose(&mut section, plane);
    let speed = section.required_speed("speed", limits::SPEED);
    let hull = hull(&mut section);
    let turning_radius = section.required_number("turning_radius_m", limits::LENGTH);
    let speeds = own_speeds(&mut section, speed);
    let margin = section.number("safety_margin_m", limits::DISTANCE);
    let land_margin = if section.has("land_margin_m") {
        section.number("land_margin_m", limits::DISTANCE)
    } else {
        Some(0.0)
    };
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
        land_margin,
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

/// The desired trajectory and the other paths.
struct Mission {
    desired: DesiredTrajectory,
    alternatives: Vec<Vec<Vector>>,
}

fn mission(mut section: Section, own_speed: Option<f64>, plane: &Plane) -> Option<Mission> {
    let alternatives = match section.take("alternatives") {
        Some(entry) => alternatives(&entry, plane),
        None => Some(Vec::new()),
    };
    let entries = section
        .require("waypoints", "a list of at least 2 positions")
        .and_then(|entry| positions(&entry));
    let legs = entries.as_ref().map(|entries| entries.len() - 1);
    let waypoints = entries.and_then(|entries| waypoints(&entries, plane));
    let speeds = leg_speeds(&mut section, legs, own_speed);
    section.finish();
    // every leg is long and fast enough by now
    let desired = DesiredTrajectory::new(&waypoints?, &speeds?).ok()?;
    Some(Mission {
        desired,
        alternatives: alternatives?,
    })
}

/// A list of as many positions as a path may have.
fn positions<'a, 'i>(entry: &Entry<'a, 'i>) -> Option<Vec<Entry<'a, 'i>>> {
    let entries = entry.list(2, "positions")?;
    if entries.len() > limits::WAYPOINTS {
        let found = format_args!("{} positions", entries.len());
        entry.fault(found, format_args!("at most {}", limits::WAYPOINTS));
        return None;
    }
    Some(entries)
}

fn alternatives(entry: &Entry, plane: &Plane) -> Option<Vec<Vec<Vector>>> {
    let paths = entry.list(1, "paths, each a list of positions")?;
    if paths.len() > limits::ALTERNATIVES {
        let found = format_args!("{} paths", paths.len());
        entry.fault(found, format_args!("at most {}", limits::ALTERNATIVES));
        return None;
    }
    let read: Vec<_> = paths
        .iter()
        .map(|path| positions(path).and_then(|entries| waypoints(&entries, plane)))
        .collect();
    read.into_iter().collect()
}

fn waypoints(entries: &[Entry], plane: &Plane) -> Option<Vec<Vector>> {
    let points: Vec<Option<Vector>> = entries.iter().map(|e| plane.position(e)).collect();
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
    objective: Option<Objective>,
    control: Option<ControlSettings>,
    search: Option<SearchKind>,
    compliance: Option<Compliance>,
    time_weight: Option<f64>,
    max_risk: Option<f64>,
    deadline: Option<f64>,
}

/// `length` is that of own ship, metres.
fn planner(mut section: Section, length: f64) -> PlannerFields {
    let fields = PlannerFields {
        control: control_settings(&mut section, length),
        kind: section.choice(
            "kind",
            &[
                ("space-time", PlannerKind::SpaceTime),
                ("path-time", PlannerKind::PathTime),
                ("optimal-control", PlannerKind::OptimalControl),
            ],
        ),
        objective: objective(&mut section),
        search: section.choice(
            "search",
            &[
                ("a-star", SearchKind::AStar),
                ("dijkstra", SearchKind::Dijkstra),
            ],
        ),
        compliance: section.choice(
            "compliance",
            &[
                ("none", Compliance::None),
                ("shape", Compliance::Shape),
                ("rules", Compliance::Rules),
            ],
        ),
        time_weight: section.number("time_weight_m2_per_s2", limits::TIME_WEIGHT),
        max_risk: section.number("max_risk", limits::RISK),
        deadline: section.number("deadline_s", limits::DURATION),
    };
    section.finish();
    fields
}

/// The objective; the one that weighs risk needs its weight, the others have none.
fn objective(section: &mut Section) -> Option<Objective> {
    let weighed = Objective::LengthRisk { weight: 0.0 };
    let objective = section.choice(
        "objective",
        &[
            ("space-time-error", Objective::SpaceTimeError),
            ("time", Objective::Time),
            ("length", Objective::Length),
            ("length-risk", weighed),
        ],
    );
    if objective == Some(weighed) {
        let weight = section.required_number("risk_weight_m", limits::DISTANCE)?;
        return Some(Objective::LengthRisk { weight });
    }
    section.forbid(
        "risk_weight_m",
        "nothing: only the objective \"length-risk\" weighs risk",
    );
    objective
}

/// Reads a whole text, of a file in `folder`; the faults say what is wrong with it.
pub(super) fn text(source: &Source, text: &str, folder: &Path) -> Option<Scenario> {
    let (document, errors) = DeTable::parse_recoverable(text);
    if errors.is_empty() {
        let root = document.get_ref();
        let scenario = scenario(Section::new(source, String::new(), None, root), folder)?;
        for fault in scenario.unfit() {
            source.fault(
                &fault.path,
                offset_of(root, &fault.path),
                fault.found,
                fault.allowed,
            );
        }
        return Some(scenario);
    }
    // what could be recovered may be in the wrong table: only the grammar is judged
    let mut said = BTreeSet::new();
    let mut too_deep = false;
    for error in errors {
        let (message, offset) = (error.message(), error.span().map(|span| span.start));
        // of a value that is nested too deep the rest is not read, so nothing of it is closed
        let follows = too_deep && message.starts_with(UNCLOSED);
        // brackets within brackets are all unclosed at one place
        if !follows && said.insert((offset, message.to_owned())) {
            source.fault("", offset, message, "TOML 1.0 without errors");
        }
        too_deep |= message.contains(TOO_DEEP);
    }
    None
}

/// Where the value at a path like `a.b[2]` begins.
fn offset_of(root: &DeTable, path: &str) -> Option<usize> {
    let mut table = root;
    let mut found = None;
    for part in path.split('.') {
        let (key, index) = match part.split_once('[') {
            Some((key, rest)) => (key, rest.trim_end_matches(']').parse::<usize>().ok()),
            None => (part, None),
        };
        let value = table.get(key)?;
        let value = match index {
            Some(index) => value.get_ref().as_array()?.get(index)?,
            None => value,
        };
        found = Some(value.span().start);
        match value.get_ref().as_table() {
            Some(inner) => table = inner,
            None => break,
        }
    }
    found
}
