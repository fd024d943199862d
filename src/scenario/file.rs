//! The file as it is written: values with their places, every fault noted on the way.
//!
//! A derived deserialiser would stop at its first error; here reading goes on, so that one run names
//! everything that is wrong. The outcome is good only when no fault was noted.

use std::cell::RefCell;
use std::fmt::Display;
use std::path::{Path, PathBuf};

use toml::Spanned;
use toml::de::DeValue;

use super::fault::Fault;
use super::section::Section;
use crate::frame::Vector;
use crate::text::{LINE, is_line, is_unprintable};

/// Limits nearer to zero are written with a power of ten.
const SHORT: f64 = 1e-9;

/// Which numbers are allowed. A NaN never is.
#[derive(Debug, Clone, Copy)]
pub(super) struct Range {
    pub(super) low: f64,
    pub(super) high: f64,
    pub(super) or_zero: bool,
}

impl Range {
    pub(super) const fn between(low: f64, high: f64) -> Self {
        Self {
            low,
            high,
            or_zero: false,
        }
    }

    pub(super) const fn within(limit: f64) -> Self {
        Self::between(-limit, limit)
    }

    pub(super) const fn zero_or_between(low: f64, high: f64) -> Self {
        Self {
            low,
            high,
            or_zero: true,
        }
    }

    pub(super) fn contains(&self, value: f64) -> bool {
        (self.low..=self.high).contains(&value) || (self.or_zero && value == 0.0)
    }
}

impl Display for Range {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let zero = if self.or_zero { "0, or " } else { "" };
        write!(f, "{zero}a number from ")?;
        // a long row of zeros is no figure
        if self.low != 0.0 && self.low.abs() < SHORT {
            write!(f, "{:e}", self.low)?;
        } else {
            write!(f, "{}", self.low)?;
        }
        write!(f, " to {}", self.high)
    }
}

/// Where the lines of a file are, and what is wrong with it so far.
#[derive(Debug)]
pub(super) struct Source {
    /// Byte of every line's end, increasing.
    line_ends: Vec<usize>,
    faults: RefCell<Vec<Fault>>,
}

impl Source {
    pub(super) fn new(text: &str) -> Self {
        Self {
            line_ends: text.match_indices('\n').map(|(at, _)| at).collect(),
            faults: RefCell::default(),
        }
    }

    /// Notes a fault at a byte of the text.
    pub(super) fn fault(
        &self,
        path: &str,
        offset: Option<usize>,
        found: impl Display,
        allowed: impl Display,
    ) {
        self.faults.borrow_mut().push(Fault {
            path: path.to_owned(),
            found: found.to_string(),
            allowed: allowed.to_string(),
            line: offset.map(|at| 1 + self.line_ends.partition_point(|end| *end < at)),
        });
    }

    /// Every fault, in order of lines.
    pub(super) fn into_faults(self) -> Vec<Fault> {
        let mut faults = self.faults.into_inner();
        faults.sort_by_key(|fault| fault.line);
        faults
    }
}

/// A value and its place.
#[derive(Debug, Clone)]
pub(super) struct Entry<'a, 'i> {
    source: &'a Source,
    path: String,
    value: &'a Spanned<DeValue<'i>>,
}

impl<'a, 'i> Entry<'a, 'i> {
    /// A value at a path.
    pub(super) fn new(source: &'a Source, path: String, value: &'a Spanned<DeValue<'i>>) -> Self {
        Self {
            source,
            path,
            value,
        }
    }

    /// Notes that something else should be here.
    pub(super) fn fault(&self, found: impl Display, allowed: impl Display) {
        let offset = Some(self.value.span().start);
        self.source.fault(&self.path, offset, found, allowed);
    }

    /// Notes that this value is not what it should be.
    pub(super) fn refuse<T>(&self, allowed: impl Display) -> Option<T> {
        self.fault(describe(self.value.get_ref()), allowed);
        None
    }

    /// A number in range; an integer is one too.
    pub(super) fn number(&self, range: Range) -> Option<f64> {
        match number(self.value.get_ref()) {
            // +0.0 turns a negative zero into zero
            Some(value) if range.contains(value) => Some(value + 0.0),
            _ => self.refuse(range),
        }
    }

    /// Text that is not blank, without control characters, not longer than a line.
    pub(super) fn text(&self) -> Option<String> {
        match self.value.get_ref().as_str() {
            Some(text) if is_line(text) => Some(text.to_owned()),
            _ => self.refuse(LINE),
        }
    }

    /// The name of a file, from a folder if it is relative.
    pub(super) fn file_in(&self, folder: &Path) -> Option<PathBuf> {
        match self.value.get_ref().as_str() {
            Some(name) if !name.trim().is_empty() && !name.chars().any(is_unprintable) => {
                Some(folder.join(name))
            }
            _ => self.refuse("the name of a file, relative to the folder of this one"),
        }
    }

    /// One of these words.
    pub(super) fn choice<T: Copy>(&self, words: &[(&str, T)]) -> Option<T> {
        let found = self.value.get_ref().as_str();
        if let Some((_, meaning)) = words.iter().find(|(w, _)| Some(*w) == found) {
            return Some(*meaning);
        }
        let allowed: Vec<String> = words.iter().map(|(w, _)| format!("\"{w}\"")).collect();
        self.refuse(allowed.join(", "))
    }

    /// The values of a list that has at least `least`.
    pub(super) fn list(&self, least: usize, of_what: &str) -> Option<Vec<Self>> {
        match self.value.get_ref().as_array() {
            Some(values) if values.len() >= least => Some(
                values
                    .iter()
                    .enumerate()
                    .map(|(index, value)| Self {
                        source: self.source,
                        path: format!("{}[{index}]", self.path),
                        value,
                    })
                    .collect(),
            ),
            _ => self.refuse(format_args!("a list of at least {least} {of_what}")),
        }
    }

    /// A list of numbers in range: `None` when one is not.
    pub(super) fn numbers(&self, range: Range) -> Option<Vec<f64>> {
        let values = self.list(1, "numbers")?;
        let numbers: Vec<_> = values.iter().map(|value| value.number(range)).collect();
        numbers.into_iter().collect()
    }

    /// Two numbers in range: a point.
    pub(super) fn pair(&self, range: Range) -> Option<Vector> {
        match self.value.get_ref().as_array().map(|array| array.len()) {
            Some(2) => {
                let numbers = self.numbers(range)?;
                Some(Vector::new(*numbers.first()?, *numbers.get(1)?))
            }
            _ => self.refuse("[east, north]"),
        }
    }

    /// The keys of a table.
    pub(super) fn section(&self, shape: &str) -> Option<Section<'a, 'i>> {
        match self.value.get_ref().as_table() {
            Some(table) => Some(Section::new(
                self.source,
                self.path.clone(),
                Some(self.value.span().start),
                table,
            )),
            None => self.refuse(shape),
        }
    }

    /// True when the value has keys of its own.
    pub(super) fn is_table(&self) -> bool {
        self.value.get_ref().is_table()
    }
}

fn number(value: &DeValue) -> Option<f64> {
    match value {
        DeValue::Float(float) => float.as_str().parse().ok(),
        DeValue::Integer(integer) => i128::from_str_radix(integer.as_str(), integer.radix())
            .ok()
            .map(|integer| integer as f64),
        _ => None,
    }
}

fn describe(value: &DeValue) -> String {
    match value {
        DeValue::String(text) => {
            let short: String = text.chars().take(40).collect();
            let more = if text.chars().count() > 40 { "…" } else { "" };
            format!("the text {short:?}{more}")
        }
        DeValue::Integer(integer) => integer.to_string(),
        DeValue::Float(float) => float.to_string(),
        DeValue::Boolean(truth) => truth.to_string(),
        DeValue::Datetime(when) => format!("the date {when}"),
        DeValue::Array(values) => format!("a list of {}", values.len()),
        DeValue::Table(_) => "a table".to_owned(),
    }
}
