//! The plan or comparison document in a recording: all of it but the time that planning took, which lies in a store of its own, so that
//! recordings of one scenario compare equal. It is compressed: as text it would be most of a long run's recording.

use std::io::{Read, Write};

use rerun::components::{Blob, MediaType};
use rerun::external::arrow::array::{Array, AsArray};
use rerun::external::arrow::datatypes::UInt8Type;
use rerun::log::Chunk;
use rerun::{DynamicArchetype, RecordingStreamResult, TextDocument};

use super::TIMING;
use super::recorder::Recorder;

/// What the document is in the recording.
const ARCHETYPE: &str = "Document";
const BLOB: &str = "blob";
const MEDIA_TYPE: &str = "media_type";
const ZSTANDARD: &str = "application/zstd";

/// Of twenty-two: those behind it gain a fortieth and take longer by half.
const LEVEL: i32 = 6;

/// Bytes, 1 GiB: more is no document of ours.
const DOCUMENT_BYTES: u64 = 1 << 30;

/// What stands before the time in the text of a document.
const KEY: &str = "\"plan_s\": ";

/// What stands in its place in the recording.
const NOTHING: &str = "null";

/// The text without its times, and the times as they stand there, a line each.
struct Parted {
    text: String,
    times: String,
}

impl Parted {
    /// The key is found as a key alone: within a text its quotes are escaped.
    fn of(document: &str) -> Self {
        let mut parts = document.split(KEY);
        let mut text = parts.next().unwrap_or_default().to_owned();
        let mut times = Vec::new();
        for part in parts {
            let is_end = |c: char| c.is_whitespace() || c == ',' || c == '}';
            let end = part.find(is_end).unwrap_or(part.len());
            times.push(&part[..end]);
            text.extend([KEY, NOTHING, &part[end..]]);
        }
        Self {
            text,
            times: times.join("\n"),
        }
    }
}

/// Puts the times back; where a time is lost there stays null.
pub(super) fn joined(text: &str, times: Option<&str>) -> String {
    let mut times = times.unwrap_or_default().lines();
    let key = format!("{KEY}{NOTHING}");
    let mut parts = text.split(&key);
    let mut whole = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        whole.extend([KEY, times.next().unwrap_or(NOTHING), part]);
    }
    whole
}

/// Logs the document after everything else, so that a recording that was cut short is without it.
pub(super) fn log_document(
    rec: &mut Recorder,
    entity: &str,
    packed: Vec<u8>,
) -> RecordingStreamResult<()> {
    rec.log_static(entity, &archetype(packed))
}

fn archetype(bytes: Vec<u8>) -> DynamicArchetype {
    DynamicArchetype::new(ARCHETYPE)
        .with_component::<Blob>(BLOB, [bytes])
        .with_component::<MediaType>(MEDIA_TYPE, [ZSTANDARD])
}

/// All of a document but its times. With a checksum: the file has none.
pub(super) fn packed(document: &str) -> std::io::Result<Vec<u8>> {
    let text = Parted::of(document).text;
    let mut encoder = zstd::Encoder::new(Vec::new(), LEVEL)?;
    encoder.include_checksum(true)?;
    // tables for this much: those for a text of any length take longer to clear than it does to pack
    encoder.set_pledged_src_size(Some(text.len() as u64))?;
    encoder.write_all(text.as_bytes())?;
    encoder.finish()
}

/// The text of a document without its times; an error in words where its bytes are not what was written.
pub(super) fn unpacked(chunks: &[Chunk]) -> Result<String, String> {
    let missing = || "the document has no bytes".to_owned();
    let chunk = chunks.last().ok_or_else(missing)?;
    let mut identifiers = chunk.components_identifiers();
    let blob = identifiers
        .find(|c| c.as_str() == format!("{ARCHETYPE}:{BLOB}"))
        .and_then(|c| chunk.components().get_array(c))
        .filter(|rows| !rows.is_empty())
        .map(|rows| rows.value(0))
        .ok_or_else(missing)?;
    let bytes = blob.as_list_opt::<i32>().filter(|l| !l.is_empty());
    let bytes = bytes.map(|l| l.value(0)).ok_or_else(missing)?;
    let bytes = bytes.as_primitive_opt::<UInt8Type>().ok_or_else(missing)?;
    let mut text = String::new();
    zstd::Decoder::new(bytes.values().as_ref())
        .and_then(|decoder| decoder.take(DOCUMENT_BYTES).read_to_string(&mut text))
        .map_err(|error| format!("the document is damaged: {error}"))?;
    Ok(text)
}

/// The time alone.
pub(super) fn timing(document: &str) -> RecordingStreamResult<Recorder> {
    let mut rec = Recorder::of_section(0);
    rec.log_static(TIMING, &TextDocument::new(Parted::of(document).times))?;
    Ok(rec)
}

#[cfg(test)]
mod tests {
    use rerun::AsComponents;

    use super::super::DOCUMENT;
    use super::*;

    #[test]
    fn a_document_comes_back_as_it_was() {
        for text in [
            "{\n  \"scenario\": \"\\\"plan_s\\\": 3\",\n  \"timing\": {\n    \"plan_s\": 0.0025\n  }\n}\n",
            "{\"timing\":{\"plan_s\": 1e-5},\"more\":[]}",
            "[{\"plan_s\": 1e-5},{\"plan_s\": null},{\"plan_s\": 0.0025}]",
            "{}",
        ] {
            let parted = Parted::of(text);
            assert!(!parted.text.contains("0.0025") && !parted.text.contains("1e-5"));
            assert_eq!(joined(&parted.text, Some(&parted.times)), text);
        }
        assert_eq!(joined("{\"plan_s\": null}", None), "{\"plan_s\": null}");
    }

    #[test]
    fn a_damaged_document_is_an_error() {
        let text = "[0.1234, 5.678]\n".repeat(500);
        let whole = packed(&text).expect("packs");
        assert!(whole.len() < text.len() / 20, "{}", whole.len());
        let chunk = |bytes: &[u8]| {
            let blob = archetype(bytes.to_vec()).as_serialized_batches();
            let columns = blob.into_iter().map(|batch| {
                let column = batch.partitioned([1]).expect("one row");
                (column.descriptor, column.list_array)
            });
            let (id, path) = (rerun::log::ChunkId::new(), DOCUMENT.into());
            let columns = columns.collect();
            Chunk::from_auto_row_ids(id, path, Default::default(), columns).expect("a chunk")
        };
        assert_eq!(unpacked(&[chunk(&whole)]), Ok(text));
        let mut changed = whole.clone();
        let last = changed.len() - 6;
        changed[last] ^= 1;
        for bytes in [&whole[..whole.len() - 5], &changed, b"", b"a text"] {
            let found = unpacked(&[chunk(bytes)]);
            assert!(found.is_err_and(|e| e.contains("damaged")), "{bytes:?}");
        }
        assert!(unpacked(&[]).is_err());
    }
}
