//! The bits of a message of AIS. A sentence holds them as its armour: a character for each six.

/// The longest message that is kept: five slots have 1,192 bits.
const MOST_WORDS: usize = 20;
pub(crate) const MOST_BITS: usize = 64 * MOST_WORDS;

/// Bits, the first one highest.
#[derive(Debug, Clone)]
pub(crate) struct Bits {
    words: [u64; MOST_WORDS],
    pub len: usize,
}

/// Value of each character of the armour; 64 for those that are none.
const VALUES: [u8; 256] = {
    let mut values = [64; 256];
    let mut byte = 48;
    while byte < 120 {
        if byte < 88 || byte >= 96 {
            let value = byte - 48;
            values[byte] = if value > 40 { value - 8 } else { value } as u8;
        }
        byte += 1;
    }
    values
};

impl Bits {
    pub fn new() -> Self {
        Self {
            words: [0; MOST_WORDS],
            len: 0,
        }
    }

    /// Adds the bits of a part. False for a character that stands for no six bits, or more bits than a
    /// message has.
    pub fn push(&mut self, armoured: &[u8], fill: u8) -> bool {
        let from = self.len;
        if from + 6 * armoured.len() > MOST_BITS {
            return false;
        }
        let mut wrong = 0;
        for byte in armoured {
            let value = VALUES[usize::from(*byte)];
            wrong |= value;
            let (word, bit) = (self.len / 64, self.len % 64);
            let value = u64::from(value & 63);
            if bit <= 58 {
                self.words[word] |= value << (58 - bit);
            } else {
                self.words[word] |= value >> (bit - 58);
                self.words[word + 1] |= value << (122 - bit);
            }
            self.len += 6;
        }
        for _ in 0..usize::from(fill).min(self.len - from) {
            self.len -= 1;
            self.words[self.len / 64] &= !(1 << (63 - self.len % 64));
        }
        wrong & 64 == 0
    }

    /// An unsigned number of up to 32 bits. Bits beyond the end are 0.
    pub fn unsigned(&self, from: usize, bits: usize) -> u32 {
        debug_assert!(bits <= 32 && from + bits <= MOST_BITS);
        let (word, bit) = (from / 64, from % 64);
        let high = self.words[word] << bit;
        let low = match bit {
            0 => 0,
            _ => self.words.get(word + 1).copied().unwrap_or(0) >> (64 - bit),
        };
        ((high | low) >> (64 - bits)) as u32
    }

    /// A number in two's complement.
    pub fn signed(&self, from: usize, bits: usize) -> i32 {
        let shift = 32 - bits;
        ((self.unsigned(from, bits) << shift) as i32) >> shift
    }

    pub fn flag(&self, at: usize) -> bool {
        self.unsigned(at, 1) == 1
    }
}
