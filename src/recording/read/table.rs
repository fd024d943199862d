//! The rows of an entity as JSON values.

use std::collections::BTreeMap;

use rerun::log::Chunk;
use serde_json::Value;

use super::unit;
use super::values::instances;

/// The component that names the curves of a plot.
const NAMES: &str = "SeriesLines:names";

/// The component that holds a text.
const TEXT: &str = "TextDocument:text";

/// Everything that an entity holds, a row per time and write.
#[derive(Debug, Clone, PartialEq)]
pub struct EntityTable {
    /// The timelines, with their unit.
    pub timelines: Vec<String>,
    /// The components, sorted.
    pub components: Vec<String>,
    /// In order of time; what holds at all times first.
    pub rows: Vec<EntityRow>,
    /// Names of the scalars of a row, where they have names.
    pub names: Vec<String>,
}

/// One row.
#[derive(Debug, Clone, PartialEq)]
pub struct EntityRow {
    /// One per timeline; `None` for what holds at all times.
    pub times: Vec<Option<f64>>,
    /// The instances of each component; null where the row has none.
    pub values: Vec<Value>,
}

impl EntityTable {
    pub(super) fn of(chunks: &[Chunk]) -> Self {
        let mut timelines: BTreeMap<String, usize> = BTreeMap::new();
        let mut components: BTreeMap<String, usize> = BTreeMap::new();
        for chunk in chunks {
            for column in chunk.timelines().values() {
                let (unit, _) = unit(column.timeline().typ());
                timelines.insert(titled(column.name(), unit), 0);
            }
            for component in chunk.components_identifiers() {
                components.insert(component.to_string(), 0);
            }
        }
        let number = |names: &mut BTreeMap<String, usize>| {
            names
                .values_mut()
                .enumerate()
                .for_each(|(i, place)| *place = i);
        };
        number(&mut timelines);
        number(&mut components);
        let mut rows: Vec<EntityRow> = Vec::new();
        for chunk in chunks {
            let begun = rows.len();
            let empty = || EntityRow {
                times: vec![None; timelines.len()],
                values: vec![Value::Null; components.len()],
            };
            rows.resize_with(begun + chunk.num_rows(), empty);
            for column in chunk.timelines().values() {
                let (unit, scale) = unit(column.timeline().typ());
                let place = timelines[&titled(column.name(), unit)];
                for (row, time) in rows[begun..].iter_mut().zip(column.times_raw()) {
                    row.times[place] = Some(*time as f64 / scale);
                }
            }
            for component in chunk.components_identifiers() {
                let place = components[&component.to_string()];
                let Some(list) = chunk.components().get_array(component) else {
                    continue;
                };
                for (index, row) in rows[begun..].iter_mut().enumerate() {
                    row.values[place] = instances(list, index);
                }
            }
        }
        // a stable sort keeps the order of writing at equal times
        rows.sort_by(|a, b| {
            let pairs = a.times.iter().zip(&b.times);
            pairs
                .map(|(a, b)| match (a, b) {
                    (Some(a), Some(b)) => a.total_cmp(b),
                    (a, b) => a.is_some().cmp(&b.is_some()),
                })
                .find(|order| order.is_ne())
                .unwrap_or(std::cmp::Ordering::Equal)
        });
        let mut table = Self {
            timelines: timelines.into_keys().collect(),
            components: components.into_keys().collect(),
            rows,
            names: Vec::new(),
        };
        table.names = table.texts(NAMES);
        table
    }

    /// The text of a document, the last one written.
    pub(super) fn text(&self) -> Option<String> {
        self.texts(TEXT).pop()
    }

    /// The texts of a component in the last row that has it.
    fn texts(&self, component: &str) -> Vec<String> {
        let Some(place) = self.components.iter().position(|c| c == component) else {
            return Vec::new();
        };
        let rows = self.rows.iter().rev();
        let found = rows.filter_map(|row| row.values[place].as_array()).next();
        let texts = found.into_iter().flatten();
        texts
            .filter_map(|v| v.as_str().map(str::to_owned))
            .collect()
    }
}

/// The name of a timeline with its unit.
fn titled(name: &str, unit: &str) -> String {
    if unit.is_empty() {
        name.to_owned()
    } else {
        format!("{name}_{unit}")
    }
}
