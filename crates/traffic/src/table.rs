//! Tables of AIS reports by the names of their columns: CSV of MarineCadastre in both of its layouts, CSV
//! of the Danish Maritime Authority, and any other table whose columns have one of these names.

use std::collections::{HashMap, VecDeque};
use std::fmt;

use searoom_geometry::frame::Geographic;

use crate::ais;
use crate::counts::Dropped;
use crate::fields::{
    contradiction, course_set, heading_set, hull, is_length, metres, place, speed_set,
};
use crate::report::{
    Fix, HullSet, Identity, Interval, Kind, Name, Note, Notes, Report, Status, VelocitySet,
};
use crate::sentence::decimal;
use crate::settings::Settings;
use crate::time;

/// Rows whose identity, time and place are remembered, so that the same one again is dropped.
const REMEMBERED: usize = 65_536;

/// Names of columns that are kept for messages, and their length.
const MOST_NAMES: usize = 64;
const MOST_LETTERS: usize = 40;

/// What a column says.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Column {
    Mmsi,
    Time,
    Latitude,
    Longitude,
    Speed,
    Course,
    Heading,
    Name,
    CallSign,
    Type,
    Status,
    Length,
    Width,
    Class,
    Bow,
    Stern,
    Port,
    Starboard,
}

const COLUMNS: usize = Column::Starboard as usize + 1;

/// Names of columns by their letters and digits alone, in lower case: of MarineCadastre until 2023, from 2024
/// on, and of the Danish authority.
const NAMES: &[(&str, Column)] = &[
    ("mmsi", Column::Mmsi),
    ("basedatetime", Column::Time),
    ("timestamp", Column::Time),
    ("lat", Column::Latitude),
    ("latitude", Column::Latitude),
    ("lon", Column::Longitude),
    ("longitude", Column::Longitude),
    ("sog", Column::Speed),
    ("cog", Column::Course),
    ("heading", Column::Heading),
    ("vesselname", Column::Name),
    ("name", Column::Name),
    ("callsign", Column::CallSign),
    ("vesseltype", Column::Type),
    ("status", Column::Status),
    ("navigationalstatus", Column::Status),
    ("length", Column::Length),
    ("width", Column::Width),
    ("transceiverclass", Column::Class),
    ("transceiver", Column::Class),
    ("typeofmobile", Column::Class),
    ("a", Column::Bow),
    ("b", Column::Stern),
    ("c", Column::Port),
    ("d", Column::Starboard),
];

/// Columns without which a row says nothing, and what each is called in messages.
const NEEDED: &[(Column, &str)] = &[
    (Column::Mmsi, "identity"),
    (Column::Time, "time"),
    (Column::Latitude, "latitude"),
    (Column::Longitude, "longitude"),
];

/// A table that lacks a column without which its rows say nothing.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct MissingColumn {
    /// What the column would say.
    pub field: &'static str,
    /// Names of the table's columns.
    pub found: Vec<String>,
    /// Names that the column may have, as letters and digits: `base_date_time` is `basedatetime`.
    pub allowed: Vec<&'static str>,
}

impl fmt::Display for MissingColumn {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self {
            field,
            found,
            allowed,
        } = self;
        let (found, allowed) = (found.join(", "), allowed.join(", "));
        write!(
            f,
            "no column of the {field}: found {found}; allowed {allowed}"
        )
    }
}

impl std::error::Error for MissingColumn {}

/// Cells of a row, by what they say. What is not there is empty.
#[derive(Debug)]
pub(crate) struct Row<'r>([&'r str; COLUMNS]);

impl<'r> Row<'r> {
    fn text(&self, column: Column) -> &'r str {
        self.0[column as usize]
    }

    /// A finite number and half a step of its last digit, which is unknown with an exponent; `None` for words
    /// such as "Unknown".
    fn step(&self, column: Column) -> Option<(f64, f64)> {
        let text = self.text(column);
        let found = decimal(text).or_else(|| {
            // 5e-05 is 5.5 m from Greenwich
            let is_short = text.len() <= 24 && text.contains(['e', 'E']);
            let number = is_short.then(|| text.parse().ok()).flatten()?;
            Some((number, f64::INFINITY))
        });
        found.filter(|(number, _)| number.is_finite())
    }

    fn number(&self, column: Column) -> Option<f64> {
        self.step(column).map(|(number, _)| number)
    }

    /// A whole number, which some tables hold as a decimal.
    fn whole(&self, column: Column, most: f64) -> Option<u32> {
        let number = self.number(column)?;
        let is_whole = number.fract() == 0.0 && (0.0..=most).contains(&number);
        is_whole.then_some(number as u32)
    }
}

/// The columns of a table, and what its last rows were.
#[derive(Debug)]
pub(crate) struct Table {
    columns: Vec<Option<Column>>,
    unread: Vec<String>,
    missing: Option<MissingColumn>,
    last: Remembered,
}

impl Table {
    /// The table with these names of columns; none where they are not those of reports.
    pub fn new<'n>(names: impl Iterator<Item = &'n str>) -> Option<Self> {
        let mut table = Self {
            columns: Vec::new(),
            unread: Vec::new(),
            missing: None,
            last: Remembered::default(),
        };
        table.read_names(names).then_some(table)
    }

    /// False where the names are not those of reports; then nothing changes.
    fn read_names<'n>(&mut self, names: impl Iterator<Item = &'n str>) -> bool {
        let names: Vec<&str> = names.collect();
        let mut columns: Vec<Option<Column>> = Vec::new();
        for name in &names {
            let plain = plain(name);
            let known = NAMES.iter().find(|(known, _)| *known == plain);
            let column = known.map(|(_, column)| *column);
            // the first of two with one meaning
            let column = column.filter(|column| !columns.contains(&Some(*column)));
            columns.push(column);
        }
        let is_there = |column: Column| columns.contains(&Some(column));
        if columns.iter().flatten().count() < 2
            || !NEEDED.iter().any(|(column, _)| is_there(*column))
        {
            return false;
        }
        let shown = |name: &str| Name::printable(name, MOST_LETTERS);
        let missing = NEEDED.iter().find(|(column, _)| !is_there(*column));
        self.missing = missing.map(|(missing, field)| MissingColumn {
            field,
            found: names
                .iter()
                .take(MOST_NAMES)
                .map(|name| shown(name))
                .collect(),
            allowed: NAMES
                .iter()
                .filter(|(_, column)| column == missing)
                .map(|(name, _)| *name)
                .collect(),
        });
        let unread = names
            .iter()
            .zip(&columns)
            .filter(|(_, column)| column.is_none());
        self.unread = unread
            .map(|(name, _)| shown(name))
            .take(MOST_NAMES)
            .collect();
        self.columns = columns;
        true
    }

    /// Names of columns that are not read.
    pub fn unread(&self) -> &[String] {
        &self.unread
    }

    pub fn missing(&self) -> Option<&MissingColumn> {
        self.missing.as_ref()
    }

    /// The report of a row; `None` for the names of columns, where files follow one another.
    pub fn report<'c>(
        &mut self,
        cells: impl Iterator<Item = &'c str> + Clone,
        settings: &Settings,
    ) -> Result<Option<Report>, Dropped> {
        let mut row = Row([""; COLUMNS]);
        let mut count = 0;
        for (index, cell) in cells.clone().enumerate() {
            count += 1;
            if let Some(Some(column)) = self.columns.get(index) {
                row.0[*column as usize] = cell.trim();
            }
        }
        if plain(row.text(Column::Mmsi)) == "mmsi" && self.read_names(cells) {
            return Ok(None);
        }
        if self.missing.is_some() {
            return Err(Dropped::NoColumn);
        }
        if count != self.columns.len() {
            return Err(Dropped::Row);
        }
        let report = report(&row, settings).ok_or(Dropped::Row)?;
        match self.last.is_again(&report, settings) {
            true => Err(Dropped::Again),
            false => Ok(Some(report)),
        }
    }
}

/// Letters and digits of a name, in lower case.
fn plain(name: &str) -> String {
    let letters = name.chars().filter(|letter| letter.is_ascii_alphanumeric());
    letters
        .take(MOST_LETTERS)
        .map(|letter| letter.to_ascii_lowercase())
        .collect()
}

/// The report of a row; none without an identity and a time.
fn report(row: &Row, settings: &Settings) -> Option<Report> {
    let mmsi = row.whole(Column::Mmsi, 999_999_999.0)?;
    let received = time::of_row(row.text(Column::Time))?;
    let kind = kind(row.text(Column::Class), mmsi);
    let mut notes = Notes::default();
    let fix = fix(row, received, settings, &mut notes);
    let status = status(row, mmsi);
    contradiction(status, &fix, &mut notes);
    Some(Report {
        fix: Some(fix),
        hull: size(row, kind, settings, &mut notes),
        status,
        name: name(row, Column::Name),
        call_sign: name(row, Column::CallSign),
        type_code: row.whole(Column::Type, 255.0).map(|code| code as u8),
        notes,
        ..Report::new(received, None, Identity::Mmsi(mmsi), kind)
    })
}

fn fix(row: &Row, received: f64, settings: &Settings, notes: &mut Notes) -> Fix {
    let position = row.step(Column::Latitude).zip(row.step(Column::Longitude));
    let position = match position {
        Some(((lat, half_lat), (lon, half_lon))) => {
            // zeros at the end may have been cut off
            let half_step = half_lat.max(half_lon).min(0.5e-4);
            place(
                Geographic::new(lat, lon),
                half_step,
                settings.inaccurate_m,
                notes,
            )
        }
        None => {
            notes.add(Note::NoPosition);
            None
        }
    };
    let within = |half: f64| half.clamp(0.05, 0.5);
    let [speed, course] = [Column::Speed, Column::Course].map(|column| row.step(column));
    let heading = row
        .number(Column::Heading)
        .filter(|heading| (0.0..360.0).contains(heading));
    let is_zero = |step: Option<(f64, f64)>| step.is_some_and(|(number, _)| number == 0.0);
    let speed = match is_zero(speed) && is_zero(course) && heading.is_none() {
        true => {
            notes.add(Note::ZerosForUnknown);
            Interval::new(0.0, f64::INFINITY)
        }
        false => {
            let half_step = speed.map_or(0.0, |(_, half)| within(half));
            speed_set(speed.map(|(knots, _)| knots), half_step, notes)
        }
    };
    let course = course.map(|(degrees, half)| (degrees, within(half)));
    let course = course_set(course, speed, settings, notes);
    let velocity = VelocitySet { speed, course };
    let heading = heading.map(|heading| (heading, 0.5));
    Fix {
        // rows are dated by their reception, to the second
        time: Interval::new(received - settings.delay_s, received + 1.0),
        position,
        velocity,
        heading: heading_set(heading, velocity, settings, notes),
        turn_rate: None,
    }
}

/// What sent a row. A number makes no station, no aircraft and no mark of what has a ship's class.
fn kind(class: &str, mmsi: u32) -> Kind {
    let class = plain(class);
    match (mmsi / 1_000_000, class.as_str()) {
        (970 | 972 | 974, _) => Kind::Distress,
        (980..=989, _) => Kind::Craft,
        (_, "aton") => Kind::Mark,
        (_, "a" | "classa") => Kind::ClassA,
        (_, "b" | "classb") => Kind::ClassB,
        (_, "basestation") => Kind::BaseStation,
        (_, "sarairborne") => Kind::Aircraft,
        (_, "sart" | "searchandrescuetransponder" | "manoverboarddevice") => Kind::Distress,
        (990..=999, _) => Kind::Mark,
        _ => Kind::Ship,
    }
}

/// Status by its code, or by the words of the Danish authority.
fn status(row: &Row, mmsi: u32) -> Option<Status> {
    if let Some(code) = row.whole(Column::Status, 15.0) {
        return ais::status(code, mmsi);
    }
    let code = match plain(row.text(Column::Status)).as_str() {
        "underwayusingengine" => 0,
        "atanchor" => 1,
        "notundercommand" => 2,
        "restrictedmaneuverability" | "restrictedmanoeuvrability" => 3,
        "constrainedbyherdraught" => 4,
        "moored" => 5,
        "aground" => 6,
        "engagedinfishing" => 7,
        "underwaysailing" => 8,
        "powerdrivenvesseltowingastern" => 11,
        _ => return None,
    };
    ais::status(code, mmsi)
}

fn name(row: &Row, column: Column) -> Option<Name> {
    let text = row.text(column);
    let is_unknown = ["unknown", "unknownvalue", "undefined"].contains(&plain(text).as_str());
    (!is_unknown).then(|| Name::of(text)).flatten()
}

/// Hull from the distances of the antenna, or from length and beam alone. `None` where the row has no size at
/// all, not even an empty one.
fn size(row: &Row, kind: Kind, settings: &Settings, notes: &mut Notes) -> Option<HullSet> {
    let bounds = match kind {
        Kind::ClassB | Kind::Craft => settings.class_b_m,
        _ => settings.class_a_m,
    };
    if kind == Kind::Craft {
        // many decoders read the mother ship's number as a size
        notes.add(Note::NoSize);
        return Some(HullSet::unknown(bounds[0], bounds[1]));
    }
    let metres = |column: Column| row.number(column).filter(is_length);
    let sides = [Column::Bow, Column::Stern, Column::Port, Column::Starboard].map(metres);
    if let [Some(bow), Some(stern), Some(port), Some(starboard)] = sides
        && bow + stern > 0.0
    {
        let mut hull = hull([bow, stern, port, starboard], bounds, settings, notes);
        // descriptions of the table differ in which side is which
        if hull.port != hull.starboard {
            notes.add(Note::Sides);
            let [a, b] = [hull.port, hull.starboard];
            let either = Interval::new(a.least.min(b.least), a.most.max(b.most));
            (hull.port, hull.starboard) = (either, either);
        }
        return Some(hull);
    }
    let [length, beam] =
        [Column::Length, Column::Width].map(|column| metres(column).unwrap_or(0.0));
    Some(hull([0.0, length, 0.0, beam], bounds, settings, notes))
}

/// The last rows, by identity and time, with their places.
#[derive(Debug, Default)]
struct Remembered {
    places: HashMap<(Identity, u64), Option<Geographic>>,
    order: VecDeque<(Identity, u64)>,
}

impl Remembered {
    /// True for an identity at a time and a place where it was before. Elsewhere it is another ship with the
    /// same number.
    fn is_again(&mut self, report: &Report, settings: &Settings) -> bool {
        let key = (report.identity, report.received.to_bits());
        let at = report.fix.and_then(|fix| fix.position).map(|set| set.at);
        if let Some(before) = self.places.get(&key) {
            return match (at, before) {
                (Some(a), Some(b)) => metres(a, *b).norm() <= 2.0 * settings.inaccurate_m,
                _ => true,
            };
        }
        if self.order.len() >= REMEMBERED
            && let Some(oldest) = self.order.pop_front()
        {
            self.places.remove(&oldest);
        }
        self.order.push_back(key);
        self.places.insert(key, at);
        false
    }
}

/// Cells of one line of CSV.
#[derive(Debug)]
pub(crate) struct Cells {
    parser: csv_core::Reader,
    text: Vec<u8>,
    ends: Vec<usize>,
}

/// Most columns of a table.
const MOST_COLUMNS: usize = 256;

impl Default for Cells {
    fn default() -> Self {
        Self {
            parser: csv_core::Reader::new(),
            text: Vec::new(),
            ends: vec![0; MOST_COLUMNS],
        }
    }
}

impl Cells {
    /// The cells of a line without its end; `None` for a quotation mark that is not closed, or too many
    /// cells.
    pub fn of(&mut self, line: &str) -> Option<impl Iterator<Item = &str> + Clone> {
        self.parser.reset();
        self.text.resize(self.text.len().max(line.len() + 1), 0);
        use csv_core::ReadRecordResult::{InputEmpty, Record};
        let (first, _, written, count) =
            (self.parser).read_record(line.as_bytes(), &mut self.text, &mut self.ends);
        if first != InputEmpty {
            return None;
        }
        let (text, ends) = (&mut self.text[written..], &mut self.ends[count..]);
        let (last, _, more, ended) = self.parser.read_record(b"\n", text, ends);
        let (written, count) = (written + more, count + ended);
        if last != Record {
            return None;
        }
        let text = str::from_utf8(&self.text[..written]).ok()?;
        let ends = &self.ends[..count];
        let begins = std::iter::once(&0).chain(ends);
        Some(
            begins
                .zip(ends)
                .map(|(begin, end)| text.get(*begin..*end).unwrap_or_default()),
        )
    }
}
