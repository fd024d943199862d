//! Parts of a campaign: Parquet files of rows, each with what it belongs to in its footer.

use std::io;
use std::ops::Range;
use std::path::Path;
use std::sync::Arc;

use parquet::basic::{Compression, LogicalType, Repetition, Type as Physical, ZstdLevel};
use parquet::column::reader::ColumnReaderImpl;
use parquet::data_type::{BoolType, ByteArray, ByteArrayType, DataType, DoubleType, Int64Type};
use parquet::errors::{ParquetError, Result as ParquetResult};
use parquet::file::metadata::KeyValue;
use parquet::file::properties::WriterProperties;
use parquet::file::reader::{FileReader, RowGroupReader, SerializedFileReader};
use parquet::file::writer::{SerializedFileWriter, SerializedRowGroupWriter};
use parquet::schema::types::{Type, TypePtr};
use sha2::{Digest, Sha256};

use super::row::{COLUMNS, Cell, Of, TIMED, column};
use super::specification::hex;
use crate::output::{WriteError, write_durably};

/// Format of a part, in its footer.
const FORMAT: &str = "searoom-campaign/1";

/// Rows that are in memory at once when parts are joined.
const GROUP: usize = 50_000;

/// Metadata of a part: the campaign and the rows that it belongs to.
#[derive(Debug, Clone, PartialEq)]
pub struct Header {
    /// Hash of the specification.
    pub hash: String,
    /// Build of the program.
    pub build: String,
    /// Its rows, the end excluded.
    pub rows: Range<u64>,
}

/// A part that was read.
#[derive(Debug, Clone, PartialEq)]
pub struct Part {
    /// Its metadata.
    pub header: Header,
    /// Its rows, in order.
    pub rows: Vec<Vec<Cell>>,
}

/// Why a file is no part.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum PartError {
    /// It was not written whole, or has changed since.
    #[error("{0}")]
    Damaged(String),
    /// It is whole, with the columns of another version of the program.
    #[error("{0}")]
    OtherColumns(String),
}

/// The version of the program, and a hash of its sources.
pub(super) fn build() -> String {
    concat!(env!("CARGO_PKG_VERSION"), "+", env!("SEAROOM_SOURCES")).to_owned()
}

impl Header {
    /// Metadata of a part that this build writes.
    pub fn new(hash: &str, rows: Range<u64>) -> Self {
        Self {
            hash: hash.to_owned(),
            build: build(),
            rows,
        }
    }

    /// Name of the file of a part.
    pub fn file_name(&self) -> String {
        let Range { start, end } = self.rows;
        format!("rows-{start:010}-{:010}.parquet", end.saturating_sub(1))
    }

    /// The entries of the footer.
    fn entries(&self, rows: &[Vec<Cell>], shard: &str) -> Vec<KeyValue> {
        let cpu = rows.iter().map(|row| match &row[column("cpu_s")] {
            Cell::Number(Some(seconds)) => *seconds,
            _ => 0.0,
        });
        let entry = |key: &str, value: String| KeyValue::new(format!("searoom.{key}"), value);
        vec![
            entry("format", FORMAT.to_owned()),
            entry("specification", self.hash.clone()),
            entry("build", self.build.clone()),
            entry("shard", shard.to_owned()),
            entry("first", self.rows.start.to_string()),
            entry("end", self.rows.end.to_string()),
            entry("cpu_s", format!("{:.3}", cpu.sum::<f64>())),
            entry("digest", self.digest(rows)),
        ]
    }

    /// SHA-256 of the header and of every cell.
    fn digest(&self, rows: &[Vec<Cell>]) -> String {
        let mut hash = Sha256::new();
        hash.update(format!("{self:?}"));
        for cell in rows.iter().flatten() {
            match cell {
                Cell::Count(count) => hash.update(format!("{count:?}")),
                Cell::Number(number) => hash.update(format!("{:?}", number.map(f64::to_bits))),
                Cell::Truth(truth) => hash.update(format!("{truth:?}")),
                Cell::Word(word) => hash.update(format!("{word:?}")),
            }
        }
        hex(hash)
    }
}

fn schema() -> ParquetResult<TypePtr> {
    let fields = COLUMNS.iter().map(|column| {
        let (physical, logical) = match column.of {
            Of::Count(_) => (Physical::INT64, None),
            Of::Number(_) => (Physical::DOUBLE, None),
            Of::Truth(_) => (Physical::BOOLEAN, None),
            Of::Word(_) => (Physical::BYTE_ARRAY, Some(LogicalType::String)),
        };
        let field = Type::primitive_type_builder(column.name, physical)
            .with_repetition(Repetition::OPTIONAL)
            .with_logical_type(logical);
        field.build().map(Arc::new)
    });
    let fields = fields.collect::<ParquetResult<Vec<_>>>()?;
    let rows = Type::group_type_builder("rows").with_fields(fields);
    rows.build().map(Arc::new)
}

/// Writes groups of rows one after another. Equal rows give equal bytes.
fn write_groups(
    out: impl io::Write + Send,
    groups: impl Iterator<Item = io::Result<Vec<Vec<Cell>>>>,
    entries: Vec<KeyValue>,
) -> io::Result<()> {
    let properties = WriterProperties::builder()
        .set_compression(Compression::ZSTD(ZstdLevel::default()))
        .set_created_by(format!("searoom {}", env!("CARGO_PKG_VERSION")))
        .set_key_value_metadata(Some(entries));
    let properties = Arc::new(properties.build());
    let mut writer = SerializedFileWriter::new(out, schema()?, properties)?;
    for rows in groups {
        let rows = rows?;
        let mut group = writer.next_row_group()?;
        for (index, column) in COLUMNS.iter().enumerate() {
            let cells = rows.iter().map(|row| &row[index]);
            match column.of {
                Of::Count(_) => write_column::<Int64Type>(&mut group, cells, |cell| match cell {
                    Cell::Count(count) => *count,
                    _ => None,
                }),
                Of::Number(_) => write_column::<DoubleType>(&mut group, cells, |cell| match cell {
                    Cell::Number(number) => *number,
                    _ => None,
                }),
                Of::Truth(_) => write_column::<BoolType>(&mut group, cells, |cell| match cell {
                    Cell::Truth(truth) => *truth,
                    _ => None,
                }),
                Of::Word(_) => {
                    write_column::<ByteArrayType>(&mut group, cells, |cell| match cell {
                        Cell::Word(word) => word.as_deref().map(ByteArray::from),
                        _ => None,
                    })
                }
            }?;
        }
        group.close()?;
    }
    writer.close()?;
    Ok(())
}

fn write_column<'c, T: DataType>(
    group: &mut SerializedRowGroupWriter<impl io::Write + Send>,
    cells: impl Iterator<Item = &'c Cell>,
    value: impl Fn(&Cell) -> Option<T::T>,
) -> ParquetResult<()> {
    let values: Vec<Option<T::T>> = cells.map(value).collect();
    let levels: Vec<i16> = values.iter().map(|v| i16::from(v.is_some())).collect();
    let values: Vec<T::T> = values.into_iter().flatten().collect();
    let missing = || ParquetError::General("a column too few".to_owned());
    let mut writer = group.next_column()?.ok_or_else(missing)?;
    let typed = writer.typed::<T>();
    typed.write_batch(&values, Some(&levels), None)?;
    writer.close()
}

impl Part {
    /// Writes the part to a temporary file, which is synced and renamed.
    pub fn write(&self, file: &Path, shard: &str) -> Result<(), WriteError> {
        let entries = self.header.entries(&self.rows, shard);
        write_durably(file, |open| {
            write_groups(open, std::iter::once(Ok(self.rows.clone())), entries)
        })
    }

    /// Reads a part and checks its digest.
    pub fn read(file: &Path) -> Result<Self, PartError> {
        // a damaged footer may lead the reader anywhere
        let read = std::panic::catch_unwind(|| read(file));
        let read = read.unwrap_or_else(|_| Err("a footer that makes no sense".to_owned()));
        let named = |error: String| format!("{}: {error}", file.display());
        let part = read.map_err(|error| PartError::Damaged(named(error)))?;
        part.ok_or_else(|| PartError::OtherColumns(named("columns of another version".to_owned())))
    }
}

/// `None` for a part with other columns.
fn read(file: &Path) -> Result<Option<Part>, String> {
    let open = std::fs::File::open(file).map_err(|error| error.to_string())?;
    let unread = |error: ParquetError| format!("not a whole Parquet file ({error})");
    let reader = SerializedFileReader::new(open).map_err(unread)?;
    let meta = reader.metadata().file_metadata();
    let entry = |key: &str| {
        let entries = meta.key_value_metadata().into_iter().flatten();
        let name = format!("searoom.{key}");
        let mut named = entries.filter(|entry| entry.key == name);
        let value = named.next().and_then(|entry| entry.value.clone());
        value.ok_or_else(|| format!("no {name} in its footer: not a part of a campaign"))
    };
    let number = |key: &str| {
        let value = entry(key)?;
        value.parse::<u64>().map_err(|_| format!("{key} {value:?}"))
    };
    let format = entry("format")?;
    let names = meta.schema_descr().columns().iter().map(|c| c.name());
    if format != FORMAT || !names.eq(COLUMNS.iter().map(|column| column.name)) {
        return Ok(None);
    }
    let header = Header {
        hash: entry("specification")?,
        build: entry("build")?,
        rows: number("first")?..number("end")?,
    };
    let mut rows = Vec::new();
    for index in 0..reader.num_row_groups() {
        let group = reader.get_row_group(index).map_err(unread)?;
        rows.extend(read_group(group.as_ref()).map_err(unread)?);
    }
    if entry("digest")? != header.digest(&rows) {
        return Err("altered: its rows do not have the digest in its footer".to_owned());
    }
    let numbers = rows.iter().map(|row| match row[0] {
        Cell::Count(Some(row)) => u64::try_from(row).ok(),
        _ => None,
    });
    if !numbers.eq(header.rows.clone().map(Some)) {
        return Err("other rows than its footer says".to_owned());
    }
    Ok(Some(Part { header, rows }))
}

fn read_group(group: &dyn RowGroupReader) -> ParquetResult<Vec<Vec<Cell>>> {
    let count = usize::try_from(group.metadata().num_rows()).unwrap_or(0);
    let mut rows = vec![Vec::with_capacity(COLUMNS.len()); count];
    for (index, column) in COLUMNS.iter().enumerate() {
        let reader = group.get_column_reader(index)?;
        use parquet::column::reader::get_typed_column_reader as typed;
        let cells: Vec<Cell> = match column.of {
            Of::Count(_) => {
                read_column::<Int64Type, _>(typed(reader), count, |value| Ok(Cell::Count(value)))
            }
            Of::Number(_) => {
                read_column::<DoubleType, _>(typed(reader), count, |value| Ok(Cell::Number(value)))
            }
            Of::Truth(_) => {
                read_column::<BoolType, _>(typed(reader), count, |value| Ok(Cell::Truth(value)))
            }
            Of::Word(_) => read_column::<ByteArrayType, _>(typed(reader), count, |value| {
                let text = value.map(|bytes| bytes.as_utf8().map(str::to_owned));
                text.transpose().map(Cell::Word)
            }),
        }?;
        for (row, cell) in rows.iter_mut().zip(cells) {
            row.push(cell);
        }
    }
    Ok(rows)
}

fn read_column<T: DataType, C>(
    mut reader: ColumnReaderImpl<T>,
    count: usize,
    cell: impl Fn(Option<T::T>) -> ParquetResult<C>,
) -> ParquetResult<Vec<C>> {
    let (mut levels, mut values) = (Vec::new(), Vec::new());
    reader.read_records(count, Some(&mut levels), None, &mut values)?;
    if levels.len() != count {
        return Err(ParquetError::General("a column too short".to_owned()));
    }
    let mut values = values.into_iter();
    let cells = levels.iter().map(|level| match level {
        0 => cell(None),
        _ => cell(values.next()),
    });
    cells.collect()
}

/// Joins parts that are in order and whole, as one file of all rows.
pub(super) fn join(
    file: &Path,
    header: &Header,
    parts: &[std::path::PathBuf],
) -> Result<(), WriteError> {
    let mut parts = parts.iter();
    let groups = std::iter::from_fn(|| {
        let mut rows = Vec::new();
        while rows.len() < GROUP {
            match parts.next().map(|part| Part::read(part)) {
                Some(Ok(part)) => rows.extend(part.rows),
                Some(Err(error)) => return Some(Err(io::Error::other(error))),
                None => break,
            }
        }
        (!rows.is_empty()).then_some(Ok(rows))
    });
    let entries = header.entries(&[], "1/1").into_iter();
    let entries =
        entries.filter(|entry| !["searoom.cpu_s", "searoom.digest"].contains(&&*entry.key));
    let entries = entries.collect();
    write_durably(file, |open| write_groups(open, groups, entries))
}

/// The cells of a row that do not depend on the machine.
pub fn untimed(row: &[Cell]) -> &[Cell] {
    &row[..row.len().saturating_sub(TIMED)]
}

/// The columns in which two rows differ, apart from those that depend on the machine.
pub fn differing(a: &[Cell], b: &[Cell]) -> Vec<&'static str> {
    let pairs = COLUMNS.iter().zip(untimed(a).iter().zip(untimed(b)));
    let differ = pairs.filter(|(_, (a, b))| a != b);
    differ.map(|(column, _)| column.name).collect()
}
