//! Tables in Parquet: the rows of a file, as those of CSV.

use parquet::errors::{ParquetError, Result};
use parquet::file::reader::{ChunkReader, FileReader, SerializedFileReader};
use parquet::record::Field;

use crate::reader::{Format, Reader};
use crate::report::Report;
use crate::table::{Cells, Table};

impl Reader {
    /// Reads a whole file of Parquet by the names of its columns, as a table of CSV: see
    /// [`Reader::unread_columns`] and [`Reader::missing_column`]. Rows are dated by their own times.
    ///
    /// Fails for what is no file of Parquet, is compressed by other means than Snappy or Zstandard, or has no
    /// column of reports. The crate `parquet` may panic or take much memory for a file that was made to harm,
    /// so read files of a known origin.
    pub fn parquet<R: ChunkReader + 'static>(
        &mut self,
        file: R,
        mut found: impl FnMut(Report),
    ) -> Result<()> {
        let file = SerializedFileReader::new(file)?;
        let schema = file.metadata().file_metadata().schema_descr().root_schema();
        let names = schema.get_fields().iter().map(|field| field.name());
        let table = Table::new(names);
        let Some(table) = table else {
            return Err(ParquetError::General("no columns of reports".to_owned()));
        };
        self.format = Format::Table(Box::new((table, Cells::default())));
        for row in file.get_row_iter(None)? {
            let row = row?;
            let cells: Vec<String> = row.get_column_iter().map(|(_, cell)| text(cell)).collect();
            self.counts.lines += 1;
            let Format::Table(of) = &mut self.format else {
                break;
            };
            let report =
                of.0.report(cells.iter().map(String::as_str), &self.settings);
            match report {
                Ok(Some(report)) => {
                    self.counts.reports += 1;
                    found(report);
                }
                Ok(None) => {}
                Err(why) => self.counts.drop(why),
            }
        }
        Ok(())
    }
}

/// A cell as it would stand in CSV; empty where it is null.
fn text(cell: &Field) -> String {
    match cell {
        Field::Str(text) => text.clone(),
        // text without a mark that it is one
        Field::Bytes(bytes) => String::from_utf8_lossy(bytes.data()).into_owned(),
        Field::Float(number) => format!("{number:?}"),
        Field::Double(number) => format!("{number:?}"),
        Field::TimestampMillis(time) | Field::TimestampMicros(time) | Field::Long(time) => {
            time.to_string()
        }
        Field::Byte(number) => number.to_string(),
        Field::Short(number) => number.to_string(),
        Field::Int(number) => number.to_string(),
        Field::UByte(number) => number.to_string(),
        Field::UShort(number) => number.to_string(),
        Field::UInt(number) => number.to_string(),
        Field::ULong(number) => number.to_string(),
        _ => String::new(),
    }
}
