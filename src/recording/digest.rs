//! What a recording is named after: a digest of its packed chunks, in their order.

/// FNV-1a, 128 bits.
const BASIS: u128 = 0x6c62_272e_07bb_0142_62b8_2175_6295_c58d;
const PRIME: u128 = 0x0000_0000_0100_0000_0000_0000_0000_013b;

/// Of everything in the payloads of a store.
#[derive(Debug, Clone, Copy)]
pub(super) struct Digest(u128);

impl Digest {
    pub(super) fn of<'a>(payloads: impl IntoIterator<Item = &'a [u8]>) -> Self {
        let bytes = payloads.into_iter().flatten();
        Self(bytes.fold(BASIS, |digest, byte| {
            (digest ^ u128::from(*byte)).wrapping_mul(PRIME)
        }))
    }

    /// The name of the store that is shown.
    pub(super) fn recording(self) -> String {
        self.store("rec")
    }

    /// The name of a store beside it.
    pub(super) fn store(self, what: &str) -> String {
        format!("{what}_{:032x}", self.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Published values: draft-eastlake-fnv, 128 bits.
    #[test]
    fn it_is_fnv_1a() {
        for (text, digest) in [
            ("", "6c62272e07bb014262b821756295c58d"),
            ("a", "d228cb696f1a8caf78912b704e4a8964"),
            ("foobar", "343e1662793c64bf6f0d3597ba446f18"),
        ] {
            let halves = text.as_bytes().split_at(text.len() / 2);
            let found = Digest::of([halves.0, halves.1]);
            assert_eq!(found.recording(), format!("rec_{digest}"));
        }
    }
}
