//! A set of thresholds from a file of a user's own: every fault of the file at once.

use std::fmt;
use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};

use toml::{Table, Value};

use super::thresholds::{Entry, Thresholds, published};
use crate::text::{LINE, is_line};

/// One thing wrong in a file of thresholds: where, what was found, what is allowed.
///
/// # Examples
///
/// ```
/// use searoom::colregs::conduct::{Thresholds, ThresholdsFault};
///
/// let text = "name = 'mine'\nsource = 'our handbook'\nlike = 'searoom'\nhead_on_deg = -6.0";
/// let faults: Vec<ThresholdsFault> = Thresholds::parse(text).expect_err("a negative angle");
/// assert_eq!(faults[0].to_string(), "head_on_deg: found -6.0; allowed: a number from 0 to 180");
/// ```
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ThresholdsFault {
    /// Which key.
    pub field: String,
    /// What the file says there.
    pub found: String,
    /// What it may say.
    pub allowed: String,
}

impl fmt::Display for ThresholdsFault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self {
            field,
            found,
            allowed,
        } = self;
        write!(f, "{field}: found {found}; allowed: {allowed}")
    }
}

/// Why a file gives no thresholds.
///
/// # Examples
///
/// ```
/// use searoom::colregs::conduct::{Thresholds, ThresholdsError};
///
/// let error = Thresholds::read("nowhere.toml".as_ref()).expect_err("no such file");
/// assert!(matches!(error, ThresholdsError::Read { .. }));
/// ```
#[derive(Debug, thiserror::Error)]
pub enum ThresholdsError {
    /// The file cannot be read.
    #[error("{}: cannot be read: {source}", file.display())]
    Read {
        /// The file.
        file: PathBuf,
        /// The system's answer.
        source: std::io::Error,
    },
    /// The file was read and is wrong.
    #[error("{}: {}", file.display(), listed(faults))]
    Faults {
        /// The file.
        file: PathBuf,
        /// Everything wrong with it, in order of the keys. Never empty.
        faults: Vec<ThresholdsFault>,
    },
}

fn listed(faults: &[ThresholdsFault]) -> String {
    let lines: Vec<String> = faults.iter().map(ToString::to_string).collect();
    lines.join("\n  ")
}

/// What a key may be.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Kind {
    Text,
    /// A number within limits.
    Number(f64, f64),
    /// A whole number within limits.
    Count(i64, i64),
}

const DEGREES: Kind = Kind::Number(0.0, 180.0);
const SPEED: Kind = Kind::Number(0.0, 100.0);
const SECONDS: Kind = Kind::Number(0.0, 86_400.0);
const LENGTHS: Kind = Kind::Number(0.0, 1000.0);
const SHARE: Kind = Kind::Number(0.0, 1.0);

/// Every key, in the order of the published file.
const KEYS: [(&str, Kind); 37] = [
    ("name", Kind::Text),
    ("source", Kind::Text),
    ("head_on_deg", DEGREES),
    ("abaft_the_beam_deg", DEGREES),
    ("at_rest_mps", SPEED),
    ("closing_mps", SPEED),
    ("risk_time_s", SECONDS),
    ("risk_lengths", LENGTHS),
    ("release_factor", Kind::Number(1.0, 100.0)),
    ("evaluations", Kind::Count(1, 1000)),
    ("collision_lengths", LENGTHS),
    ("near_miss_lengths", LENGTHS),
    ("least_lengths", LENGTHS),
    ("preferred_lengths", LENGTHS),
    ("weight_least", SHARE),
    ("weight_near_miss", SHARE),
    ("weight_collision", SHARE),
    ("apparent_deg", DEGREES),
    ("steady_deg", DEGREES),
    ("steady_speed", SHARE),
    ("turn_rate_deg_per_s", DEGREES),
    ("small_turns", Kind::Count(0, 1000)),
    ("starboard_deg", DEGREES),
    ("weight_starboard", SHARE),
    ("weight_delay", SHARE),
    ("weight_side", SHARE),
    ("ahead_lengths", LENGTHS),
    ("ahead_s", SECONDS),
    ("weight_ahead_overtaking", SHARE),
    ("weight_ahead_crossing", SHARE),
    ("hold_deg", DEGREES),
    ("stage_3_lengths", LENGTHS),
    ("monitor_turn_deg", DEGREES),
    ("monitor_lengths", LENGTHS),
    ("monitor_time_s", SECONDS),
    ("react_s", SECONDS),
    ("manoeuvre_s", SECONDS),
];

/// Each has to be more than the one before it.
const GROWING: [&str; 4] = [
    "collision_lengths",
    "near_miss_lengths",
    "least_lengths",
    "preferred_lengths",
];

/// They share one whole.
const WEIGHTS: [&str; 3] = ["weight_least", "weight_near_miss", "weight_collision"];

/// A file of thresholds has some kilobytes; a longer one is another file.
const MOST_BYTES: u64 = 65_536;

/// The weights of [`WEIGHTS`] make 1 to this.
const ROUNDING: f64 = 1e-9;

impl Kind {
    fn allowed(self) -> String {
        match self {
            Self::Text => LINE.to_owned(),
            Self::Number(low, high) => format!("a number from {low} to {high}"),
            Self::Count(low, high) => format!("a whole number from {low} to {high}"),
        }
    }

    fn allows(self, value: &Value) -> bool {
        match (self, value) {
            (Self::Text, Value::String(text)) => is_line(text),
            (Self::Number(low, high), value) => {
                number(value).is_some_and(|n| (low..=high).contains(&n))
            }
            (Self::Count(low, high), Value::Integer(n)) => (low..=high).contains(n),
            _ => false,
        }
    }
}

fn number(value: &Value) -> Option<f64> {
    match value {
        Value::Float(number) => Some(*number),
        Value::Integer(number) => Some(*number as f64),
        _ => None,
    }
}

/// As it is written, a list or a table by that word.
fn shown(value: &Value) -> String {
    match value {
        Value::String(text) => format!("{text:?}"),
        Value::Integer(number) => number.to_string(),
        Value::Float(number) if number.is_nan() => "nan".to_owned(),
        Value::Float(number) => format!("{number:?}"),
        Value::Boolean(truth) => truth.to_string(),
        Value::Datetime(_) => "a date".to_owned(),
        Value::Array(_) => "a list".to_owned(),
        Value::Table(_) => "a table".to_owned(),
    }
}

impl Thresholds {
    /// Reads a file with the keys of one entry of the published ones (docs/rules.md), each at most once. With
    /// `like = "NAME"` the keys that are not there are those of a published set. Every fault is in the error.
    pub fn read(file: &Path) -> Result<Self, ThresholdsError> {
        let wrong = |faults| ThresholdsError::Faults {
            file: file.to_owned(),
            faults,
        };
        let unread = |source| ThresholdsError::Read {
            file: file.to_owned(),
            source,
        };
        // a pipe may never end
        if !std::fs::metadata(file).map_err(unread)?.is_file() {
            let kind = std::io::ErrorKind::InvalidInput;
            return Err(unread(std::io::Error::new(kind, "not a regular file")));
        }
        let mut text = String::new();
        File::open(file)
            .and_then(|open| open.take(MOST_BYTES + 1).read_to_string(&mut text))
            .map_err(unread)?;
        if text.len() as u64 > MOST_BYTES {
            let found = format!("more than {MOST_BYTES} bytes");
            return Err(wrong(vec![fault("file", found, "no more than that")]));
        }
        Self::parse(&text).map_err(wrong)
    }

    /// The same from a text.
    pub fn parse(text: &str) -> Result<Self, Vec<ThresholdsFault>> {
        let own: Table = text.parse().map_err(|error: toml::de::Error| {
            let line = error
                .span()
                .map_or(0, |at| text[..at.start].lines().count());
            let message = error.message().to_owned();
            vec![fault(&format!("line {}", line.max(1)), message, "TOML")]
        })?;
        let mut faults = Vec::new();
        let names: Vec<&str> = Self::all().iter().map(|t| t.name.as_str()).collect();
        let base = own.get("like").and_then(|like| {
            let found = published().iter().find(|t| t.get("name") == Some(like));
            if found.is_none() {
                faults.push(fault("like", shown(like), &names.join(", ")));
            }
            found
        });
        let mut whole = base.cloned().unwrap_or_default();
        for (key, kind) in KEYS {
            match own.get(key) {
                Some(value) if key == "name" && names.iter().any(|n| value.as_str() == Some(n)) => {
                    let other = format!("another name than {}", names.join(", "));
                    faults.push(fault(key, shown(value), &other));
                }
                Some(value) if kind.allows(value) => {
                    whole.insert(key.to_owned(), value.clone());
                }
                Some(value) => faults.push(fault(key, shown(value), &kind.allowed())),
                // what a set is called and where it comes from is its own
                None if kind == Kind::Text || !own.contains_key("like") => {
                    faults.push(fault(key, "nothing", &kind.allowed()));
                }
                None => {}
            }
        }
        let known = |key: &str| key == "like" || KEYS.iter().any(|(name, _)| *name == key);
        for (key, value) in own.iter().filter(|(key, _)| !known(key)) {
            let keys: Vec<&str> = KEYS.iter().map(|(name, _)| *name).collect();
            let key = key.escape_debug().to_string();
            let allowed = format!("like, {}", keys.join(", "));
            faults.push(fault(&key, shown(value), &allowed));
        }
        whole.remove("like");
        if faults.is_empty() {
            faults = disagreements(&whole);
        }
        if !faults.is_empty() {
            return Err(faults);
        }
        let entry: Result<Entry, _> = whole.try_into();
        entry
            .map(Entry::thresholds)
            .map_err(|error| vec![fault("thresholds", error.message(), "what the keys allow")])
    }
}

/// Numbers that are allowed each, but not together.
fn disagreements(whole: &Table) -> Vec<ThresholdsFault> {
    let of = |key: &str| whole.get(key).and_then(number).unwrap_or(f64::NAN);
    let mut faults = Vec::new();
    for pair in GROWING.windows(2) {
        if !(of(pair[0]) < of(pair[1])) {
            let allowed = format!("more than {} = {}", pair[0], of(pair[0]));
            faults.push(fault(pair[1], of(pair[1]), &allowed));
        }
    }
    let sum: f64 = WEIGHTS.iter().map(|key| of(key)).sum();
    if !((sum - 1.0).abs() <= ROUNDING) {
        faults.push(fault(&WEIGHTS.join(" + "), sum, "1"));
    }
    faults
}

fn fault(field: &str, found: impl fmt::Display, allowed: &str) -> ThresholdsFault {
    ThresholdsFault {
        field: field.to_owned(),
        found: found.to_string(),
        allowed: allowed.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn written(table: &Table) -> String {
        let line = |(key, value): (&String, &Value)| format!("{key} = {}\n", shown(value));
        table.iter().map(line).collect()
    }

    /// The published entries, each as a file of its own, are sound: every key is known and within its limits.
    #[test]
    fn published_sets_are_what_a_file_may_say() {
        for (table, set) in published().iter().zip(Thresholds::all()) {
            let mut own = table.clone();
            own.insert("name".to_owned(), Value::String("mine".to_owned()));
            assert_eq!(own.len(), KEYS.len());
            let read = Thresholds::parse(&written(&own)).expect("sound");
            let named = Thresholds {
                name: "mine".to_owned(),
                ..set.clone()
            };
            assert_eq!(read, named);
            for key in own.keys() {
                let mut less = own.clone();
                less.remove(key);
                let faults = Thresholds::parse(&written(&less)).expect_err("a key is missing");
                assert_eq!([faults[0].field.as_str()], [key.as_str()]);
            }
        }
    }

    #[test]
    fn every_fault_is_named_with_what_is_allowed() {
        let faults = |text: &str| -> Vec<String> {
            let text = format!("source = 'a'\nlike = 'searoom'\n{text}");
            let faults = Thresholds::parse(&text).expect_err("faulty");
            faults.iter().map(ToString::to_string).collect()
        };
        let several =
            faults("name = 'm'\nevaluations = 2.5\nahead_s = nan\nhead_on = 5\nhold_deg = '3'");
        assert_eq!(several.len(), 4, "{several:?}");
        assert_eq!(
            several[0],
            "evaluations: found 2.5; allowed: a whole number from 1 to 1000"
        );
        assert_eq!(
            several[1],
            "ahead_s: found nan; allowed: a number from 0 to 86400"
        );
        assert!(several[3].starts_with("head_on: found 5; allowed: like, name"));
        for (written, shown) in [
            (r"a\nb", r"a\nb"),
            (r"\u001b[31mred", r"\u{1b}[31mred"),
            (r"\u202eback", r"\u{202e}back"),
            (" ", " "),
        ] {
            assert_eq!(
                faults(&format!("name = \"{written}\"")),
                [format!("name: found \"{shown}\"; allowed: {LINE}")]
            );
        }
        let key = faults("name = 'm'\n\"a\\u001b\" = 1");
        assert!(key[0].starts_with(r"a\u{1b}: found 1"), "{key:?}");
        assert!(faults("name = 'searoom'")[0].contains("another name than searoom"));
        assert_eq!(
            faults("name = 'm'\nnear_miss_lengths = 1.5\nweight_least = 0.3"),
            [
                "least_lengths: found 1; allowed: more than near_miss_lengths = 1.5",
                "weight_least + weight_near_miss + weight_collision: found 1.1; allowed: 1",
            ]
        );
        let unknown =
            Thresholds::parse("name = 'm'\nsource = 'a'\nlike = 'nobody'").expect_err("faulty");
        assert_eq!(unknown.len(), 1);
        assert!(unknown[0].allowed.starts_with("searoom, dnv-trafficgen"));
        let broken = Thresholds::parse("name = 'm'\nsource =").expect_err("no TOML");
        assert_eq!(
            (broken[0].field.as_str(), broken[0].allowed.as_str()),
            ("line 2", "TOML")
        );
    }
}
