//! Tables in Parquet say what the same tables in CSV say.

use std::sync::Arc;

use parquet::basic::{Compression, ConvertedType, LogicalType, TimeUnit, Type as Physical};
use parquet::data_type::{ByteArray, ByteArrayType, DoubleType, FloatType, Int64Type};
use parquet::file::properties::WriterProperties;
use parquet::file::writer::SerializedFileWriter;
use parquet::schema::types::Type;
use rand::{Rng, SeedableRng};
use searoom_traffic::{Dropped, Reader, Report, Settings};

/// 2022-01-03 00:00:00 UTC.
const TIME: i64 = 1_641_168_000;

#[derive(Clone, Copy, PartialEq)]
enum Times {
    Text,
    Micros,
    Nanos,
}

/// Three ships, of which the last one is there twice and has no speed.
fn file(times: Times, compression: Compression, with_latitude: bool) -> Vec<u8> {
    let column = Type::primitive_type_builder;
    let time = match times {
        Times::Text => {
            column("base_date_time", Physical::BYTE_ARRAY).with_converted_type(ConvertedType::UTF8)
        }
        Times::Micros => column("base_date_time", Physical::INT64).with_logical_type(Some(
            LogicalType::Timestamp {
                is_adjusted_to_u_t_c: true,
                unit: TimeUnit::MICROS,
            },
        )),
        Times::Nanos => column("base_date_time", Physical::INT64).with_logical_type(Some(
            LogicalType::Timestamp {
                is_adjusted_to_u_t_c: true,
                unit: TimeUnit::NANOS,
            },
        )),
    };
    let latitude = if with_latitude { "latitude" } else { "y" };
    let fields = [
        column("mmsi", Physical::INT64),
        time,
        column("longitude", Physical::DOUBLE),
        column(latitude, Physical::DOUBLE),
        column("sog", Physical::FLOAT),
        column("vessel_name", Physical::BYTE_ARRAY).with_converted_type(ConvertedType::UTF8),
        column("draft", Physical::DOUBLE),
    ];
    let fields = fields.map(|field| Arc::new(field.build().expect("a column")));
    let schema = Type::group_type_builder("schema").with_fields(fields.to_vec());
    let schema = Arc::new(schema.build().expect("a schema"));
    let properties = WriterProperties::builder()
        .set_compression(compression)
        .build();
    let mut bytes = Vec::new();
    let mut writer =
        SerializedFileWriter::new(&mut bytes, schema, Arc::new(properties)).expect("a writer");
    let mut rows = writer.next_row_group().expect("rows");
    let text = |text: &str| ByteArray::from(text);
    macro_rules! write {
        ($kind:ty, $values:expr, $levels:expr) => {{
            let mut column = rows.next_column().expect("written").expect("a column");
            let levels: Option<&[i16]> = $levels;
            column
                .typed::<$kind>()
                .write_batch($values, levels, None)
                .expect("written");
            column.close().expect("written");
        }};
    }
    let all: Option<&[i16]> = Some(&[1, 1, 1, 1]);
    write!(
        Int64Type,
        &[366_000_001, 366_000_002, 366_000_003, 366_000_003],
        all
    );
    match times {
        Times::Text => {
            let time = text("2022-01-03 00:00:00");
            write!(
                ByteArrayType,
                &[time.clone(), time.clone(), time.clone(), time],
                all
            );
        }
        Times::Micros => write!(Int64Type, &[TIME * 1_000_000; 4], all),
        Times::Nanos => write!(Int64Type, &[TIME * 1_000_000_000; 4], all),
    }
    write!(DoubleType, &[-74.01732, 0.00005, -74.0, -74.0], all);
    write!(DoubleType, &[40.66947, 40.6, 40.0, 40.0], all);
    write!(FloatType, &[12.0, 0.1], Some(&[1, 1, 0, 0]));
    write!(
        ByteArrayType,
        &[text("ALFA"), text("BRAVO")],
        Some(&[1, 1, 0, 0])
    );
    write!(DoubleType, &[], Some(&[0, 0, 0, 0]));
    rows.close().expect("written");
    writer.close().expect("written");
    bytes
}

fn read(bytes: Vec<u8>) -> (Vec<Report>, Reader) {
    let mut reader = Reader::new(Settings::default());
    let mut reports = Vec::new();
    let read = reader.parquet(bytes::Bytes::from(bytes), |report| reports.push(report));
    read.expect("a table");
    (reports, reader)
}

#[test]
fn a_file_says_what_its_table_says() {
    let csv = b"mmsi,base_date_time,longitude,latitude,sog,vessel_name,draft\n\
        366000001,2022-01-03 00:00:00,-74.01732,40.66947,12.0,ALFA,\n\
        366000002,2022-01-03 00:00:00,0.000050000,40.6,0.1,BRAVO,\n\
        366000003,2022-01-03 00:00:00,-74.0,40.0,,,\n";
    let mut same = Vec::new();
    Reader::new(Settings::default()).bytes(csv, 0.0, |report| same.push(report));
    assert_eq!(same.len(), 3);
    for times in [Times::Text, Times::Micros, Times::Nanos] {
        for compression in [
            Compression::UNCOMPRESSED,
            Compression::SNAPPY,
            Compression::ZSTD(Default::default()),
        ] {
            let (reports, reader) = read(file(times, compression, true));
            assert_eq!(reports, same, "{compression}");
            let counts = reader.counts();
            assert_eq!((counts.lines, counts.reports), (4, 3));
            assert_eq!(counts.dropped(Dropped::Again), 1);
            assert_eq!(reader.unread_columns(), ["draft"]);
        }
    }
}

#[test]
fn a_file_that_lacks_a_column_says_so() {
    let (reports, reader) = read(file(Times::Text, Compression::SNAPPY, false));
    assert!(reports.is_empty() && reader.counts().dropped(Dropped::NoColumn) == 4);
    assert_eq!(reader.missing_column().expect("a column").field, "latitude");
    let mut reader = Reader::new(Settings::default());
    let noise = bytes::Bytes::from_static(b"noise");
    assert!(reader.parquet(noise, |_| {}).is_err());
}

/// A file that was damaged by chance is an error or another table. The crate promises no more.
#[test]
fn damaged_files_are_errors() {
    let whole = file(Times::Micros, Compression::SNAPPY, true);
    let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(5);
    let mut failed = 0;
    for _ in 0..2000 {
        let mut bytes = whole.clone();
        bytes.truncate(rng.random_range(0..bytes.len()));
        let mut reader = Reader::new(Settings::default());
        failed += u32::from(reader.parquet(bytes::Bytes::from(bytes), |_| {}).is_err());
    }
    assert_eq!(failed, 2000);
}
