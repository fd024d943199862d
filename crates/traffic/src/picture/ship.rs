//! A ship of the picture as sets on a plane at a time.

use std::f64::consts::{FRAC_PI_2, PI};

use searoom_geometry::frame::{
    Geographic, Georeference, Pose, Vector, direction, heading_of, to_port, wrap,
};
use searoom_geometry::tolerance::SIGMAS;
use searoom_geometry::{ConvexPolygon, outer_disc};
use searoom_model::target::{DomainKind, Motion, Representation, ShipTrack, Status, Target};
use searoom_model::vessel::Hull;

use super::track::Track;
use super::{Known, PictureSettings, Reach};
use crate::report::{Directions, HullSet, Identity, Interval, Kind, Note, Notes, VelocitySet};

/// Why a ship is in no set.
pub const WITHOUT_PLACE: &str = "heard without a place";
/// Why a ship is in no set.
pub const STALE: &str = "not heard for too long";

/// Why a ship is in no set.
pub const OFF_PLANE: &str = "more than 100 km from the origin of the plane";

/// A hull may swing about its heading by this angle while the ship lies, radians: 5°.
const SWING: f64 = PI / 36.0;

/// A rate of turn is one from here on, radians per second: 2° a minute. Less is the error of the sensor.
const TURNING: f64 = PI / 180.0 / 30.0;

/// Largest turn that is expected, radians.
const MOST_TURN: f64 = FRAC_PI_2;

/// Degrees of latitude over which the direction of north is taken.
const NORTH_DEG: f64 = 1e-4;

/// Metres: a beam that is not known is not wider than this share of the length.
const BEAM_SHARE: f64 = 0.3;

/// A ship at a time.
#[derive(Debug, Clone)]
pub struct Ship {
    pub identity: Identity,
    /// Which place of its identity it is, from 1 on.
    pub place: u32,
    pub kind: Kind,
    pub status: Option<Status>,
    /// Seconds since the fix, at most.
    pub age_s: f64,
    /// True for a ship that has been at one place for some minutes.
    pub is_lying: bool,
    /// Of its fix and its size.
    pub notes: Notes,
    /// Its name, unique among the ships of a view, and its sets.
    pub target: Target,
}

/// A station or a ship that is in no set.
#[derive(Debug, Clone, PartialEq)]
pub struct Listed {
    pub identity: Identity,
    pub name: String,
    pub kind: Kind,
    pub why: &'static str,
    /// Seconds since it was heard.
    pub silent_s: f64,
}

/// Angle from true north to the north of the plane, radians, to be added to a direction.
pub(super) fn convergence(plane: &Georeference, at: Geographic) -> f64 {
    let step = if at.lat_deg > 0.0 {
        -NORTH_DEG
    } else {
        NORTH_DEG
    };
    let beside = Geographic {
        lat_deg: at.lat_deg + step,
        ..at
    };
    let north = (plane.to_plane(beside) - plane.to_plane(at)) * step.signum();
    wrap(heading_of(north) - FRAC_PI_2)
}

/// Largest length of a ship that does not tell its size, metres, by its type (ITU-R M.1371-5, table 53).
fn longest(type_code: Option<u8>) -> f64 {
    match type_code {
        Some(36 | 37 | 50 | 51 | 53 | 55) => 100.0,
        Some(30 | 52 | 54 | 58) => 150.0,
        Some(31 | 32 | 33 | 34 | 40..=49) => 200.0,
        _ => f64::INFINITY,
    }
}

/// What a station is that is no ship.
pub(super) fn is_no_ship(kind: Kind) -> Option<&'static str> {
    match kind {
        Kind::BaseStation => Some("a station ashore"),
        Kind::Aircraft => Some("an aircraft"),
        Kind::VirtualMark => Some("a mark that is not in the water"),
        _ => None,
    }
}

impl Known {
    /// What an identity is that is not a ship; `None` for a ship, and for a mark, which lies in the way as
    /// one.
    pub(super) fn is_no_ship(&self) -> Option<&'static str> {
        is_no_ship(self.kind)
    }

    pub(super) fn listed(&self, identity: Identity, why: &'static str, time: f64) -> Listed {
        Listed {
            identity,
            name: self.named(identity),
            kind: self.kind,
            why,
            silent_s: time - self.heard,
        }
    }

    fn named(&self, identity: Identity) -> String {
        let name = self.name.as_ref().map(|name| name.as_str().trim());
        match name.filter(|name| !name.is_empty()) {
            Some(name) => name.to_owned(),
            None => identity.to_string(),
        }
    }

    /// Reach of the hull from the antenna, and length and beam; largest where they are not known.
    fn size(&self) -> (HullSet, Notes) {
        let [length, beam] = match self.is_craft() {
            true => [50.0, 15.0],
            false => [500.0, 130.0],
        };
        let mut notes = Notes::default();
        notes.add(Note::NoSize);
        let (hull, notes) = (self.hull).unwrap_or((HullSet::unknown(length, beam), notes));
        let most = match self.kind {
            // a buoy; fixed structures have other codes (ITU-R M.1371-5, table 74)
            Kind::Mark if self.type_code.is_some_and(|code| (20..=30).contains(&code)) => 10.0,
            _ => longest(self.type_code),
        };
        match notes.has(Note::NoSize) && hull.length.most > most && hull.length.least <= most {
            true => (HullSet::unknown(most, BEAM_SHARE * most), notes),
            false => (hull, notes),
        }
    }

    /// The ship at a time in seconds; own ship may be `beside` metres from where it is thought to be. `None`
    /// beyond the plane.
    pub(super) fn ship(
        &self,
        identity: Identity,
        track: &Track,
        (time, beside): (f64, f64),
        plane: &Georeference,
        settings: &PictureSettings,
    ) -> Option<Ship> {
        let (fix, place) = (&track.fix, &track.position);
        let antenna = plane.to_near_plane(place.at)?;
        let turned = convergence(plane, place.at);
        let is_fixed = self.kind == Kind::Mark && fix.velocity.speed.most == 0.0;
        let is_lying = is_fixed || track.is_lying(settings.rest_mps, settings.lying_s);
        // a ship that is slow drifts, or gets under way
        let drift = match (is_fixed, is_lying, fix.velocity.speed.most) {
            (true, ..) => Some(0.0),
            (_, true, _) => Some(
                track
                    .lying_mps()
                    .clamp(settings.lying_mps, settings.drift_mps),
            ),
            (.., most) if most <= settings.rest_mps => Some(settings.drift_mps.max(most)),
            _ => None,
        };
        let ages = Interval::new(
            (time - fix.time.most).max(0.0),
            (time - fix.time.least).max(0.0),
        );
        let turned_by = |to: Directions| Directions {
            middle: wrap(to.middle + turned),
            ..to
        };
        let velocity = VelocitySet {
            course: turned_by(fix.velocity.course),
            ..fix.velocity
        };
        let fastest = self.fastest(settings);
        let acceleration = settings.acceleration_mps2[usize::from(self.is_craft())];
        // a velocity of another time than the place may have changed by so much
        let changed = acceleration * track.velocity_apart();
        let velocity = changed_by(velocity, changed);
        let motion = match drift {
            Some(drift) => outer_disc(drift * ages.most, 0.0),
            None => since_the_fix(&velocity, ages, acceleration, fastest),
        };
        let (hull, hull_notes) = self.size();
        let heading = turned_by(fix.heading);
        let (pose_heading, headings) = match heading.half < PI {
            true => (heading.middle, heading),
            false => (velocity.course.middle, Directions::ALL),
        };
        let centre = centres(&hull, &headings);
        let places = (place.outer().rotated(turned).minkowski_sum(&motion))
            .minkowski_sum(&centre)
            .minkowski_sum(&outer_disc(beside, 0.0));
        // where it is by dead reckoning: its course leads from there
        let middle_age = 0.5 * (ages.least + ages.most);
        let is_steady =
            drift.is_none() && velocity.course.half < FRAC_PI_2 && velocity.speed.most.is_finite();
        let reckoned = match is_steady {
            true => {
                let speed = 0.5 * (velocity.speed.least + velocity.speed.most);
                direction(velocity.course.middle) * (speed * middle_age)
            }
            false => Vector::zeros(),
        };
        let reckoned = reckoned + centre.centroid();
        let middle = match places.contains(reckoned) {
            true => reckoned,
            false => places.centroid(),
        };
        let (speed, speed_spread, course, course_spread) = match drift {
            Some(drift) => (0.0, drift, pose_heading, PI),
            None => under_way(&velocity, (pose_heading, fastest), settings),
        };
        let [port, starboard] = match drift {
            Some(_) => [0.0; 2],
            None => expected_turn(fix.turn_rate, settings.turning_s),
        };
        let swing = match (is_fixed, drift) {
            (true, _) => 0.0,
            (false, Some(_)) => SWING,
            // the hull turns with the course
            (false, None) => settings.course_spread.max(SWING),
        };
        let heading_spread = match headings.half < PI {
            true => {
                wrap(headings.middle - course).abs() + headings.half + swing + port.max(starboard)
            }
            false => PI,
        };
        let ship = ShipTrack {
            position_std: places.translated(-middle).reach() / SIGMAS,
            kept_positions: Some(places.translated(-middle)),
            heading_spread: Some(heading_spread.min(PI)),
            speed_spread,
            course_spread: (course_spread + port.min(starboard)).min(PI),
            starboard_turn: match course_spread < PI {
                true => starboard - port,
                false => 0.0,
            },
            domain: match self.kind == Kind::Mark {
                true => DomainKind::Hull,
                false => DomainKind::Colregs,
            },
            ..ShipTrack::exact(
                Pose::new(antenna + middle, course),
                speed,
                Hull::new(hull.length.most, hull.beam.most),
            )
        };
        Some(Ship {
            identity,
            place: track.number,
            kind: self.kind,
            status: self.status,
            age_s: ages.most,
            is_lying,
            notes: track.notes.and(hull_notes),
            target: Target {
                name: self.named(identity),
                motion: Motion::Ship(ship),
                representation: Representation::Polytope,
                status: self.status,
            },
        })
    }
}

/// A velocity set that holds every velocity within a distance of one of its own, m/s.
fn changed_by(velocity: VelocitySet, changed: f64) -> VelocitySet {
    if changed == 0.0 {
        return velocity;
    }
    let speed = velocity.speed;
    let share = changed / speed.least;
    let turned = if share < 1.0 { share.asin() } else { PI };
    VelocitySet {
        speed: Interval::new((speed.least - changed).max(0.0), speed.most + changed),
        course: Directions {
            half: (velocity.course.half + turned).min(PI),
            ..velocity.course
        },
    }
}

/// How far a ship may have come since its fix, metres: its velocity then and any acceleration up to a bound, and
/// not faster than it can be.
fn since_the_fix(
    velocity: &VelocitySet,
    ages: Interval,
    acceleration: f64,
    fastest: f64,
) -> ConvexPolygon {
    let most = match velocity.speed.most.is_finite() {
        true => velocity.speed.most.max(fastest),
        false => fastest.max(velocity.speed.least),
    };
    let anywhere = most * ages.most;
    let altered = 0.5 * acceleration * ages.most * ages.most;
    // the mean velocity is within half of what the acceleration adds
    let steady = velocity.outer(fastest);
    let corners = [ages.least, ages.most].map(|age| steady.scaled(age));
    let corners: Vec<Vector> = corners
        .iter()
        .flat_map(|part| part.vertices().to_vec())
        .collect();
    let all = outer_disc(anywhere, 0.0);
    let Ok(straight) = ConvexPolygon::hull(&corners) else {
        return all;
    };
    let moved = straight.minkowski_sum(&outer_disc(altered, 0.0));
    moved.outer_intersection(&all).unwrap_or(all)
}

/// Where the middle of the hull may be from the antenna, metres.
pub(super) fn centres(hull: &HullSet, headings: &Directions) -> ConvexPolygon {
    let half = |a: f64, b: f64| 0.5 * (a - b);
    let along = Interval::new(
        half(hull.ahead.least, hull.astern.most),
        half(hull.ahead.most, hull.astern.least),
    );
    let across = Interval::new(
        half(hull.port.least, hull.starboard.most),
        half(hull.port.most, hull.starboard.least),
    );
    let corners = [along.least, along.most]
        .into_iter()
        .flat_map(|x| [across.least, across.most].map(|y| Vector::new(x, y)));
    let corners: Vec<Vector> = corners.collect();
    let reach = corners.iter().map(|c| c.norm()).fold(0.0, f64::max);
    if !(headings.half < FRAC_PI_2) {
        return outer_disc(reach, 0.0);
    }
    let turned = corners.iter().flat_map(|corner| {
        let at = |heading: f64, size: f64| {
            let ahead = direction(heading);
            (ahead * corner.x + to_port(ahead) * corner.y) * size
        };
        // an arc lies within the tangents at its ends and in its middle
        let half = 0.5 * headings.half;
        let wider = 1.0 / half.cos();
        [
            at(headings.middle - headings.half, 1.0),
            at(headings.middle + headings.half, 1.0),
            at(headings.middle - half, wider),
            at(headings.middle + half, wider),
        ]
    });
    let turned: Vec<Vector> = turned.collect();
    ConvexPolygon::hull(&turned).unwrap_or_else(|_| outer_disc(reach, 0.0))
}

/// Middle and half-width of speed and course from now on.
fn under_way(
    velocity: &VelocitySet,
    (heading, fastest): (f64, f64),
    settings: &PictureSettings,
) -> (f64, f64, f64, f64) {
    let speed = velocity.speed;
    let most = match speed.most.is_finite() {
        true => speed.most,
        false => fastest.max(speed.least),
    };
    if !(velocity.course.half < FRAC_PI_2) {
        // every velocity up to the greatest one
        return (0.0, most + settings.speed_spread_mps, heading, PI);
    }
    let (middle, half) = (0.5 * (speed.least + most), 0.5 * (most - speed.least));
    let course = velocity.course;
    (
        middle,
        half + settings.speed_spread_mps,
        course.middle,
        course.half + settings.course_spread,
    )
}

/// How far a ship may turn on to port and to starboard, radians.
fn expected_turn(rate: Option<Interval>, lasts: f64) -> [f64; 2] {
    let Some(rate) = rate else {
        return [0.0; 2];
    };
    [rate.most, -rate.least].map(|rate| match rate > TURNING {
        true => (rate * lasts).min(MOST_TURN),
        false => 0.0,
    })
}

/// Names that several ships have get the number of the ship, so that each is unique.
pub(super) fn name_apart(ships: &mut [Ship]) {
    let mut count = std::collections::HashMap::new();
    for ship in ships.iter() {
        *count.entry(ship.target.name.clone()).or_insert(0) += 1;
    }
    for ship in ships {
        if count[&ship.target.name] > 1 {
            let name = format!("{} ({})", ship.target.name, ship.identity);
            ship.target.name = match ship.place {
                1 => name,
                place => format!("{name} at place {place}"),
            };
        }
    }
}

impl Ship {
    /// Its tracked motion.
    pub fn track(&self) -> Option<&ShipTrack> {
        self.target.ship()
    }

    /// True where it may come within reach of a point.
    pub(super) fn is_within(&self, point: Vector, reach: Reach) -> bool {
        let nearest = self.track().map(|ship| {
            let places = ship
                .kept_positions
                .as_ref()
                .map_or(0.0, ConvexPolygon::reach);
            let run = (ship.speed + ship.speed_spread) * reach.within_s;
            (ship.pose.position - point).norm() - places - ship.hull.half_diagonal() - run
        });
        // negated so that a NaN is near
        !nearest.is_some_and(|nearest| nearest > reach.own_m)
    }
}
