//! The checksum of a recording.
//!
//! Rerun's format has none: its decoder believes every length and every digit. The first message of
//! a recording of Searoom opens it. Where that message names the program, it also holds the number
//! of all bytes and the checksum of all others. They are tested before anything is decoded. The
//! checksum detects accidents; it is no signature.
//!
//! It is not in a store of its own: Rerun's tools activate every layout that they find
//! (`findings/rerun-merge-activates-every-blueprint.sh`). They write a recording again in other
//! bytes, so that its checksum is gone; see [`Checksum::Gone`].

use std::ops::Range;

use rerun::external::re_log_types::external::re_tuid::Tuid;
use rerun::external::re_log_types::{LogMsg, SetStoreInfo, StoreId, StoreInfo, StoreSource};

use super::APPLICATION;
use crate::document::Checksum;

const PREFIX: &str = "checksum_";
const DIGITS: usize = 16;
/// Between the checksum and the number of bytes. Recordings of earlier versions end before it.
const LENGTH: &str = "_bytes_";
/// Digits of the number of bytes.
const LENGTH_DIGITS: usize = 12;

/// The first message ends within these bytes.
const HEAD: usize = 256;

/// FNV-1a with 64 bits (draft-eastlake-fnv). A change of a single byte always changes it.
pub fn checksum(parts: &[&[u8]]) -> u64 {
    let bytes = parts.iter().copied().flatten();
    bytes.fold(0xcbf2_9ce4_8422_2325, |sum, byte| {
        (sum ^ u64::from(*byte)).wrapping_mul(0x0100_0000_01b3)
    })
}

/// The message that opens a store.
pub fn opening(store_id: StoreId) -> LogMsg {
    opened(store_id, APPLICATION.to_owned())
}

/// The first message of a recording, with zeros in place of its numbers.
pub fn unsealed(store_id: StoreId) -> LogMsg {
    let seal = format!("{PREFIX}{:0DIGITS$}{LENGTH}{:0LENGTH_DIGITS$}", 0, 0);
    opened(store_id, format!("{APPLICATION} {seal}"))
}

fn opened(store_id: StoreId, source: String) -> LogMsg {
    SetStoreInfo {
        row_id: Tuid::ZERO,
        info: StoreInfo::new(store_id, StoreSource::Other(source)),
    }
    .into()
}

/// Writes the checksum and the number of bytes into a recording that begins with [`unsealed`].
pub fn seal(bytes: &mut [u8]) {
    let Some(seal) = Seal::of(bytes) else { return };
    if let Some(length) = seal.length {
        let digits = format!("{:0LENGTH_DIGITS$}", bytes.len());
        bytes[length].copy_from_slice(digits.as_bytes());
    }
    let digits = digits(bytes, &seal.sum);
    bytes[seal.sum].copy_from_slice(digits.as_bytes());
}

/// The state of a file whose frames are whole or not; `None` where it was cut off or damaged.
/// O(bytes).
pub fn checksum_of(bytes: &[u8], is_whole: impl FnOnce(&[u8]) -> bool) -> Option<Checksum> {
    if let Some(seal) = Seal::of(bytes) {
        if digits(bytes, &seal.sum).as_bytes() == &bytes[seal.sum.clone()] {
            return Some(Checksum::Valid);
        }
        if seal.is_in_place(bytes) {
            return None;
        }
    }
    is_whole(bytes).then_some(Checksum::Gone)
}

/// Where a recording holds its checksum, and the number of its bytes.
struct Seal {
    sum: Range<usize>,
    /// `None` in a recording of an earlier version, where the checksum is the name of a store.
    length: Option<Range<usize>>,
}

impl Seal {
    fn of(bytes: &[u8]) -> Option<Self> {
        let head = bytes.get(..HEAD)?;
        let mut starts = head.windows(PREFIX.len());
        let start = starts.position(|part| part == PREFIX.as_bytes())? + PREFIX.len();
        let sum = start..start + DIGITS;
        let length = sum.end + LENGTH.len()..sum.end + LENGTH.len() + LENGTH_DIGITS;
        let has_length = head.get(sum.end..length.start)? == LENGTH.as_bytes();
        (length.end <= HEAD).then_some(Self {
            sum,
            length: has_length.then_some(length),
        })
    }

    /// True where the file is the one that the checksum was made for, whole or damaged: it has as
    /// many bytes. In a recording of an earlier version its store is named once; a program that
    /// writes it again activates the store, and so names it once more.
    fn is_in_place(&self, bytes: &[u8]) -> bool {
        match &self.length {
            Some(length) => {
                let told = std::str::from_utf8(&bytes[length.clone()]).ok();
                told.and_then(|digits| digits.parse().ok()) == Some(bytes.len())
            }
            None => {
                let name = &bytes[self.sum.start - PREFIX.len()..self.sum.end];
                !bytes[self.sum.end..]
                    .windows(name.len())
                    .any(|part| part == name)
            }
        }
    }
}

/// The checksum of all bytes outside its place.
fn digits(bytes: &[u8], place: &Range<usize>) -> String {
    let sum = checksum(&[&bytes[..place.start], &bytes[place.end..]]);
    format!("{sum:0DIGITS$x}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_checksum_is_fnv_1a() {
        // published values
        for (text, expected) in [
            ("", 0xcbf2_9ce4_8422_2325),
            ("a", 0xaf63_dc4c_8601_ec8c),
            ("foobar", 0x8594_4171_f739_67e8),
        ] {
            let (first, second) = text.as_bytes().split_at(text.len() / 2);
            assert_eq!(checksum(&[first, second]), expected);
        }
    }

    #[test]
    fn any_cut_and_any_changed_bit_breaks_the_seal() {
        let [sum, length] = [DIGITS, LENGTH_DIGITS].map(|digits| "0".repeat(digits));
        let head = format!("RRF2 {PREFIX}{sum}");
        let data = "data".repeat(80);
        for (text, seals_its_length) in [
            (format!("{head}{LENGTH}{length} and {data}"), true),
            // an earlier version
            (format!("{head} and {data}"), false),
        ] {
            let state = |bytes: &[u8]| checksum_of(bytes, |_| false);
            let mut whole = text.into_bytes();
            assert_eq!(state(&whole), None);
            seal(&mut whole);
            assert_eq!(state(&whole), Some(Checksum::Valid));
            for end in 0..whole.len() {
                assert_eq!(state(&whole[..end]), None, "cut at {end}");
            }
            let place = Seal::of(&whole).expect("sealed");
            let told = head.len() - PREFIX.len() - DIGITS..head.len() + LENGTH.len() + length.len();
            // without these words it is no recording of today, and none of an earlier version either
            let between = head.len()..head.len() + LENGTH.len();
            for at in 0..whole.len() {
                for bit in 0..8 {
                    let mut changed = whole.clone();
                    changed[at] ^= 1 << bit;
                    // frames that look whole excuse nothing outside the seal's own words
                    let found = checksum_of(&changed, |_| true);
                    let is_seal = told.contains(&at) && !between.contains(&at);
                    let is_elsewhere = place.sum.contains(&at) || !is_seal;
                    let expected = (!is_elsewhere).then_some(Checksum::Gone);
                    if seals_its_length || is_elsewhere {
                        assert_eq!(found, expected, "bit {bit} of byte {at}");
                    }
                    assert_ne!(found, Some(Checksum::Valid));
                }
            }
            assert_eq!(
                state(&[&whole[..], &whole].concat()),
                None,
                "two recordings"
            );
        }
    }

    #[test]
    fn a_file_of_another_length_was_written_again_where_it_is_whole() {
        let zeros = "0".repeat(LENGTH_DIGITS);
        let data = "data".repeat(80);
        let mut sealed = format!("RRF2 {PREFIX}{}{LENGTH}{zeros} {data}", "0".repeat(DIGITS));
        sealed.push('.');
        let mut bytes = sealed.into_bytes();
        seal(&mut bytes);
        bytes.pop();
        for (is_whole, expected) in [(true, Some(Checksum::Gone)), (false, None)] {
            assert_eq!(checksum_of(&bytes, |_| is_whole), expected);
            assert_eq!(checksum_of(data.as_bytes(), |_| is_whole), expected);
        }
        // the store of an earlier version is activated
        let name = format!("{PREFIX}{}", "1".repeat(DIGITS));
        let again = format!("RRF2 {name} {data} {name}").into_bytes();
        assert_eq!(checksum_of(&again, |_| true), Some(Checksum::Gone));
        let once = format!("RRF2 {name} {data}").into_bytes();
        assert_eq!(checksum_of(&once, |_| true), None);
    }
}
