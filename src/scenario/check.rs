//! Scenario file → [`Scenario`], noting every fault.

use std::path::Path;
use std::sync::Arc;

use chrono::{DateTime, Utc};

use super::plane::{Plane, near};
use super::planner::{PlannerTable, planner};
use super::route::Route;
use super::simulation::simulation;
use super::targets::targets;
use super::{Compliance, Land, Memory, Scenario, SimulationSettings, after, land, limits};
use crate::colregs::TargetMemory;
use crate::frame::{Pose, Vector, heading_from_course_deg};
use crate::input::{Fault, Faults, Field, Node, Table, every, from_toml};
use crate::planner::{DEFAULT_PLANNER, Objective, PlannerSettings, SearchKind};
use crate::target::Target;
use crate::text::LINE;
use crate::trajectory::DesiredTrajectory;
use crate::vessel::{Hull, OwnShip};

/// Own ship's speeds if the file has none, as fractions of its own speed.
const DEFAULT_SPEEDS: [f64; 2] = [0.5, 1.0];

/// Speeds that differ by this fraction are one.
const SAME_SPEED: f64 = 1e-9;

/// Seconds after arrival for which own ship is observed by default.
const DEFAULT_ARRIVAL_HOLD: f64 = 60.0;

/// Seconds of wall clock for one plan by default.
const DEFAULT_DEADLINE: f64 = 5.0;

/// Reads the text of a scenario file in `folder`. A scenario that comes with faults is of no use.
pub(super) fn parse(text: &str, folder: &Path, faults: &Faults) -> Option<Scenario> {
    let root: Node = from_toml(text, faults)?;
    let table = Field::root(&root, faults).table("a table")?;
    let scenario = scenario(table, folder)?;
    for fault in scenario.unfit() {
        faults.note(at(&root, fault));
    }
    Some(scenario)
}

/// Faults of a scenario with their places in its text.
pub(super) fn located(text: &str, faults: Vec<Fault>) -> Vec<Fault> {
    match from_toml(text, &Faults::default()) {
        Some(root) => faults.into_iter().map(|fault| at(&root, fault)).collect(),
        None => faults,
    }
}

/// A fault with its line, under the key that the file has.
fn at(root: &Node, fault: Fault) -> Fault {
    let path = root.path_in_unit(&fault.path).unwrap_or(fault.path);
    let line = root.line_at(&path);
    Fault { path, ..fault }.at_line(line)
}

/// The scenario of a file's outermost table. `None` only if a fault was noted.
fn scenario(mut root: Table, folder: &Path) -> Option<Scenario> {
    let title = root
        .require("title", LINE)
        .and_then(|field| field.line_of_text());
    let horizon = root.required_number("horizon_s", limits::DURATION);
    let time = root
        .take("time_s")
        .map_or(Some(0.0), |field| field.number(limits::CLOCK));
    let start = root.take("start_utc").map(|field| field.date_time());
    let arrival_hold = root.number("arrival_hold_s", limits::HOLD);
    let plane = Plane::new(&mut root);
    let map = land::map(&mut root, &plane, folder);
    let own_ship = root
        .required_table("own_ship")
        .map(|table| own_ship(table, |table| pose(table, &plane)));
    let speed = own_ship.as_ref().and_then(|own| own.speed);
    let margin = own_ship.as_ref().map(|own| own.land_margin);
    let acceleration = own_ship.as_ref().and_then(|own| own.acceleration);
    let has_speeds = own_ship.as_ref().is_some_and(|own| own.has_speeds);
    let mut own_ship = own_ship.and_then(|own| own.ship);
    let mission = root
        .required_table("mission")
        .and_then(|table| mission(table, speed, &plane, folder, time));
    if let (Some(own), Some(mission), false) = (&mut own_ship, &mission, has_speeds) {
        add_speeds(&mut own.speeds, &mission.desired);
    }
    // without a length the file is faulty, and any length serves
    let length = own_ship.as_ref().map_or(1.0, |own| own.hull.length);
    let planner: PlannerTable = root
        .take("planner")
        .and_then(|field| field.table("a table"))
        .map(|table| planner(table, length))
        .unwrap_or_default();
    let targets = targets(&mut root, &plane, time, own_ship.as_ref());
    let (targets, simulated): (Option<Vec<_>>, Option<Vec<_>>) =
        targets.map(|targets| targets.into_iter().unzip()).unzip();
    let simulation = simulation(&mut root, simulated.unwrap_or_default());
    let land = map.zip(margin).map(|(map, margin)| Land { map, margin });
    if let Some(land) = &land {
        let paths = mission
            .as_ref()
            .map(|m| (&m.desired, m.alternatives.as_slice()));
        land::check(&mut root, land, &plane, own_ship.as_ref(), paths);
    }
    plane.finish(&mut root);
    root.finish();
    let (mission, own_ship) = (mission?, own_ship?);
    let desired = mission.desired;
    let start = start.unwrap_or(mission.date);
    let (targets, known): (Vec<Target>, Vec<TargetMemory>) = targets?.into_iter().unzip();
    let known_any = known.iter().any(|known| known.role.is_some());
    let tracked = targets.iter().any(|target| target.ship().is_some());
    Some(Scenario {
        time: time?,
        start,
        arrival_hold: arrival_hold.unwrap_or(DEFAULT_ARRIVAL_HOLD),
        alternatives: mission.alternatives,
        targets,
        acceleration,
        earth: plane.earth(),
        land,
        memory: Memory {
            targets: if known_any { known } else { Vec::new() },
            ..Memory::default()
        },
        simulation,
        ..bare(title?, horizon?, own_ship, desired, planner, tracked)
    })
}

/// A scenario of own ship alone; `tracked` where it will meet tracked ships.
pub(super) fn bare(
    title: &str,
    horizon: f64,
    own_ship: OwnShip,
    desired: DesiredTrajectory,
    planner: PlannerTable,
    tracked: bool,
) -> Scenario {
    let length = own_ship.hull.length;
    let mean_speed = desired.length() / desired.duration();
    let kind = planner.kind.unwrap_or(DEFAULT_PLANNER);
    let default_compliance = if kind.facts().keeps_rules && tracked {
        Compliance::Rules
    } else {
        Compliance::Shape
    };
    let limits = planner.limits(length);
    Scenario {
        title: title.to_owned(),
        time: 0.0,
        start: None,
        horizon,
        arrival_hold: DEFAULT_ARRIVAL_HOLD,
        time_weight: planner.time_weight.unwrap_or(mean_speed * mean_speed),
        own_ship,
        acceleration: None,
        desired,
        alternatives: Vec::new(),
        targets: Vec::new(),
        planner: kind,
        objective: planner.objective.unwrap_or(Objective::SpaceTimeError),
        settings: (planner.settings).unwrap_or_else(|| PlannerSettings::at_length(length)),
        search: planner.search.unwrap_or(SearchKind::AStar),
        compliance: planner.compliance.unwrap_or(default_compliance),
        max_risk: planner.max_risk.unwrap_or(0.0),
        deadline: planner.deadline.unwrap_or(DEFAULT_DEADLINE),
        limits: Arc::new(limits),
        thresholds: None,
        earth: None,
        land: None,
        memory: Memory::default(),
        simulation: SimulationSettings::default(),
    }
}

/// A pose from the keys `position` and `course_deg`.
pub(super) fn pose(table: &mut Table, plane: &Plane) -> Option<Pose> {
    let position = plane.required_position(table);
    let course = table.required_number("course_deg", limits::COURSE);
    Some(Pose::new(position?, heading_from_course_deg(course?)))
}

/// A hull from the keys `length_m` and `beam_m`.
pub(super) fn hull(table: &mut Table) -> Option<Hull> {
    let length = table.required_number("length_m", limits::LENGTH);
    let beam = table.required_number("beam_m", limits::LENGTH);
    Some(Hull::new(length?, beam?))
}

/// Own ship; its speed and margin are known even if another field is faulty.
pub(super) struct OwnShipFields {
    pub(super) ship: Option<OwnShip>,
    speed: Option<f64>,
    /// True where the file has the speeds that own ship may use.
    has_speeds: bool,
    /// Metres.
    land_margin: f64,
    pub(super) acceleration: Option<f64>,
}

/// Own ship, whose pose is read by `pose`.
pub(super) fn own_ship(
    mut table: Table,
    pose: impl FnOnce(&mut Table) -> Option<Pose>,
) -> OwnShipFields {
    let pose = pose(&mut table);
    let speed = table.required_speed("speed", limits::SPEED);
    let hull = hull(&mut table);
    let turning_radius = table.required_distance("turning_radius", limits::LENGTH);
    let has_speeds = table.has_speed("speeds");
    let speeds = own_speeds(&mut table, speed);
    let margin = table.distance("safety_margin", limits::DISTANCE);
    let tracking_margin = table.distance("tracking_margin", limits::DISTANCE);
    let acceleration = table.number("acceleration_mps2", limits::ACCELERATION);
    let land_margin = table.distance("land_margin", limits::DISTANCE);
    table.finish();
    let ship = || {
        let hull = hull?;
        Some(OwnShip {
            pose: pose?,
            speed: speed?,
            hull,
            turning_radius: turning_radius?,
            speeds: speeds?,
            safety_margin: margin.unwrap_or(hull.length),
            tracking_margin: tracking_margin.unwrap_or(0.0),
        })
    };
    OwnShipFields {
        ship: ship(),
        speed,
        has_speeds,
        land_margin: land_margin.unwrap_or(0.0),
        acceleration,
    }
}

/// The finite set of speeds: increasing, each once, the largest positive.
fn own_speeds(table: &mut Table, speed: Option<f64>) -> Option<Vec<f64>> {
    let mut speeds = match table.speeds("speeds", limits::CHOSEN_SPEED) {
        Some((field, speeds)) => {
            let speeds = speeds?;
            if !speeds.iter().any(|speed| *speed > 0.0) {
                return field.reject("only zeros", "a list with at least one speed above 0");
            }
            if speeds.len() > limits::SPEEDS {
                let found = format_args!("{} speeds", speeds.len());
                return field.reject(found, format_args!("at most {}", limits::SPEEDS));
            }
            if (1..speeds.len()).any(|k| speeds[..k].contains(&speeds[k])) {
                let allowed = "each speed once; 5.5 has a point, 5,5 is two numbers";
                return field.reject("a speed twice", allowed);
            }
            speeds
        }
        None if table.has_speed("speeds") => return None,
        None => {
            let speed = speed?;
            if limits::CHOSEN_SPEED.contains(speed * DEFAULT_SPEEDS[0]) && speed > 0.0 {
                DEFAULT_SPEEDS.map(|factor| factor * speed).to_vec()
            } else {
                table.require_speed(
                    "speeds",
                    "a list of speeds, because own ship's speed is too small to derive them from",
                );
                return None;
            }
        }
    };
    speeds.sort_by(f64::total_cmp);
    Some(speeds)
}

/// Adds the speeds of the mission: without them own ship would change between two others all the way.
fn add_speeds(speeds: &mut Vec<f64>, desired: &DesiredTrajectory) {
    for leg in desired.legs() {
        let is_there = |speed: &f64| (speed - leg.speed).abs() <= SAME_SPEED * leg.speed;
        if speeds.len() < limits::SPEEDS && !speeds.iter().any(is_there) {
            speeds.push(leg.speed);
        }
    }
    speeds.sort_by(f64::total_cmp);
}

struct Mission {
    desired: DesiredTrajectory,
    /// The date and time at 0 s on the clock of the file, by the schedule of the route.
    date: Option<DateTime<Utc>>,
    alternatives: Vec<Vec<Vector>>,
}

fn mission(
    mut table: Table,
    own_speed: Option<f64>,
    plane: &Plane,
    folder: &Path,
    time: Option<f64>,
) -> Option<Mission> {
    let start = table
        .take("start_s")
        .map_or(time, |field| field.number(limits::until(time?)));
    let alternatives = table.read_or("alternatives", Vec::new(), |field| {
        alternatives(field, plane)
    });
    let (waypoints, speeds, departs) = if let Some(field) = table.take("route") {
        table.forbid("waypoints", "nothing: the route has them");
        let (waypoints, route) = route(&field, folder, plane).unzip();
        let legs = route.as_ref().map(|route| route.speeds.as_slice());
        let speeds = leg_speeds(&mut table, legs, own_speed);
        (waypoints, speeds, route.and_then(|route| route.departs))
    } else {
        let fields = table
            .require(
                "waypoints",
                "a list of at least 2 positions, or 'route', a file",
            )
            .and_then(|field| positions(&field));
        let legs = fields.as_ref().map(|fields| vec![None; fields.len() - 1]);
        let waypoints = fields.and_then(|fields| waypoints(&fields, plane));
        (
            waypoints,
            leg_speeds(&mut table, legs.as_deref(), own_speed),
            None,
        )
    };
    table.finish();
    // every leg is long and fast enough by now
    let desired = DesiredTrajectory::new(&waypoints?, &speeds?).ok()?;
    let elapsed = time? - start?;
    Some(Mission {
        date: departs.and_then(|departs| after(departs, -start?)),
        desired: if elapsed > 0.0 {
            desired.remaining(elapsed)
        } else {
            desired
        },
        alternatives,
    })
}

/// A route file, and its waypoints on the plane.
fn route(field: &Field, folder: &Path, plane: &Plane) -> Option<(Vec<Vector>, Route)> {
    let earth = plane.need_earth();
    let file = field.file_in(folder)?;
    let kind = "a route file, RTZ 1.0 to 1.2";
    let route = field.contents(&file, Route::read(&file), kind)?;
    let earth = earth?;
    let places = route.places.iter();
    let points = every(places.map(|place| near(field, *place, &earth)))?;
    let sound = (1..).zip(points.windows(2)).all(|(leg, pair)| {
        let length = (pair[1] - pair[0]).norm();
        let is_long = length >= limits::LENGTH.low;
        if !is_long {
            let found = format_args!("waypoints {leg} and {} in one place", leg + 1);
            field.fault(
                found,
                format_args!("legs of at least {} m", limits::LENGTH.low),
            );
        }
        is_long
    });
    sound.then_some((points, route))
}

fn positions<'a>(field: &Field<'a>) -> Option<Vec<Field<'a>>> {
    field.list(2..=limits::WAYPOINTS, "positions")
}

fn alternatives(field: &Field, plane: &Plane) -> Option<Vec<Vec<Vector>>> {
    let paths = field.list(1..=limits::ALTERNATIVES, "paths, each a list of positions")?;
    every((paths.iter()).map(|path| positions(path).and_then(|fields| waypoints(&fields, plane))))
}

fn waypoints(fields: &[Field], plane: &Plane) -> Option<Vec<Vector>> {
    let (first, others) = fields.split_first()?;
    let first = plane.position(first);
    let others = waypoints_from(first, others, plane);
    let mut points = vec![first?];
    points.extend(others?);
    Some(points)
}

/// Waypoints after a known place.
pub(super) fn waypoints_from(
    start: Option<Vector>,
    fields: &[Field],
    plane: &Plane,
) -> Option<Vec<Vector>> {
    let points = fields.iter().map(|field| plane.position(field));
    let points: Vec<Option<Vector>> = std::iter::once(start).chain(points).collect();
    let mut sound = true;
    for (pair, field) in points.windows(2).zip(fields) {
        let [Some(before), Some(here)] = pair else {
            continue;
        };
        let length = (here - before).norm();
        if length < limits::LENGTH.low {
            field.fault(
                "the waypoint before it again",
                format_args!("a point at least {} m away", limits::LENGTH.low),
            );
            sound = false;
        }
        if length > limits::LEG_M {
            field.fault(
                format_args!("{:.1} km from the waypoint before it", length / 1e3),
                format_args!("at most {} km", limits::LEG_M / 1e3),
            );
            sound = false;
        }
    }
    let points: Option<Vec<Vector>> = points.into_iter().skip(1).collect();
    points.filter(|_| sound)
}

/// The speed of each leg: those of the file, else that of the leg in its route, else own ship's.
fn leg_speeds(
    table: &mut Table,
    legs: Option<&[Option<f64>]>,
    own_speed: Option<f64>,
) -> Option<Vec<f64>> {
    let one = table.speed("speed", limits::WAY);
    let per_leg = table.speeds("leg_speeds", limits::WAY);
    if let Some((field, speeds)) = per_leg {
        if table.has_speed("speed") {
            return field.reject(
                "leg speeds beside a speed of the whole mission",
                "one of the two, not both",
            );
        }
        let (speeds, legs) = (speeds?, legs?.len());
        if speeds.len() != legs {
            return field.reject(
                format_args!("{} speeds", speeds.len()),
                format_args!("{legs}, one for each leg between two waypoints"),
            );
        }
        return Some(speeds);
    }
    if table.has_speed("speed") {
        return Some(vec![one?; legs?.len()]);
    }
    if table.has_speed("leg_speeds") {
        return None;
    }
    let of_route: Option<Vec<f64>> = legs.and_then(|legs| legs.iter().copied().collect());
    if of_route.is_some() {
        return of_route;
    }
    let own_speed = own_speed?;
    if limits::WAY.contains(own_speed) {
        Some(
            legs?
                .iter()
                .map(|speed| speed.unwrap_or(own_speed))
                .collect(),
        )
    } else {
        table.require_speed("speed", limits::WAY);
        None
    }
}
