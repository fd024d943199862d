//! The frames of a file, without their contents.

use std::ops::Range;

use rerun::external::re_log_encoding::{
    Decodable, DecoderTransport, MessageHeader, MessageKind, StreamFooter, StreamHeader,
};

/// The most that LZ4 packs into one byte.
const UNPACKED: u64 = 255;

/// True where the messages follow one another to an end that has its own checksum right, and none
/// of them unpacks to more than the file can hold. O(bytes).
///
/// A file that was cut off has no end. One that lost or gained bytes has its end in another place
/// than the end tells. A changed digit of a message is not seen.
pub fn are_whole(bytes: &[u8]) -> bool {
    end(bytes).is_some_and(|end| is_footed(bytes, &end)) && is_packed(bytes)
}

/// The contents of the message that ends the file.
fn end(bytes: &[u8]) -> Option<Range<usize>> {
    let mut at = StreamHeader::ENCODED_SIZE_BYTES;
    loop {
        let start = at + MessageHeader::ENCODED_SIZE_BYTES;
        let header = MessageHeader::from_rrd_bytes(bytes.get(at..start)?).ok()?;
        at = start.checked_add(usize::try_from(header.len).ok()?)?;
        bytes.get(start..at)?;
        if header.kind == MessageKind::End {
            return Some(start..at);
        }
    }
}

/// True where nothing but the checksum of the last message follows it.
fn is_footed(bytes: &[u8], end: &Range<usize>) -> bool {
    let (last, rest) = (&bytes[end.clone()], &bytes[end.end..]);
    // programs before Rerun 0.28 write neither
    if last.is_empty() && rest.is_empty() {
        return true;
    }
    if rest.len() != StreamFooter::ENCODED_SIZE_BYTES {
        return false;
    }
    let sum = StreamFooter::compute_crc(last);
    StreamFooter::from_rrd_bytes(rest).is_ok_and(|footer| {
        footer.entries.iter().all(|entry| {
            let place = entry.rrd_footer_byte_span_from_start_excluding_header;
            place.start == end.start as u64
                && place.len == last.len() as u64
                && entry.crc_excluding_header == sum
        })
    })
}

/// True where all messages together unpack to no more than LZ4 can pack into the file.
fn is_packed(bytes: &[u8]) -> bool {
    let Ok(messages) = DecoderTransport::decode_eager(bytes) else {
        return false;
    };
    let mut left = UNPACKED * bytes.len() as u64;
    for message in messages {
        let size = message.map(|message| message.byte_size_uncompressed());
        let Some(rest) = size.ok().and_then(|size| left.checked_sub(size)) else {
            return false;
        };
        left = rest;
    }
    true
}
