//! The Arrow messages of a payload, held against the bytes that are there before Arrow decodes them: it asks for as much memory as it is
//! told, and a program that gets none ends.
//!
//! Format: <https://arrow.apache.org/docs/format/Columnar.html#serialization-and-interprocess-communication-ipc>.

use flatbuffers::VerifierOptions;
use rerun::external::arrow::ipc::{
    CompressionType, MessageHeader, RecordBatch, root_as_message_with_opts,
};

/// What may stand before a length.
const CONTINUATION: [u8; 4] = [0xff; 4];

/// Bytes of the metadata that a byte of it stands for, where parts are shared: writers share no more than the layout of their tables.
const SHARED: usize = 4;
const LEAST_METADATA: usize = 1024;

/// Bytes before a compressed buffer: what it unpacks to. Less than nothing where it is not packed after all.
const PREFIX: usize = 8;

/// Bytes that a byte of a compressed buffer stands for at most, in a block of LZ4 and in one of Zstandard.
const LZ4_RATIO: u64 = 255;
const ZSTANDARD_RATIO: u64 = 1 << 15;

/// Values that a byte can hold.
const BITS: u64 = 8;

/// What is wrong with a stream, in words: a message, a buffer or a count that reaches beyond what is there. O(messages, buffers).
pub(super) fn check(stream: &[u8]) -> Result<(), String> {
    let mut rest = stream;
    while !rest.is_empty() {
        if rest.starts_with(&CONTINUATION) {
            rest = &rest[CONTINUATION.len()..];
        }
        let Some((length, behind)) = rest.split_first_chunk() else {
            return Err("an Arrow message ends within its length".to_owned());
        };
        let length = i32::from_le_bytes(*length);
        // the end of the stream
        if length == 0 {
            return Ok(());
        }
        let (metadata, behind) = part(behind, i64::from(length), "the metadata")?;
        let limits = VerifierOptions {
            max_tables: metadata.len(),
            max_apparent_size: SHARED * metadata.len() + LEAST_METADATA,
            ..VerifierOptions::default()
        };
        let message = root_as_message_with_opts(&limits, metadata)
            .map_err(|error| format!("the metadata of an Arrow message: {error}"))?;
        let (body, behind) = part(behind, message.bodyLength(), "the body")?;
        let batch = match message.header_type() {
            MessageHeader::RecordBatch => message.header_as_record_batch(),
            MessageHeader::DictionaryBatch => {
                message.header_as_dictionary_batch().and_then(|d| d.data())
            }
            _ => None,
        };
        if let Some(batch) = batch {
            check_batch(batch, body)?;
        }
        rest = behind;
    }
    Ok(())
}

/// As much of the rest as is said to belong to `what`, and what follows.
fn part<'a>(rest: &'a [u8], length: i64, what: &str) -> Result<(&'a [u8], &'a [u8]), String> {
    let within = usize::try_from(length)
        .ok()
        .and_then(|length| rest.split_at_checked(length));
    within.ok_or_else(|| {
        let left = rest.len();
        format!("{what} of an Arrow message is said to have {length} bytes, where {left} are left")
    })
}

fn check_batch(batch: RecordBatch, body: &[u8]) -> Result<(), String> {
    let codec = batch.compression().map(|compression| compression.codec());
    let (mut stored, mut held) = (0, 0);
    for buffer in batch.buffers().into_iter().flatten() {
        let (offset, length) = (buffer.offset(), buffer.length());
        let bytes = usize::try_from(offset)
            .ok()
            .zip(usize::try_from(length).ok())
            .and_then(|(offset, length)| body.get(offset..offset.checked_add(length)?));
        let Some(bytes) = bytes else {
            return Err(format!(
                "a buffer of {length} bytes at {offset} reaches out of a body of {}",
                body.len()
            ));
        };
        stored += bytes.len();
        held += match codec {
            Some(codec) if !bytes.is_empty() => unpacked(bytes, codec)?,
            _ => bytes.len() as u64,
        };
    }
    // shared ones may be copied each
    if stored > body.len() {
        return Err(format!(
            "buffers of {stored} bytes together in a body of {}",
            body.len()
        ));
    }
    let most = held.saturating_mul(BITS);
    let nodes = batch.nodes().into_iter().flatten();
    let counts = nodes.flat_map(|node| [node.length(), node.null_count()]);
    for count in counts.chain([batch.length()]) {
        if u64::try_from(count).is_ok_and(|count| count <= most) {
            continue;
        }
        return Err(format!(
            "{count} values are said to be in {held} bytes of an Arrow message"
        ));
    }
    Ok(())
}

/// Bytes that a compressed buffer says it unpacks to.
fn unpacked(buffer: &[u8], codec: CompressionType) -> Result<u64, String> {
    let Some((prefix, packed)) = buffer.split_first_chunk::<PREFIX>() else {
        return Err(format!("a packed buffer of {} bytes", buffer.len()));
    };
    let packed = packed.len() as u64;
    let ratio = match codec {
        CompressionType::LZ4_FRAME => LZ4_RATIO,
        CompressionType::ZSTD => ZSTANDARD_RATIO,
        _ => 0,
    };
    match i64::from_le_bytes(*prefix) {
        -1 => Ok(packed),
        size => u64::try_from(size)
            .ok()
            .filter(|size| *size <= ratio.saturating_mul(packed))
            .ok_or_else(|| format!("a buffer of {packed} bytes is said to unpack to {size} bytes")),
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use flatbuffers::FlatBufferBuilder;
    use rerun::external::arrow::array::{ArrayRef, Int64Array, NullArray, StringArray};
    use rerun::external::arrow::array::{RecordBatch as Batch, StructArray};
    use rerun::external::arrow::datatypes::{Fields, Int8Type};
    use rerun::external::arrow::ipc::writer::StreamWriter;
    use rerun::external::arrow::ipc::{
        BodyCompression, BodyCompressionArgs, Buffer, DictionaryBatch, DictionaryBatchArgs,
        FieldNode, Message, MessageArgs, MetadataVersion, RecordBatchArgs,
    };

    use super::*;

    /// A message with one batch, sound unless changed: 16 bytes in two buffers, for two values.
    #[derive(Clone)]
    struct Crafted {
        metadata_length: Option<i32>,
        body_length: i64,
        rows: i64,
        nodes: Vec<[i64; 2]>,
        buffers: Vec<[i64; 2]>,
        codec: Option<CompressionType>,
        body: Vec<u8>,
        in_dictionary: bool,
    }

    fn sound() -> Crafted {
        Crafted {
            metadata_length: None,
            body_length: 16,
            rows: 2,
            nodes: vec![[2, 0]],
            buffers: vec![[0, 0], [0, 16]],
            codec: None,
            body: vec![0; 16],
            in_dictionary: false,
        }
    }

    /// One buffer that says that it unpacks to `size` bytes, and has sixteen.
    fn packed(codec: CompressionType, size: i64) -> Crafted {
        Crafted {
            codec: Some(codec),
            body: [size.to_le_bytes().to_vec(), vec![0; 16]].concat(),
            body_length: 24,
            buffers: vec![[0, 0], [0, 24]],
            ..sound()
        }
    }

    impl Crafted {
        fn stream(&self) -> Vec<u8> {
            let mut builder = FlatBufferBuilder::new();
            let nodes: Vec<FieldNode> = self
                .nodes
                .iter()
                .map(|[length, nulls]| FieldNode::new(*length, *nulls))
                .collect();
            let buffers: Vec<Buffer> = self
                .buffers
                .iter()
                .map(|[offset, length]| Buffer::new(*offset, *length))
                .collect();
            let nodes = builder.create_vector(&nodes);
            let buffers = builder.create_vector(&buffers);
            let compression = self.codec.map(|codec| {
                let codec = BodyCompressionArgs {
                    codec,
                    ..Default::default()
                };
                BodyCompression::create(&mut builder, &codec)
            });
            let batch = RecordBatchArgs {
                length: self.rows,
                nodes: Some(nodes),
                buffers: Some(buffers),
                compression,
                ..Default::default()
            };
            let batch = RecordBatch::create(&mut builder, &batch);
            let (header_type, header) = if self.in_dictionary {
                let dictionary = DictionaryBatchArgs {
                    id: 1,
                    data: Some(batch),
                    isDelta: false,
                };
                let dictionary = DictionaryBatch::create(&mut builder, &dictionary);
                (MessageHeader::DictionaryBatch, dictionary.as_union_value())
            } else {
                (MessageHeader::RecordBatch, batch.as_union_value())
            };
            let message = MessageArgs {
                version: MetadataVersion::V5,
                header_type,
                header: Some(header),
                bodyLength: self.body_length,
                custom_metadata: None,
            };
            let message = Message::create(&mut builder, &message);
            builder.finish(message, None);
            let metadata = builder.finished_data();
            let length = self.metadata_length.unwrap_or(metadata.len() as i32);
            [&CONTINUATION, &length.to_le_bytes(), metadata, &self.body].concat()
        }
    }

    #[test]
    fn what_is_there_is_let_through() {
        let lz4 = CompressionType::LZ4_FRAME;
        let end = [CONTINUATION.to_vec(), vec![0; 4]].concat();
        let two = [sound().stream(), sound().stream(), end].concat();
        assert_eq!(check(&two), Ok(()));
        for crafted in [
            packed(lz4, -1),
            packed(lz4, 16 * 255),
            packed(CompressionType::ZSTD, 16 << 15),
        ] {
            assert_eq!(check(&crafted.stream()), Ok(()));
        }
    }

    /// A number that is not damaged where another is: every one of these would be believed.
    #[test]
    fn what_reaches_beyond_the_bytes_is_refused() {
        let all = |changed: Crafted| {
            let dictionary = Crafted {
                in_dictionary: true,
                ..changed.clone()
            };
            [changed, dictionary]
        };
        let far = [1 << 33, 1 << 50, i64::MAX, -1, i64::MIN];
        let mut wrong: Vec<(String, Crafted)> = Vec::new();
        let mut add = |name: String, change: &dyn Fn(&mut Crafted)| {
            let mut crafted = sound();
            change(&mut crafted);
            wrong.extend(all(crafted).map(|c| (name.clone(), c)));
        };
        for length in [1_000, i32::MAX, -1, i32::MIN] {
            add(format!("metadata {length}"), &|c| {
                c.metadata_length = Some(length);
            });
        }
        for number in far.into_iter().chain([17, 129]) {
            add(format!("body {number}"), &|c| c.body_length = number);
            add(format!("buffer at {number}"), &|c| c.buffers[1][0] = number);
            add(format!("buffer of {number}"), &|c| c.buffers[1][1] = number);
        }
        for number in far.into_iter().chain([129]) {
            add(format!("rows {number}"), &|c| c.rows = number);
            add(format!("values {number}"), &|c| c.nodes[0][0] = number);
            add(format!("nulls {number}"), &|c| c.nodes[0][1] = number);
        }
        add("both buffers in one place".to_owned(), &|c| {
            c.buffers[0] = [0, 16];
        });
        for codec in [CompressionType::LZ4_FRAME, CompressionType::ZSTD] {
            for size in [1 << 33, 1 << 50, i64::MAX, -2, i64::MIN] {
                add(format!("{codec:?} of {size}"), &|c| {
                    *c = packed(codec, size);
                });
            }
            add(format!("{codec:?} without a length"), &|c| {
                c.codec = Some(codec);
                c.buffers[1] = [0, 7];
            });
        }
        for (name, crafted) in wrong {
            assert!(check(&crafted.stream()).is_err(), "{name}");
            // nor behind a sound one
            let behind = [sound().stream(), crafted.stream()].concat();
            assert!(check(&behind).is_err(), "{name}, behind another");
        }
    }

    /// What Arrow writes passes, and no part of it does without the rest.
    #[test]
    fn what_arrow_writes_is_let_through() {
        let numbers: ArrayRef = Arc::new(Int64Array::from(vec![Some(1), None, Some(3)]));
        let texts: ArrayRef = Arc::new(StringArray::from(vec!["a", "", "a longer text"]));
        let keys: ArrayRef = Arc::new(
            ["a", "b", "a"]
                .into_iter()
                .collect::<rerun::external::arrow::array::DictionaryArray<Int8Type>>(),
        );
        let nothing: ArrayRef = Arc::new(NullArray::new(3));
        let empty: ArrayRef = Arc::new(StructArray::new_empty_fields(3, None));
        assert_eq!(empty.data_type().primitive_width(), None);
        let columns = [
            ("numbers", numbers),
            ("texts", texts),
            ("keys", keys),
            ("nothing", nothing),
            ("empty", empty),
        ];
        let batch = Batch::try_from_iter_with_nullable(columns.map(|(n, c)| (n, c, true)));
        let batch = batch.expect("columns");
        assert_ne!(batch.schema().fields(), &Fields::empty());
        let mut stream = Vec::new();
        let mut writer = StreamWriter::try_new(&mut stream, &batch.schema()).expect("a schema");
        for _ in 0..3 {
            writer.write(&batch).expect("writes");
        }
        writer.finish().expect("writes");
        assert_eq!(check(&stream), Ok(()));
        let none = Batch::new_empty(batch.schema());
        let mut stream = Vec::new();
        let mut writer = StreamWriter::try_new(&mut stream, &none.schema()).expect("a schema");
        writer.write(&none).expect("writes");
        writer.finish().expect("writes");
        assert_eq!(check(&stream), Ok(()));
    }
}
