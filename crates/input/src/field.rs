//! A value with its place in the file: the cursor with which files are read.

use std::fmt::{self, Display};
use std::ops::RangeInclusive;
use std::path::{Path, PathBuf};
use std::rc::Rc;

use chrono::{DateTime, Utc};

use super::table::Key;
use super::value::{Node, Value};
use super::{Fault, Faults, InputError, Table, meant};
use crate::text::{LINE, is_line, is_unprintable, printable};
use searoom_geometry::frame::{Vector, mps_from_knots};

/// Faults of another file that are listed: a map of another place has one in every feature.
const MOST_LISTED: usize = 20;

/// A date and a time of day, in words.
pub const DATE_TIME: &str =
    "a date and a time with its offset from UTC, such as 2026-05-01T12:00:00Z";

/// The date and time of a text of RFC 3339.
pub fn date_time(text: &str) -> Option<DateTime<Utc>> {
    let read = DateTime::parse_from_rfc3339(text.trim()).ok()?;
    Some(read.to_utc())
}

/// Limits nearer to zero than this are written with a power of ten.
const SHORT: f64 = 1e-9;

/// Allowed numbers. A NaN never is.
#[derive(Debug, Clone, Copy)]
pub struct Range {
    /// Least allowed number.
    pub low: f64,
    /// Greatest allowed number.
    pub high: f64,
    pub(super) or_zero: bool,
    unit: &'static str,
}

impl Range {
    /// The numbers from `low` to `high`, both included.
    pub const fn between(low: f64, high: f64) -> Self {
        Self {
            low,
            high,
            or_zero: false,
            unit: "",
        }
    }

    /// The numbers from `-limit` to `limit`.
    pub const fn within(limit: f64) -> Self {
        Self::between(-limit, limit)
    }

    /// This range, and zero.
    pub const fn or_zero(self) -> Self {
        Self {
            or_zero: true,
            ..self
        }
    }

    /// The range with its unit, for files whose keys do not name the unit.
    pub const fn in_unit(self, unit: &'static str) -> Self {
        Self { unit, ..self }
    }

    /// The range in units of another size: round limits, just inside its own.
    pub fn in_units_of(self, size: f64) -> Self {
        if size == 1.0 {
            return self;
        }
        Self {
            low: (self.low / size * 1e3).ceil() / 1e3,
            high: (self.high / size).floor(),
            ..self
        }
    }

    /// A range of speeds in knots from one in m/s.
    pub fn in_knots(self) -> Self {
        self.in_units_of(mps_from_knots(1.0))
    }

    /// True for an allowed number.
    pub fn contains(&self, value: f64) -> bool {
        (self.low..=self.high).contains(&value) || (self.or_zero && value == 0.0)
    }

    /// The number in a text, if it is allowed.
    pub fn parse(&self, text: &str) -> Option<f64> {
        let number = text.parse::<f64>().ok()?;
        // +0.0 turns a negative zero into zero
        self.contains(number).then_some(number + 0.0)
    }
}

impl Display for Range {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let zero = if self.or_zero { "0, or " } else { "" };
        write!(f, "{zero}a number from ")?;
        if self.low != 0.0 && self.low.abs() < SHORT {
            write!(f, "{:e}", self.low)?;
        } else {
            write!(f, "{}", self.low)?;
        }
        write!(f, " to {}", self.high)?;
        if !self.unit.is_empty() {
            write!(f, " {}", self.unit)?;
        }
        Ok(())
    }
}

/// A value, its place, and the faults found so far. The place is written out only for a fault: a
/// scenario may have ten thousand targets.
#[derive(Debug, Clone)]
pub struct Field<'a> {
    faults: &'a Faults,
    /// Place of the table or list that holds the value.
    base: Rc<str>,
    last: Last<'a>,
    node: &'a Node,
}

/// Last part of a place.
#[derive(Debug, Clone, Copy)]
enum Last<'a> {
    /// The value is that at the base itself.
    None,
    Key(&'a str),
    Index(usize),
}

impl<'a> Field<'a> {
    /// The whole content of a file, whose faults are noted in `faults`.
    pub fn root(node: &'a Node, faults: &'a Faults) -> Self {
        Self {
            faults,
            base: Rc::from(""),
            last: Last::None,
            node,
        }
    }

    /// This value with another collection of faults.
    pub fn noting(&self, faults: &'a Faults) -> Self {
        Self {
            faults,
            ..self.clone()
        }
    }

    /// Where the value is, as in `targets[0].speed_mps`.
    pub fn path(&self) -> String {
        match self.last {
            Last::None => self.base.to_string(),
            Last::Key(key) => path_of(&self.base, key),
            Last::Index(index) => format!("{}[{index}]", self.base),
        }
    }

    /// The key in its table.
    pub(super) fn key(&self) -> Option<&'a str> {
        match self.last {
            Last::Key(key) => Some(key),
            Last::None | Last::Index(_) => None,
        }
    }

    /// This value as the base of others.
    pub(super) fn as_base(&self) -> Self {
        let base = match self.last {
            Last::None => Rc::clone(&self.base),
            Last::Key(_) | Last::Index(_) => Rc::from(self.path()),
        };
        Self {
            base,
            last: Last::None,
            ..self.clone()
        }
    }

    /// Notes a fault at this value.
    pub fn fault(&self, found: impl Display, allowed: impl Display) {
        let fault = Fault::new(self.path(), found, allowed);
        self.faults.note(fault.at_line(self.node.line));
    }

    /// Notes a fault at a key of this table.
    pub fn fault_at(&self, key: &str, found: impl Display, allowed: impl Display) {
        self.faults.note(self.fault_of(key, found, allowed));
    }

    fn fault_of(&self, key: &str, found: impl Display, allowed: impl Display) -> Fault {
        let node = self.node.get(key).unwrap_or(self.node);
        Fault::new(path_of(&self.path(), key), found, allowed).at_line(node.line)
    }

    /// Notes a key of this table that is not among the `known` ones, and which of them was meant.
    pub(super) fn unknown(&self, key: &str, meant: Option<&String>, known: &[String]) {
        let allowed = format_args!("one of {}", known.join(", "));
        match meant {
            Some(meant) => {
                let found = format_args!("an unknown key, perhaps for '{meant}'");
                self.fault_at(key, found, allowed);
            }
            None => {
                let fault = self.fault_of(key, "an unknown key", allowed);
                self.faults.note_unknown(key, fault);
            }
        }
    }

    /// Notes the keys that this table may have.
    pub(super) fn finish(&self, known: Vec<Key>) {
        self.faults.add_table(&self.as_base().base, known);
    }

    /// Notes a fault here, without which there would be a value.
    pub fn reject<T>(&self, found: impl Display, allowed: impl Display) -> Option<T> {
        self.fault(found, allowed);
        None
    }

    /// Notes that this value is not an allowed one.
    pub fn refuse<T>(&self, allowed: impl Display) -> Option<T> {
        self.reject(self.node.described(), allowed)
    }

    /// The value at a key; a fault if this is not a table.
    pub fn get(&self, key: &str) -> Option<Self> {
        if !self.is_table() {
            return self.refuse("an object");
        }
        let (key, node) = self.node.entry(key)?;
        Some(self.inside(key, node))
    }

    /// The value at the first key of a table that is wanted, if this is one.
    pub(super) fn find(&self, wanted: impl Fn(&str) -> bool) -> Option<Self> {
        let (key, node) = self.node.entry_where(wanted)?;
        Some(self.inside(key, node))
    }

    fn inside(&self, key: &'a str, node: &'a Node) -> Self {
        Self {
            faults: self.faults,
            base: self.as_base().base,
            last: Last::Key(key),
            node,
        }
    }

    /// The value at a key that must be there.
    pub fn require(&self, key: &str, allowed: impl Display) -> Option<Self> {
        let found = self.get(key);
        if found.is_none() && self.is_table() {
            self.fault_at(key, "nothing", format_args!("{allowed}; it is required"));
        }
        found
    }

    /// The number at a key that must be there.
    pub fn required_number(&self, key: &str, range: Range) -> Option<f64> {
        self.require(key, range)?.number(range)
    }

    /// The value at a key that may be absent: the outer `None` is a faulty value.
    pub fn optional<T>(
        &self,
        key: &str,
        read: impl FnOnce(&Self) -> Option<T>,
    ) -> Option<Option<T>> {
        match self.get(key) {
            Some(field) => read(&field).map(Some),
            None => Some(None),
        }
    }

    /// The number at a key that may be absent: the outer `None` is a faulty number.
    pub fn optional_number(&self, key: &str, range: Range) -> Option<Option<f64>> {
        self.optional(key, |field| field.number(range))
    }

    /// The keys of a table, in alphabetical order.
    pub fn keys(&self) -> impl Iterator<Item = &'a str> + use<'a> {
        let table = match &self.node.value {
            Value::Table(table) => Some(table),
            _ => None,
        };
        table.into_iter().flatten().map(|(key, _)| key.as_str())
    }

    /// A number in a range; an integer is one too.
    pub fn number(&self, range: Range) -> Option<f64> {
        match self.any_number() {
            // +0.0 turns a negative zero into zero
            Some(value) if range.contains(value) => Some(value + 0.0),
            _ => self.refuse(range),
        }
    }

    /// A whole number in a range.
    pub fn whole_number(&self, range: Range) -> Option<usize> {
        match self.any_number() {
            Some(value) if range.contains(value) && value.fract() == 0.0 => Some(value as usize),
            _ => self.refuse(format_args!(
                "a whole number from {} to {}",
                range.low, range.high
            )),
        }
    }

    /// The number here, if it is one, without a fault otherwise.
    pub fn any_number(&self) -> Option<f64> {
        match self.node.value {
            Value::Number(number) => Some(number),
            _ => None,
        }
    }

    /// The text here, if it is one, without a fault otherwise.
    pub fn any_text(&self) -> Option<&'a str> {
        self.node.as_text()
    }

    /// Text on one line that may be a name or a title.
    pub fn line_of_text(&self) -> Option<&'a str> {
        match self.node.as_text() {
            Some(text) if is_line(text) => Some(text),
            _ => self.refuse(LINE),
        }
    }

    /// The name of a file, relative to a folder.
    pub fn file_in(&self, folder: &Path) -> Option<PathBuf> {
        match self.node.as_text() {
            Some(name) if !name.trim().is_empty() && !name.chars().any(is_unprintable) => {
                Some(folder.join(name))
            }
            _ => self.refuse("the name of a file, relative to the folder of this one"),
        }
    }

    /// The content of the file that is named here, or its faults, noted here.
    pub fn contents<T>(&self, file: &Path, read: Result<T, InputError>, kind: &str) -> Option<T> {
        match read {
            Ok(content) => Some(content),
            Err(InputError::Read { file, source, near }) => {
                let (file, near) = (file.display(), meant(&near));
                let found = format_args!("{file}, which cannot be read ({source}){near}");
                self.reject(found, kind)
            }
            Err(InputError::Faults { faults, .. }) => {
                for fault in faults.iter().take(MOST_LISTED) {
                    let line = fault.line.map(|line| format!("line {line}: "));
                    let line = line.unwrap_or_default();
                    let path = match fault.path.as_str() {
                        "" => String::new(),
                        path => format!("{path}: "),
                    };
                    let found = format_args!("{}: {line}{path}{}", file.display(), fault.found);
                    self.fault(found, &fault.allowed);
                }
                if let Some(more) = faults.len().checked_sub(MOST_LISTED).filter(|n| *n > 0) {
                    let found = format_args!("{}: {more} more faults", file.display());
                    self.fault(found, "none");
                }
                None
            }
        }
    }

    /// A date and a time of day with its offset from UTC.
    pub fn date_time(&self) -> Option<DateTime<Utc>> {
        let date = match &self.node.value {
            Value::Date(date) => date_time(date),
            _ => None,
        };
        date.or_else(|| self.refuse(DATE_TIME))
    }

    /// True or false.
    pub fn truth(&self) -> Option<bool> {
        match self.node.value {
            Value::Bool(truth) => Some(truth),
            _ => self.refuse("true, false"),
        }
    }

    /// The meaning of one of these words.
    pub fn choice<T: Copy>(&self, words: &[(&str, T)]) -> Option<T> {
        let found = self.node.as_text();
        if let Some((_, meaning)) = words.iter().find(|(word, _)| Some(*word) == found) {
            return Some(*meaning);
        }
        let allowed: Vec<String> = words.iter().map(|(w, _)| format!("\"{w}\"")).collect();
        self.refuse(allowed.join(", "))
    }

    /// The items of a list with an allowed number of them.
    pub fn list(&self, counts: RangeInclusive<usize>, what: &str) -> Option<Vec<Self>> {
        let (least, most) = (counts.start(), counts.end());
        match &self.node.value {
            Value::List(items) if counts.contains(&items.len()) => {
                let base = self.as_base().base;
                let field = |(index, node)| Self {
                    faults: self.faults,
                    base: Rc::clone(&base),
                    last: Last::Index(index),
                    node,
                };
                Some(items.iter().enumerate().map(field).collect())
            }
            Value::List(items) if items.len() > *most => {
                let found = format_args!("{} {what}", items.len());
                self.reject(found, format_args!("at most {most}"))
            }
            Value::Table(_) if what == "tables" => {
                let path = self.path();
                self.refuse(format_args!(
                    "[[{path}]], with two brackets, before each of them"
                ))
            }
            _ => self.refuse(format_args!("a list of at least {least} {what}")),
        }
    }

    /// A list of at least one number, each in a range.
    pub fn numbers(&self, range: Range) -> Option<Vec<f64>> {
        let items = self.list(1..=usize::MAX, "numbers")?;
        every(items.iter().map(|item| item.number(range)))
    }

    /// A list of two numbers in a range: a vector.
    pub fn pair(&self, range: Range) -> Option<Vector> {
        match &self.node.value {
            Value::List(items) if items.len() == 2 => {
                let numbers = self.numbers(range)?;
                Some(Vector::new(*numbers.first()?, *numbers.get(1)?))
            }
            _ => self.refuse("[east, north]"),
        }
    }

    /// The table here, whose unknown keys are faults.
    pub fn table(&self, shape: &str) -> Option<Table<'a>> {
        if self.is_table() {
            Some(Table::new(self.as_base()))
        } else {
            self.refuse(shape)
        }
    }

    /// True if the value has keys of its own.
    pub fn is_table(&self) -> bool {
        matches!(self.node.value, Value::Table(_))
    }
}

/// The place of a key in a table at a place.
fn path_of(table: &str, key: &str) -> String {
    let key = printable(key);
    match table.is_empty() {
        true => key,
        false => format!("{table}.{key}"),
    }
}

/// Every value, or none where one is faulty. All are read, so that all faults are noted.
pub fn every<T>(read: impl Iterator<Item = Option<T>>) -> Option<Vec<T>> {
    let values: Vec<Option<T>> = read.collect();
    values.into_iter().collect()
}

/// A text in quotation marks, cut after 40 characters.
pub fn abbreviated(text: &str) -> String {
    const SHOWN: usize = 40;
    let short: String = text.chars().take(SHOWN).collect();
    let more = if text.chars().count() > SHOWN {
        "…"
    } else {
        ""
    };
    format!("{short:?}{more}")
}
