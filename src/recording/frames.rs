//! The messages of a file, before any is decoded: the decoder is silent about a file that was cut.

use re_protos::common::v1alpha1::Compression;
use re_protos::external::prost::Message;
use re_protos::log_msg::v1alpha1::ArrowMsg;

/// "RRF2", a version, options.
pub(super) const HEADER: usize = 12;

/// A kind and a length, little-endian.
const MESSAGE: usize = 16;

/// The kind of the last message where there is a footer.
const END: u64 = 0;

/// The kind of a message with a chunk.
const CHUNK: u64 = 2;

/// Bytes that a byte of LZ4 stands for at most, and that a message is longer by all the same.
const LARGEST_RATIO: u64 = 255;
const SLACK: u64 = 64;

/// How the files begin.
const MAGIC: &[u8] = b"RRF2";

/// True for what begins as recordings do.
pub fn is_recording(bytes: &[u8]) -> bool {
    bytes.starts_with(MAGIC)
}

/// What is wrong with a file as a chain of messages, in words; `None` for a chain that ends where the file does.
pub(super) fn fault(bytes: &[u8]) -> Option<String> {
    let total = bytes.len();
    if bytes.is_empty() {
        return Some("an empty file".to_owned());
    }
    if !is_recording(bytes) && !MAGIC.starts_with(bytes) {
        return Some("no Rerun recording: it does not begin with RRF2".to_owned());
    }
    if total < HEADER {
        return Some(format!("cut off within the header, after {total} bytes"));
    }
    if total == HEADER {
        return Some("cut off behind the header: nothing is in it".to_owned());
    }
    let number = |at: usize| -> Option<u64> {
        let bytes = bytes.get(at..at + 8)?;
        Some(u64::from_le_bytes(bytes.try_into().ok()?))
    };
    let mut at = HEADER;
    while at < total {
        let (Some(kind), Some(length)) = (number(at), number(at + 8)) else {
            return Some(format!("cut off within a message, after {total} bytes"));
        };
        let start = at + MESSAGE;
        let end = usize::try_from(length)
            .ok()
            .and_then(|n| start.checked_add(n));
        match end.filter(|end| *end <= total) {
            // behind the footer comes a frame of another form, and a further stream may follow
            Some(_) if kind == END => return None,
            // the decoder would ask for as much memory as it is told
            Some(end) if kind == CHUNK && is_beyond_packing(&bytes[start..end]) => {
                return Some(format!(
                    "damaged: a message at byte {at} of {total} is said to unpack to more than it can"
                ));
            }
            Some(end) => at = end,
            None => {
                return Some(format!(
                    "cut off or damaged: a message at byte {at} of {total} is said to have {length} bytes"
                ));
            }
        }
    }
    None
}

/// True of a packed chunk that says it is larger than anything of its length can be. What is no chunk at all is left to the decoder.
fn is_beyond_packing(message: &[u8]) -> bool {
    ArrowMsg::decode(message).is_ok_and(|chunk| {
        let most = LARGEST_RATIO * chunk.payload.len() as u64 + SLACK;
        chunk.compression == i32::from(Compression::Lz4) && chunk.uncompressed_size > most
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn message(kind: u64, length: u64, payload: usize) -> Vec<u8> {
        let mut bytes = kind.to_le_bytes().to_vec();
        bytes.extend(length.to_le_bytes());
        bytes.resize(bytes.len() + payload, 7);
        bytes
    }

    #[test]
    fn a_chain_ends_where_the_file_ends() {
        let header = b"RRF2\0\x24\x03\0\x01\x02\0\0";
        let with = |rest: &[Vec<u8>]| [header.to_vec(), rest.concat()].concat();
        let whole = with(&[message(1, 5, 5), message(2, 0, 0)]);
        assert_eq!(fault(&whole), None);
        // behind the end there may be a footer
        assert_eq!(
            fault(&with(&[message(2, 3, 3), message(0, 4, 4), vec![1; 5]])),
            None
        );
        for end in 0..whole.len() {
            let at_a_joint = end == HEADER + MESSAGE + 5;
            assert_eq!(fault(&whole[..end]).is_none(), at_a_joint, "{end}");
        }
        for wrong in [
            with(&[message(2, u64::MAX, 3)]),
            with(&[message(2, 4, 3)]),
            b"RIFF and more".to_vec(),
        ] {
            assert!(fault(&wrong).is_some());
        }
    }

    #[test]
    fn a_chunk_that_says_it_is_larger_than_it_can_be_is_not_decoded() {
        let chunk = |uncompressed_size: u64| {
            let chunk = ArrowMsg {
                compression: Compression::Lz4.into(),
                payload: vec![0; 100].into(),
                uncompressed_size,
                ..ArrowMsg::default()
            };
            let payload = chunk.encode_to_vec();
            let mut bytes = b"RRF2\0\x24\x03\0\x01\x02\0\0".to_vec();
            bytes.extend(CHUNK.to_le_bytes());
            bytes.extend((payload.len() as u64).to_le_bytes());
            [bytes, payload].concat()
        };
        assert_eq!(fault(&chunk(20_000)), None);
        assert!(fault(&chunk(1 << 50)).is_some_and(|f| f.contains("damaged")));
    }
}
