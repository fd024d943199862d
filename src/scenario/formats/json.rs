//! A JSON value with its place, so that every fault says where.

use std::cell::RefCell;
use std::fmt::Display;

use serde::de::{DeserializeSeed, Deserializer, MapAccess, SeqAccess, Visitor};
use serde_json::{Map, Number, Value};

use super::super::fault::Fault;
use super::super::file::Range;
use crate::text::{LINE, is_line};

/// What a JSON file says; a key that is there twice is an error, for one of the two would be dropped silently.
pub(super) fn parse(text: &str) -> Result<Value, Fault> {
    let mut reader = serde_json::Deserializer::from_str(text);
    let value = Unique.deserialize(&mut reader);
    value
        .and_then(|value| reader.end().map(|()| value))
        .map_err(|error| Fault {
            path: String::new(),
            found: error.to_string(),
            allowed: "JSON without errors".to_owned(),
            line: (error.line() > 0).then_some(error.line()),
        })
}

/// Builds a value whose objects name every key once.
struct Unique;

impl<'de> DeserializeSeed<'de> for Unique {
    type Value = Value;

    fn deserialize<D: Deserializer<'de>>(self, reader: D) -> Result<Value, D::Error> {
        reader.deserialize_any(self)
    }
}

impl<'de> Visitor<'de> for Unique {
    type Value = Value;

    fn expecting(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        f.write_str("a JSON value")
    }

    fn visit_unit<E>(self) -> Result<Value, E> {
        Ok(Value::Null)
    }

    fn visit_bool<E>(self, value: bool) -> Result<Value, E> {
        Ok(Value::Bool(value))
    }

    fn visit_i64<E>(self, value: i64) -> Result<Value, E> {
        Ok(Value::from(value))
    }

    fn visit_u64<E>(self, value: u64) -> Result<Value, E> {
        Ok(Value::from(value))
    }

    fn visit_f64<E>(self, value: f64) -> Result<Value, E> {
        Ok(Number::from_f64(value).map_or(Value::Null, Value::Number))
    }

    fn visit_str<E>(self, value: &str) -> Result<Value, E> {
        Ok(Value::from(value))
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<Value, A::Error> {
        let mut values = Vec::new();
        while let Some(value) = list.next_element_seed(Unique)? {
            values.push(value);
        }
        Ok(Value::Array(values))
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Value, A::Error> {
        let mut values = Map::new();
        while let Some(key) = map.next_key::<String>()? {
            let value = map.next_value_seed(Unique)?;
            if values.contains_key(&key) {
                let twice = format!("the key {key:?} twice in one object");
                return Err(serde::de::Error::custom(twice));
            }
            values.insert(key, value);
        }
        Ok(Value::Object(values))
    }
}

/// A value, where it stands, and the faults so far.
#[derive(Debug, Clone)]
pub(super) struct Json<'a> {
    value: &'a Value,
    path: String,
    faults: &'a RefCell<Vec<Fault>>,
}

impl<'a> Json<'a> {
    /// The outermost value of a file.
    pub(super) fn root(value: &'a Value, faults: &'a RefCell<Vec<Fault>>) -> Self {
        Self {
            value,
            path: String::new(),
            faults,
        }
    }

    /// The same value with another list of faults.
    pub(super) fn noting(&self, faults: &'a RefCell<Vec<Fault>>) -> Self {
        Self {
            faults,
            ..self.clone()
        }
    }

    /// Where it stands, as in `targets[0].speed_mps`.
    pub(super) fn path(&self) -> &str {
        &self.path
    }

    /// Notes a fault at this place.
    pub(super) fn fault(&self, found: impl Display, allowed: impl Display) {
        self.faults.borrow_mut().push(Fault {
            path: self.path.clone(),
            found: found.to_string(),
            allowed: allowed.to_string(),
            line: None,
        });
    }

    /// The value of a key that may be left out; null is nothing. A fault where this is no object.
    pub(super) fn take(&self, key: &str) -> Option<Json<'a>> {
        let Value::Object(map) = self.value else {
            self.fault(shown(self.value), "an object");
            return None;
        };
        let value = map.get(key).filter(|value| !value.is_null())?;
        Some(self.at(self.path_of(key), value))
    }

    /// The value of a key that must be there.
    pub(super) fn require(&self, key: &str, allowed: impl Display) -> Option<Json<'a>> {
        let found = self.take(key);
        if found.is_none() && self.value.is_object() {
            self.faults.borrow_mut().push(Fault {
                path: self.path_of(key),
                found: "nothing".to_owned(),
                allowed: format!("{allowed}; it is required"),
                line: None,
            });
        }
        found
    }

    fn at(&self, path: String, value: &'a Value) -> Self {
        Self {
            value,
            path,
            faults: self.faults,
        }
    }

    fn path_of(&self, key: &str) -> String {
        if self.path.is_empty() {
            key.to_owned()
        } else {
            format!("{}.{key}", self.path)
        }
    }

    /// The keys of an object, in the order of the alphabet.
    pub(super) fn keys(&self) -> impl Iterator<Item = &'a str> + use<'a> {
        self.value
            .as_object()
            .into_iter()
            .flat_map(|map| map.keys().map(String::as_str))
    }

    /// The entries of a list with so many of them.
    pub(super) fn list(&self, least: usize, most: usize, what: &str) -> Option<Vec<Json<'a>>> {
        let Value::Array(values) = self.value else {
            self.fault(shown(self.value), format_args!("a list of {what}"));
            return None;
        };
        if values.len() < least || values.len() > most {
            let allowed = format_args!("{least} to {most} {what}");
            self.fault(format_args!("{} {what}", values.len()), allowed);
            return None;
        }
        let entry = |(index, value)| self.at(format!("{}[{index}]", self.path), value);
        Some(values.iter().enumerate().map(entry).collect())
    }

    /// A number in a range, whose unit is said in the message.
    pub(super) fn number(&self, range: Range, unit: &str) -> Option<f64> {
        let allowed = || format!("{range} {unit}");
        match self.value.as_f64() {
            Some(number) if range.contains(number) => Some(number + 0.0),
            _ => {
                self.fault(shown(self.value), allowed());
                None
            }
        }
    }

    /// The number here, if it is one; no fault where it is none.
    pub(super) fn quiet(&self) -> Option<f64> {
        self.value.as_f64()
    }

    /// The number at a key that must be there.
    pub(super) fn required_number(&self, key: &str, range: Range, unit: &str) -> Option<f64> {
        self.require(key, format_args!("{range} {unit}"))?
            .number(range, unit)
    }

    /// The number at a key that may be left out: `None` when it is faulty.
    pub(super) fn optional_number(
        &self,
        key: &str,
        range: Range,
        unit: &str,
    ) -> Option<Option<f64>> {
        match self.take(key) {
            Some(entry) => entry.number(range, unit).map(Some),
            None => Some(None),
        }
    }

    /// A text that may be a name.
    pub(super) fn text(&self) -> Option<&'a str> {
        let text = self.value.as_str().map(str::trim);
        let sound = text.filter(|text| is_line(text));
        if sound.is_none() {
            self.fault(shown(self.value), LINE);
        }
        sound
    }

    /// One of these words, or one of as many codes from 0 where codes are allowed.
    pub(super) fn word(&self, words: &[&str], codes: &[u64]) -> Option<()> {
        let known = match self.value {
            Value::String(word) => words.contains(&word.as_str()),
            value => value.as_u64().is_some_and(|code| codes.contains(&code)),
        };
        if !known {
            self.fault(
                shown(self.value),
                format_args!("one of \"{}\"", words.join("\", \"")),
            );
        }
        known.then_some(())
    }
}

/// A value as a message shows it.
fn shown(value: &Value) -> String {
    /// Characters of a long text.
    const SHOWN: usize = 40;
    match value {
        Value::Null => "null".to_owned(),
        Value::Bool(value) => value.to_string(),
        Value::Number(number) => number.to_string(),
        Value::String(text) if text.chars().count() > SHOWN => {
            format!("{:?}…", text.chars().take(SHOWN).collect::<String>())
        }
        Value::String(text) => format!("{text:?}"),
        Value::Array(list) => format!("a list of {}", list.len()),
        Value::Object(map) => format!("an object of {} keys", map.len()),
    }
}
