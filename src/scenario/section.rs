//! A table of the file, whose keys are taken one by one.

use std::fmt::Display;

use toml::de::DeTable;

use super::file::{Entry, Range, Source};
use super::limits;
use crate::frame::mps_from_knots;

/// A key this similar to an unknown one (Jaro-Winkler) is what was meant.
const SIMILAR: f64 = 0.8;

/// A table of which keys are taken one by one. [`Section::finish`] notes what is left and what was
/// missed.
#[derive(Debug)]
pub(super) struct Section<'a, 'i> {
    source: &'a Source,
    path: String,
    offset: Option<usize>,
    table: &'a DeTable<'i>,
    known: Vec<String>,
    missing: Vec<(Vec<String>, String)>,
}

impl<'a, 'i> Section<'a, 'i> {
    /// A table at a path; the file's outermost has an empty one.
    pub(super) fn new(
        source: &'a Source,
        path: String,
        offset: Option<usize>,
        table: &'a DeTable<'i>,
    ) -> Self {
        Self {
            source,
            path,
            offset,
            table,
            known: Vec::new(),
            missing: Vec::new(),
        }
    }

    fn path_of(&self, key: &str) -> String {
        if self.path.is_empty() {
            key.to_owned()
        } else {
            format!("{}.{key}", self.path)
        }
    }

    /// True when the key is there. The key counts as known.
    pub(super) fn has(&mut self, key: &str) -> bool {
        self.take(key).is_some()
    }

    /// The value of a key that may be left out.
    pub(super) fn take(&mut self, key: &str) -> Option<Entry<'a, 'i>> {
        if !self.known.iter().any(|known| known == key) {
            self.known.push(key.to_owned());
        }
        self.table
            .get(key)
            .map(|value| Entry::new(self.source, self.path_of(key), value))
    }

    /// The value of a key that must be there.
    pub(super) fn require(&mut self, key: &str, allowed: impl Display) -> Option<Entry<'a, 'i>> {
        let entry = self.take(key);
        if entry.is_none() {
            self.missing
                .push((vec![key.to_owned()], allowed.to_string()));
        }
        entry
    }

    /// A number that may be left out.
    pub(super) fn number(&mut self, key: &str, range: Range) -> Option<f64> {
        self.take(key)?.number(range)
    }

    /// A number that must be there.
    pub(super) fn required_number(&mut self, key: &str, range: Range) -> Option<f64> {
        self.require(key, range)?.number(range)
    }

    /// One of these words, or nothing.
    pub(super) fn choice<T: Copy>(&mut self, key: &str, words: &[(&str, T)]) -> Option<T> {
        self.take(key)?.choice(words)
    }

    /// The entry of `<stem>_mps` or `<stem>_kn` and one unit of it in m/s; both at once are a fault.
    fn speed_entry(&mut self, stem: &str) -> Option<(Entry<'a, 'i>, f64)> {
        let (metric, nautical) = (format!("{stem}_mps"), format!("{stem}_kn"));
        match (self.take(&metric), self.take(&nautical)) {
            (Some(_), Some(entry)) => {
                entry.fault(
                    format_args!("{nautical} beside {metric}"),
                    "one of the two, not both",
                );
                None
            }
            (Some(entry), None) => Some((entry, 1.0)),
            (None, Some(entry)) => Some((entry, mps_from_knots(1.0))),
            (None, None) => None,
        }
    }

    /// True when the speed is given in either unit.
    pub(super) fn has_speed(&mut self, stem: &str) -> bool {
        let metric = self.has(&format!("{stem}_mps"));
        self.has(&format!("{stem}_kn")) || metric
    }

    /// A speed in m/s from `<stem>_mps` or `<stem>_kn`; the range is in m/s.
    pub(super) fn speed(&mut self, stem: &str, range: Range) -> Option<f64> {
        let (entry, unit) = self.speed_entry(stem)?;
        Some(entry.number(in_unit(range, unit))? * unit)
    }

    /// A speed that must be there in one of the units.
    pub(super) fn required_speed(&mut self, stem: &str, range: Range) -> Option<f64> {
        self.require_speed(stem, range);
        self.speed(stem, range)
    }

    /// Notes the speed as missing when neither unit is there.
    pub(super) fn require_speed(&mut self, stem: &str, allowed: impl Display) {
        if !self.has_speed(stem) {
            self.missing.push((
                vec![format!("{stem}_mps"), format!("{stem}_kn")],
                allowed.to_string(),
            ));
        }
    }

    /// Speeds in m/s from the list `<stem>_mps` or `<stem>_kn`, with the list's place.
    pub(super) fn speeds(
        &mut self,
        stem: &str,
        range: Range,
    ) -> Option<(Entry<'a, 'i>, Option<Vec<f64>>)> {
        let (entry, unit) = self.speed_entry(stem)?;
        let speeds = entry
            .numbers(in_unit(range, unit))
            .map(|numbers| numbers.into_iter().map(|n| n * unit).collect());
        Some((entry, speeds))
    }

    /// Refuses a key that another one rules out.
    pub(super) fn forbid(&mut self, key: &str, because: &str) {
        if let Some(entry) = self.take(key) {
            entry.refuse::<()>(because);
        }
    }

    /// Notes every key that nobody asked for and every required one that is not there. A required
    /// key that is merely misspelt is one fault.
    pub(super) fn finish(mut self) {
        let mut missing = std::mem::take(&mut self.missing);
        for key in self.table.keys() {
            let name: &str = key.get_ref();
            if self.known.iter().any(|known| known == name) {
                continue;
            }
            let meant = nearest(name, &self.known);
            let found = match meant {
                Some(meant) => format!("an unknown key, perhaps for '{meant}'"),
                None => "an unknown key".to_owned(),
            };
            missing.retain(|(keys, _)| !keys.iter().any(|key| Some(key) == meant));
            self.source.fault(
                &self.path_of(name),
                Some(key.span().start),
                &found,
                format_args!("one of {}", self.known.join(", ")),
            );
        }
        for (keys, allowed) in missing {
            let or = match keys.get(1) {
                Some(other) => format!(" (or {other})"),
                None => String::new(),
            };
            self.source.fault(
                &self.path_of(&keys[0]),
                self.offset,
                "nothing",
                format_args!("{allowed}; it is required{or}"),
            );
        }
    }
}

fn in_unit(range: Range, unit: f64) -> Range {
    if unit == 1.0 {
        range
    } else {
        limits::in_knots(range)
    }
}

fn nearest<'k>(name: &str, known: &'k [String]) -> Option<&'k String> {
    let lower = name.to_lowercase();
    known
        .iter()
        .map(|key| (strsim::jaro_winkler(&lower, key), key))
        .filter(|(similarity, _)| *similarity > SIMILAR)
        // of equals the one that was asked for first
        .rev()
        .max_by(|a, b| a.0.total_cmp(&b.0))
        .map(|(_, key)| key)
}
