//! The checksum of a recording.
//!
//! Rerun's format has none: its decoder believes every length and every digit. The first message of
//! a recording of Searoom therefore opens an empty store, which is named after the checksum of all
//! other bytes. Viewers ignore that store. The checksum is tested before anything is decoded. It
//! detects accidents; it is no signature.

use std::ops::Range;

use rerun::external::re_log_types::external::re_tuid::Tuid;
use rerun::external::re_log_types::{
    LogMsg, SetStoreInfo, StoreId, StoreInfo, StoreKind, StoreSource,
};

use super::APPLICATION;

const PREFIX: &str = "checksum_";
const DIGITS: usize = 16;

/// The first message ends within these bytes.
const HEAD: usize = 256;

/// FNV-1a with 64 bits (draft-eastlake-fnv). A change of a single byte always changes it.
pub fn checksum(parts: &[&[u8]]) -> u64 {
    let bytes = parts.iter().copied().flatten();
    bytes.fold(0xcbf2_9ce4_8422_2325, |sum, byte| {
        (sum ^ u64::from(*byte)).wrapping_mul(0x0100_0000_01b3)
    })
}

pub fn opening(store_id: StoreId) -> LogMsg {
    let source = StoreSource::Other(APPLICATION.to_owned());
    SetStoreInfo {
        row_id: Tuid::ZERO,
        info: StoreInfo::new(store_id, source),
    }
    .into()
}

/// The first message of a recording, with zeros in place of the checksum.
pub fn unsealed() -> LogMsg {
    let name = format!("{PREFIX}{:0DIGITS$}", 0);
    opening(StoreId::new(StoreKind::Blueprint, APPLICATION, name))
}

/// Writes the checksum into a recording that begins with [`unsealed`].
pub fn seal(bytes: &mut [u8]) {
    if let Some(place) = place(bytes) {
        let digits = digits(bytes, &place);
        bytes[place].copy_from_slice(digits.as_bytes());
    }
}

/// Tests whether a recording has the checksum of its bytes. O(bytes).
pub fn is_sealed(bytes: &[u8]) -> bool {
    place(bytes).is_some_and(|place| digits(bytes, &place).as_bytes() == &bytes[place])
}

fn place(bytes: &[u8]) -> Option<Range<usize>> {
    let mut head = bytes.get(..HEAD)?.windows(PREFIX.len());
    let start = head.position(|part| part == PREFIX.as_bytes())? + PREFIX.len();
    (start + DIGITS <= HEAD).then_some(start..start + DIGITS)
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
        let zeros = "0".repeat(DIGITS);
        let mut whole = format!("RRF2 {PREFIX}{zeros} and {}", "data".repeat(80)).into_bytes();
        assert!(!is_sealed(&whole));
        seal(&mut whole);
        assert!(is_sealed(&whole));
        for end in 0..whole.len() {
            assert!(!is_sealed(&whole[..end]), "cut at {end}");
        }
        for at in 0..whole.len() {
            for bit in 0..8 {
                let mut changed = whole.clone();
                changed[at] ^= 1 << bit;
                assert!(!is_sealed(&changed), "bit {bit} of byte {at}");
            }
        }
        assert!(!is_sealed(&[&whole[..], &whole].concat()), "two recordings");
    }
}
