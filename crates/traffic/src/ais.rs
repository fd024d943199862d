//! What the fields of a message mean (Recommendation ITU-R M.1371-5, annex 8), as sets.
//!
//! Each code that stands for "unknown" or for "or more" widens a set here, with a [`Note`]. The table is in
//! docs/reference/traffic.md.

use searoom_geometry::frame::{Geographic, KNOT_MPS};

use crate::assembly::Message;
use crate::bits::Bits;
use crate::counts::Dropped;
use crate::fields::{
    about, contradiction, course_set, hull, place, steps, turn_rate, without_heading,
};
use crate::report::{
    Directions, Fix, HullSet, Identity, Interval, Kind, Name, Note, Notes, PositionSet, Report,
    Status, VelocitySet,
};
use crate::settings::Settings;

/// How far the clock of a station may be behind, seconds.
const CLOCK_S: f64 = 2.0;

/// Where the fields of a message with a position are, and how they are scaled.
struct Layout {
    /// First bits of speed, accuracy, position, course and heading, and of the time stamp.
    speed: usize,
    accuracy: usize,
    longitude: usize,
    course: usize,
    heading: Option<usize>,
    second: usize,
    /// Knots of a step of the speed.
    speed_step: f64,
}

/// Of classes A and B, and of an aircraft, which counts in whole knots.
const CLASS_A: Layout = Layout {
    speed: 50,
    accuracy: 60,
    longitude: 61,
    course: 116,
    heading: Some(128),
    second: 137,
    speed_step: 0.1,
};
const CLASS_B: Layout = Layout {
    speed: 46,
    accuracy: 56,
    longitude: 57,
    course: 112,
    heading: Some(124),
    second: 133,
    speed_step: 0.1,
};
const AIRCRAFT: Layout = Layout {
    speed: 50,
    heading: None,
    second: 128,
    speed_step: 1.0,
    ..CLASS_A
};

/// Report of a whole message, and why there is none.
pub(crate) fn report(message: &Message, settings: &Settings) -> Result<Report, Dropped> {
    let bits = &message.bits;
    let number = bits.unsigned(0, 6);
    let least = match number {
        1..=3 | 4 | 11 | 9 | 18 => 144,
        5 => 302,
        19 => 301,
        21 => 270,
        24 => 160,
        27 => 95,
        _ => return Err(Dropped::OtherMessage),
    };
    if bits.len < least {
        return Err(Dropped::TooShort);
    }
    let mmsi = bits.unsigned(8, 30);
    let identity = Identity::Mmsi(mmsi);
    let kind = kind(number, mmsi);
    let mut report = Report::new(message.received, message.source, identity, kind);
    report.is_own = message.is_own;
    let read = Reading {
        bits,
        settings,
        received: message.received,
    };
    let notes = &mut report.notes;
    match number {
        1..=3 => {
            let mut fix = read.moving(&CLASS_A, notes);
            fix.turn_rate = read.turn_rate(42);
            report.status = status(bits.unsigned(38, 4), mmsi);
            contradiction(report.status, &fix, notes);
            if bits.flag(148) {
                notes.add(Note::Raim);
            }
            report.fix = Some(fix);
        }
        4 | 11 => report.fix = Some(read.station(notes)),
        5 => {
            report.hull = Some(read.hull(240, settings.class_a_m, notes));
            report.call_sign = name(bits, 70, 7);
            report.name = name(bits, 112, 20);
            report.type_code = Some(bits.unsigned(232, 8) as u8);
            if bits.len < 422 {
                notes.add(Note::Short);
            }
        }
        9 => report.fix = Some(read.moving(&AIRCRAFT, notes)),
        18 => report.fix = Some(read.moving(&CLASS_B, notes)),
        19 => {
            report.fix = Some(read.moving(&CLASS_B, notes));
            report.name = name(bits, 143, 20);
            report.type_code = Some(bits.unsigned(263, 8) as u8);
            report.hull = Some(read.hull(271, settings.class_b_m, notes));
        }
        21 => {
            report.fix = Some(read.mark(notes));
            report.name = name(bits, 43, 20);
            report.type_code = Some(bits.unsigned(38, 5) as u8);
            // a mark may be a platform
            report.hull = Some(read.hull(219, settings.class_a_m, notes));
            if bits.flag(269) {
                report.kind = Kind::VirtualMark;
            }
            // without a second the flag means nothing
            if bits.flag(259) && bits.unsigned(253, 6) < 60 {
                notes.add(Note::OffPosition);
                let adrift = |fix: Fix| Fix {
                    velocity: VelocitySet::UNKNOWN,
                    ..fix
                };
                report.fix = report.fix.map(adrift);
            }
        }
        24 => match bits.unsigned(38, 2) {
            0 => report.name = name(bits, 40, 20),
            1 if bits.len < 162 => return Err(Dropped::TooShort),
            1 => {
                report.type_code = Some(bits.unsigned(40, 8) as u8);
                report.call_sign = name(bits, 90, 7);
                // the bits of the size are the number of the mother ship
                if report.kind == Kind::Craft {
                    let mother_ship = bits.unsigned(132, 30);
                    report.mother_ship = (mother_ship > 0).then_some(Identity::Mmsi(mother_ship));
                    notes.add(Note::NoSize);
                    let [length, beam] = settings.class_b_m;
                    report.hull = Some(HullSet::unknown(length, beam));
                } else {
                    report.hull = Some(read.hull(132, settings.class_b_m, notes));
                }
            }
            _ => return Err(Dropped::OtherMessage),
        },
        _ => {
            let fix = read.long_range(notes);
            report.status = status(bits.unsigned(40, 4), mmsi);
            contradiction(report.status, &fix, notes);
            report.fix = Some(fix);
        }
    }
    Ok(report)
}

/// What sent a message. Default numbers begin with zeros, so a number makes no station of what sends a ship's
/// position, and none an aircraft: neither would be a target.
fn kind(number: u32, mmsi: u32) -> Kind {
    match (number, mmsi / 1_000_000) {
        (_, 970 | 972 | 974) => Kind::Distress,
        (4, _) => Kind::BaseStation,
        (9, _) | (5 | 24, 111) => Kind::Aircraft,
        (21, _) | (_, 990..=999) => Kind::Mark,
        (_, 980..=989) => Kind::Craft,
        (1..=3 | 5 | 11, _) => Kind::ClassA,
        (27, _) => Kind::Ship,
        _ => Kind::ClassB,
    }
}

pub(crate) fn status(code: u32, mmsi: u32) -> Option<Status> {
    let is_distress = matches!(mmsi / 1_000_000, 970 | 972 | 974);
    Some(match code {
        0 => Status::UnderWay,
        1 => Status::Anchored,
        2 => Status::NotUnderCommand,
        3 => Status::Restricted,
        4 => Status::ConstrainedByDraught,
        5 => Status::Moored,
        6 => Status::Aground,
        7 => Status::Fishing,
        8 => Status::Sailing,
        11 => Status::TowingAstern,
        12 => Status::Pushing,
        14 => Status::Distress,
        15 if is_distress => Status::DistressTest,
        _ => return None,
    })
}

/// The fields of one message.
struct Reading<'m> {
    bits: &'m Bits,
    settings: &'m Settings,
    received: f64,
}

impl Reading<'_> {
    /// Position and motion of classes A and B and of aircraft.
    fn moving(&self, layout: &Layout, notes: &mut Notes) -> Fix {
        let bits = self.bits;
        let (time, is_measured) = self.time(layout.second, notes);
        let position = self.position(layout.longitude, layout.accuracy, is_measured, notes);
        let speed_code = bits.unsigned(layout.speed, 10);
        let course_code = bits.unsigned(layout.course, 12);
        let heading_code = layout.heading.map(|from| bits.unsigned(from, 9));
        let speed = match speed_code {
            // an encoder that knows nothing sends zeros
            0 if course_code == 0 && heading_code == Some(511) => {
                notes.add(Note::ZerosForUnknown);
                Interval::new(0.0, f64::INFINITY)
            }
            1023 => {
                notes.add(Note::NoSpeed);
                Interval::new(0.0, f64::INFINITY)
            }
            1022 => {
                notes.add(Note::SpeedOrMore);
                Interval::new(1021.5 * layout.speed_step * KNOT_MPS, f64::INFINITY)
            }
            code => steps(f64::from(code), layout.speed_step * KNOT_MPS),
        };
        let course = (course_code < 3600).then(|| (0.1 * f64::from(course_code), 0.05));
        let course = course_set(course, speed, self.settings, notes);
        let heading = match heading_code {
            Some(code @ ..360) => about(f64::from(code), 0.5, self.settings.heading_error),
            _ => without_heading(speed, course, self.settings, notes),
        };
        Fix {
            time,
            position,
            velocity: VelocitySet { speed, course },
            heading,
            turn_rate: None,
        }
    }

    /// A station, or a ship that answers with its place: no motion.
    fn station(&self, notes: &mut Notes) -> Fix {
        let (time, is_measured) = self.time(72, notes);
        Fix {
            time,
            position: self.position(79, 78, is_measured, notes),
            velocity: VelocitySet::UNKNOWN,
            heading: Directions::ALL,
            turn_rate: None,
        }
    }

    /// A mark rests.
    fn mark(&self, notes: &mut Notes) -> Fix {
        let (time, is_measured) = self.time(253, notes);
        Fix {
            time,
            position: self.position(164, 163, is_measured, notes),
            velocity: VelocitySet {
                speed: Interval::new(0.0, 0.0),
                course: Directions::ALL,
            },
            heading: Directions::ALL,
            turn_rate: None,
        }
    }

    /// The message for satellites: tenths of a minute, whole knots and degrees.
    fn long_range(&self, notes: &mut Notes) -> Fix {
        let bits = self.bits;
        // sent without a time stamp
        let age = match bits.flag(94) {
            true => {
                notes.add(Note::Latent);
                self.settings.latent_s
            }
            false => 5.0,
        };
        let (longitude, latitude) = (bits.signed(44, 18), bits.signed(62, 17));
        let position = place(
            Geographic::new(f64::from(latitude) / 600.0, f64::from(longitude) / 600.0),
            0.5 / 600.0,
            self.radius(bits.flag(38), true),
            notes,
        );
        let (speed_code, course_code) = (bits.unsigned(79, 6), bits.unsigned(85, 9));
        let speed = match speed_code {
            63 => {
                notes.add(Note::NoSpeed);
                Interval::new(0.0, f64::INFINITY)
            }
            code => steps(f64::from(code), KNOT_MPS),
        };
        let course = (course_code < 360).then(|| (f64::from(course_code), 0.5));
        let course = course_set(course, speed, self.settings, notes);
        Fix {
            time: Interval::new(self.received - age, self.received),
            position,
            velocity: VelocitySet { speed, course },
            heading: without_heading(speed, course, self.settings, notes),
            turn_rate: None,
        }
    }

    /// When the fix was taken, and whether it was measured: in the minute that is nearest to the reception,
    /// or in the one before where that is in the future.
    fn time(&self, from: usize, notes: &mut Notes) -> (Interval, bool) {
        let second = self.bits.unsigned(from, 6);
        if second < 60 {
            let since = (self.received - f64::from(second)).rem_euclid(60.0);
            let at = self.received - since;
            let ahead = 60.0 - since;
            return (
                match since {
                    ..=30.0 => Interval::new(at, at + 1.0),
                    _ if ahead <= CLOCK_S => Interval::new(at + 60.0, at + 61.0),
                    // a late report, or a clock that is wrong
                    _ => {
                        notes.add(Note::AgeUnknown);
                        Interval::new(at, at + 61.0)
                    }
                },
                true,
            );
        }
        let [class_a, class_b] = self.settings.interval_s;
        let age = match self.bits.unsigned(0, 6) {
            18 | 19 => class_b,
            _ => class_a,
        };
        let is_measured = second == 60;
        notes.add(match is_measured {
            true => Note::AgeUnknown,
            false => Note::NotMeasured,
        });
        (
            Interval::new(self.received - age, self.received),
            is_measured,
        )
    }

    fn radius(&self, is_accurate: bool, is_measured: bool) -> f64 {
        match (is_measured, is_accurate) {
            (false, _) => self.settings.not_measured_m,
            (true, true) => self.settings.accurate_m,
            (true, false) => self.settings.inaccurate_m,
        }
    }

    /// A position in ten thousandths of a minute.
    fn position(
        &self,
        from: usize,
        accuracy: usize,
        is_measured: bool,
        notes: &mut Notes,
    ) -> Option<PositionSet> {
        let bits = self.bits;
        let (longitude, latitude) = (bits.signed(from, 28), bits.signed(from + 28, 27));
        const PARTS: f64 = 600_000.0;
        let at = Geographic::new(f64::from(latitude) / PARTS, f64::from(longitude) / PARTS);
        let radius = self.radius(bits.flag(accuracy), is_measured);
        place(at, 0.5 / PARTS, radius, notes)
    }

    /// Rate of turn from its root in 4.733 degrees a minute, starboard positive.
    fn turn_rate(&self, from: usize) -> Option<Interval> {
        let code = self.bits.signed(from, 8);
        (code != -128).then(|| turn_rate(f64::from(code)))
    }

    /// Distances from the antenna to bow, stern, port and starboard side.
    fn hull(&self, from: usize, bounds: [f64; 2], notes: &mut Notes) -> HullSet {
        let metres = |from: usize, bits: usize| f64::from(self.bits.unsigned(from, bits));
        let [bow, stern] = [metres(from, 9), metres(from + 9, 9)];
        let [port, starboard] = [metres(from + 18, 6), metres(from + 24, 6)];
        hull([bow, stern, port, starboard], bounds, self.settings, notes)
    }
}

/// Text of six-bit characters without what follows `@`, and without blanks at its end.
fn name(bits: &Bits, from: usize, most: usize) -> Option<Name> {
    let mut name = Name {
        letters: [0; 20],
        length: 0,
    };
    for index in 0..most {
        let code = bits.unsigned(from + 6 * index, 6) as u8;
        if code == 0 || from + 6 * (index + 1) > bits.len {
            break;
        }
        name.letters[index] = if code < 32 { code + 64 } else { code };
        name.length = index as u8 + 1;
    }
    while name.length > 0 && name.letters[usize::from(name.length) - 1] == b' ' {
        name.length -= 1;
    }
    (name.length > 0).then_some(name)
}
