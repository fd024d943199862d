//! TOML and JSON texts as one tree of values, each with the line where it begins.

use std::collections::BTreeMap;
use std::fmt;

use serde::de::{DeserializeSeed, Deserializer, MapAccess, SeqAccess, Visitor};
use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::{Fault, Faults, abbreviated};

/// A value and the line where it begins; JSON values have no line.
#[derive(Debug, Clone)]
pub struct Node {
    pub(super) value: Value,
    pub(super) line: Option<usize>,
}

#[derive(Debug, Clone)]
pub(super) enum Value {
    Null,
    Bool(bool),
    Number(f64),
    Text(String),
    Date(String),
    List(Vec<Node>),
    /// In the order of the keys.
    Table(Vec<(String, Node)>),
}

/// Number of keys up to which a comparison of lengths with each is faster than a binary search.
const FEW_KEYS: usize = 16;

impl Node {
    /// The value at a key of a table, if it is there and not null.
    pub fn get(&self, key: &str) -> Option<&Self> {
        self.entry(key).map(|(_, node)| node)
    }

    /// [`Self::get`] with the key in the table.
    pub(super) fn entry(&self, key: &str) -> Option<(&str, &Self)> {
        let Value::Table(table) = &self.value else {
            return None;
        };
        let found = match table.len() <= FEW_KEYS {
            true => table.iter().position(|(other, _)| other == key),
            false => (table.binary_search_by(|(other, _)| other.as_str().cmp(key))).ok(),
        };
        let (key, node) = &table[found?];
        (!matches!(node.value, Value::Null)).then_some((key.as_str(), node))
    }

    /// The first key of a table that is wanted and whose value is not null.
    pub(super) fn entry_where(&self, wanted: impl Fn(&str) -> bool) -> Option<(&str, &Self)> {
        let Value::Table(table) = &self.value else {
            return None;
        };
        let mut entries = table.iter();
        let (key, node) = entries.find(|(key, _)| wanted(key))?;
        (!matches!(node.value, Value::Null)).then_some((key.as_str(), node))
    }

    /// The text here; `None` for a value of another kind.
    pub fn as_text(&self) -> Option<&str> {
        match &self.value {
            Value::Text(text) => Some(text),
            _ => None,
        }
    }

    /// The line of the value at a path like `a.b[2]`, or of the innermost table on the way to it.
    pub fn line_at(&self, path: &str) -> Option<usize> {
        let mut node = self;
        let mut line = None;
        for part in path.split('.') {
            let (key, index) = match part.split_once('[') {
                Some((key, rest)) => (key, rest.trim_end_matches(']').parse::<usize>().ok()),
                None => (part, None),
            };
            let Some(next) = node.get(key) else {
                return line;
            };
            node = next;
            if let (Some(index), Value::List(list)) = (index, &node.value) {
                node = list.get(index)?;
            }
            line = node.line;
            if !matches!(node.value, Value::Table(_)) {
                break;
            }
        }
        line
    }

    /// The path of a quantity by the key of the unit in which it is given.
    pub fn path_in_unit(&self, path: &str) -> Option<String> {
        let (table, key) = path.rsplit_once('.')?;
        let mut node = self;
        for part in table.split('.') {
            node = node.get(part)?;
        }
        let (stem, unit) = key.rsplit_once('_')?;
        let others = super::table::units_like(unit).iter();
        let given = others.map(|(unit, _)| format!("{stem}_{unit}"));
        let mut given = given.filter(|key| node.get(key).is_some());
        given.next().map(|key| format!("{table}.{key}"))
    }

    /// The value as a message shows it.
    pub(super) fn described(&self) -> String {
        match &self.value {
            Value::Null => "null".to_owned(),
            Value::Bool(truth) => truth.to_string(),
            Value::Number(number) => shown(*number),
            Value::Text(text) => format!("the text {}", abbreviated(text)),
            Value::Date(date) => format!("the date {date}"),
            Value::List(list) => format!("a list of {}", list.len()),
            Value::Table(_) => "a table".to_owned(),
        }
    }
}

/// A number as a message shows it: `3`, `2.5`, `1e308`, `nan`.
fn shown(number: f64) -> String {
    /// Beyond, a whole number has more digits than are exact.
    const EXACT: f64 = 1e15;
    if number.is_nan() {
        "nan".to_owned()
    } else if number.fract() == 0.0 && number.abs() < EXACT {
        format!("{number:.0}")
    } else {
        format!("{number:?}")
    }
}

/// Parses TOML. Notes the first error of the grammar alone: those after it mostly follow from it.
pub fn from_toml(text: &str, faults: &Faults) -> Option<Node> {
    let line_ends: Vec<usize> = text.match_indices('\n').map(|(at, _)| at).collect();
    let line = |offset: usize| 1 + line_ends.partition_point(|end| *end < offset);
    let (document, errors) = DeTable::parse_recoverable(text);
    let start = |error: &toml::de::Error| error.span().map(|span| span.start);
    let Some(first) = errors.into_iter().min_by_key(start) else {
        let value = Value::Table(table_of(document.get_ref(), &line));
        return Some(Node { value, line: None });
    };
    let line = start(&first).map(line);
    let there = line.and_then(|line| text.lines().nth(line - 1));
    let there = there.map(str::trim);
    let is_twice = first.message().contains("duplicate");
    let allowed = match there {
        Some(header) if is_twice && header.starts_with('[') => {
            "valid TOML; where there may be several tables, each begins like [[targets]]"
        }
        _ if is_twice => "valid TOML; the key is given before",
        Some(there) if has_decimal_comma(there) => "valid TOML; the decimal sign is a point",
        _ => "valid TOML; a bracket or a quote left open above also leads here",
    };
    let found = match there {
        Some(there) => format!("{}, in {}", first.message(), abbreviated(there)),
        None => first.message().to_owned(),
    };
    faults.note(Fault::new("", found, allowed).at_line(line));
    None
}

/// True for a line with `key = 1,5`, in an inline table too.
fn has_decimal_comma(line: &str) -> bool {
    line.split('=').skip(1).any(|value| {
        let value = value.trim_start().trim_start_matches(['-', '+']);
        let rest = value.trim_start_matches(|c: char| c.is_ascii_digit());
        let decimals = rest.strip_prefix(',').unwrap_or_default();
        rest.len() < value.len() && decimals.starts_with(|c: char| c.is_ascii_digit())
    })
}

fn table_of(table: &DeTable, line: &impl Fn(usize) -> usize) -> Vec<(String, Node)> {
    let entries = table.iter();
    let entries = entries.map(|(key, value)| (key.get_ref().to_string(), node_of(value, line)));
    let mut entries: Vec<_> = entries.collect();
    // sorted already, unless the reader keeps the order of the file
    entries.sort_by(|a, b| a.0.cmp(&b.0));
    entries
}

fn node_of(value: &Spanned<DeValue>, line: &impl Fn(usize) -> usize) -> Node {
    Node {
        value: match value.get_ref() {
            DeValue::String(text) => Value::Text(text.to_string()),
            DeValue::Integer(integer) => {
                let number = i128::from_str_radix(integer.as_str(), integer.radix());
                // an integer that is too large is out of every range
                Value::Number(number.map_or(f64::INFINITY, |number| number as f64))
            }
            // a float of TOML is one of Rust
            DeValue::Float(float) => Value::Number(float.as_str().parse().unwrap_or(f64::NAN)),
            DeValue::Boolean(truth) => Value::Bool(*truth),
            DeValue::Datetime(date) => Value::Date(date.to_string()),
            DeValue::Array(list) => Value::List(list.iter().map(|v| node_of(v, line)).collect()),
            DeValue::Table(table) => Value::Table(table_of(table, line)),
        },
        line: Some(line(value.span().start)),
    }
}

/// Parses JSON. A key that appears twice in an object is an error: one of the two would be lost.
pub fn from_json(text: &str) -> Result<Node, Fault> {
    let mut reader = serde_json::Deserializer::from_str(text);
    let value = JsonNode.deserialize(&mut reader);
    value
        .and_then(|value| reader.end().map(|()| value))
        .map_err(|error| {
            let line = (error.line() > 0).then_some(error.line());
            Fault::new("", error, "JSON without errors").at_line(line)
        })
}

/// Builds a [`Node`] whose tables name every key once.
struct JsonNode;

impl<'de> DeserializeSeed<'de> for JsonNode {
    type Value = Node;

    fn deserialize<D: Deserializer<'de>>(self, reader: D) -> Result<Node, D::Error> {
        reader.deserialize_any(self)
    }
}

fn bare<E>(value: Value) -> Result<Node, E> {
    Ok(Node { value, line: None })
}

impl<'de> Visitor<'de> for JsonNode {
    type Value = Node;

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str("a JSON value")
    }

    fn visit_unit<E>(self) -> Result<Node, E> {
        bare(Value::Null)
    }

    fn visit_bool<E>(self, value: bool) -> Result<Node, E> {
        bare(Value::Bool(value))
    }

    fn visit_i64<E>(self, value: i64) -> Result<Node, E> {
        bare(Value::Number(value as f64))
    }

    fn visit_u64<E>(self, value: u64) -> Result<Node, E> {
        bare(Value::Number(value as f64))
    }

    fn visit_f64<E>(self, value: f64) -> Result<Node, E> {
        bare(Value::Number(value))
    }

    fn visit_str<E>(self, value: &str) -> Result<Node, E> {
        bare(Value::Text(value.to_owned()))
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<Node, A::Error> {
        let mut values = Vec::new();
        while let Some(value) = list.next_element_seed(JsonNode)? {
            values.push(value);
        }
        bare(Value::List(values))
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Node, A::Error> {
        let mut table = BTreeMap::new();
        while let Some(key) = map.next_key::<String>()? {
            let value = map.next_value_seed(JsonNode)?;
            if table.contains_key(&key) {
                let twice = format!("the key {key:?} twice in one object");
                return Err(serde::de::Error::custom(twice));
            }
            table.insert(key, value);
        }
        bare(Value::Table(table.into_iter().collect()))
    }
}
