//! Scenario file → [`Scenario`], noting every fault.

use std::path::Path;
use std::sync::Arc;

use chrono::{DateTime, Utc};

use super::plane::{Plane, near};
use super::planner::{PlannerTable, planner};
use super::route::{Route, RouteLeg};
use super::simulation::simulation;
use super::speed_limits::SpeedLimit;
use super::targets::targets;
use super::{
    Compliance, Land, Memory, OwnNow, Scenario, SimulationSettings, after, land, limits, status,
};
use searoom_colregs::TargetMemory;
use searoom_geometry::frame::{
    GEOREFERENCE_REACH_M, Geographic, Georeference, Pose, Vector, heading_from_course_deg,
};
use searoom_input::text::{LINE, counted, knots, significant};
use searoom_input::{Fault, Faults, Field, Node, Range, Remarks, Table, every, from_toml};
use searoom_model::target::Target;
use searoom_model::trajectory::DesiredTrajectory;
use searoom_model::vessel::{Hull, OwnShip};
use searoom_planner::{DEFAULT_PLANNER, Objective, PlannerSettings, SearchKind};

/// Own ship's speeds if the file has none, as fractions of its own speed.
const DEFAULT_SPEEDS: [f64; 2] = [0.5, 1.0];

/// Speeds that differ by this fraction are one.
pub(super) const SAME_SPEED: f64 = 1e-9;

/// Cautions of a file.
pub(super) const CAUTIONS: usize = 1000;

/// The waypoints of a route by their numbers in the file.
pub(super) const FROM_WAYPOINT: Range = Range::between(1.0, 10_000.0);

/// Horizon in durations of a mission that is cut out of a longer route.
const HORIZON_MISSIONS: f64 = 2.0;

/// Metres behind a corner, in turning radii, that a mission needs to end there after the turn.
const ROOM_AFTER_TURN: f64 = 4.0;

/// Metres beside the straight leg of a plane from which on rhumb lines are remarked.
const BESIDE_M: f64 = 1.0;

/// Seconds after arrival for which own ship is observed by default.
pub(super) const DEFAULT_ARRIVAL_HOLD: f64 = 60.0;

/// Seconds of wall clock for one plan by default.
pub(super) const DEFAULT_DEADLINE: f64 = 5.0;

/// Reads the text of a scenario file in `folder`. A scenario that comes with faults is of no use.
pub(super) fn parse(
    text: &str,
    folder: &Path,
    now: Option<&OwnNow>,
    faults: &Faults,
) -> Option<Scenario> {
    let root: Node = from_toml(text, faults)?;
    let table = Field::root(&root, faults).table("a table")?;
    let scenario = scenario(table, folder, now)?;
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
fn scenario(mut root: Table, folder: &Path, now: Option<&OwnNow>) -> Option<Scenario> {
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
    let mut remarks = Remarks::default();
    cautions(&mut root, &mut remarks);
    let map = land::map(&mut root, &plane, folder, &mut remarks);
    let mut own_ship = root
        .required_table("own_ship")
        .map(|table| own_ship(table, |table| pose(table, &plane)));
    if let (
        Some(OwnShipFields {
            ship: Some(ship), ..
        }),
        Some(now),
    ) = (&mut own_ship, now)
        && let Some(earth) = plane.need_earth()
    {
        ship.pose = Pose::new(earth.to_plane(now.place), now.heading);
        ship.speed = now.speed;
    }
    let speed = own_ship.as_ref().and_then(|own| own.speed);
    let margin = own_ship.as_ref().map(|own| own.land_margin);
    let acceleration = own_ship.as_ref().and_then(|own| own.acceleration);
    let has_speeds = own_ship.as_ref().is_some_and(|own| own.has_speeds);
    let mut own_ship = own_ship.and_then(|own| own.ship);
    let reading = Reading {
        plane: &plane,
        folder,
        own_speed: speed,
        own_pose: own_ship.as_ref().map(|own| own.pose),
        own_fastest: own_ship.as_ref().map(OwnShip::max_speed),
        own_length: own_ship.as_ref().map_or(0.0, |own| own.hull.length),
        turning_radius: own_ship.as_ref().map_or(0.0, |own| own.turning_radius),
        time,
        horizon,
    };
    let mission = root
        .required_table("mission")
        .and_then(|table| mission(table, &reading, &mut remarks));
    if let (Some(own), Some(mission)) = (&mut own_ship, &mission) {
        match (has_speeds, mission.is_route) {
            (false, _) => add_speeds(&mut own.speeds, &mission.desired, f64::INFINITY),
            (true, true) => {
                let most = own.max_speed();
                add_speeds(&mut own.speeds, &mission.desired, most);
            }
            (true, false) => {}
        }
        fast_legs(own, mission, &mut remarks);
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
    for (target, _) in targets.iter().flatten() {
        if let Some(status) = target.status {
            status::remark(&target.name, status, &mut remarks);
        }
    }
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
    // own ship at sea is among ships that the file does not have
    let tracked = now.is_some() || targets.iter().any(|target| target.ship().is_some());
    Some(Scenario {
        time: time?,
        start,
        arrival_hold: arrival_hold.unwrap_or(DEFAULT_ARRIVAL_HOLD),
        stay: mission.stay,
        speed_limits: mission.speed_limits,
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
        remarks,
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
        stay: None,
        speed_limits: Vec::new(),
        alternatives: Vec::new(),
        targets: Vec::new(),
        out_of_reach: Arc::default(),
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
        remarks: Remarks::default(),
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

/// Adds the speeds of the mission up to `most`: without them own ship would change between two others
/// all the way.
fn add_speeds(speeds: &mut Vec<f64>, desired: &DesiredTrajectory, most: f64) {
    for leg in desired.legs() {
        let is_there = |speed: &f64| (speed - leg.speed).abs() <= SAME_SPEED * leg.speed;
        let fits = speeds.len() < limits::SPEEDS && leg.speed <= most;
        if fits && !speeds.iter().any(is_there) {
            speeds.push(leg.speed);
        }
    }
    speeds.sort_by(f64::total_cmp);
}

/// Remarks on speeds of a route that own ship does not reach, and on limits that it may exceed.
fn fast_legs(own: &OwnShip, mission: &Mission, remarks: &mut Remarks) {
    if !mission.is_route {
        return;
    }
    let largest = own.max_speed();
    let (mut fast, mut fastest) = (0, 0.0);
    for leg in mission
        .desired
        .legs()
        .iter()
        .filter(|leg| leg.speed > (1.0 + SAME_SPEED) * largest)
    {
        fast += 1;
        fastest = leg.speed.max(fastest);
    }
    if fast > 0 {
        let (fastest, largest) = (knots(fastest), knots(largest));
        let statement = format_args!(
            "up to {fastest}, and own ship falls behind: the largest of its speeds is {largest}"
        );
        remarks.note(
            format_args!("speeds of {}", counted(fast, "leg")),
            statement,
        );
    }
    let limits = mission.speed_limits.iter().map(|leg| leg.most);
    let least = limits.reduce(f64::min);
    if let Some(least) = least.filter(|most| *most < (1.0 - SAME_SPEED) * largest) {
        let statement = format_args!(
            "limits the mission alone, on a leg to {}; a plan may use own ship's speeds up to {}",
            knots(least),
            knots(largest)
        );
        remarks.note("speedMax", statement);
    }
}

/// The cautions of the program that wrote the file.
fn cautions(root: &mut Table, remarks: &mut Remarks) {
    let Some(field) = root.take("cautions") else {
        return;
    };
    let Some(list) = field.list(0..=CAUTIONS, "texts") else {
        return;
    };
    let texts = every(
        list.iter()
            .map(|text| text.line_of_text().map(str::to_owned)),
    );
    remarks.cautions.extend(texts.unwrap_or_default());
}

/// Own lengths within which own ship is at its place.
const ON_THE_SPOT_LENGTHS: f64 = 0.5;

struct Mission {
    desired: DesiredTrajectory,
    /// The date and time at 0 s on the clock of the file, by the schedule of the route.
    date: Option<DateTime<Utc>>,
    alternatives: Vec<Vec<Vector>>,
    /// See [`Scenario::stay`].
    stay: Option<f64>,
    /// True where the speeds are those of a route file.
    is_route: bool,
    /// See [`Scenario::speed_limits`].
    speed_limits: Vec<SpeedLimit>,
}

/// Values of the file that the mission needs.
struct Reading<'a> {
    plane: &'a Plane,
    folder: &'a Path,
    /// m/s.
    own_speed: Option<f64>,
    own_pose: Option<Pose>,
    /// m/s.
    own_fastest: Option<f64>,
    /// Metres.
    own_length: f64,
    /// Metres.
    turning_radius: f64,
    time: Option<f64>,
    horizon: Option<f64>,
}

fn mission(mut table: Table, reading: &Reading, remarks: &mut Remarks) -> Option<Mission> {
    let Reading { plane, time, .. } = *reading;
    let start = table
        .take("start_s")
        .map_or(time, |field| field.number(limits::until(time?)));
    let alternatives = table.read_or("alternatives", Vec::new(), |field| {
        alternatives(field, plane)
    });
    let from = table.take("from_waypoint");
    let from_read = from
        .as_ref()
        .map(|field| field.whole_number(FROM_WAYPOINT).map(First::Waypoint));
    let nearest = table.take("from_nearest");
    let is_nearest = nearest.as_ref().and_then(Field::truth) == Some(true);
    if let (Some(field), true) = (&from, is_nearest) {
        field.fault(
            "from_waypoint beside from_nearest",
            "one of the two, not both",
        );
    }
    let from_read = from_read.or(is_nearest.then_some(Some(First::Nearest)));
    let schedule = table.take("schedule");
    let of_route = from.iter().chain(&nearest).chain(&schedule).next().cloned();
    let schedule = schedule.map(|field| field.line_of_text());
    let mut part: Option<Part> = None;
    let mut is_place = false;
    let (waypoints, speeds) = if let Some(field) = table.take("route") {
        table.forbid("waypoints", "nothing: the route has them");
        part = match (schedule, from_read) {
            (Some(None), _) | (_, Some(None)) => None,
            (schedule, from) => {
                let wanted = (schedule.flatten(), from.flatten());
                route(&field, wanted, reading, remarks)
            }
        };
        let legs = part.as_ref().map(|part| part.legs.as_slice());
        let is_ordered = table.has_speed("speed") || table.has_speed("leg_speeds");
        let mut speeds = leg_speeds(&mut table, legs, reading.own_speed);
        if let (Some(speeds), Some(part), false) = (&mut speeds, &part, is_ordered) {
            slow_down(&field, speeds, part, remarks)?;
        }
        (part.as_ref().map(|part| part.points.clone()), speeds)
    } else {
        if let Some(field) = of_route {
            field.fault(
                "a key of a route",
                "nothing beside 'waypoints': it is for 'route'",
            );
        }
        let fields = table
            .require(
                "waypoints",
                "a list of positions, one where own ship stays, or 'route', a file",
            )
            .and_then(|field| field.list(1..=limits::WAYPOINTS, "positions"));
        is_place = fields.as_ref().is_some_and(|fields| fields.len() == 1);
        let legs = fields
            .as_ref()
            .map(|fields| vec![LegSpeeds::default(); (fields.len() - 1).max(1)]);
        let waypoints = fields.and_then(|fields| match &fields[..] {
            [place] => to_place(place, reading, remarks),
            fields => waypoints(fields, plane),
        });
        let makes_way = |speed: &f64| limits::WAY.contains(*speed);
        let own_speed = match is_place {
            true => (reading.own_speed.filter(makes_way)).or(reading.own_fastest),
            false => reading.own_speed,
        };
        (
            waypoints,
            leg_speeds(&mut table, legs.as_deref(), own_speed),
        )
    };
    let horizon = reading.horizon;
    let stays = table.take("stay_until_s").map(|field| {
        let (until, now) = (field.number(limits::STAY)?, time?);
        let last = now + horizon?;
        if !(until >= now && until <= last) {
            let allowed = format_args!("{now} s, the present, to {last} s, the end of horizon_s");
            return field.reject(until, allowed);
        }
        // a rounding must not end it after the horizon
        Some((until - now).min(horizon?))
    });
    table.finish();
    let stay = match stays {
        Some(stay) => Some(stay?),
        None if is_place => Some(horizon?),
        None => None,
    };
    // every leg is long and fast enough by now
    let desired = DesiredTrajectory::new(&waypoints?, &speeds?).ok()?;
    let elapsed = time? - start?;
    let mut desired = if elapsed > 0.0 {
        desired.remaining(elapsed)
    } else {
        desired
    };
    let is_beyond_reach = part.as_ref().is_some_and(|part| part.is_beyond_reach);
    if let (true, Some(horizon)) = (is_beyond_reach, reading.horizon) {
        let room = ROOM_AFTER_TURN * reading.turning_radius;
        desired = until(desired, horizon / HORIZON_MISSIONS, room, remarks);
    }
    let departs = part.as_ref().and_then(|part| part.departs);
    Some(Mission {
        date: departs.and_then(|departs| after(departs, -start?)),
        desired,
        alternatives,
        stay,
        is_route: part.is_some(),
        speed_limits: part.as_ref().map(Part::speed_limits).unwrap_or_default(),
    })
}

/// The beginning of a mission that takes no more than some seconds. It does not end within `room`,
/// metres, behind a corner, but at the corner.
fn until(
    desired: DesiredTrajectory,
    time: f64,
    room: f64,
    remarks: &mut Remarks,
) -> DesiredTrajectory {
    let mut legs = desired.legs().iter();
    let Some((index, leg)) = legs
        .by_ref()
        .enumerate()
        .find(|(_, leg)| leg.end_time() > time)
    else {
        return desired;
    };
    let made = (time - leg.start_time) * leg.speed;
    let is_short = index > 0 && made < room;
    let length = leg.start_distance + if is_short { 0.0 } else { made };
    let Some(begin) = desired.shortened(desired.length() - length) else {
        return desired;
    };
    let statement = format_args!(
        "the mission is its next {:.1} km, which take no more than half of horizon_s, so that \
         there is time to give way",
        1e-3 * begin.length()
    );
    remarks.note("route", statement);
    begin
}

/// Speeds that a leg of a route has, m/s.
#[derive(Debug, Clone, Copy, Default)]
struct LegSpeeds {
    ordered: Option<f64>,
    /// The highest allowed one.
    most: Option<f64>,
}

/// The part of a route that is the mission.
struct Part {
    points: Vec<Vector>,
    legs: Vec<LegSpeeds>,
    /// Seconds that own ship waits where each leg ends.
    waits: Vec<f64>,
    departs: Option<DateTime<Utc>>,
    /// True where the route is not wholly within reach.
    is_beyond_reach: bool,
}

impl Part {
    /// The legs with the highest speeds that they allow; empty where none has a limit.
    fn speed_limits(&self) -> Vec<SpeedLimit> {
        if self.legs.iter().all(|leg| leg.most.is_none()) {
            return Vec::new();
        }
        let legs = self.points.windows(2).zip(&self.legs);
        let limit = |(ends, leg): (&[Vector], &LegSpeeds)| SpeedLimit {
            from: ends[0],
            to: ends[1],
            most: leg.most.unwrap_or(f64::INFINITY),
        };
        legs.map(limit).collect()
    }
}

/// Makes a leg before a wait as slow as to end with the wait: a desired trajectory does not wait.
fn slow_down(field: &Field, speeds: &mut [f64], part: &Part, remarks: &mut Remarks) -> Option<()> {
    for (leg, (speed, wait)) in speeds.iter_mut().zip(&part.waits).enumerate() {
        if *wait <= 0.0 {
            continue;
        }
        let length = (part.points[leg + 1] - part.points[leg]).norm();
        *speed = length / (length / *speed + wait);
        if !limits::WAY.contains(*speed) {
            let found = format_args!("a stay of {wait} s after a leg of {length:.0} m");
            return field.reject(found, "a shorter stay, or a route that ends there");
        }
        let statement = format_args!(
            "taken as a slower leg {}, at {}, which ends when the stay does",
            leg + 1,
            knots(*speed)
        );
        remarks.note(format_args!("stay of {wait:.0} s"), statement);
    }
    Some(())
}

/// Where the mission on a route begins.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum First {
    /// At a waypoint, counted from 1.
    Waypoint(usize),
    /// At the place nearest to own ship.
    Nearest,
}

/// The part of a route file, with its schedule and its first waypoint by choice, that is the mission.
/// A route beyond the reach of the plane is followed from the place nearest to own ship, or from the
/// chosen waypoint, to the end of the reach.
fn route(
    field: &Field,
    (schedule, from): (Option<&str>, Option<First>),
    reading: &Reading,
    remarks: &mut Remarks,
) -> Option<Part> {
    let earth = reading.plane.need_earth();
    let file = field.file_in(reading.folder)?;
    let kind = "a route file, RTZ 1.0 to 1.2";
    let route = field.contents(&file, Route::read(&file, schedule), kind)?;
    let earth = earth?;
    let count = route.places.len();
    if let Some(First::Waypoint(from)) = from
        && from >= count
    {
        let found = format_args!("from_waypoint = {from} for a route of {count} waypoints");
        return field.reject(found, format_args!("1 to {}", count - 1));
    }
    remarks.extend(&route.remarks);
    let is_near = |place: &Geographic| earth.to_near_plane(*place).is_some();
    let is_whole = count <= limits::WAYPOINTS && route.places.iter().all(is_near);
    let (first, begins) = match from {
        Some(First::Waypoint(from)) => (from - 1, 0.0),
        None if is_whole => (0, 0.0),
        None | Some(First::Nearest) => {
            let own = reading
                .own_pose
                .map_or_else(Vector::zeros, |own| own.position);
            let Some(nearest) = nearest(&route.legs, own, &earth) else {
                near(field, route.places[0], &earth)?;
                return None;
            };
            nearest
        }
    };
    // a fault where the chosen waypoint is beyond reach
    let mut points = vec![near(field, route.legs[first].at(begins), &earth)?];
    let (mut legs, mut waits) = (Vec::new(), Vec::new());
    let mut beside: [f64; 2] = [0.0; 2];
    let (mut last, mut ends) = (first, 1.0);
    for (index, leg) in route.legs.iter().enumerate().skip(first) {
        if legs.len() + 1 == limits::WAYPOINTS {
            break;
        }
        let from = if index == first { begins } else { 0.0 };
        let reached = leg.within_reach(&earth);
        let to = match reached {
            Some([starts, to]) if starts <= from => to,
            _ => break,
        };
        let point = near(field, leg.at(to), &earth)?;
        let length = (point - points[points.len() - 1]).norm();
        if !(length >= limits::LENGTH.low) {
            if to < 1.0 || index == first {
                continue;
            }
            return field.reject(
                format_args!("waypoints {} and {} in one place", index + 1, index + 2),
                format_args!("legs of at least {} m", limits::LENGTH.low),
            );
        }
        let off = &mut beside[usize::from(leg.is_great_circle)];
        *off = off.max(leg.beside([from, to], &earth));
        points.push(point);
        legs.push(LegSpeeds {
            ordered: leg.speed,
            most: leg.most,
        });
        waits.push(if to < 1.0 { 0.0 } else { leg.wait });
        (last, ends) = (index, to);
        if to < 1.0 {
            break;
        }
    }
    // where the mission ends nothing waits
    if let Some(wait) = waits.last_mut() {
        *wait = 0.0;
    }
    if legs.is_empty() {
        return field.reject("no leg within reach of the origin", "a route near own ship");
    }
    let is_cut = last + 1 < route.legs.len() || ends < 1.0;
    if is_cut || (first, begins) != (0, 0.0) {
        let reach = GEOREFERENCE_REACH_M / 1e3;
        let until = match ends < 1.0 {
            true => format!("on leg {}", last + 1),
            false => format!("at waypoint {}", last + 2),
        };
        let begun = match begins > 0.0 {
            true => format!("beside own ship on leg {}", first + 1),
            false => format!("at waypoint {}", first + 1),
        };
        let statement = format_args!(
            "of {count} waypoints; the mission begins {begun} and ends {until}, within {reach:.0} \
             km of the origin and with at most {} waypoints",
            limits::WAYPOINTS
        );
        remarks.note("route", statement);
    }
    for (kind, off, from) in [
        ("rhumb lines (Loxodrome)", beside[0], BESIDE_M),
        ("great circles (Orthodrome)", beside[1], 0.0),
    ] {
        let is_there = kind.starts_with('r') || route.legs.iter().any(|leg| leg.is_great_circle);
        if is_there && off >= from {
            let statement = format_args!(
                "a leg is a straight line of the plane, here at most {off:.1} m beside them"
            );
            remarks.note(kind, statement);
        }
    }
    let departs = match begins > 0.0 {
        true => None,
        false => route.departs[first],
    };
    Some(Part {
        points,
        legs,
        waits,
        departs,
        is_beyond_reach: is_cut || !is_whole || from == Some(First::Nearest),
    })
}

/// The leg that comes nearest to own ship within reach, and the fraction of it where it does. The end
/// of a leg is the beginning of the next one.
fn nearest(legs: &[RouteLeg], own: Vector, earth: &Georeference) -> Option<(usize, f64)> {
    let mut best: Option<(f64, usize, f64)> = None;
    for (index, leg) in legs.iter().enumerate() {
        let Some([from, to]) = leg.within_reach(earth) else {
            continue;
        };
        let [start, end] = [from, to].map(|fraction| earth.to_plane(leg.at(fraction)));
        let way = end - start;
        let along = ((own - start).dot(&way) / way.norm_squared()).clamp(0.0, 1.0);
        let off = (start + way * along - own).norm();
        if best.is_none_or(|(least, ..)| off < least) {
            best = Some((off, index, from + along * (to - from)));
        }
    }
    let (_, index, fraction) = best?;
    Some(match fraction >= 1.0 && index + 1 < legs.len() {
        true => (index + 1, 0.0),
        false => (index, fraction),
    })
}

/// The path to a single waypoint: from own ship, or a millimetre where it is there, to half of its
/// length. No ship at anchor is at the last digit of its place.
fn to_place(field: &Field, reading: &Reading, remarks: &mut Remarks) -> Option<Vec<Vector>> {
    let (place, own) = (reading.plane.position(field)?, reading.own_pose?);
    let length = (place - own.position).norm();
    if length > limits::LEG_M {
        let found = format_args!("{:.1} km from own ship", length / 1e3);
        return field.reject(found, format_args!("at most {} km", limits::LEG_M / 1e3));
    }
    if length > ON_THE_SPOT_LENGTHS * reading.own_length {
        return Some(vec![own.position, place]);
    }
    if length > 0.0 {
        let statement = format_args!(
            "{} m from own ship, which stays where it is: that is within half of its length",
            significant(length)
        );
        remarks.note("waypoint of the stay", statement);
    }
    Some(vec![
        own.position - own.ahead() * limits::LENGTH.low,
        own.position,
    ])
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

/// The speed of each leg: those of the file, else that of the leg in its route, else own ship's, up
/// to the highest that the leg allows.
fn leg_speeds(
    table: &mut Table,
    legs: Option<&[LegSpeeds]>,
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
    let own_speed = own_speed?;
    let makes_way = limits::WAY.contains(own_speed);
    // own ship at rest has no speed for a leg without one
    let usual = |leg: &LegSpeeds| match makes_way {
        true => Some(leg.most.map_or(own_speed, |most| own_speed.min(most))),
        false => leg.most,
    };
    let legs = legs?.iter().map(|leg| leg.ordered.or_else(|| usual(leg)));
    let speeds: Option<Vec<f64>> = legs.collect();
    if speeds.is_none() {
        table.require_speed("speed", limits::WAY);
    }
    speeds
}
