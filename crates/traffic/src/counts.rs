//! What was read, and what was not.

use std::fmt;

searoom_geometry::words! {
    /// Why a line or a message did not become a report.
    pub enum Dropped {
        /// Neither a tag block nor a sentence.
        NoSentence => "lines that are no sentence",
        /// Longer than any sentence.
        TooLong => "lines that are too long",
        /// The check sum is another, or not there.
        CheckSum => "wrong or missing check sums",
        /// That of a tag block.
        TagCheckSum => "tag blocks with a wrong check sum, which are ignored",
        /// A sentence that is not read.
        OtherSentence => "sentences of another kind",
        /// Fields that are missing or no numbers.
        Fields => "sentences with wrong fields",
        /// A part whose others did not come in time.
        LateParts => "messages without all parts in time",
        /// More messages wait for parts than are kept.
        TooManyParts => "messages that waited for parts while too many did",
        /// Characters that are no armour of AIS.
        Armour => "messages with a wrong character",
        /// Fewer bits than its fields need.
        TooShort => "messages that are too short",
        /// A message that has no ship's position or size.
        OtherMessage => "messages of another kind",
        /// HDG, HDM and Signal K's `headingMagnetic`: without the variation they are no true heading.
        Magnetic => "magnetic headings, which are not used",
        /// Status L.
        Lost => "radar targets that are lost",
        /// Own ship's position is too old, or not there.
        NoOwnPosition => "radar targets without own position",
        /// A relative bearing, and own ship's heading is too old or not there.
        NoOwnHeading => "radar targets without own heading",
        /// More radar targets have names than are kept.
        TooManyNames => "names of radar targets while too many were kept",
        /// Cells that are missing, or no identity or no time.
        Row => "rows with wrong cells",
        /// The same identity, time and place.
        Again => "rows that were there before",
        /// The table lacks a column that is needed.
        NoColumn => "rows of a table that lacks a column",
        /// No JSON, or cut off.
        Document => "documents that are broken",
        /// Neither a delta nor a full model of Signal K.
        OtherDocument => "documents of another kind",
        /// Neither own ship, nor a number, nor a UUID.
        Context => "deltas of another context",
        /// Values whose paths are not used.
        Path => "values of other paths",
        /// A text for a number, or nothing that a number can be.
        Value => "values of a wrong type",
        /// More contexts of Signal K than are kept; the others begin anew.
        TooManyContexts => "contexts that were silent while too many were kept",
    }
}

/// How much was read and dropped.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Counts {
    /// Lines that are not empty.
    pub lines: u64,
    /// Reports that were made.
    pub reports: u64,
    dropped: [u64; Dropped::WORDS.len()],
    /// Messages by their number.
    messages: [u64; 64],
}

impl Default for Counts {
    fn default() -> Self {
        Self {
            lines: 0,
            reports: 0,
            dropped: [0; _],
            messages: [0; 64],
        }
    }
}

impl Counts {
    pub(crate) fn drop(&mut self, why: Dropped) {
        self.dropped[why as usize] += 1;
    }

    pub(crate) fn message(&mut self, number: u8) {
        self.messages[usize::from(number & 63)] += 1;
    }

    /// Number of lines or messages dropped for a reason.
    pub fn dropped(&self, why: Dropped) -> u64 {
        self.dropped[why as usize]
    }

    /// Number of whole messages of a number, 0 to 63.
    pub fn messages(&self, number: u8) -> u64 {
        self.messages.get(usize::from(number)).copied().unwrap_or(0)
    }
}

impl fmt::Display for Counts {
    /// A line for what was read, and one for each reason.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} lines, {} reports", self.lines, self.reports)?;
        for (word, why) in Dropped::WORDS {
            if self.dropped(*why) > 0 {
                write!(f, "\n{} {word}", self.dropped(*why))?;
            }
        }
        Ok(())
    }
}
