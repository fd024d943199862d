//! Sentences of NMEA 0183 with their tag blocks.

use crate::counts::Dropped;

/// The longest line that is read, bytes: a sentence has at most 82, and a tag block 80 more.
pub(crate) const MOST_BYTES: usize = 512;

/// Times of tag blocks above this are milliseconds: as seconds it would be the year 5138.
const MILLISECONDS_FROM: f64 = 1e11;

/// What stands before a sentence between backslashes.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Tag<'l> {
    /// `c:`, seconds of Unix time.
    pub time: Option<f64>,
    /// `s:`
    pub source: Option<&'l [u8]>,
    /// Number of the group, the last part of `g:`.
    pub group: Option<u32>,
}

/// A part of a message of AIS.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Part<'l> {
    pub tag: Tag<'l>,
    /// True for VDO.
    pub is_own: bool,
    pub count: u8,
    /// From 1 on.
    pub number: u8,
    pub sequence: Option<u8>,
    pub channel: Option<u8>,
    pub armoured: &'l [u8],
    /// Bits of the last character that do not count.
    pub fill: u8,
}

/// The exclusive or of all bytes.
fn check_sum(bytes: &[u8]) -> u8 {
    bytes.iter().fold(0, |sum, byte| sum ^ byte)
}

/// Splits bytes at the last `*`, and compares the two hexadecimal digits after it with the sum before it.
fn checked(bytes: &[u8]) -> Option<&[u8]> {
    let [body @ .., b'*', high, low] = bytes else {
        return None;
    };
    let digit = |byte: u8| (byte as char).to_digit(16);
    let said = digit(*high)? * 16 + digit(*low)?;
    (u32::from(check_sum(body)) == said).then_some(body)
}

fn number(digits: &[u8]) -> Option<u32> {
    if digits.is_empty() || digits.len() > 9 {
        return None;
    }
    digits.iter().try_fold(0, |number, byte| {
        byte.is_ascii_digit()
            .then(|| number * 10 + u32::from(byte - b'0'))
    })
}

/// A tag block without its backslashes; `None` where its check sum is wrong.
fn tag(block: &[u8]) -> Option<Tag<'_>> {
    let body = checked(block)?;
    let mut tag = Tag::default();
    for field in body.split(|byte| *byte == b',') {
        match field {
            [b'c', b':', digits @ ..] => {
                let text = str::from_utf8(digits).ok();
                let time = text.and_then(|text| text.parse::<f64>().ok());
                let time = time.filter(|time| (0.0..1e15).contains(time));
                tag.time = time.map(|time| match time >= MILLISECONDS_FROM {
                    true => 1e-3 * time,
                    false => time,
                });
            }
            [b's', b':', source @ ..] => tag.source = Some(source),
            [b'g', b':', group @ ..] => {
                tag.group = group.rsplit(|byte| *byte == b'-').next().and_then(number);
            }
            // the first field of a group may also be written `1G2:341`
            [digit, b'G', rest @ ..] if digit.is_ascii_digit() => {
                let mut parts = rest.split(|byte| *byte == b':');
                tag.group = parts.nth(1).and_then(number);
            }
            _ => {}
        }
    }
    Some(tag)
}

/// The part of a message in a line without its line end, and what of the line was ignored: a tag block with a
/// wrong check sum is as none.
pub(crate) fn part(line: &[u8]) -> Result<(Part<'_>, Option<Dropped>), Dropped> {
    let mut rest = line;
    let (mut found, mut ignored) = (Tag::default(), None);
    if let [b'\\', after @ ..] = rest {
        let end = after.iter().position(|byte| *byte == b'\\');
        let end = end.ok_or(Dropped::NoSentence)?;
        match tag(&after[..end]) {
            Some(tag) => found = tag,
            None => ignored = Some(Dropped::TagCheckSum),
        }
        rest = &after[end + 1..];
    }
    let ([b'!', rest @ ..] | [b'$', rest @ ..]) = rest else {
        return Err(Dropped::NoSentence);
    };
    let body = checked(rest.trim_ascii_end()).ok_or(Dropped::CheckSum)?;
    let mut fields = body.split(|byte| *byte == b',');
    // a talker of two letters, of which stations have others than AI
    let is_own = match fields.next() {
        Some([_, _, b'V', b'D', b'M']) => false,
        Some([_, _, b'V', b'D', b'O']) => true,
        _ => return Err(Dropped::OtherSentence),
    };
    let digit = |field: Option<&[u8]>| match field {
        Some([byte @ b'0'..=b'9']) => Some(byte - b'0'),
        _ => None,
    };
    let (count, number) = (digit(fields.next()), digit(fields.next()));
    let sequence = digit(fields.next());
    let channel = fields.next().and_then(|field| field.first().copied());
    let (armoured, fill) = (fields.next(), digit(fields.next()));
    match (count, number, armoured, fill) {
        (Some(count @ 1..), Some(number @ 1..), Some(armoured), Some(fill @ 0..=5))
            if number <= count =>
        {
            let part = Part {
                tag: found,
                is_own,
                count,
                number,
                sequence,
                channel,
                armoured,
                fill,
            };
            Ok((part, ignored))
        }
        _ => Err(Dropped::Fields),
    }
}
