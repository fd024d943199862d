//! Probable mistakes of a scenario.

use crate::frame::{
    Vector, course_deg_from_heading, deg_from_radians, heading_of, knots_from_mps, wrap,
};
use crate::planner::Minimises;
use crate::scenario::Scenario;
use crate::target::ShipTrack;
use crate::text::{knots, significant};
use crate::vessel::Hull;

/// Speed in knots from which an AIS report means "not available" (102.3) or "at least 102.2"
/// (ITU-R M.1371-5, table 48), less half a step of the format.
const AIS_UNKNOWN_KN: f64 = 102.25;
const AIS_TOP_KN: f64 = 102.15;

/// Least length in metres, and a speed in knots that no ship of it has reached: SS United States,
/// 302 m, made 38 kn, and the ferry Francisco, 99 m, 58 kn.
const FASTEST: [(f64, f64); 3] = [(150.0, 40.0), (20.0, 60.0), (0.0, 100.0)];

/// Greatest difference of the velocities of own ship and its own echo: m/s, and a fraction of own
/// speed.
const ECHO_SPEED: f64 = 0.5;
const ECHO_SHARE: f64 = 0.1;

/// Speed, m/s, below which a ship lies still.
const STILL: f64 = 0.3;

/// Ratio of two speeds from which one is probably in the other's unit: a knot is 1/1.94 m/s.
const OTHER_UNIT: f64 = 1.8;

/// Seconds by which own ship may be ahead of the beginning of its mission.
const EARLY: f64 = 60.0;

/// Every probable mistake, as a text behind the name of its ship or table. O(targets × waypoints).
pub(super) fn mistakes(scenario: &Scenario) -> Vec<String> {
    let ships = (scenario.targets.iter()).filter_map(|t| Some((&*t.name, t.ship()?)));
    let own = &scenario.own_ship;
    let mut found = Vec::new();
    let sizes = ships.clone().map(|(name, ship)| (name, ship.hull));
    found.extend(
        [("own_ship", own.hull)]
            .into_iter()
            .chain(sizes)
            .filter_map(wide),
    );
    let speeds = ships.map(|(name, ship)| (name, ship.greatest_speed(), ship.hull.length));
    let fastest = own.speed.max(own.max_speed());
    let speeds = [("own_ship", fastest, own.hull.length)]
        .into_iter()
        .chain(speeds);
    found.extend(speeds.filter_map(too_fast));
    found.extend(overlaps(scenario));
    found.extend(under_ships(scenario));
    found.extend(of_own_ship(scenario));
    found
}

/// A hull that is wider than long.
fn wide((name, Hull { length, beam }): (&str, Hull)) -> Option<String> {
    (beam > length)
        .then(|| format!("{name}: beam_m, {beam}, is greater than length_m, {length}: exchanged?"))
}

/// A speed that no ship of this length has.
fn too_fast((name, speed, length): (&str, f64, f64)) -> Option<String> {
    let knots = knots_from_mps(speed);
    let found = format!("{name}: speed, {}", both_units(speed));
    if (AIS_UNKNOWN_KN..AIS_UNKNOWN_KN + 0.1).contains(&knots) {
        return Some(format!(
            "{found}: what AIS reports where it is not available?"
        ));
    }
    if (AIS_TOP_KN..AIS_UNKNOWN_KN).contains(&knots) {
        return Some(format!("{found}: the greatest that AIS reports, or more?"));
    }
    let (_, most) = FASTEST.into_iter().find(|(least, _)| length >= *least)?;
    (knots > most).then(|| {
        format!("{found}, is more than ships of {length} m make: m/s and knots exchanged?")
    })
}

/// Targets that overlap own ship at t = 0.
fn overlaps(scenario: &Scenario) -> impl Iterator<Item = String> {
    let own = &scenario.own_ship;
    let velocity = own.pose.ahead() * own.speed;
    scenario.targets.iter().filter_map(move |target| {
        let name = &target.name;
        if !(target.distance_from(&own.hull, &own.pose, 0.0) < 0.0) {
            return None;
        }
        let Some(ship) = target.ship() else {
            return Some(format!("{name}: its set holds own ship at the start"));
        };
        let apart = (ship.velocity() - velocity).norm();
        Some(match apart <= ECHO_SPEED + ECHO_SHARE * own.speed {
            true => format!(
                "{name}: overlaps own ship at the start, at its course and speed: own ship's own \
                 report or echo, which is no target?"
            ),
            false => format!("{name}: overlaps own ship at the start"),
        })
    })
}

/// Waypoints where own ship cannot be without touching a ship that lies there.
fn under_ships(scenario: &Scenario) -> Vec<String> {
    let (own, desired) = (&scenario.own_ship, &scenario.desired);
    let ends = desired.legs().iter().enumerate().map(|(index, leg)| {
        let name = match index + 1 == desired.legs().len() {
            true => "the last waypoint".to_owned(),
            false => {
                let on = significant(leg.start_distance + leg.length);
                format!("the waypoint {on} m from the first")
            }
        };
        (name, leg.start + leg.direction * leg.length, leg.end_time())
    });
    let ships = (scenario.targets.iter()).filter_map(|t| Some((&*t.name, t.ship()?)));
    let lie = ships.filter(|(_, ship)| ship.greatest_speed() < STILL);
    let over = |ship: &ShipTrack, place: Vector, time: f64| {
        ship.hull
            .polygon(&ship.pose_at(time))
            .signed_distance(place)
            < 0.5 * own.hull.beam
    };
    lie.flat_map(|(name, ship)| {
        let covered = ends
            .clone()
            .filter(move |(_, at, due)| over(ship, *at, *due));
        covered.map(move |(waypoint, ..)| format!("{name}: lies at rest over {waypoint}"))
    })
    .collect()
}

/// Findings about own ship: speeds and courses it cannot or would hardly have.
fn of_own_ship(scenario: &Scenario) -> Vec<String> {
    let (own, desired) = (&scenario.own_ship, &scenario.desired);
    let most = own.max_speed();
    let mut found = Vec::new();
    if own.speed >= OTHER_UNIT * most {
        let [now, most] = [own.speed, most].map(both_units);
        found.push(format!(
            "own_ship: speed, {now}, and the greatest of its speeds, {most}: m/s and knots exchanged?"
        ));
    }
    let legs = desired.legs();
    let asked = legs.iter().map(|leg| leg.speed).fold(0.0, f64::max);
    if asked >= OTHER_UNIT * most {
        let [asked, most] = [asked, most].map(both_units);
        found.push(format!(
            "mission: speed, {asked}, and the greatest that own ship makes, {most}: m/s and knots \
             exchanged?"
        ));
    }
    let current = scenario.simulation.current.mean.norm();
    if current >= most {
        let [current, most] = [current, most].map(both_units);
        found.push(format!(
            "simulation.current: speed, {current}, is as much as own ship makes, {most}, or more: it \
             cannot keep its track"
        ));
    }
    let first = &legs[0];
    let course = heading_of(first.direction);
    let off = wrap(own.pose.heading - course).abs();
    if own.speed > 0.0 && off > std::f64::consts::FRAC_PI_2 {
        let [own, leg] = [own.pose.heading, course].map(course_deg_from_heading);
        found.push(format!(
            "own_ship: course_deg, {own:.1}, is {:.0}° from the first leg, {leg:.1}: waypoints in the \
             wrong order?",
            deg_from_radians(off)
        ));
    }
    let from_start = own.pose.position - first.start;
    let within = most * scenario.horizon;
    if from_start.norm() > within {
        let [away, within] = [from_start.norm(), within].map(significant);
        found.push(format!(
            "mission: begins {away} m from own ship, which sails at most {within} m within horizon_s: \
             another origin?"
        ));
    }
    // a ship that was planned before may be ahead of its schedule
    let ahead = first.direction.dot(&from_start);
    if ahead > own.hull.length.max(EARLY * first.speed) && scenario.memory.remainder.is_empty() {
        let ahead = significant(ahead);
        found.push(format!(
            "mission: begins {ahead} m astern of own ship, which slows down to keep to its schedule: a \
             first waypoint already passed?"
        ));
    }
    found.extend(short_horizon(scenario));
    found
}

/// A horizon before the end of the mission, where one plan has to arrive.
fn short_horizon(scenario: &Scenario) -> Option<String> {
    let (horizon, duration) = (scenario.horizon, scenario.desired.duration());
    let facts = scenario.planner.facts();
    let arrives = !matches!(facts.minimises, Minimises::Own(_));
    let in_parts = match facts.follows_paths {
        true => "",
        false => ". `simulate` sails it in parts",
    };
    // less is a rounding of the file
    (arrives && horizon + 0.5 < duration).then(|| {
        format!(
            "horizon_s: {horizon} s are less than the {duration:.0} s of the mission at its \
             speeds, and a plan has to arrive by then; take more, with time to give way{in_parts}"
        )
    })
}

/// A speed in both of its units: files have either.
fn both_units(speed: f64) -> String {
    format!("{} ({} m/s)", knots(speed), significant(speed))
}
