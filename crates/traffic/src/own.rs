//! Own ship's sentences, and what is remembered of them for its radar targets.
//!
//! A report says what its sentence says. What a sentence does not carry is unknown in its report: HDT has a
//! fix without a position, which is no ship without a place.

use std::f64::consts::PI;

use searoom_geometry::frame::Geographic;

use crate::counts::Dropped;
use crate::fields::{about, course_set, place, speed_set};
use crate::report::{
    Directions, Fix, Identity, Interval, Kind, Note, Notes, PositionSet, Report, SourceId,
    VelocitySet,
};
use crate::sentence::Fields;
use crate::settings::Settings;
use crate::time;

/// Greatest age of what a sentence without a time says, and of a fix when it arrives, seconds.
const LATENCY_S: f64 = 1.0;

/// Metres of error for each unit of a horizontal dilution of precision: twice a user's range error of 5 m.
const DILUTED_M: f64 = 10.0;

/// How a position was found, from the letter or the number that a sentence has for it.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Quality {
    None,
    Autonomous,
    /// Corrected by stations or satellites.
    Corrected,
    /// Reckoned or typed in.
    NotMeasured,
    Simulated,
}

impl Quality {
    /// Mode of RMC, GLL and VTG. Sentences before version 2.3 have none.
    fn of_mode(mode: Option<u8>) -> Self {
        match mode {
            None | Some(b'A') => Self::Autonomous,
            Some(b'D' | b'F' | b'P' | b'R') => Self::Corrected,
            Some(b'E' | b'M') => Self::NotMeasured,
            Some(b'S') => Self::Simulated,
            Some(_) => Self::None,
        }
    }

    /// The best of GNS's modes, one for each system of satellites.
    fn of_modes(modes: &[u8]) -> Self {
        let has = |letters: &[u8]| modes.iter().any(|mode| letters.contains(mode));
        match () {
            () if has(b"S") => Self::Simulated,
            () if has(b"DFPR") => Self::Corrected,
            () if has(b"A") => Self::Autonomous,
            () if has(b"EM") => Self::NotMeasured,
            () => Self::None,
        }
    }

    /// GGA's number.
    fn of_number(number: Option<f64>) -> Self {
        match number {
            Some(1.0) => Self::Autonomous,
            Some(2.0 | 3.0 | 4.0 | 5.0 | 9.0) => Self::Corrected,
            Some(6.0 | 7.0) => Self::NotMeasured,
            Some(8.0) => Self::Simulated,
            _ => Self::None,
        }
    }
}

/// When a sentence was received, and from where.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Reception {
    pub received: f64,
    pub source: Option<SourceId>,
}

/// The report of one of own ship's sentences; `None` for another sentence.
pub(crate) fn report(
    formatter: &[u8; 3],
    fields: &Fields,
    reception: Reception,
    settings: &Settings,
) -> Option<Result<Report, Dropped>> {
    let read = Reading {
        fields,
        reception,
        settings,
    };
    let mut notes = Notes::default();
    let fix = match formatter {
        b"RMC" => read.rmc(&mut notes),
        b"GGA" => read.gga(&mut notes),
        b"GNS" => read.gns(&mut notes),
        b"GLL" => read.gll(&mut notes),
        b"VTG" => read.vtg(&mut notes),
        b"HDT" => read.hdt(),
        b"THS" => read.ths(&mut notes),
        b"HDG" | b"HDM" => Err(Dropped::Magnetic),
        _ => return None,
    };
    let Reception { received, source } = reception;
    Some(fix.map(|fix| Report {
        is_own: true,
        fix: Some(fix),
        notes,
        ..Report::new(received, source, Identity::Own, Kind::Ship)
    }))
}

struct Reading<'l> {
    fields: &'l Fields<'l>,
    reception: Reception,
    settings: &'l Settings,
}

impl Reading<'_> {
    /// A fix of which nothing is known, at a time of the day.
    fn fix(&self, of_day: usize, notes: &mut Notes) -> Result<Fix, Dropped> {
        let received = self.reception.received;
        let text = self.fields.text(of_day);
        let time = match text.is_empty() {
            true => {
                notes.add(Note::AgeUnknown);
                self.now()
            }
            false => {
                let of_day = time::of_day(text).ok_or(Dropped::Fields)?;
                let at = time::nearest_day(of_day, received);
                Interval::new(at, at)
            }
        };
        Ok(Fix {
            time,
            position: None,
            velocity: VelocitySet::UNKNOWN,
            heading: Directions::ALL,
            turn_rate: None,
        })
    }

    fn now(&self) -> Interval {
        let received = self.reception.received;
        Interval::new(received - LATENCY_S, received)
    }

    /// Position from four fields, in degrees and minutes with a letter each.
    fn position(
        &self,
        from: usize,
        quality: Quality,
        dilution: Option<f64>,
        notes: &mut Notes,
    ) -> Result<Option<PositionSet>, Dropped> {
        let settings = self.settings;
        let radius = match quality {
            Quality::Corrected => settings.accurate_m,
            Quality::Autonomous => settings.inaccurate_m,
            Quality::NotMeasured => {
                notes.add(Note::NotMeasured);
                settings.not_measured_m
            }
            Quality::Simulated => {
                notes.add(Note::Simulated);
                return Ok(None);
            }
            Quality::None => {
                notes.add(Note::NoPosition);
                return Ok(None);
            }
        };
        let radius = radius.max(DILUTED_M * dilution.unwrap_or(0.0));
        position(self.fields, from, radius, notes)
    }

    /// Course and speed, from fields with the degrees and the knots.
    fn velocity(
        &self,
        quality: Quality,
        knots: Option<(f64, f64)>,
        course: Option<(f64, f64)>,
        notes: &mut Notes,
    ) -> VelocitySet {
        // a reckoned velocity may be one through the water
        let is_measured = matches!(quality, Quality::Autonomous | Quality::Corrected);
        let (knots, course) = if is_measured {
            (knots, course)
        } else {
            (None, None)
        };
        let half_step = knots.map_or(0.0, |(_, half_step)| half_step);
        let speed = speed_set(knots.map(|(knots, _)| knots), half_step, notes);
        VelocitySet {
            speed,
            course: course_set(course, speed, self.settings, notes),
        }
    }

    fn rmc(&self, notes: &mut Notes) -> Result<Fix, Dropped> {
        let fields = self.fields;
        let quality = match fields.letter(2) {
            Some(b'A') => Quality::of_mode(fields.letter(12)),
            _ => Quality::None,
        };
        let mut fix = self.fix(1, notes)?;
        if !fields.text(1).is_empty() && !fields.text(9).is_empty() {
            let midnight = time::of_short_date(fields.text(9)).ok_or(Dropped::Fields)?;
            let at = midnight + time::of_day(fields.text(1)).ok_or(Dropped::Fields)?;
            fix.time = Interval::new(at, at);
        }
        fix.position = self.position(3, quality, None, notes)?;
        fix.velocity = self.velocity(quality, fields.step(7)?, fields.step(8)?, notes);
        Ok(fix)
    }

    fn gga(&self, notes: &mut Notes) -> Result<Fix, Dropped> {
        let mut fix = self.fix(1, notes)?;
        let quality = Quality::of_number(self.fields.number(6)?);
        fix.position = self.position(2, quality, self.fields.number(8)?, notes)?;
        Ok(fix)
    }

    fn gns(&self, notes: &mut Notes) -> Result<Fix, Dropped> {
        let mut fix = self.fix(1, notes)?;
        let quality = Quality::of_modes(self.fields.bytes(6));
        fix.position = self.position(2, quality, self.fields.number(8)?, notes)?;
        Ok(fix)
    }

    fn gll(&self, notes: &mut Notes) -> Result<Fix, Dropped> {
        let mut fix = self.fix(5, notes)?;
        // the oldest form ends with the position
        let quality = match self.fields.letter(6) {
            Some(b'A') => Quality::of_mode(self.fields.letter(7)),
            None if self.fields.len() <= 5 => Quality::Autonomous,
            _ => Quality::None,
        };
        fix.position = self.position(1, quality, None, notes)?;
        Ok(fix)
    }

    fn vtg(&self, notes: &mut Notes) -> Result<Fix, Dropped> {
        let fields = self.fields;
        let is_of_letters = [(2, b'T'), (6, b'N'), (8, b'K')]
            .into_iter()
            .all(|(field, letter)| fields.letter(field).is_none_or(|found| found == letter));
        if !is_of_letters {
            return Err(Dropped::Fields);
        }
        let kilometres = fields.step(7)?;
        const KNOTS: f64 = 1.0 / 1.852;
        let kilometres = kilometres.map(|(speed, half)| (speed * KNOTS, half * KNOTS));
        let quality = Quality::of_mode(fields.letter(9));
        let knots = fields.step(5)?.or(kilometres);
        Ok(Fix {
            time: self.now(),
            position: None,
            velocity: self.velocity(quality, knots, fields.step(1)?, notes),
            heading: Directions::ALL,
            turn_rate: None,
        })
    }

    /// A fix that has a heading alone.
    fn heading(&self, error: f64) -> Result<Fix, Dropped> {
        let (degrees, half_step) = self.fields.step(1)?.ok_or(Dropped::Fields)?;
        if !(0.0..=360.0).contains(&degrees) {
            return Err(Dropped::Fields);
        }
        Ok(Fix {
            time: self.now(),
            position: None,
            velocity: VelocitySet::UNKNOWN,
            heading: about(degrees, half_step, error),
            turn_rate: None,
        })
    }

    fn hdt(&self) -> Result<Fix, Dropped> {
        match self.fields.letter(2) {
            Some(b'T') => self.heading(self.settings.heading_error),
            _ => Err(Dropped::Fields),
        }
    }

    fn ths(&self, notes: &mut Notes) -> Result<Fix, Dropped> {
        let error = self.settings.heading_error;
        match self.fields.letter(2) {
            Some(b'A') => self.heading(error),
            Some(b'E' | b'M') => {
                notes.add(Note::HeadingNotMeasured);
                self.heading(error + self.settings.heading_from_course)
            }
            mode => {
                notes.add(match mode {
                    Some(b'S') => Note::Simulated,
                    _ => Note::NoHeading,
                });
                Ok(Fix {
                    time: self.now(),
                    position: None,
                    velocity: VelocitySet::UNKNOWN,
                    heading: Directions::ALL,
                    turn_rate: None,
                })
            }
        }
    }
}

/// Position from `ddmm.mm,N,dddmm.mm,E`; none where a number is missing.
pub(crate) fn position(
    fields: &Fields,
    from: usize,
    radius_m: f64,
    notes: &mut Notes,
) -> Result<Option<PositionSet>, Dropped> {
    let angle = |field: usize, positive: u8, negative: u8| {
        let Some((number, half_step)) = fields.step(field)? else {
            return Ok(None);
        };
        let degrees = (0.01 * number).floor();
        let minutes = number - 100.0 * degrees;
        let sign = match fields.letter(field + 1) {
            Some(letter) if letter == positive => 1.0,
            Some(letter) if letter == negative => -1.0,
            _ => return Err(Dropped::Fields),
        };
        if !(number >= 0.0 && minutes < 60.0) {
            return Err(Dropped::Fields);
        }
        Ok(Some((sign * (degrees + minutes / 60.0), half_step / 60.0)))
    };
    let (lat, lon) = (angle(from, b'N', b'S')?, angle(from + 2, b'E', b'W')?);
    let Some(((lat, half_lat), (lon, half_lon))) = lat.zip(lon) else {
        notes.add(Note::NoPosition);
        return Ok(None);
    };
    Ok(place(
        Geographic::new(lat, lon),
        half_lat.max(half_lon),
        radius_m,
        notes,
    ))
}

/// The newest position, velocity and heading of own ship, each with the time of its reception.
#[derive(Debug, Default)]
pub(crate) struct Own {
    position: Option<(f64, PositionSet)>,
    velocity: Option<(f64, VelocitySet)>,
    heading: Option<(f64, Directions)>,
}

/// What is no older than a limit, and its age in seconds. A clock that was set back makes nothing young.
fn young<T: Copy>(known: &Option<(f64, T)>, at: f64, limit: f64) -> Option<(T, f64)> {
    let (received, value) = (*known)?;
    let age = (at - received).abs();
    (age <= limit).then_some((value, age))
}

impl Own {
    /// Remembers what own ship says of itself.
    pub fn keep(&mut self, report: &Report) {
        let Some(fix) = report.fix.filter(|_| report.is_own) else {
            return;
        };
        if let Some(set) = fix.position {
            self.position = Some((report.received, set));
        }
        if fix.velocity.speed.most.is_finite() {
            self.velocity = Some((report.received, fix.velocity));
        }
        if fix.heading.half < PI && !report.notes.has(Note::HeadingFromCourse) {
            self.heading = Some((report.received, fix.heading));
        }
    }

    /// Where own ship is at a time: its last position, wider by what it may have sailed since.
    pub fn position(&self, at: f64, settings: &Settings) -> Option<PositionSet> {
        let (set, age) = young(&self.position, at, settings.own_position_s)?;
        let velocity = self.velocity(at, settings);
        let fastest = velocity.map_or(settings.own_speed_mps, |velocity| velocity.speed.most);
        Some(PositionSet {
            radius_m: set.radius_m + fastest * (age + LATENCY_S),
            ..set
        })
    }

    pub fn velocity(&self, at: f64, settings: &Settings) -> Option<VelocitySet> {
        young(&self.velocity, at, settings.own_position_s).map(|(velocity, _)| velocity)
    }

    /// Where own ship heads at a time: its last heading, wider by what it may have turned since.
    pub fn heading(&self, at: f64, settings: &Settings) -> Option<Directions> {
        let (heading, age) = young(&self.heading, at, settings.own_heading_s)?;
        Some(Directions {
            half: (heading.half + settings.own_turn_rate * age).min(PI),
            ..heading
        })
    }
}
