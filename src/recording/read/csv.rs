//! The rows of an entity as columns of numbers and texts, for a CSV file.

use serde_json::Value;

use super::table::{EntityRow, EntityTable};

/// Names of the coordinates of a point.
const AXES: [&str; 4] = ["x", "y", "z", "w"];

/// Numbers and texts in named columns.
#[derive(Debug, Clone, PartialEq)]
pub struct Columns {
    /// One per column.
    pub header: Vec<String>,
    /// One value per column of the header; empty where there is none.
    pub rows: Vec<Vec<String>>,
}

impl EntityTable {
    /// The table as columns: the times, then a column per number, text or coordinate.
    ///
    /// Where something changes in time, what holds at all times is left out. Where an entity holds
    /// lines, there is a row per point of them, and nothing else of it.
    pub fn columns(&self) -> Columns {
        let lines = (0..self.components.len())
            .find(|&c| self.rows.iter().any(|r| depth(&r.values[c]) >= 3));
        match lines {
            Some(component) => self.points(component),
            None => self.instances(),
        }
    }

    fn points(&self, component: usize) -> Columns {
        let mut header = self.timelines.clone();
        header.extend(["line".to_owned(), "point".to_owned()]);
        let mut dimension = 0;
        let mut rows = Vec::new();
        for row in &self.rows {
            let lines = row.values[component].as_array().into_iter().flatten();
            for (l, line) in lines.enumerate() {
                for (p, point) in line.as_array().into_iter().flatten().enumerate() {
                    let point = point.as_array().map_or(&[][..], Vec::as_slice);
                    dimension = dimension.max(point.len());
                    let mut cells: Vec<String> = row.times.iter().map(time).collect();
                    cells.extend([l.to_string(), p.to_string()]);
                    cells.extend(point.iter().map(cell));
                    rows.push(cells);
                }
            }
        }
        header.extend((0..dimension).map(axis));
        fill(header, rows)
    }

    fn instances(&self) -> Columns {
        let in_time = |row: &&EntityRow| row.times.iter().any(Option::is_some);
        let timed: Vec<&EntityRow> = self.rows.iter().filter(in_time).collect();
        let rows = if timed.is_empty() {
            self.rows.iter().collect()
        } else {
            timed
        };
        // how many instances a component has, and how many numbers each of them
        let shape = |c: usize| -> (usize, usize) {
            let cells = rows.iter().filter_map(|r| r.values[c].as_array());
            cells.fold((0, 0), |(n, d), instances| {
                let inner = instances.iter().filter_map(Value::as_array);
                let widest = inner.map(Vec::len).max().unwrap_or(0);
                (n.max(instances.len()), d.max(widest))
            })
        };
        let shapes: Vec<(usize, usize)> = (0..self.components.len()).map(shape).collect();
        let mut header = self.timelines.clone();
        for (c, component) in self.components.iter().enumerate() {
            let (count, dimension) = shapes[c];
            let short = component.rsplit(':').next().unwrap_or(component);
            for i in 0..count {
                let named = self
                    .names
                    .get(i)
                    .filter(|_| component.starts_with("Scalars:"));
                let one = match named {
                    Some(name) => name.clone(),
                    None if count == 1 => short.to_owned(),
                    None => format!("{short}[{i}]"),
                };
                if dimension == 0 {
                    header.push(one);
                } else {
                    header.extend((0..dimension).map(|d| format!("{one}.{}", axis(d))));
                }
            }
        }
        let cells = rows.iter().map(|row| {
            let mut cells: Vec<String> = row.times.iter().map(time).collect();
            for (c, value) in row.values.iter().enumerate() {
                let (count, dimension) = shapes[c];
                let instances = value.as_array().map_or(&[][..], Vec::as_slice);
                for i in 0..count {
                    match (instances.get(i), dimension) {
                        (instance, 0) => cells.push(instance.map_or_else(String::new, cell)),
                        (instance, _) => {
                            let parts = instance.and_then(Value::as_array);
                            let part = |d| parts.and_then(|p: &Vec<Value>| p.get(d));
                            cells.extend(
                                (0..dimension).map(|d| part(d).map_or_else(String::new, cell)),
                            );
                        }
                    }
                }
            }
            cells
        });
        fill(header, cells.collect())
    }
}

/// Makes every row as long as the header.
fn fill(header: Vec<String>, mut rows: Vec<Vec<String>>) -> Columns {
    for row in &mut rows {
        row.resize(header.len(), String::new());
    }
    Columns { header, rows }
}

fn axis(dimension: usize) -> String {
    AXES.get(dimension)
        .map_or_else(|| dimension.to_string(), |a| (*a).to_owned())
}

fn time(time: &Option<f64>) -> String {
    time.map_or_else(String::new, |t| t.to_string())
}

fn cell(value: &Value) -> String {
    match value {
        Value::Null => String::new(),
        Value::String(text) => text.clone(),
        other => other.to_string(),
    }
}

/// How deeply lists are nested: 1 for numbers, 2 for points, 3 for lines.
fn depth(value: &Value) -> usize {
    match value {
        Value::Array(list) => 1 + list.iter().map(depth).max().unwrap_or(0),
        _ => 0,
    }
}
