//! The targets of a scenario file.

use std::collections::BTreeMap;

use super::check::{hull, pose, waypoints_from};
use super::plane::Plane;
use super::simulation::{SimulatedTarget, simulated};
use super::{explicit_sets, limits};
use searoom_colregs::{Risk, Role, SteadyShip, TargetMemory};
use searoom_geometry::frame::{
    Pose, Vector, course_deg_from_heading, deg_from_radians, heading_from_course_deg,
    mps_from_knots, radians_from_deg, wrap,
};
use searoom_geometry::tolerance::{self, SIGMAS};
use searoom_geometry::{ConvexPolygon, ConvexSet};
use searoom_input::text::{LINE, counted};
use searoom_input::{Field, Table};
use searoom_model::target::{
    DomainKind, KnownLeg, Motion, Representation, ShipTrack, Status, Target,
};
use searoom_model::vessel::OwnShip;

/// Degrees by which the first leg of a route may differ from the course beside the spread.
const ROUTE_COURSE_DEG: f64 = 1.0;

/// Keys of what a tracked ship may do, and of the accuracy of its velocity.
const SPREADS: [&str; 8] = [
    "speed_std_mps",
    "speed_std_kn",
    "course_std_deg",
    "speed_spread_mps",
    "speed_spread_kn",
    "course_spread_deg",
    "starboard_turn_deg",
    "turn_rate_deg_per_s",
];

/// The list `targets`, which may be absent, with what is known of each from before the present, and
/// its true motion in a simulation.
pub(super) fn targets(
    root: &mut Table,
    plane: &Plane,
    time: Option<f64>,
    own: Option<&OwnShip>,
) -> Option<Vec<((Target, TargetMemory), SimulatedTarget)>> {
    let Some(field) = root.take("targets") else {
        return Some(Vec::new());
    };
    let fields = field.list(0..=usize::MAX, "tables")?;
    let mut names: BTreeMap<&str, usize> = BTreeMap::new();
    let mut targets = Vec::with_capacity(fields.len());
    for (index, field) in fields.iter().enumerate() {
        let Some(mut table) = field.table("a table") else {
            targets.push(None);
            continue;
        };
        let name = table.require("name", LINE);
        let text = name.as_ref().and_then(|name| name.line_of_text());
        if let (Some(name), Some(text)) = (&name, text)
            && let first = *names.entry(text).or_insert(index)
            && first != index
        {
            name.fault(
                format_args!("{text:?}, the name of targets[{first}] too"),
                "a name that no other target has",
            );
        }
        let motion = motion(&mut table, plane);
        let status = table.take("status");
        let status = status.map_or(Some(None), |field| field.choice(Status::WORDS).map(Some));
        let ship = match &motion {
            Some((Motion::Ship(ship), _)) => Some(ship),
            _ => None,
        };
        let role = role(&mut table, time, own, ship);
        let simulated = match ship {
            None if motion.is_some() => {
                for key in SimulatedTarget::KEYS {
                    table.forbid(key, "nothing: only a tracked ship has one");
                }
                SimulatedTarget::default()
            }
            _ => simulated(&mut table, plane),
        };
        table.finish();
        let found = text.zip(motion).zip(role).zip(status);
        targets.push(found.map(|(((name, motion), role), status)| {
            let target = Target {
                name: name.to_owned(),
                motion: motion.0,
                representation: motion.1,
                status,
            };
            let memory = TargetMemory {
                role,
                ..TargetMemory::default()
            };
            ((target, memory), simulated)
        }));
    }
    targets.into_iter().collect()
}

/// The role that own ship has had toward a tracked ship since some time; the outer `None` is a
/// fault. Both ships then are where they would have come from on own ship's first course, and on
/// the target's present one.
fn role(
    table: &mut Table,
    time: Option<f64>,
    own: Option<&OwnShip>,
    ship: Option<&ShipTrack>,
) -> Option<Option<Risk>> {
    const MORE: [&str; 2] = ["role_since_s", "first_course_deg"];
    let Some(field) = table.take("role") else {
        for key in MORE {
            table.forbid(key, "nothing: there is no role");
        }
        return Some(None);
    };
    let since = table
        .take(MORE[0])
        .map_or(time, |field| field.number(limits::until(time?)));
    let course = table.number(MORE[1], limits::COURSE);
    let role = field.choice(&Role::with_rule().collect::<Vec<_>>())?;
    let Some(ship) = ship else {
        return field.refuse("nothing: only a tracked ship has a role");
    };
    let (own, since) = (own?, since? - time?);
    let heading = course.map_or(own.pose.heading, heading_from_course_deg);
    let at = |pose: Pose, speed: f64| {
        SteadyShip::new(
            Pose::new(pose.position + pose.ahead() * (speed * since), pose.heading),
            speed,
        )
    };
    Some(Some(Risk {
        role,
        time: since,
        own: at(Pose::new(own.pose.position, heading), own.speed),
        target: at(ship.pose, ship.speed),
    }))
}

/// Motion of a target, and the representation of its obstacle.
fn motion(table: &mut Table, plane: &Plane) -> Option<(Motion, Representation)> {
    let asked = table.take("representation");
    let representation = (asked.as_ref()).map_or(Some(Representation::Polytope), |field| {
        field.choice(Representation::WORDS)
    });
    // a ship may have its velocities as a set, and keeps its hull, role and domain
    let has_sets = ["initial_set", "velocity_sets"].map(|key| table.has(key));
    let is_ship = ["position", "length_m", "beam_m"].map(|key| table.has(key));
    let only_velocities = table.has("velocity_set") && !is_ship.contains(&true);
    let motion = if has_sets.contains(&true) || only_velocities {
        explicit_sets::sets(table).map(Motion::Sets)
    } else {
        ship(table, plane).map(Motion::Ship)
    };
    let (motion, representation) = (motion?, representation?);
    let refused = match (&motion, representation) {
        (Motion::Sets(sets), Representation::Polytope) if sets.initial.as_ellipse().is_some() => {
            "\"ellipsoid\", or nothing: the sets are ellipses"
        }
        (Motion::Sets(sets), Representation::Ellipsoid)
            if sets.initial.as_polygon().is_some() && sets.velocities.len() > 1 =>
        {
            "\"polytope\": polygons of velocities one after another have no ellipsoid"
        }
        (Motion::Ship(ship), Representation::Ellipsoid)
            if ship.turn_rate > 0.0 || !ship.route.is_empty() =>
        {
            "\"polytope\": a ship that may turn, or has waypoints, has velocity sets one after \
             another, which have no ellipsoid"
        }
        _ => "",
    };
    if let Some(field) = asked.filter(|_| !refused.is_empty()) {
        return field.refuse(refused);
    }
    Some((motion, representation))
}

fn ship(table: &mut Table, plane: &Plane) -> Option<ShipTrack> {
    let has_route = table.has("waypoints");
    let has_course = table.has("course_deg") || !has_route;
    let pose = match has_course {
        true => pose(table, plane),
        // the first leg of the route gives the course
        false => plane
            .required_position(table)
            .map(|place| Pose::new(place, 0.0)),
    };
    let speed = table.required_speed("speed", limits::SPEED);
    let hull = hull(table);
    let position_std = table.number("position_std_m", limits::DISTANCE);
    let places = table.take("position_set").map(|field| {
        let nothing = "nothing beside position_set: it holds every position";
        table.forbid("position_std_m", nothing);
        positions(&field)
    });
    let heading_spread = table.number("heading_spread_deg", limits::COURSE_SPREAD);
    let domain = table.read_or("domain", DomainKind::Colregs, domain);
    let given = table.has("velocity_set").then(|| velocities(table));
    let start = pose.map(|pose| pose.position);
    let route = route(table, plane, start, speed);
    let time_spread = table.number("time_spread_s", limits::TIME_SPREAD);
    let speed_std = table.speed("speed_std", limits::SPEED);
    let course_std = table.number("course_std_deg", limits::COURSE_SPREAD);
    let speed_spread = table.speed("speed_spread", limits::SPEED);
    let course_spread = table.number("course_spread_deg", limits::COURSE_SPREAD);
    let starboard_turn = table.number("starboard_turn_deg", limits::STARBOARD_TURN);
    let turn_rate = table.number("turn_rate_deg_per_s", limits::TURN_RATE);
    let places = places.map_or(Some(None), |places| places.map(Some))?;
    let reach = places.as_ref().map(|places| places.reach() / SIGMAS);
    let ship = ShipTrack {
        position_std: reach.or(position_std).unwrap_or(0.0),
        kept_positions: places,
        heading_spread: heading_spread.map(radians_from_deg),
        speed_std: speed_std.unwrap_or(0.0),
        course_std: radians_from_deg(course_std.unwrap_or(0.0)),
        speed_spread: speed_spread.unwrap_or(0.0),
        course_spread: radians_from_deg(course_spread.unwrap_or(0.0)),
        starboard_turn: radians_from_deg(starboard_turn.unwrap_or(0.0)),
        turn_rate: radians_from_deg(turn_rate.unwrap_or(0.0)),
        time_spread: time_spread.unwrap_or(0.0),
        domain,
        ..ShipTrack::exact(pose?, speed?, hull?)
    };
    if has_route {
        return on_route(ship, has_course, route?);
    }
    let Some(given) = given else {
        return Some(ship);
    };
    let (field, velocities) = given?;
    if velocities.signed_distance(ship.velocity()) > tolerance::ALTERATION_MPS {
        return field.reject(
            "a set without the velocity of course_deg and the speed",
            "a set that holds it",
        );
    }
    Some(ship.with_velocities(velocities))
}

/// The known route of a ship from its position on, with the fields of its places and its speeds;
/// `None` for a fault, and without one.
fn route<'a>(
    table: &mut Table<'a>,
    plane: &Plane,
    start: Option<Vector>,
    speed: Option<f64>,
) -> Option<([Field<'a>; 2], Vec<KnownLeg>)> {
    let Some(field) = table.take("waypoints") else {
        let nothing = "nothing: the target has no waypoints";
        for key in ["leg_speeds_mps", "leg_speeds_kn", "time_spread_s"] {
            table.forbid(key, nothing);
        }
        return None;
    };
    for key in ["velocity_set", "starboard_turn_deg", "turn_rate_deg_per_s"] {
        table.forbid(
            key,
            "nothing beside waypoints: they say where the target turns",
        );
    }
    let places = field.list(1..=limits::TARGET_WAYPOINTS, "positions");
    let speeds = table.speeds("leg_speeds", limits::WAY);
    let places = places?;
    let mut speeds_field = field.clone();
    let route = waypoints_from(start, &places, plane);
    let speeds = match speeds {
        Some((given, speeds)) => {
            let (found, legs) = (speeds?, places.len());
            if found.len() != legs {
                let allowed = format_args!("{legs}, one for each waypoint");
                return given.reject(counted(found.len(), "speed"), allowed);
            }
            speeds_field = given;
            found
        }
        None if limits::WAY.contains(speed?) => vec![speed?; places.len()],
        None => {
            let found = "a route of a target at rest";
            return field.reject(found, "leg_speeds_mps, or a speed above 0");
        }
    };
    let legs = route?.into_iter().zip(speeds);
    let legs = legs.map(|(to, speed)| KnownLeg { to, speed });
    Some(([field, speeds_field], legs.collect()))
}

/// The ship on its route, if its course, where it is given, and its speed are those of the first leg
/// within what it may do.
fn on_route(
    ship: ShipTrack,
    has_course: bool,
    ([field, speeds_field], route): ([Field; 2], Vec<KnownLeg>),
) -> Option<ShipTrack> {
    let (course, speed) = (ship.pose.heading, ship.speed);
    let (widest, fastest) = (ship.course_half_width(), ship.speed_half_width());
    let ship = ship.with_route(route);
    let off = wrap(course - ship.pose.heading).abs();
    if has_course && !(off <= widest + radians_from_deg(ROUTE_COURSE_DEG)) {
        let found = format_args!(
            "a first leg of course {:.1}°, which is {:.1}° from course_deg",
            course_deg_from_heading(ship.pose.heading),
            deg_from_radians(off)
        );
        return field.reject(
            found,
            "a first leg within course_spread_deg and 1° of course_deg",
        );
    }
    if !((speed - ship.speed).abs() <= fastest + tolerance::ALTERATION_MPS) {
        let (unit, size) = match speeds_field.path().ends_with("_kn") {
            true => ("kn", mps_from_knots(1.0)),
            false => ("m/s", 1.0),
        };
        let [first, now] = [ship.speed, speed].map(|speed| speed / size);
        let found = format_args!("{first:.3} {unit} first, and {now:.3} {unit} now");
        return speeds_field.reject(found, "a first speed within the spread of the present one");
    }
    Some(ship)
}

/// The positions of the hull's centre about the estimate, metres.
fn positions(field: &Field) -> Option<ConvexPolygon> {
    let places = explicit_sets::position_set(field)?;
    if places.signed_distance(Vector::zeros()) > tolerance::TOUCH_M {
        return field.reject(
            "a set without [0, 0], which is the position",
            "corners about the position, in metres east and north of it",
        );
    }
    Some(places)
}

/// The velocities that a tracked ship may take, given as a polygon in place of its spreads.
fn velocities<'a>(table: &mut Table<'a>) -> Option<(Field<'a>, ConvexPolygon)> {
    for key in SPREADS {
        table.forbid(key, "nothing beside velocity_set: it holds every velocity");
    }
    let field = table.take("velocity_set")?;
    match explicit_sets::velocity_set(&field)? {
        ConvexSet::Polygon(polygon) => Some((field, polygon)),
        ConvexSet::Ellipse(_) => field.reject("an ellipse", "{ vertices_mps } beside a ship"),
    }
}

fn domain(field: &Field) -> Option<DomainKind> {
    if !field.is_table() {
        return field.choice(&[
            ("colregs", DomainKind::Colregs),
            ("paper", DomainKind::Paper),
            ("hull", DomainKind::Hull),
        ]);
    }
    let mut table = field.table("a table")?;
    let [fore, aft, port, starboard] = ["fore", "aft", "port", "starboard"]
        .map(|side| table.required_distance(side, limits::DISTANCE));
    table.finish();
    Some(DomainKind::Custom {
        fore: fore?,
        aft: aft?,
        port: port?,
        starboard: starboard?,
    })
}
