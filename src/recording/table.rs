//! The rows of an entity as values: what any component holds, by its shape alone.

use std::collections::BTreeMap;

use rerun::external::arrow::array::{Array, AsArray, ListArray};
use rerun::external::arrow::datatypes::{
    DataType, Float32Type, Float64Type, Int64Type, UInt8Type, UInt32Type, UInt64Type,
};
use rerun::log::Chunk;
use serde_json::Value;

use super::reading::scale;

/// The component that names the curves of a plot.
const NAMES: &str = "SeriesLines:names";

/// The component that holds a text.
const TEXT: &str = "TextDocument:text";

/// Names of the coordinates of a point.
const AXES: [&str; 4] = ["x", "y", "z", "w"];

/// Everything that an entity holds, a row per instant and write.
///
/// # Examples
///
/// ```
/// # use searoom::{pipeline, scenario::Scenario};
/// use searoom::recording::{EntityTable, Recorded, write};
///
/// let scenario = Scenario::read("scenarios/colregs/head-on.toml".as_ref())?;
/// # let folder = tempfile::tempdir()?;
/// let file = folder.path().join("head-on.rrd");
/// write(&pipeline::run(scenario), None, &file)?;
/// let recorded = Recorded::read(&file)?;
/// let first = &recorded.entities()[0];
/// let table: EntityTable = recorded.table(&first.path).expect("it is there");
/// assert!(!table.rows.is_empty() && recorded.table("/no/such/entity").is_none());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct EntityTable {
    /// The timelines, with their unit.
    pub timelines: Vec<String>,
    /// The components, sorted.
    pub components: Vec<String>,
    /// In order of time; what holds at all times first.
    pub rows: Vec<EntityRow>,
    /// What the scalars of a row are called, where they have names.
    pub names: Vec<String>,
}

/// One row.
///
/// # Examples
///
/// ```
/// # use searoom::{pipeline, scenario::Scenario};
/// use searoom::recording::{EntityRow, Recorded, write};
///
/// let scenario = Scenario::read("scenarios/colregs/head-on.toml".as_ref())?;
/// # let folder = tempfile::tempdir()?;
/// let file = folder.path().join("head-on.rrd");
/// write(&pipeline::run(scenario), None, &file)?;
/// let recorded = Recorded::read(&file)?;
/// let table = recorded.table(&recorded.entities()[0].path).expect("it is there");
/// let row: &EntityRow = &table.rows[0];
/// assert_eq!((row.times.len(), row.values.len()), (table.timelines.len(), table.components.len()));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct EntityRow {
    /// Per timeline; none for what holds at all times.
    pub times: Vec<Option<f64>>,
    /// Per component its instances; null where the row has none.
    pub values: Vec<Value>,
}

/// Numbers and texts in named columns: for a CSV file.
///
/// # Examples
///
/// ```
/// # use searoom::{pipeline, scenario::Scenario};
/// use searoom::recording::{Columns, Recorded, write};
///
/// let scenario = Scenario::read("scenarios/colregs/head-on.toml".as_ref())?;
/// # let folder = tempfile::tempdir()?;
/// let file = folder.path().join("head-on.rrd");
/// write(&pipeline::run(scenario), None, &file)?;
/// let recorded = Recorded::read(&file)?;
/// let table = recorded.table(&recorded.entities()[0].path).expect("it is there");
/// let Columns { header, rows } = table.columns();
/// assert!(rows.iter().all(|row| row.len() == header.len()));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Columns {
    /// One per column.
    pub header: Vec<String>,
    /// As long as the header; empty where there is nothing.
    pub rows: Vec<Vec<String>>,
}

impl EntityTable {
    pub(super) fn of(chunks: &[Chunk]) -> Self {
        let mut timelines: BTreeMap<String, usize> = BTreeMap::new();
        let mut components: BTreeMap<String, usize> = BTreeMap::new();
        for chunk in chunks {
            for column in chunk.timelines().values() {
                let (unit, _) = scale(column.timeline().typ());
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
                let (unit, scale) = scale(column.timeline().typ());
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
        // stable: of one instant the order of writing stays
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

    /// The table as columns: times, then a column per instance of what is a number, a text or a point; of what changes in time
    /// that alone. Where an entity holds lines, a row per point of them instead, and nothing else of it.
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
        // beside what changes in time, what holds always is the look of it
        let in_time = |row: &&EntityRow| row.times.iter().any(Option::is_some);
        let timed: Vec<&EntityRow> = self.rows.iter().filter(in_time).collect();
        let rows = if timed.is_empty() {
            self.rows.iter().collect()
        } else {
            timed
        };
        // so is what the first row alone has
        let is_look = |c: usize| {
            let has = |row: &&EntityRow| !row.values[c].is_null();
            rows.len() > 1 && has(&rows[0]) && !rows[1..].iter().any(has)
        };
        // how many instances, and how many numbers in each
        let shape = |c: usize| -> (usize, usize) {
            if is_look(c) {
                return (0, 0);
            }
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

/// Every row as long as the header.
fn fill(header: Vec<String>, mut rows: Vec<Vec<String>>) -> Columns {
    for row in &mut rows {
        row.resize(header.len(), String::new());
    }
    Columns { header, rows }
}

fn titled(name: &str, unit: &str) -> String {
    if unit.is_empty() {
        name.to_owned()
    } else {
        format!("{name}_{unit}")
    }
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

/// How many lists a value is in: a row of numbers 1, of points 2, of lines 3.
fn depth(value: &Value) -> usize {
    match value {
        Value::Array(list) => 1 + list.iter().map(depth).max().unwrap_or(0),
        _ => 0,
    }
}

/// The text of a document, the last one written.
pub(super) fn text_of(chunks: &[Chunk]) -> Option<String> {
    EntityTable::of(chunks).texts(TEXT).pop()
}

/// The instances of a component in a row; null where it has none.
fn instances(list: &ListArray, row: usize) -> Value {
    if list.is_valid(row) {
        values(list.value(row).as_ref())
    } else {
        Value::Null
    }
}

/// With the digits that tell it from its neighbours, not those that single precision has by accident.
fn shortest(value: f32) -> Value {
    let text = value.to_string().parse::<f64>();
    text.unwrap_or(f64::from(value)).into()
}

/// Any array as JSON; of kinds that no component of ours has, the name of the kind.
fn values(array: &dyn Array) -> Value {
    let each = |value: &dyn Fn(usize) -> Value| {
        let one = |i| {
            if array.is_valid(i) {
                value(i)
            } else {
                Value::Null
            }
        };
        Value::Array((0..array.len()).map(one).collect())
    };
    match array.data_type() {
        DataType::Float64 => each(&|i| array.as_primitive::<Float64Type>().value(i).into()),
        DataType::Float32 => each(&|i| shortest(array.as_primitive::<Float32Type>().value(i))),
        DataType::Int64 => each(&|i| array.as_primitive::<Int64Type>().value(i).into()),
        DataType::UInt64 => each(&|i| array.as_primitive::<UInt64Type>().value(i).into()),
        DataType::UInt32 => each(&|i| array.as_primitive::<UInt32Type>().value(i).into()),
        DataType::UInt8 => each(&|i| array.as_primitive::<UInt8Type>().value(i).into()),
        DataType::Boolean => each(&|i| array.as_boolean().value(i).into()),
        DataType::Utf8 => each(&|i| array.as_string::<i32>().value(i).into()),
        DataType::List(_) => each(&|i| values(array.as_list::<i32>().value(i).as_ref())),
        DataType::FixedSizeList(..) => {
            each(&|i| values(array.as_fixed_size_list().value(i).as_ref()))
        }
        DataType::Struct(fields) => {
            let columns: Vec<Value> = array
                .as_struct()
                .columns()
                .iter()
                .map(|c| values(c.as_ref()))
                .collect();
            each(&|i| {
                let field = |(name, column): (&String, &Value)| (name.clone(), column[i].clone());
                let names: Vec<String> = fields.iter().map(|f| f.name().clone()).collect();
                Value::Object(names.iter().zip(&columns).map(field).collect())
            })
        }
        other => {
            let kind = other.to_string();
            each(&|_| Value::String(kind.clone()))
        }
    }
}
