//! Requirements of each planner on a scenario, beyond those of the single fields.

use super::{Compliance, Land, Scenario, limits};
use searoom_geometry::frame::{Vector, heading_of, wrap};
use searoom_geometry::tolerance;
use searoom_input::Fault;
use searoom_input::text::rounded;
use searoom_model::target::Target;
use searoom_model::trajectory::{NetworkError, PathNetwork};
use searoom_planner::{Minimises, Objective};

/// Every field that the scenario's planner cannot honour; faults without lines.
pub(super) fn unfit(scenario: &Scenario) -> Vec<Fault> {
    let planner = scenario.planner.facts();
    let name = planner.name;
    let mut faults = Vec::new();
    if planner.follows_paths {
        faults = for_paths(scenario);
    }
    if planner.minimises != Minimises::Objective && scenario.objective != Objective::SpaceTimeError
    {
        let found = format!("\"{}\" for the {name} planner", scenario.objective.kind());
        let allowed = match planner.minimises {
            Minimises::Own(_) => "nothing: it minimises its own stage cost",
            _ => "\"space-time-error\", or the path-time planner",
        };
        faults.push(Fault::new("planner.objective", found, allowed));
    }
    if !planner.follows_paths && !scenario.alternatives.is_empty() {
        faults.push(Fault::new(
            "mission.alternatives",
            format_args!("other paths for the {name} planner"),
            "nothing: it chooses its way; or the path-time planner",
        ));
    }
    faults.extend(stay(scenario));
    let own = &scenario.own_ship;
    let land_margin = scenario.land.as_ref().map(|land| land.margin);
    let room = own.safety_margin.min(land_margin.unwrap_or(f64::INFINITY));
    if own.tracking_margin > room {
        faults.push(Fault::new(
            "own_ship.tracking_margin_m",
            format_args!("{} m", own.tracking_margin),
            format_args!(
                "at most {room} m: a part of safety_margin_m, and of land_margin_m with a map"
            ),
        ));
    }
    let is_aside = |target: &Target| {
        let ship = target.ship();
        ship.is_some_and(|ship| {
            let is_known = ship.kept_velocities.is_some() || !ship.route.is_empty();
            ship.starboard_turn != 0.0 || is_known
        })
    };
    if scenario.max_risk > 0.0 && scenario.targets.iter().any(is_aside) {
        faults.push(Fault::new(
            "planner.max_risk",
            scenario.max_risk,
            "0: risk counts from the middle of the velocities, which is not the expected one of a \
             target with starboard_turn_deg, velocity_set or waypoints",
        ));
    }
    faults.extend(lag(scenario));
    if !planner.keeps_off_land && scenario.land.is_some() {
        faults.push(Fault::new(
            "map",
            format_args!("land for the {name} planner"),
            "nothing: it keeps off no land, this is not built yet",
        ));
    }
    if !planner.keeps_rules && scenario.compliance == Compliance::Rules {
        faults.push(Fault::new(
            "planner.compliance",
            format_args!("\"rules\" for the {name} planner"),
            "\"shape\" or \"none\", or the space-time planner: it alone keeps to the rules",
        ));
    }
    faults
}

/// A ship that lies at its place needs a planner and a speed for that.
fn stay(scenario: &Scenario) -> Option<Fault> {
    let stay = scenario.stay?;
    let planner = scenario.planner.facts();
    let fault = |found: String, allowed| Some(Fault::new("mission.stay_until_s", found, allowed));
    if let Minimises::Own(_) = planner.minimises {
        let found = format!("a stay until {stay} s for the {} planner", planner.name);
        return fault(found, "nothing: its motions end at the horizon");
    }
    if !planner.follows_paths && scenario.own_ship.min_speed() > 0.0 {
        let found = format!("a stay until {stay} s of a ship that cannot lie still");
        return fault(found, "a stay only where own ship's speeds have 0");
    }
    None
}

/// Plans change speed at once. Own ship, which needs the time `du / a`, is `du² / 2a` ahead or
/// behind after a change by `du`: beyond its tracking margin this is a fault.
fn lag(scenario: &Scenario) -> Option<Fault> {
    let (own, planner) = (&scenario.own_ship, scenario.planner.facts());
    let acceleration = scenario.acceleration?;
    let fault = |found: String, allowed: &str| {
        Some(Fault::new("own_ship.acceleration_mps2", found, allowed))
    };
    if matches!(planner.minimises, Minimises::Own(_)) {
        let allowed = "nothing: the forces of the vessel limit it";
        return fault(acceleration.to_string(), allowed);
    }
    let low = own.speeds.iter().copied().fold(own.speed, f64::min);
    let low = if planner.follows_paths { 0.0 } else { low };
    let high = own.max_speed().max(own.speed);
    let lag = 0.5 * (high - low).powi(2) / acceleration;
    // negated on purpose: a NaN is too much
    if lag <= own.tracking_margin {
        return None;
    }
    let found = format!(
        "{acceleration}: own ship is {lag:.2} m off its plan after a change from {} to {} m/s, and \
         its tracking margin is {} m",
        rounded(low),
        rounded(high),
        own.tracking_margin
    );
    let allowed = "a greater one, speeds nearer to one another, or a larger tracking_margin_m";
    fault(found, allowed)
}

fn for_paths(scenario: &Scenario) -> Vec<Fault> {
    let mut faults = Vec::new();
    let first = scenario.desired.legs()[0].start;
    if scenario.stay.is_some() && scenario.desired.length() < 2.0 * limits::LENGTH.low {
        let found = "a place and no path, for the path-time planner";
        let allowed = "a path of at least two waypoints, or the space-time planner";
        return vec![Fault::new("mission.waypoints", found, allowed)];
    }
    let away = (scenario.own_ship.pose.position - first).norm();
    // negated on purpose: a NaN is away
    if !(away <= tolerance::JOINT_M) {
        faults.push(Fault::new(
            "own_ship.position",
            format_args!("a start {} m from the first waypoint", rounded(away)),
            "the first waypoint: the path-time planner keeps to the path",
        ));
    }
    let alternative = |index: usize| format!("mission.alternatives[{index}]");
    match PathNetwork::new(&scenario.desired.waypoints(), &scenario.alternatives) {
        Ok(network) => {
            if let Some(land) = &scenario.land {
                faults.extend(turns_aground(scenario, land, &network));
            }
        }
        Err(NetworkError::NoSharedPoint { alternative: index }) => faults.push(Fault::new(
            alternative(index),
            "a path that shares no point with another one",
            "a path that leaves the mission's path, or another alternative, and comes back",
        )),
        Err(NetworkError::NoWayThrough { alternative: index }) => faults.push(Fault::new(
            alternative(index),
            "a path on no way from the first waypoint to the last",
            "a path that is met first where it can be reached, and later where another path goes \
             on",
        )),
        Err(NetworkError::EmptyLeg { path, leg }) => faults.push(Fault::new(
            match path.checked_sub(1) {
                Some(index) => alternative(index),
                None => "mission.waypoints".to_owned(),
            },
            format_args!("no length of leg {leg}"),
            "legs of some length",
        )),
    }
    faults
}

/// Places where own hull, turning on the spot from one leg to the next, would be too near to land.
fn turns_aground(scenario: &Scenario, land: &Land, network: &PathNetwork) -> Vec<Fault> {
    let own = &scenario.own_ship;
    let legs = network.legs();
    let mut faults = Vec::new();
    for point in 0..network.points() {
        let same = network.same_place(point);
        if same.iter().any(|p| *p < point) {
            continue;
        }
        let place = network.place(point);
        let arriving = legs.iter().filter(|leg| same.contains(&leg.ends[1]));
        let mut before: Vec<f64> = arriving.map(|leg| heading_of(leg.direction)).collect();
        if same.contains(&network.start()) {
            before.push(own.pose.heading);
        }
        let mut least = f64::INFINITY;
        for from in before {
            for leg in network.onward(point) {
                let turn = wrap(heading_of(legs[*leg].direction) - from);
                if turn.abs() > tolerance::JOINT_RAD {
                    least = least.min(land.room_to_turn(&own.hull, place, from, turn));
                }
            }
        }
        // negated on purpose: a NaN is aground
        if !(least >= land.margin - tolerance::DEPTH_M) {
            let field = field_at(scenario, place);
            let found = if least < 0.0 {
                format!(
                    "a turn on the spot that takes own hull {:.1} m onto land",
                    -least
                )
            } else {
                format!("a turn on the spot that takes own hull to {least:.1} m from land")
            };
            let allowed = format!(
                "at least {} m of water around own hull on every heading between the legs that \
                 meet here, or the space-time planner",
                land.margin
            );
            faults.push(Fault::new(field, found, allowed));
        }
    }
    faults
}

/// Path of the waypoint at a place, or of the alternatives if they only cross there.
fn field_at(scenario: &Scenario, place: Vector) -> String {
    let at = |points: &[Vector]| {
        let near = |p: &Vector| (p - place).norm() <= tolerance::JOINT_M;
        points.iter().position(near)
    };
    if let Some(index) = at(&scenario.desired.waypoints()) {
        return format!("mission.waypoints[{index}]");
    }
    let others = scenario.alternatives.iter().enumerate();
    let mut found = others.filter_map(|(path, points)| Some((path, at(points)?)));
    match found.next() {
        Some((path, index)) => format!("mission.alternatives[{path}][{index}]"),
        None => format!(
            "mission.alternatives (crossing at east {:.1} m, north {:.1} m)",
            place.x, place.y
        ),
    }
}
