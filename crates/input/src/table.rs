//! A table whose keys are all known: unknown keys and missing ones are faults.

use std::fmt::Display;

use super::{Field, Range};
use searoom_geometry::frame::NAUTICAL_MILE_M;

/// A known key this similar to an unknown one (Jaro-Winkler) was meant.
const SIMILAR: f64 = 0.8;

/// Words of other systems in keys, and ours.
const OTHER_WORDS: [(&str, &str); 10] = [
    ("heading", "course"),
    ("hdg", "course"),
    ("cog", "course"),
    ("sog", "speed"),
    ("loa", "length"),
    ("breadth", "beam"),
    ("width", "beam"),
    ("knots", "kn"),
    ("nm", "nmi"),
    ("cables", "cbl"),
];

/// Suffix of a key and the size of its unit.
pub(super) type Unit = (&'static str, f64);

/// Units of speeds in m/s and of distances in metres.
pub(super) static SPEED_UNITS: [Unit; 2] = [("mps", 1.0), ("kn", NAUTICAL_MILE_M / 3600.0)];
pub(super) static DISTANCE_UNITS: [Unit; 3] = [
    ("m", 1.0),
    ("nmi", NAUTICAL_MILE_M),
    ("cbl", NAUTICAL_MILE_M / 10.0),
];

/// The units of the quantity that has this one.
pub(super) fn units_like(unit: &str) -> &'static [Unit] {
    let all: [&[Unit]; 2] = [&SPEED_UNITS, &DISTANCE_UNITS];
    let like = all
        .into_iter()
        .find(|units| units.iter().any(|(name, _)| *name == unit));
    like.unwrap_or_default()
}

/// A key that a table may have: a stem, and a unit behind it where there is one.
#[derive(Clone, Copy, Debug)]
pub struct Key {
    stem: &'static str,
    unit: &'static str,
}

impl Key {
    pub(super) fn is(self, name: &str) -> bool {
        let Self { stem, unit } = self;
        // lengths first: most keys are others
        if unit.is_empty() {
            return name == stem;
        }
        name.len() == stem.len() + 1 + unit.len()
            && name.starts_with(stem)
            && name.ends_with(unit)
            && name.as_bytes()[stem.len()] == b'_'
    }
}

impl PartialEq for Key {
    fn eq(&self, other: &Self) -> bool {
        // keys of one place in the program are at one place in memory
        let is_same = |a: &'static str, b: &'static str| std::ptr::eq(a, b) || a == b;
        is_same(self.stem, other.stem) && is_same(self.unit, other.unit)
    }
}

impl Display for Key {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self.unit {
            "" => f.write_str(self.stem),
            unit => write!(f, "{}_{unit}", self.stem),
        }
    }
}

/// A table whose keys are taken one by one. [`Table::finish`] notes unknown and missing keys.
#[derive(Debug)]
pub struct Table<'a> {
    field: Field<'a>,
    /// With repetitions.
    known: Vec<Key>,
    /// The keys of the file among them.
    taken: Vec<&'a str>,
    missing: Vec<(Vec<String>, String)>,
}

impl<'a> Table<'a> {
    pub(super) fn new(field: Field<'a>) -> Self {
        Self {
            field,
            known: Vec::new(),
            taken: Vec::new(),
            missing: Vec::new(),
        }
    }

    /// True if the key is there. The key counts as known.
    pub fn has(&mut self, key: &'static str) -> bool {
        self.take(key).is_some()
    }

    /// The value of a key, if it is there and not null. The key counts as known.
    pub fn take(&mut self, key: &'static str) -> Option<Field<'a>> {
        self.known.push(Key {
            stem: key,
            unit: "",
        });
        let found = self.field.get(key);
        self.taken.extend(found.as_ref().and_then(Field::key));
        found
    }

    /// [`Self::take`] of a quantity in a unit.
    fn take_in(&mut self, stem: &'static str, unit: &'static str) -> Option<Field<'a>> {
        let key = Key { stem, unit };
        self.known.push(key);
        let found = self.field.find(|name| key.is(name));
        self.taken.extend(found.as_ref().and_then(Field::key));
        found
    }

    /// The value of a key that must be there; [`Self::finish`] notes its absence.
    pub fn require(&mut self, key: &'static str, allowed: impl Display) -> Option<Field<'a>> {
        let field = self.take(key);
        if field.is_none() {
            self.missing
                .push((vec![key.to_owned()], allowed.to_string()));
        }
        field
    }

    /// The value of a key without which the others cannot be read: it is a fault at once.
    pub fn require_first(&mut self, key: &'static str, allowed: impl Display) -> Option<Field<'a>> {
        self.has(key);
        self.field.require(key, allowed)
    }

    /// The table of a key that must be there.
    pub fn required_table(&mut self, key: &'static str) -> Option<Table<'a>> {
        self.require(key, "a table")?.table("a table")
    }

    /// The number of a key that may be absent; `None` for a faulty one, too.
    pub fn number(&mut self, key: &'static str, range: Range) -> Option<f64> {
        self.take(key)?.number(range)
    }

    /// The number of a key that must be there.
    pub fn required_number(&mut self, key: &'static str, range: Range) -> Option<f64> {
        self.require(key, range)?.number(range)
    }

    /// The value of a key, or `default` where the key is absent or its value is a fault.
    pub fn read_or<T>(
        &mut self,
        key: &'static str,
        default: T,
        read: impl FnOnce(&Field<'a>) -> Option<T>,
    ) -> T {
        let found = self.take(key).and_then(|field| read(&field));
        found.unwrap_or(default)
    }

    /// A number, or `default` where the key is absent or its value is a fault.
    pub fn number_or(&mut self, key: &'static str, range: Range, default: f64) -> f64 {
        self.read_or(key, default, |field| field.number(range))
    }

    /// The meaning of one of these words; the key may be absent.
    pub fn choice<T: Copy>(&mut self, key: &'static str, words: &[(&str, T)]) -> Option<T> {
        self.take(key)?.choice(words)
    }

    /// The field of a quantity in one of its units, and the size of that unit; two at once are a
    /// fault.
    fn field_in(&mut self, stem: &'static str, units: &[Unit]) -> Option<(Field<'a>, f64)> {
        let mut found: Option<(Key, Field<'a>, f64)> = None;
        for (unit, size) in units {
            let key = Key { stem, unit };
            match (&found, self.take_in(stem, unit)) {
                (Some((first, ..)), Some(field)) => {
                    let beside = format_args!("{key} beside {first}");
                    field.fault(beside, "one of the two, not both");
                    return None;
                }
                (None, Some(field)) => found = Some((key, field, *size)),
                (_, None) => {}
            }
        }
        found.map(|(_, field, size)| (field, size))
    }

    /// A distance in metres from `<stem>_m`, `<stem>_nmi` or `<stem>_cbl`; the range is in metres.
    pub fn distance(&mut self, stem: &'static str, range: Range) -> Option<f64> {
        let (field, unit) = self.field_in(stem, &DISTANCE_UNITS)?;
        let distance = field.number(range.in_units_of(unit))?;
        // 2.1 cables are 388.92 m: the unit has a decimal, and no more digits than these
        Some(match unit == 1.0 {
            true => distance,
            false => (distance * unit * 1e9).round() / 1e9,
        })
    }

    /// A distance that must be there in one of the units.
    pub fn required_distance(&mut self, stem: &'static str, range: Range) -> Option<f64> {
        self.require_in(stem, &DISTANCE_UNITS, range);
        self.distance(stem, range)
    }

    /// True if the quantity is given in one of the units.
    fn has_in(&mut self, stem: &'static str, units: &[Unit]) -> bool {
        let units = units.iter().map(|(unit, _)| unit);
        // every key counts as known
        let given = units.filter(|unit| self.take_in(stem, unit).is_some());
        given.count() > 0
    }

    /// Notes the quantity as missing if it is given in none of the units.
    fn require_in(&mut self, stem: &'static str, units: &[Unit], allowed: impl Display) {
        if !self.has_in(stem, units) {
            let keys = units.iter().map(|(suffix, _)| format!("{stem}_{suffix}"));
            self.missing.push((keys.collect(), allowed.to_string()));
        }
    }

    /// True if the speed is given in either unit.
    pub fn has_speed(&mut self, stem: &'static str) -> bool {
        self.has_in(stem, &SPEED_UNITS)
    }

    /// A speed in m/s from `<stem>_mps` or `<stem>_kn`; the range is in m/s.
    pub fn speed(&mut self, stem: &'static str, range: Range) -> Option<f64> {
        let (field, unit) = self.field_in(stem, &SPEED_UNITS)?;
        Some(field.number(range.in_units_of(unit))? * unit)
    }

    /// A speed that must be there in one of the units.
    pub fn required_speed(&mut self, stem: &'static str, range: Range) -> Option<f64> {
        self.require_speed(stem, range);
        self.speed(stem, range)
    }

    /// Notes the speed as missing if it is given in neither unit.
    pub fn require_speed(&mut self, stem: &'static str, allowed: impl Display) {
        self.require_in(stem, &SPEED_UNITS, allowed);
    }

    /// Speeds in m/s from the list `<stem>_mps` or `<stem>_kn`, and the field of the list.
    pub fn speeds(
        &mut self,
        stem: &'static str,
        range: Range,
    ) -> Option<(Field<'a>, Option<Vec<f64>>)> {
        let (field, unit) = self.field_in(stem, &SPEED_UNITS)?;
        let speeds = field
            .numbers(range.in_units_of(unit))
            .map(|numbers| numbers.into_iter().map(|n| n * unit).collect());
        Some((field, speeds))
    }

    /// Refuses a key that another one rules out.
    pub fn forbid(&mut self, key: &'static str, because: &str) {
        if let Some(field) = self.take(key) {
            field.refuse::<()>(because);
        }
    }

    /// Notes every unknown key and every missing one. A required key that is misspelt is one fault.
    pub fn finish(mut self) {
        let mut missing = std::mem::take(&mut self.missing);
        let mut listed: Vec<String> = Vec::new();
        for name in self.field.keys() {
            let is_taken = self.taken.iter().any(|taken| std::ptr::eq(*taken, name));
            // a known key may have the value null
            if is_taken || self.known.iter().any(|known| known.is(name)) {
                continue;
            }
            if listed.is_empty() {
                listed = once_each(&self.known);
            }
            let meant = nearest(name, &listed);
            missing.retain(|(keys, _)| !keys.iter().any(|key| Some(key) == meant));
            self.field.unknown(name, meant, &listed);
        }
        for (keys, allowed) in missing {
            let or = match &keys[1..] {
                [] => String::new(),
                others => format!(" (or {})", others.join(", ")),
            };
            let allowed = format_args!("{allowed}; it is required{or}");
            self.field.fault_at(&keys[0], "nothing", allowed);
        }
        self.field.finish(self.known);
    }
}

/// The keys as texts in the order in which they were first taken.
fn once_each(keys: &[Key]) -> Vec<String> {
    let mut all: Vec<String> = Vec::new();
    for key in keys.iter().map(Key::to_string) {
        if !all.contains(&key) {
            all.push(key);
        }
    }
    all
}

fn nearest<'k>(name: &str, known: &'k [String]) -> Option<&'k String> {
    let lower = name.to_lowercase();
    let words = lower.split('_').map(|word| {
        let other = OTHER_WORDS.iter().find(|(other, _)| *other == word);
        other.map_or(word, |(_, ours)| ours)
    });
    let ours = words.collect::<Vec<_>>().join("_");
    let alike = |key: &str| {
        let of = |name: &str| strsim::jaro_winkler(name, key);
        of(&lower).max(of(&ours))
    };
    known
        .iter()
        .map(|key| (alike(key), key))
        .filter(|(similarity, _)| *similarity > SIMILAR)
        // among equals the one that was asked for first
        .rev()
        .max_by(|a, b| a.0.total_cmp(&b.0))
        .map(|(_, key)| key)
}
