//! The rows of an entity as JSON values.

use rerun::log::Chunk;
use serde_json::Value;

use super::values::instances;
use super::{components, seconds};
use crate::recording::TIMELINE;

const NAMES: &str = "SeriesLines:names";
const TEXT: &str = "TextDocument:text";

/// Everything that an entity holds, a row per time and write.
#[derive(Debug, Clone, PartialEq)]
pub struct EntityTable {
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
    /// Seconds; `None` for what holds at all times.
    pub time: Option<f64>,
    /// The instances of each component; null where the row has none.
    pub values: Vec<Value>,
}

impl EntityTable {
    pub(super) fn of(chunks: &[Chunk]) -> Self {
        let components = components(chunks);
        let mut rows: Vec<EntityRow> = Vec::new();
        for chunk in chunks {
            let begun = rows.len();
            let empty = || EntityRow {
                time: None,
                values: vec![Value::Null; components.len()],
            };
            rows.resize_with(begun + chunk.num_rows(), empty);
            for (row, time) in rows[begun..].iter_mut().zip(seconds(chunk)) {
                row.time = Some(time);
            }
            for component in chunk.components_identifiers() {
                let place = components.iter().position(|c| *c == component.as_str());
                let list = chunk.components().get_array(component);
                let Some((place, list)) = place.zip(list) else {
                    continue;
                };
                for (index, row) in rows[begun..].iter_mut().enumerate() {
                    row.values[place] = instances(list, index);
                }
            }
        }
        // a stable sort keeps the order of writing at equal times
        let time = |row: &EntityRow| row.time.unwrap_or(f64::NEG_INFINITY);
        rows.sort_by(|a, b| time(a).total_cmp(&time(b)));
        let mut table = Self {
            components,
            rows,
            names: Vec::new(),
        };
        table.names = table.texts(NAMES);
        table
    }

    /// The table for a CSV file, its header first. Its columns are the times, each named curve, and
    /// each other component as JSON. Where something changes in time, components that hold at all
    /// times are left out.
    pub fn csv_rows(&self) -> Vec<Vec<String>> {
        let is_timed = |row: &EntityRow| row.time.is_some();
        let any_timed = self.rows.iter().any(is_timed);
        let shown = |row: &&EntityRow| is_timed(row) || !any_timed;
        let is_curves =
            |component: &str| component.starts_with("Scalars:") && !self.names.is_empty();
        let used = |c: &usize| {
            self.rows
                .iter()
                .filter(shown)
                .any(|r| !r.values[*c].is_null())
        };
        let used: Vec<usize> = (0..self.components.len()).filter(used).collect();
        let mut header = Vec::new();
        if any_timed {
            header.push(format!("{TIMELINE}_s"));
        }
        for component in used.iter().map(|c| &self.components[*c]) {
            if is_curves(component) {
                header.extend_from_slice(&self.names);
            } else {
                let short = component.rsplit(':').next().unwrap_or(component);
                header.push(short.to_owned());
            }
        }
        let mut rows = vec![header];
        for row in self.rows.iter().filter(shown) {
            let mut cells: Vec<String> = row.time.iter().map(f64::to_string).collect();
            for &c in &used {
                if is_curves(&self.components[c]) {
                    let value = |i| {
                        row.values[c]
                            .get(i)
                            .map_or_else(String::new, Value::to_string)
                    };
                    cells.extend((0..self.names.len()).map(value));
                } else {
                    cells.push(row.values[c].to_string());
                }
            }
            rows.push(cells);
        }
        rows
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
