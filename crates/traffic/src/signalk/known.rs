//! The last values of a context, and the sets that they are.

use std::f64::consts::TAU;

use searoom_geometry::frame::{Geographic, KNOT_MPS, deg_from_radians};
use serde_json::Value;

use super::{Group, Leaf, Path, mmsi_of};
use crate::ais;
use crate::counts::{Counts, Dropped};
use crate::fields::{course_set, heading_set, hull, is_length, place, speed_set, turn_rate};
use crate::report::{
    Fix, HullSet, Identity, Interval, Kind, Name, Note, Notes, Status, VelocitySet,
};
use crate::settings::Settings;

/// Radians of a full circle, slightly less: a course or heading of 360° is AIS's code for "unknown".
const CIRCLE: f64 = TAU - 1e-4;

/// Fastest ship, m/s: more are AIS's codes 102.2 and 102.3 kn.
const FASTEST_MPS: f64 = 52.5;

/// A value and its time, seconds of Unix time. `None` where it was sent as unknown.
type Timed = Option<(f64, Option<f64>)>;

/// The last values of a context.
#[derive(Debug, Clone, Default)]
pub(super) struct Known {
    course: Timed,
    speed: Timed,
    heading: Timed,
    turn_rate: Timed,
    length: Option<f64>,
    beam: Option<f64>,
    from_bow: Option<f64>,
    from_center: Option<f64>,
    kind: Option<Kind>,
    is_virtual: bool,
    is_off: bool,
    pub mmsi: Option<u32>,
    /// Number of the update in which it was heard last.
    pub heard: u64,
}

/// What an update says that is not kept.
#[derive(Debug, Default)]
pub(super) struct Update {
    position: Option<Option<(f64, f64)>>,
    pub status: Option<Status>,
    pub name: Option<Name>,
    pub call_sign: Option<Name>,
    pub type_code: Option<u8>,
    pub has_motion: bool,
    pub has_size: bool,
    pub is_used: bool,
}

impl Known {
    pub fn read(&mut self, leaf: &Leaf, at: f64, update: &mut Update, counts: &mut Counts) {
        let Leaf { path, value, .. } = leaf;
        let mut number = |value: &Value| {
            let number = value.as_f64().filter(|number| number.is_finite());
            if number.is_none() && !value.is_null() {
                counts.drop(Dropped::Value);
            }
            number
        };
        let text = || value.as_str();
        match path {
            Path::Position => {
                let part = |key: &str| value.get(key).unwrap_or(&Value::Null);
                let (lat, lon) = (number(part("latitude")), number(part("longitude")));
                update.position = Some(lat.zip(lon));
            }
            Path::Course => self.course = Some((at, number(value).filter(is_angle))),
            Path::Heading => self.heading = Some((at, number(value).filter(is_angle))),
            Path::Speed => self.speed = Some((at, number(value).filter(is_speed))),
            Path::TurnRate => self.turn_rate = Some((at, number(value))),
            Path::State => update.status = text().and_then(status),
            Path::Length => {
                let overall = value.get("overall").unwrap_or(value);
                self.length = number(overall).filter(is_length);
            }
            Path::Beam => self.beam = number(value).filter(is_length),
            Path::FromBow => self.from_bow = number(value).filter(is_length),
            Path::FromCenter => self.from_center = number(value),
            Path::Class => {
                self.kind = text().and_then(|class| match class {
                    "A" => Some(Kind::ClassA),
                    "B" => Some(Kind::ClassB),
                    "BASE" => Some(Kind::BaseStation),
                    "ATON" => Some(Kind::Mark),
                    _ => None,
                });
            }
            Path::Type => {
                let id = number(value.get("id").unwrap_or(value));
                let is_code = |id: &f64| id.fract() == 0.0 && (0.0..256.0).contains(id);
                update.type_code = id.filter(is_code).map(|id| id as u8);
            }
            Path::Name => update.name = text().and_then(Name::of),
            Path::CallSign => update.call_sign = text().and_then(Name::of),
            Path::Mmsi => {
                let number = value.as_u64().map(|mmsi| mmsi.to_string());
                self.mmsi = text().or(number.as_deref()).and_then(mmsi_of);
            }
            Path::Virtual => self.is_virtual = *value == &Value::Bool(true),
            Path::OffPosition => self.is_off = *value == &Value::Bool(true),
            Path::Magnetic => counts.drop(Dropped::Magnetic),
            // read before the others
            Path::Time => {}
        }
        update.has_motion |= matches!(
            path,
            Path::Position | Path::Course | Path::Speed | Path::Heading | Path::TurnRate
        );
        update.has_size |= matches!(
            path,
            Path::Length | Path::Beam | Path::FromBow | Path::FromCenter
        );
        update.is_used |= !matches!(path, Path::Magnetic | Path::Time);
    }

    pub fn kind(&self, group: Group, identity: Identity) -> Kind {
        let prefix = match identity {
            Identity::Mmsi(mmsi) => mmsi / 1_000_000,
            _ => 0,
        };
        match (group, prefix, self.kind) {
            (_, 970 | 972 | 974, _) | (Group::Distress, ..) => Kind::Distress,
            (_, 980..=989, _) => Kind::Craft,
            (_, _, Some(Kind::BaseStation)) => Kind::BaseStation,
            (Group::Marks, ..) if self.is_virtual => Kind::VirtualMark,
            (Group::Marks, ..) | (_, _, Some(Kind::Mark)) => Kind::Mark,
            (Group::Aircraft, ..) => Kind::Aircraft,
            (_, _, Some(kind)) => kind,
            (_, 990..=999, None) => Kind::Mark,
            (_, _, None) => Kind::Ship,
        }
    }

    pub fn fix(&self, update: &Update, at: f64, settings: &Settings, notes: &mut Notes) -> Fix {
        let mut oldest = at;
        let mut joined = |value: Timed| {
            let (time, value) = value?;
            let value = value.filter(|_| (at - time).abs() <= settings.join_s)?;
            oldest = oldest.min(time);
            Some(value)
        };
        let course = joined(self.course).map(deg_from_radians);
        let speed = joined(self.speed).map(|speed| speed / KNOT_MPS);
        let heading = joined(self.heading).map(deg_from_radians);
        let turn = joined(self.turn_rate);
        let position = update.position.and_then(|position| {
            let Some((lat, lon)) = position else {
                notes.add(Note::NoPosition);
                return None;
            };
            let step = position_step_deg(lat, lon);
            place(
                Geographic::new(lat, lon),
                0.5 * step,
                settings.inaccurate_m,
                notes,
            )
        });
        let speed = match (speed, course, heading) {
            (Some(0.0), Some(0.0), None) => {
                notes.add(Note::ZerosForUnknown);
                Interval::new(0.0, f64::INFINITY)
            }
            _ => speed_set(speed, 0.5 * speed.map_or(0.1, step), notes),
        };
        let course = course.map(|degrees| (degrees, 0.5 * step(degrees)));
        let course = course_set(course, speed, settings, notes);
        let velocity = VelocitySet { speed, course };
        let heading = heading.map(|degrees| (degrees, 0.5));
        let heading = heading_set(heading, velocity, settings, notes);
        Fix {
            time: Interval::new(oldest - settings.delay_s, at),
            position,
            velocity,
            heading,
            turn_rate: turn.and_then(turn_set),
        }
    }

    /// The fix of a mark, which rests unless it is off its position or sends a speed.
    pub fn resting(&self, fix: Fix, notes: &mut Notes) -> Fix {
        let velocity = match (self.is_off, self.speed) {
            (true, _) => {
                notes.add(Note::OffPosition);
                VelocitySet::UNKNOWN
            }
            (false, Some(_)) => fix.velocity,
            (false, None) => VelocitySet {
                speed: Interval::new(0.0, 0.0),
                ..VelocitySet::UNKNOWN
            },
        };
        Fix { velocity, ..fix }
    }

    pub fn hull(&self, kind: Kind, settings: &Settings, notes: &mut Notes) -> HullSet {
        let bounds = match kind {
            Kind::ClassB | Kind::Craft => settings.class_b_m,
            _ => settings.class_a_m,
        };
        if kind == Kind::Craft {
            // many decoders read the mother ship's number as a size
            notes.add(Note::NoSize);
            return HullSet::unknown(bounds[0], bounds[1]);
        }
        let (length, beam) = (self.length.unwrap_or(0.0), self.beam.unwrap_or(0.0));
        let center = self
            .from_center
            .map(f64::abs)
            .filter(|center| *center <= 0.5 * beam + 0.01);
        let bow = self.from_bow.filter(|bow| *bow <= length);
        let (bow, port, starboard) = match (bow, center) {
            // whether port is negative is not sure
            (Some(bow), Some(center)) => {
                let narrow = 0.5 * beam - center;
                (
                    bow,
                    if narrow < 0.02 { 0.0 } else { narrow },
                    0.5 * beam + center,
                )
            }
            (Some(bow), None) => (bow, 0.0, beam),
            (None, _) => (0.0, 0.0, beam),
        };
        let mut hull = hull(
            [bow, length - bow, port, starboard],
            bounds,
            settings,
            notes,
        );
        if hull.port != hull.starboard {
            notes.add(match center {
                Some(_) => Note::Sides,
                None => Note::NoAntenna,
            });
            let [a, b] = [hull.port, hull.starboard];
            let least = match center {
                Some(_) => a.least.min(b.least),
                None => 0.0,
            };
            let either = Interval::new(least, a.most.max(b.most));
            (hull.port, hull.starboard) = (either, either);
        }
        hull
    }
}

fn is_angle(angle: &f64) -> bool {
    (0.0..CIRCLE).contains(angle)
}

/// True for a speed of a ship. 63 kn is what some readers make of the long-range message's "unknown".
fn is_speed(speed: &f64) -> bool {
    (0.0..=FASTEST_MPS).contains(speed) && (speed / KNOT_MPS - 63.0).abs() > 0.01
}

/// Step of a number of knots or degrees: a whole number may be of the long-range message.
fn step(number: f64) -> f64 {
    match (number - number.round()).abs() < 0.002 {
        true => 1.0,
        false => 0.1,
    }
}

/// Step of a position in degrees, which may be of the long-range message: tenths of a minute.
fn position_step_deg(lat: f64, lon: f64) -> f64 {
    let is_coarse = |degrees: f64| (600.0 * degrees - (600.0 * degrees).round()).abs() < 1e-4;
    match is_coarse(lat) && is_coarse(lon) {
        true => 1.0 / 600.0,
        false => 1.0 / 600_000.0,
    }
}

/// Rate of turn in rad/s, starboard positive, as AIS's steps. 720 °/min is the code for a turn at an
/// unknown rate, and more is none.
fn turn_set(rate: f64) -> Option<Interval> {
    let per_minute = 60.0 * deg_from_radians(rate);
    let root = 4.733 * per_minute.abs().sqrt();
    (root < 127.5).then(|| turn_rate(root.copysign(rate)))
}

fn status(state: &str) -> Option<Status> {
    let code = match state {
        "motoring" => 0,
        "anchored" => 1,
        "not under command" => 2,
        "constrained by draft" => 4,
        "moored" => 5,
        "aground" => 6,
        "sailing" => 8,
        "towing < 200m" | "towing > 200m" => 11,
        "pushing" => 12,
        "ais-sart" => 14,
        // the schema spells it so
        state if state.starts_with("restricted man") => 3,
        state if state.starts_with("fishing") || state.starts_with("trawling") => 7,
        _ => return None,
    };
    ais::status(code, 0)
}
