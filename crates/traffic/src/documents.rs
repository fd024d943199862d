//! JSON documents in a stream of lines: one a line, or one over many lines.

use std::borrow::Cow;

use crate::counts::Dropped;

/// Longest document, bytes: a full model of some thousand ships.
pub(crate) const MOST_DOCUMENT_BYTES: usize = 8 << 20;

/// The document that has begun, and where its reading stands.
#[derive(Debug, Default)]
pub(crate) struct Documents {
    begun: Vec<u8>,
    depth: u32,
    in_text: bool,
    after_backslash: bool,
}

impl Documents {
    /// Gives a line without its end, and returns the document that it completes. A line that begins with a
    /// brace begins a document, so that one that was cut off costs none but itself; it is counted.
    pub fn add<'l>(
        &'l mut self,
        line: &'l [u8],
        mut dropped: impl FnMut(Dropped),
    ) -> Option<Cow<'l, [u8]>> {
        if !self.begun.is_empty() && line.first() == Some(&b'{') {
            dropped(Dropped::Document);
            self.clear();
        }
        if self.begun.is_empty() && line.trim_ascii_start().first() != Some(&b'{') {
            dropped(Dropped::Document);
            return None;
        }
        if self.begun.len() + line.len() > MOST_DOCUMENT_BYTES {
            dropped(Dropped::TooLong);
            self.clear();
            return None;
        }
        self.scan(line);
        if self.depth == 0 && self.begun.is_empty() {
            return Some(line.into());
        }
        self.begun.extend_from_slice(line);
        self.begun.push(b'\n');
        if self.depth > 0 {
            return None;
        }
        let whole = std::mem::take(&mut self.begun);
        self.clear();
        Some(whole.into())
    }

    fn scan(&mut self, line: &[u8]) {
        for byte in line {
            match (self.in_text, self.after_backslash, byte) {
                (true, true, _) => self.after_backslash = false,
                (true, false, b'\\') => self.after_backslash = true,
                (_, _, b'"') => self.in_text = !self.in_text,
                (false, _, b'{' | b'[') => self.depth += 1,
                (false, _, b'}' | b']') => self.depth = self.depth.saturating_sub(1),
                _ => {}
            }
        }
        // no text has an end of a line in it
        (self.in_text, self.after_backslash) = (false, false);
    }

    fn clear(&mut self) {
        *self = Self::default();
    }

    /// True where a document has begun; it is forgotten.
    pub fn finish(&mut self) -> bool {
        let has_begun = !self.begun.is_empty();
        self.clear();
        has_begun
    }
}
