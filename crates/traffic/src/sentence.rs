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

/// A sentence whose check sum is right.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Sentence<'l> {
    pub tag: Tag<'l>,
    /// What stands between the first character and the check sum.
    body: &'l [u8],
    /// What of the line was ignored: a tag block with a wrong check sum is as none.
    pub ignored: Option<Dropped>,
}

/// The sentence in a line without its line end.
#[inline]
pub(crate) fn sentence(line: &[u8]) -> Result<Sentence<'_>, Dropped> {
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
    Ok(Sentence {
        tag: found,
        body,
        ignored,
    })
}

impl<'l> Sentence<'l> {
    /// Three letters after a talker of two, of which stations have others than AI. A maker's own sentences,
    /// which begin with P, have none.
    #[inline]
    pub fn formatter(&self) -> Option<&'l [u8; 3]> {
        let (talker, rest) = self.body.split_first_chunk::<2>()?;
        let (formatter, fields) = rest.split_first_chunk::<3>()?;
        (talker[0] != b'P' && fields.first() == Some(&b',')).then_some(formatter)
    }

    /// The part of a message of AIS.
    #[inline]
    pub fn part(&self, is_own: bool) -> Result<Part<'l>, Dropped> {
        let mut fields = self.body.split(|byte| *byte == b',').skip(1);
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
                Ok(Part {
                    tag: self.tag,
                    is_own,
                    count,
                    number,
                    sequence,
                    channel,
                    armoured,
                    fill,
                })
            }
            _ => Err(Dropped::Fields),
        }
    }

    pub fn fields(&self) -> Result<Fields<'l>, Dropped> {
        let mut fields = [&[][..]; MOST_FIELDS];
        let mut len = 0;
        for field in self.body.split(|byte| *byte == b',') {
            *fields.get_mut(len).ok_or(Dropped::Fields)? = field.trim_ascii();
            len += 1;
        }
        Ok(Fields { fields, len })
    }
}

/// Most fields of a sentence: TLB has pairs of a number and a name in 82 bytes.
const MOST_FIELDS: usize = 48;

/// The fields of a sentence, from 1 on. Those that are not there are empty.
pub(crate) struct Fields<'l> {
    fields: [&'l [u8]; MOST_FIELDS],
    len: usize,
}

impl<'l> Fields<'l> {
    /// Number of fields, with the sentence's name.
    pub fn len(&self) -> usize {
        self.len
    }

    pub fn bytes(&self, at: usize) -> &'l [u8] {
        self.fields.get(at).copied().unwrap_or_default()
    }

    /// A question mark for what is no text.
    pub fn text(&self, at: usize) -> &'l str {
        str::from_utf8(self.bytes(at)).unwrap_or("?")
    }

    pub fn letter(&self, at: usize) -> Option<u8> {
        match self.bytes(at) {
            [letter] => Some(*letter),
            [] => None,
            _ => Some(b'?'),
        }
    }

    /// `None` for an empty field.
    pub fn number(&self, at: usize) -> Result<Option<f64>, Dropped> {
        Ok(self.step(at)?.map(|(number, _)| number))
    }

    /// A number and half a step of its last digit; `None` for an empty field.
    pub fn step(&self, at: usize) -> Result<Option<(f64, f64)>, Dropped> {
        let text = self.text(at);
        match text.is_empty() {
            true => Ok(None),
            false => decimal(text).map(Some).ok_or(Dropped::Fields),
        }
    }
}

/// A number without an exponent, and half a step of its last digit.
pub(crate) fn decimal(text: &str) -> Option<(f64, f64)> {
    let is_plain = |byte: u8| byte.is_ascii_digit() || matches!(byte, b'.' | b'-' | b'+');
    if text.len() > 24 || !text.bytes().all(is_plain) {
        return None;
    }
    let number: f64 = text.parse().ok()?;
    let decimals = text
        .split_once('.')
        .map_or(0, |(_, decimals)| decimals.len());
    Some((number, 0.5 * 0.1_f64.powi(decimals as i32)))
}
