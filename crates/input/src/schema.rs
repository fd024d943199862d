//! JSON schemas (draft 7) of tables, from the ranges, words and units with which they are read.

use std::ops::{Bound, RangeBounds};

use serde_json::{Map, Value, json};

use super::Range;
use super::table::{DISTANCE_UNITS, SPEED_UNITS, Unit};
use crate::text::LINE_CHARS;

/// The schema of a table. Its methods are named like those of [`Table`](super::Table) that read
/// the keys; the meaning of a key may be empty.
#[derive(Debug)]
pub struct Schema {
    keywords: Value,
    properties: Map<String, Value>,
    required: Vec<&'static str>,
    /// Quantities that are required in one of their units.
    in_some_unit: Vec<Value>,
}

impl Schema {
    /// A table without keys.
    pub fn table(meaning: &str) -> Self {
        Self {
            keywords: about(
                meaning,
                json!({ "type": "object", "additionalProperties": false }),
            ),
            properties: Map::new(),
            required: Vec::new(),
            in_some_unit: Vec::new(),
        }
    }

    /// A keyword of the table itself.
    #[must_use]
    pub fn with(mut self, keyword: &str, value: impl Into<Value>) -> Self {
        self.keywords[keyword] = value.into();
        self
    }

    /// A key that may be absent.
    #[must_use]
    pub fn optional(mut self, key: &str, value: impl Into<Value>, meaning: &str) -> Self {
        self.properties
            .insert(key.to_owned(), about(meaning, value.into()));
        self
    }

    /// A key that must be there.
    #[must_use]
    pub fn require(mut self, key: &'static str, value: impl Into<Value>, meaning: &str) -> Self {
        self.required.push(key);
        self.optional(key, value, meaning)
    }

    /// A speed in one of its units; the range is in m/s.
    #[must_use]
    pub fn speed(self, stem: &str, range: Range, meaning: &str) -> Self {
        self.in_units(stem, &SPEED_UNITS, meaning, |size| {
            number(range.in_units_of(size))
        })
    }

    /// A speed that must be there.
    #[must_use]
    pub fn required_speed(self, stem: &str, range: Range, meaning: &str) -> Self {
        self.speed(stem, range, meaning)
            .require_in(stem, &SPEED_UNITS)
    }

    /// A list of speeds.
    #[must_use]
    pub fn speeds(self, stem: &str, range: Range, meaning: &str) -> Self {
        self.in_units(stem, &SPEED_UNITS, meaning, |size| {
            list(1.., number(range.in_units_of(size)))
        })
    }

    /// A list of speeds of which none is there twice.
    #[must_use]
    pub fn distinct_speeds(self, stem: &str, range: Range, meaning: &str) -> Self {
        self.in_units(stem, &SPEED_UNITS, meaning, |size| {
            let mut speeds = list(1.., number(range.in_units_of(size)));
            speeds["uniqueItems"] = true.into();
            speeds
        })
    }

    /// A distance in one of its units; the range is in metres.
    #[must_use]
    pub fn distance(self, stem: &str, range: Range, meaning: &str) -> Self {
        self.in_units(stem, &DISTANCE_UNITS, meaning, |size| {
            number(range.in_units_of(size))
        })
    }

    /// A distance that must be there.
    #[must_use]
    pub fn required_distance(self, stem: &str, range: Range, meaning: &str) -> Self {
        self.distance(stem, range, meaning)
            .require_in(stem, &DISTANCE_UNITS)
    }

    fn in_units(
        self,
        stem: &str,
        units: &[Unit],
        meaning: &str,
        value: impl Fn(f64) -> Value,
    ) -> Self {
        units.iter().fold(self, |table, (unit, size)| {
            let name = match *unit {
                "mps" => "m/s",
                "kn" => "knots",
                "m" => "metres",
                "nmi" => "nautical miles",
                _ => "cables",
            };
            let (key, meaning) = (format!("{stem}_{unit}"), format!("{meaning}; {name}"));
            table.optional(&key, value(*size), &meaning)
        })
    }

    fn require_in(mut self, stem: &str, units: &[Unit]) -> Self {
        let keys = units.iter().map(|(unit, _)| format!("{stem}_{unit}"));
        let keys: Vec<Value> = keys.map(|key| json!({ "required": [key] })).collect();
        self.in_some_unit.push(json!({ "anyOf": keys }));
        self
    }

    /// The schema, with no other keys.
    pub fn finish(self) -> Value {
        let mut table = self.keywords;
        if !self.required.is_empty() {
            table["required"] = self.required.into();
        }
        if !self.in_some_unit.is_empty() {
            table["allOf"] = self.in_some_unit.into();
        }
        table["properties"] = self.properties.into();
        table
    }
}

impl From<Schema> for Value {
    fn from(table: Schema) -> Self {
        table.finish()
    }
}

/// A value with its meaning, where that is not empty.
fn about(meaning: &str, mut value: Value) -> Value {
    if !meaning.is_empty() {
        value["description"] = meaning.into();
    }
    value
}

/// A value with its default.
pub fn or(default: impl Into<Value>, mut value: Value) -> Value {
    let default = default.into();
    value["default"] = default.as_f64().map_or(default, figure);
    value
}

/// A number in a range.
pub fn number(range: Range) -> Value {
    let (low, high) = (figure(range.low), figure(range.high));
    match range.or_zero {
        true => {
            let others = json!({ "minimum": low, "maximum": high });
            json!({ "type": "number", "anyOf": [{ "const": 0 }, others] })
        }
        false => json!({ "type": "number", "minimum": low, "maximum": high }),
    }
}

/// A whole number in a range.
pub fn whole_number(range: Range) -> Value {
    let (low, high) = (figure(range.low), figure(range.high));
    json!({ "type": "integer", "minimum": low, "maximum": high })
}

/// One of several words.
pub fn choice<T>(words: &[(&str, T)]) -> Value {
    json!({ "enum": words.iter().map(|(word, _)| *word).collect::<Vec<_>>() })
}

/// A text on one line.
pub fn line_of_text() -> Value {
    json!({ "type": "string", "minLength": 1, "maxLength": LINE_CHARS })
}

/// A list with an allowed number of items.
pub fn list(counts: impl RangeBounds<usize>, items: impl Into<Value>) -> Value {
    let mut list = json!({ "type": "array", "items": items.into() });
    if let Bound::Included(least @ 1..) = counts.start_bound() {
        list["minItems"] = (*least).into();
    }
    if let Bound::Included(most) = counts.end_bound() {
        list["maxItems"] = (*most).into();
    }
    list
}

/// Tables that have all keys of one of these lists.
pub fn having(alternatives: &[&[&str]]) -> Value {
    let alternatives = alternatives.iter().map(|keys| json!({ "required": keys }));
    alternatives.collect()
}

/// A number, without a point where it is whole.
fn figure(number: f64) -> Value {
    /// Beyond, not every whole number is exact.
    const EXACT: f64 = 9e15;
    match number.fract() == 0.0 && number.abs() <= EXACT {
        true => json!(number as i64),
        false => json!(number),
    }
}
