//! The messages of a file, before any is decoded: the library's own reader is silent about a file that was cut, and stops where damage
//! looks like the end of a stream.

use rerun::external::re_log_encoding::{
    CrateVersion, Decodable, MessageHeader, MessageKind, RRD_FOURCC, StreamFooter, StreamHeader,
};

/// "RRF2", a version, options.
pub(super) const HEADER: usize = StreamHeader::ENCODED_SIZE_BYTES;

/// A kind and a length, little-endian.
const MESSAGE: usize = MessageHeader::ENCODED_SIZE_BYTES;

/// What may stand behind the last message, and where in it its marks stand.
const FOOTER: usize = StreamFooter::ENCODED_SIZE_BYTES;
const FOOTER_MARKS: std::ops::Range<usize> = 20..28;

/// True for what begins as recordings do.
pub fn is_recording(bytes: &[u8]) -> bool {
    bytes.starts_with(&RRD_FOURCC)
}

/// One message, as bytes.
#[derive(Debug, Clone, Copy)]
pub(super) struct Frame<'a> {
    /// Where in the file it begins.
    pub at: usize,
    pub kind: MessageKind,
    pub payload: &'a [u8],
    /// Of the Rerun that wrote it.
    pub version: CrateVersion,
}

/// The messages of all streams of a file.
#[derive(Debug)]
pub(super) struct Frames<'a> {
    /// In the order of the file, without those that end a stream.
    pub messages: Vec<Frame<'a>>,
    /// Whether a stream has a footer. Those of Searoom have none.
    pub is_footed: bool,
}

/// Cuts a file into its messages; what is wrong with it as a chain of such, in words. O(messages).
pub(super) fn frames(bytes: &[u8]) -> Result<Frames<'_>, String> {
    let total = bytes.len();
    if bytes.is_empty() {
        return Err("an empty file".to_owned());
    }
    if !is_recording(bytes) && !RRD_FOURCC.starts_with(bytes) {
        return Err("no Rerun recording: it does not begin with RRF2".to_owned());
    }
    if total == HEADER {
        return Err("cut off behind the header: nothing is in it".to_owned());
    }
    let mut found = Frames {
        messages: Vec::new(),
        is_footed: false,
    };
    let (mut at, mut version) = (HEADER, version_of(bytes, 0)?);
    while at < total {
        // streams may follow one another
        if is_recording(&bytes[at..]) {
            version = version_of(bytes, at)?;
            at += HEADER;
            continue;
        }
        let Some(header) = bytes.get(at..at + MESSAGE) else {
            return Err(format!("cut off within a message, after {total} bytes"));
        };
        let header = MessageHeader::from_rrd_bytes(header)
            .map_err(|_| format!("damaged: no message begins at byte {at} of {total}"))?;
        let start = at + MESSAGE;
        let end = usize::try_from(header.len)
            .ok()
            .and_then(|length| start.checked_add(length));
        let Some(end) = end.filter(|end| *end <= total) else {
            let length = header.len;
            return Err(format!(
                "cut off or damaged: a message at byte {at} of {total} is said to have {length} bytes"
            ));
        };
        if header.kind == MessageKind::End {
            let footed = behind_the_end(bytes, end, header.len > 0)?;
            found.is_footed |= footed > end;
            at = footed;
            continue;
        }
        found.messages.push(Frame {
            at,
            kind: header.kind,
            payload: &bytes[start..end],
            version,
        });
        at = end;
    }
    Ok(found)
}

fn version_of(bytes: &[u8], at: usize) -> Result<CrateVersion, String> {
    let Some(header) = bytes.get(at..at + HEADER) else {
        let total = bytes.len();
        return Err(format!("cut off within the header, after {total} bytes"));
    };
    StreamHeader::from_rrd_bytes(header)
        .and_then(|header| header.to_version_and_options())
        .map(|(version, _)| version)
        .map_err(|error| format!("damaged: {error}"))
}

/// Where a stream may follow one whose messages end at `at`: behind its footer, which older ones are without.
fn behind_the_end(bytes: &[u8], at: usize, has_footer: bool) -> Result<usize, String> {
    let rest = &bytes[at..];
    let marks = [RRD_FOURCC, StreamFooter::RRD_IDENTIFIER].concat();
    let is_footed = rest.get(..FOOTER).is_some_and(|f| f[FOOTER_MARKS] == marks);
    let end = if is_footed { at + FOOTER } else { at };
    let rest = &bytes[end..];
    if is_footed >= has_footer && (rest.is_empty() || is_recording(rest)) {
        return Ok(end);
    }
    let total = bytes.len();
    Err(format!(
        "cut off or damaged: neither a footer nor a stream at byte {end} of {total}, behind the last message"
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    const STREAM: &[u8] = b"RRF2\0\x24\x03\0\x01\x02\0\0";

    fn message(kind: u64, length: u64, payload: usize) -> Vec<u8> {
        let mut bytes = kind.to_le_bytes().to_vec();
        bytes.extend(length.to_le_bytes());
        bytes.resize(bytes.len() + payload, 7);
        bytes
    }

    fn footer() -> Vec<u8> {
        [vec![1; 20], b"RRF2FOOT".to_vec(), vec![1, 0, 0, 0]].concat()
    }

    fn with(rest: &[Vec<u8>]) -> Vec<u8> {
        [STREAM.to_vec(), rest.concat()].concat()
    }

    #[test]
    fn a_chain_ends_where_the_file_ends() {
        let whole = with(&[message(1, 5, 5), message(2, 0, 0)]);
        let found = frames(&whole).expect("whole");
        let lengths: Vec<usize> = found.messages.iter().map(|m| m.payload.len()).collect();
        assert_eq!((lengths, found.is_footed), (vec![5, 0], false));
        for end in 0..whole.len() {
            let at_a_joint = end == HEADER + MESSAGE + 5;
            assert_eq!(frames(&whole[..end]).is_ok(), at_a_joint, "{end}");
        }
        for wrong in [
            with(&[message(2, u64::MAX, 3)]),
            with(&[message(2, 4, 3)]),
            // a kind that there is not: the library's reader would take it for the end
            with(&[message(4, 3, 3), message(2, 3, 3)]),
            with(&[message(1 << 40, 3, 3)]),
            b"RIFF and more".to_vec(),
            [b"RRF2\0\x24\x03\0\x09\x09\0\0".to_vec(), message(2, 3, 3)].concat(),
        ] {
            assert!(frames(&wrong).is_err());
        }
    }

    #[test]
    fn streams_follow_one_another_and_nothing_else_does() {
        let bare = with(&[message(2, 3, 3)]);
        let ended = with(&[message(2, 3, 3), message(0, 0, 0)]);
        let footed = with(&[message(2, 3, 3), message(0, 4, 4), footer()]);
        for (streams, messages, is_footed) in [
            (vec![&ended], 1, false),
            (vec![&footed], 1, true),
            (vec![&bare, &ended, &bare], 3, false),
            (vec![&ended, &footed, &bare, &footed], 4, true),
        ] {
            let bytes: Vec<u8> = streams.into_iter().flatten().copied().collect();
            let found = frames(&bytes).expect("streams");
            assert_eq!(
                (found.messages.len(), found.is_footed),
                (messages, is_footed)
            );
        }
        for wrong in [
            [&ended[..], &[1; 5]].concat(),
            [&ended[..], &message(2, 3, 3)].concat(),
            [&footed[..], &[1; 5]].concat(),
            footed[..footed.len() - 1].to_vec(),
            footed[..footed.len() - FOOTER].to_vec(),
            [&footed[..], STREAM, &message(2, u64::MAX, 3)].concat(),
        ] {
            assert!(frames(&wrong).is_err(), "{}", wrong.len());
        }
    }
}
