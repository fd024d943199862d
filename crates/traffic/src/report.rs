//! What a report says, as sets.

use std::f64::consts::PI;
use std::fmt;

use searoom_geometry::frame::{Geographic, Vector, direction, wrap};
use searoom_geometry::{ConvexPolygon, outer_disc};
pub use searoom_model::target::Status;

/// All numbers from `least` to `most`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Interval {
    pub least: f64,
    /// Infinite where a report gives no bound.
    pub most: f64,
}

impl Interval {
    pub const fn new(least: f64, most: f64) -> Self {
        Self { least, most }
    }

    /// A number to half a step each way.
    pub(crate) fn about(number: f64, half: f64) -> Self {
        Self::new(number - half, number + half)
    }

    /// True for a number within it. A NaN is in none.
    pub fn contains(&self, number: f64) -> bool {
        (self.least..=self.most).contains(&number)
    }
}

/// All directions within an angle of one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Directions {
    /// Radians, counter-clockwise from east.
    pub middle: f64,
    /// Radians to each side; π for all directions.
    pub half: f64,
}

impl Directions {
    pub const ALL: Self = Self {
        middle: 0.0,
        half: PI,
    };

    /// True for a heading within them, radians.
    pub fn contains(&self, heading: f64) -> bool {
        self.half >= PI || wrap(heading - self.middle).abs() <= self.half
    }
}

/// Where the antenna is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PositionSet {
    /// The middle, WGS 84.
    pub at: Geographic,
    /// Half of the extent to east and to north, metres: the step in which a position is sent.
    pub half_cell_m: Vector,
    /// Metres beyond the cell: the accuracy of the fix.
    pub radius_m: f64,
}

impl PositionSet {
    /// Polygon around it, in metres east and north of the middle.
    pub fn outer(&self) -> ConvexPolygon {
        let cell = ConvexPolygon::rectangle(
            Vector::zeros(),
            2.0 * self.half_cell_m.x,
            2.0 * self.half_cell_m.y,
        );
        cell.minkowski_sum(&outer_disc(self.radius_m, 0.0))
    }
}

/// Every velocity over ground that a ship may have.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct VelocitySet {
    /// m/s.
    pub speed: Interval,
    pub course: Directions,
}

impl VelocitySet {
    pub const UNKNOWN: Self = Self {
        speed: Interval::new(0.0, f64::INFINITY),
        course: Directions::ALL,
    };

    /// Convex polygon around it, m/s, for a ship that is no faster than `fastest` m/s unless the report says
    /// so.
    pub fn outer(&self, fastest: f64) -> ConvexPolygon {
        let most = match self.speed.most.is_finite() {
            true => self.speed.most,
            false => fastest.max(self.speed.least),
        };
        if !(self.course.half < 0.5 * PI) {
            return outer_disc(most, 0.0);
        }
        // an arc lies inside of the tangents in its middle and at its ends; wider than rounding
        const SPARE: f64 = 1e-9;
        let (middle, half) = (self.course.middle, self.course.half + SPARE);
        let (least, most) = (self.speed.least * (1.0 - SPARE), most * (1.0 + SPARE));
        let corner = most / (0.5 * half).cos();
        let points = [
            direction(middle - half) * least,
            direction(middle + half) * least,
            direction(middle - half) * most,
            direction(middle + half) * most,
            direction(middle - 0.5 * half) * corner,
            direction(middle + 0.5 * half) * corner,
        ];
        ConvexPolygon::hull(&points).unwrap_or_else(|_| outer_disc(most, 0.0))
    }
}

/// How far the hull reaches from the antenna, metres.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HullSet {
    /// Of the hull, which is less than what it may reach to both sides where the antenna is anywhere.
    pub length: Interval,
    pub beam: Interval,
    pub ahead: Interval,
    pub astern: Interval,
    pub port: Interval,
    pub starboard: Interval,
}

impl HullSet {
    /// Nothing is known but the largest reach to each side.
    pub(crate) fn unknown(length: f64, beam: f64) -> Self {
        let (along, across) = (Interval::new(0.0, length), Interval::new(0.0, beam));
        Self::anywhere(along, across)
    }

    /// A hull whose antenna may be anywhere on it.
    pub(crate) fn anywhere(length: Interval, beam: Interval) -> Self {
        let [along, across] = [length, beam].map(|size| Interval::new(0.0, size.most));
        Self {
            length,
            beam,
            ahead: along,
            astern: along,
            port: across,
            starboard: across,
        }
    }

    /// Distance of the farthest corner from the antenna, metres.
    pub fn reach(&self) -> f64 {
        let along = self.ahead.most.max(self.astern.most);
        along.hypot(self.port.most.max(self.starboard.most))
    }
}

/// Position and motion at one time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Fix {
    /// When the fix was taken, seconds of Unix time.
    pub time: Interval,
    /// Unknown where a ship is heard without a place ([`Note::NoPosition`]), and where a message has none.
    pub position: Option<PositionSet>,
    pub velocity: VelocitySet,
    pub heading: Directions,
    /// Rate of turn, rad/s, counter-clockwise positive. Unknown where it is not sent.
    pub turn_rate: Option<Interval>,
}

/// Who sent a report.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Identity {
    /// Maritime mobile service identity. Two ships may have the same.
    Mmsi(u32),
    /// Own ship, by its own sensors.
    Own,
    /// A target of a radar by its number, which the radar uses again for others.
    Radar {
        source: Option<SourceId>,
        number: u16,
    },
    /// A ship of a Signal K server that has no other identity.
    Uuid([u8; 16]),
}

impl fmt::Display for Identity {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Mmsi(number) => write!(f, "MMSI {number:09}"),
            Self::Own => f.write_str("own ship"),
            Self::Radar { source, number } => match source {
                None => write!(f, "radar target {number}"),
                Some(source) => write!(f, "radar target {number} of source {}", source.0),
            },
            Self::Uuid(bytes) => {
                f.write_str("UUID ")?;
                bytes.iter().try_for_each(|byte| write!(f, "{byte:02x}"))
            }
        }
    }
}

searoom_geometry::words! {
    /// What sent a report.
    pub enum Kind {
        /// A ship with AIS of class A.
        ClassA => "class A",
        /// A ship with AIS of class B.
        ClassB => "class B",
        /// A ship whose class of AIS is not sent: own ship, and one of which only the long-range message is
        /// heard.
        Ship => "ship",
        /// A craft of a mother ship, 98….
        Craft => "craft",
        /// An aircraft that searches and rescues: no target of collision avoidance.
        Aircraft => "aircraft",
        /// A distress transmitter, 970, 972 or 974: it drifts.
        Distress => "distress transmitter",
        /// A station ashore.
        BaseStation => "base station",
        /// A mark in the water.
        Mark => "mark",
        /// A mark that is sent where nothing lies.
        VirtualMark => "virtual mark",
        /// An echo that own ship's radar tracks.
        Radar => "radar target",
    }
}

/// A source of sentences, by its number in a [`Reader`](crate::Reader).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct SourceId(pub(crate) u16);

/// A name or call sign of at most 20 bytes, without control characters.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Name {
    pub(crate) letters: [u8; 20],
    pub(crate) length: u8,
}

/// True for characters that have no form of their own, and change that of others.
fn is_hidden(letter: char) -> bool {
    letter.is_control()
        || matches!(
            letter,
            '\u{ad}' | '\u{61c}' | '\u{feff}' | '\u{fff9}'..='\u{fffb}'
        )
        || matches!(letter, '\u{200b}'..='\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2060}'..='\u{206f}')
        || matches!(letter, '\u{e0000}'..='\u{e007f}')
}

impl Name {
    /// The beginning of a text, as far as it has room; none where nothing can be seen of it.
    pub(crate) fn of(text: &str) -> Option<Self> {
        let mut name = Self {
            letters: [0; 20],
            length: 0,
        };
        for letter in text.trim().chars().filter(|letter| !is_hidden(*letter)) {
            let from = usize::from(name.length);
            let Some(room) = name.letters[from..].get_mut(..letter.len_utf8()) else {
                break;
            };
            letter.encode_utf8(room);
            name.length += letter.len_utf8() as u8;
        }
        (!name.as_str().trim().is_empty()).then_some(name)
    }

    /// The beginning of a text without what cannot be seen, for messages.
    pub(crate) fn printable(text: &str, most: usize) -> String {
        let seen = text.trim().chars().filter(|letter| !is_hidden(*letter));
        seen.take(most).collect()
    }

    pub fn as_str(&self) -> &str {
        str::from_utf8(&self.letters[..usize::from(self.length)]).unwrap_or_default()
    }
}

searoom_geometry::words! {
    /// Why a field is wider than what was sent, or not there.
    pub enum Note {
        /// No position code, or one that is not on the earth.
        NoPosition => "heard without a place",
        /// Time stamps 61 to 63.
        NotMeasured => "the place is typed in, reckoned, or without a fix",
        /// Time stamp 60, or one that is ahead of the reception: a minute more or less.
        AgeUnknown => "the age of the fix is unknown",
        /// A satellite or a late station: the fix is older than 5 s.
        Latent => "the fix may be a minute older",
        /// No speed code.
        NoSpeed => "no speed",
        /// The highest code: this speed or more.
        SpeedOrMore => "this speed or more",
        /// Speed 0, course 0 and no heading: encoders send that for what they do not know.
        ZerosForUnknown => "speed, course and heading look as if they were not known",
        /// No course code.
        NoCourse => "no course",
        /// Below about a knot a course is noise.
        SlowCourse => "too slow for a course",
        /// No heading code, or a number from 360 to 510.
        NoHeading => "no heading",
        /// No heading, and fast enough for the course to stand for it.
        HeadingFromCourse => "the heading is taken from the course, and wider",
        /// Length or beam is 0.
        NoSize => "no size",
        /// Length and beam without the place of the antenna.
        NoAntenna => "the place of the antenna is unknown",
        /// The highest codes, 511 and 63 m.
        SizeOrMore => "this long or wide, or more",
        /// Wider than long, or longer than any ship.
        WrongSize => "the size is typed in wrongly",
        /// At anchor, moored or aground, and faster than a knot.
        StatusContradictsSpeed => "the status contradicts the speed",
        /// Integrity of the receiver is monitored.
        Raim => "integrity is monitored",
        /// The mark says that it is off its position.
        OffPosition => "off its position",
        /// The report is as short as real units send it.
        Short => "the message is short",
        /// Modes and qualities of a simulator: neither a place nor a heading.
        Simulated => "from a simulator",
        /// Modes E and M of THS.
        HeadingNotMeasured => "the heading is typed in or estimated, and wider",
        /// Status Q: the radar does not know its motion yet.
        Acquiring => "the radar is acquiring it",
        /// Course and speed of a radar target that are relative, nobody says to what.
        RelativeCourse => "course and speed are relative to own heading or to own motion",
        /// Descriptions differ in which distance is that to port.
        Sides => "port and starboard of the antenna may be exchanged",
    }
}

/// A set of notes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Notes(u32);

impl Notes {
    pub fn add(&mut self, note: Note) {
        self.0 |= 1 << note as u32;
    }

    pub fn has(self, note: Note) -> bool {
        self.0 & (1 << note as u32) != 0
    }

    /// All notes of both.
    #[must_use]
    pub fn and(self, more: Self) -> Self {
        Self(self.0 | more.0)
    }

    /// In the order of [`Note::WORDS`].
    pub fn iter(self) -> impl Iterator<Item = Note> {
        let all = Note::WORDS.iter().map(|(_, note)| *note);
        all.filter(move |note| self.has(*note))
    }
}

/// What one message says.
#[derive(Debug, Clone, PartialEq)]
pub struct Report {
    /// When it was received, seconds of Unix time: of the tag block, or else of the reader's clock.
    pub received: f64,
    /// The source of its tag block.
    pub source: Option<SourceId>,
    pub identity: Identity,
    pub kind: Kind,
    /// True for own ship's own message: VDO, a sentence of its sensors, or Signal K's own ship.
    pub is_own: bool,
    /// Of a message with a position, velocity or heading. What the message has no field for is unknown here.
    pub fix: Option<Fix>,
    /// Of a message with a size.
    pub hull: Option<HullSet>,
    pub status: Option<Status>,
    pub name: Option<Name>,
    pub call_sign: Option<Name>,
    /// Code of the type of ship and cargo, or of the kind of mark.
    pub type_code: Option<u8>,
    /// Of a craft that says which ship it belongs to.
    pub mother_ship: Option<Identity>,
    pub notes: Notes,
}

impl Report {
    /// A report that says nothing yet.
    #[inline]
    pub(crate) fn new(
        received: f64,
        source: Option<SourceId>,
        identity: Identity,
        kind: Kind,
    ) -> Self {
        Self {
            received,
            source,
            identity,
            kind,
            is_own: false,
            fix: None,
            hull: None,
            status: None,
            name: None,
            call_sign: None,
            type_code: None,
            mother_ship: None,
            notes: Notes::default(),
        }
    }
}
