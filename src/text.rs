//! What a name or a title may be.

/// In words: what [`is_line`] takes.
pub(crate) const LINE: &str = "a text of 1 to 200 characters on one line";

/// Characters of a line.
const CHARS: usize = 200;

/// True for a text that is not blank, without control characters, not longer than a line.
pub(crate) fn is_line(text: &str) -> bool {
    !text.trim().is_empty() && !text.chars().any(is_unprintable) && text.chars().count() <= CHARS
}

/// Control characters, and those that break a line or turn its direction.
pub(crate) fn is_unprintable(c: char) -> bool {
    c.is_control()
        || matches!(c, '\u{2028}' | '\u{2029}' | '\u{200e}' | '\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}')
}
