//! Allowed names and titles, and safe display of untrusted texts.

use std::borrow::Cow;

use textwrap::{WordSeparator, WordSplitter};

use searoom_geometry::frame::knots_from_mps;

/// Texts that [`is_line`] accepts, in words.
pub const LINE: &str = "a text of 1 to 200 characters on one line";
/// Characters of such a text.
pub const LINE_CHARS: usize = 200;

/// True for a text of allowed length that is not blank and has no control characters.
pub fn is_line(text: &str) -> bool {
    !text.trim().is_empty()
        && !text.chars().any(is_unprintable)
        && text.chars().count() <= LINE_CHARS
}

/// True for control characters, for those that break a line or change its direction, and for those
/// that XML forbids.
pub fn is_unprintable(c: char) -> bool {
    let breaks_lines = matches!(c, '\u{2028}' | '\u{2029}');
    let turns_text = matches!(
        c,
        '\u{061c}' | '\u{200e}' | '\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}'
    );
    let no_xml = matches!(c, '\u{fffe}' | '\u{ffff}');
    c.is_control() || breaks_lines || turns_text || no_xml
}

/// An untrusted text on one line: control characters appear as their codes, `\u001b` as in JSON.
pub fn printable(text: &str) -> String {
    shown(text, |_| false).into_owned()
}

/// [`printable`] for a text with several lines and tabs.
pub fn printable_lines(text: &str) -> Cow<'_, str> {
    shown(text, |c| matches!(c, '\n' | '\t'))
}

fn shown(text: &str, keep: impl Fn(char) -> bool) -> Cow<'_, str> {
    // nearly every text is ASCII, and many bytes are compared at once
    let is_plain = |byte: &u8| matches!(byte, b' '..=b'~') | keep(char::from(*byte));
    let are_plain = |bytes: &[u8]| bytes.iter().fold(true, |all, byte| all & is_plain(byte));
    if text.as_bytes().chunks(1024).all(are_plain) {
        return Cow::Borrowed(text);
    }
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        if is_unprintable(c) && !keep(c) {
            out.push_str(&format!("\\u{:04x}", u32::from(c)));
        } else {
            out.push(c);
        }
    }
    Cow::Owned(out)
}

/// Longest number that [`short_numbers`] leaves unchanged, in characters.
const LONGEST_NUMBER: usize = 24;

/// A text in which long numbers have an exponent: `1e308` instead of 309 digits.
pub fn short_numbers(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    let mut rest = text;
    while let Some(start) = rest.find(|c: char| c.is_ascii_digit()) {
        let (before, number) = rest.split_at(start);
        let end = number.find(|c: char| !(c.is_ascii_digit() || c == '.'));
        let (number, after) = number.split_at(end.unwrap_or(number.len()));
        out.push_str(before);
        match number.parse::<f64>() {
            Ok(value) if number.len() > LONGEST_NUMBER => out.push_str(&format!("{value:e}")),
            _ => out.push_str(number),
        }
        rest = after;
    }
    out + rest
}

/// A number as a message shows it, without the digits of its rounding: to a millionth.
pub fn rounded(value: f64) -> f64 {
    (value * 1e6).round() / 1e6
}

/// A count with its word, which has an s unless the count is one.
pub fn counted(count: usize, word: &str) -> String {
    let plural = if count == 1 { "" } else { "s" };
    format!("{count} {word}{plural}")
}

/// Formats a space-time error: one decimal below 1000, more below 1.
pub fn square_metres(value: f64) -> String {
    if value.is_nan() {
        "undefined".to_owned()
    } else if value < 1000.0 {
        tenths(value)
    } else {
        format!("{value:.0}")
    }
}

/// Most decimals of a quantity; models are metres long or less.
const DECIMALS: i32 = 4;

/// Formats one decimal, and three significant digits below 1. Values that round to zero have no
/// sign.
pub fn tenths(value: f64) -> String {
    let decimals = match value.abs() {
        small if (0.5 * 0.1_f64.powi(DECIMALS)..0.95).contains(&small) => decimals(value),
        _ => 1,
    };
    let power = 10.0_f64.powi(decimals);
    let rounded = (value * power).round() / power + 0.0;
    short_numbers(&format!("{rounded:.*}", decimals as usize))
}

/// Formats three significant digits, or all before the decimal point.
pub fn significant(value: f64) -> String {
    match value.abs() < 0.95 {
        true => tenths(value),
        false => short_numbers(&format!("{value:.*}", decimals(value).max(0) as usize)),
    }
}

/// Decimals of three significant digits; a value near zero has one.
fn decimals(value: f64) -> i32 {
    // the exponent of the rounded value: 9.996 has that of 10.0
    let rounded = format!("{value:.2e}");
    let power = rounded
        .split_once('e')
        .and_then(|(_, p)| p.parse::<i32>().ok());
    match power {
        Some(power) if power >= -DECIMALS - 1 => (2 - power).min(DECIMALS),
        _ => 1,
    }
}

/// A line broken between words to a width, with an indent before all but the first. A number stays
/// with its unit.
pub fn broken(line: &str, width: usize, indent: &str) -> String {
    const BOUND: char = '\u{a0}';
    let mut bound = String::with_capacity(line.len());
    let mut chars = line.chars().peekable();
    let mut last = ' ';
    while let Some(c) = chars.next() {
        let is_unit = last.is_ascii_digit() && chars.peek().is_some_and(|c| c.is_alphabetic());
        bound.push(if c == ' ' && is_unit { BOUND } else { c });
        last = c;
    }
    let options = textwrap::Options::new(width)
        .subsequent_indent(indent)
        .break_words(false)
        .word_separator(WordSeparator::AsciiSpace)
        .word_splitter(WordSplitter::NoHyphenation);
    textwrap::wrap(&bound, options)
        .join("\n")
        .replace(BOUND, " ")
}

/// A time as minutes and seconds, such as `12:05`.
pub fn clock(seconds: f64) -> String {
    let sign = if seconds <= -0.5 { "-" } else { "" };
    let whole = seconds.abs().round() as u64;
    format!("{sign}{}:{:02}", whole / 60, whole % 60)
}

/// How a text writes times: in seconds, or as charts do.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Times {
    /// In seconds, as `725 s`.
    Seconds,
    /// In minutes and seconds, as `12:05`.
    Clock,
}

impl Times {
    /// A time, in seconds with so many decimals.
    pub fn at(self, time: f64, decimals: usize) -> String {
        let unit = if self == Self::Seconds { " s" } else { "" };
        self.figure(time, decimals) + unit
    }

    /// The time without its unit.
    pub fn figure(self, time: f64, decimals: usize) -> String {
        match self {
            Self::Seconds => format!("{time:.decimals$}"),
            Self::Clock => clock(time),
        }
    }
}

/// Formats a speed, m/s, in knots with its unit.
pub fn knots(speed: f64) -> String {
    format!("{} kn", knots_figure(speed))
}

/// Formats a speed, m/s, in knots: one decimal, two below a knot.
pub fn knots_figure(speed: f64) -> String {
    let knots = knots_from_mps(speed);
    let decimals = if (0.005..0.95).contains(&knots) { 2 } else { 1 };
    format!("{knots:.decimals$}")
}

/// Formats a turn, degrees positive to starboard, with its side, as in "30° to port".
pub fn to_side(turn_deg: f64) -> String {
    let side = if turn_deg > 0.0 { "starboard" } else { "port" };
    format!("{:.0}° to {side}", turn_deg.abs())
}

/// Formats one decimal with a sign; values that round to zero give `+0.0`.
pub fn signed(value: f64) -> String {
    format!("{:+.1}", (value * 10.0).round() / 10.0 + 0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn zero_has_no_sign() {
        assert_eq!(
            (tenths(-0.00004), signed(-0.04)),
            ("0.0".into(), "+0.0".into())
        );
        assert_eq!(signed(0.06), "+0.1");
    }

    #[test]
    fn small_quantities_have_three_digits() {
        let values = [-3.12, 0.96, 0.9439, -0.0432, 0.00432, 0.00004, -1e-9, 12.0];
        let expected = [
            "-3.1", "1.0", "0.944", "-0.0432", "0.0043", "0.0", "0.0", "12.0",
        ];
        assert_eq!(values.map(tenths), expected);
        let values = [1953.4, 225.2, 64.04, 2.284, 0.0432, 1e-5, f64::NAN];
        let expected = ["1953", "225", "64.0", "2.28", "0.0432", "0.0", "NaN"];
        assert_eq!(values.map(significant), expected);
    }

    #[test]
    fn a_number_stays_with_its_unit() {
        let line = "closest to 'b': 61.4 m, starboard";
        assert_eq!(
            broken(line, 21, "  "),
            "closest to 'b':\n  61.4 m, starboard"
        );
        assert_eq!(broken("8 (d)", 4, ""), "8\n(d)");
        let speeds = [2.5, 0.05, 0.0, 0.48].map(knots);
        assert_eq!(speeds, ["4.9 kn", "0.10 kn", "0.0 kn", "0.93 kn"]);
    }

    #[test]
    fn long_numbers_have_an_exponent() {
        let (large, small) = (format!("{:.3}", -1.5e300), 2.5e-300);
        let text = format!("{large} s, {small}, 0.0001139473170042038 and 12.");
        let short = "-1.5e300 s, 2.5e-300, 0.0001139473170042038 and 12.";
        assert_eq!(short_numbers(&text), short);
        assert_eq!(short_numbers(""), "");
    }

    #[test]
    fn control_characters_appear_as_their_codes() {
        let text = "ferry\n\u{1b}[8m\u{202e}";
        assert_eq!(printable(text), r"ferry\u000a\u001b[8m\u202e");
        assert_eq!(printable("Trondheimsfjorden ø"), "Trondheimsfjorden ø");
    }
}
