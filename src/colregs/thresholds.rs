//! Thresholds of encounters, scores and monitors: three published sets, and files of a user's own.
//!
//! The planner uses [`Thresholds::STANDARD`], and the limits that a scenario sets instead.

use std::borrow::Cow;
use std::f64::consts::FRAC_PI_6;
use std::path::Path;

use serde_json::{Map, Value, json};

use super::Sectors;
use crate::frame::radians_from_deg;
use crate::input::{Fault, Faults, Field, InputError, Range, from_toml, read_text};
use crate::text::LINE;
use crate::vessel::Hull;

/// A set of thresholds: radians, m/s, seconds, multiples of the longer ship's length, fractions.
#[derive(Debug, Clone, PartialEq)]
pub struct Thresholds {
    /// Name by which it is selected.
    pub name: Cow<'static, str>,
    /// Source of the numbers.
    pub source: Cow<'static, str>,
    /// Encounter sectors.
    pub sectors: Sectors,
    /// Rule 7.
    pub risk: RiskLimits,
    /// Scores and rule violations.
    pub score: ScoreLimits,
    /// Compliance monitors.
    pub monitor: MonitorLimits,
    /// Factor of the times of risk, of ample time, to react and to manoeuvre for own ships of
    /// `LARGE_M` (100 m) and more.
    pub large_factor: f64,
}

/// When risk of collision begins and ends.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RiskLimits {
    /// Longest time to the closest approach, seconds.
    pub time: f64,
    /// Longest distance of the centres at the closest approach, in lengths.
    pub lengths: f64,
    /// In metres instead; only a scenario sets it.
    pub distance: Option<f64>,
    /// Distance of the hulls, in lengths, at which a target that opens is past and clear.
    pub release_lengths: f64,
    /// Consecutive samples that must agree.
    pub evaluations: usize,
}

/// Thresholds of scores and rule violations.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ScoreLimits {
    /// Distance of the hulls in lengths: a collision.
    pub collision_lengths: f64,
    /// A near miss.
    pub near_miss_lengths: f64,
    /// The least safe distance.
    pub least_lengths: f64,
    /// The preferred distance.
    pub preferred_lengths: f64,
    /// Penalty between preferred and least distance.
    pub weight_least: f64,
    /// Penalty between least distance and near miss.
    pub weight_near_miss: f64,
    /// Penalty between near miss and collision.
    pub weight_collision: f64,
    /// Rule 8(b): a readily apparent alteration of course.
    pub apparent: f64,
    /// A smaller alteration is none.
    pub steady: f64,
    /// A smaller fraction of the speed is no change of speed.
    pub steady_speed: f64,
    /// A slower turn is none, rad/s.
    pub turn_rate: f64,
    /// Rule 8(b): more small turns are a succession of small alterations.
    pub small_turns: usize,
    /// Rule 14: full score for this turn to starboard.
    pub starboard: f64,
    /// Rule 14: penalty of a smaller turn.
    pub weight_starboard: f64,
    /// Rule 14: penalty of late action.
    pub weight_delay: f64,
    /// Rule 14: penalty of not passing port to port.
    pub weight_side: f64,
    /// Rules 13 and 15: distance ahead of the target in its lengths, or
    pub ahead_lengths: f64,
    /// the distance that the target makes good in this time, if that is longer.
    pub ahead_time: f64,
    /// Rule 13: penalty of passing ahead.
    pub weight_ahead_overtaking: f64,
    /// Rule 15: penalty of crossing ahead.
    pub weight_ahead_crossing: f64,
    /// Rule 17(a)(i): deviation from the course of a ship that holds it.
    pub hold: f64,
    /// Rule 17(a)(ii): distance in lengths at which the stand-on ship may act.
    pub stage_3_lengths: f64,
    /// Rule 17(b): distance in lengths at which it must.
    pub stage_4_lengths: f64,
    /// Stage 3 of an overtaken ship: the time left to the closest approach, in lengths of way that
    /// own ship makes good in it. The ships come near slowly, so a distance would be soon reached.
    pub overtaken_lengths: f64,
    /// Rule 8(a): action is in ample time up to this many seconds before the closest approach.
    pub ample_time: f64,
}

/// Thresholds of the compliance monitors.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MonitorLimits {
    /// The least avoiding turn; smaller turns are small alterations.
    pub turn: f64,
    /// Time to react, seconds.
    pub react: f64,
    /// Time to manoeuvre, seconds.
    pub manoeuvre: f64,
}

impl RiskLimits {
    /// Longest distance of the centres at the closest approach, metres: within it the hulls may come
    /// nearer than own safety margin, or than the limit.
    pub fn distance(&self, own: &Hull, safety_margin: f64, target: &Hull) -> f64 {
        let limit = self
            .distance
            .unwrap_or(self.lengths * own.length.max(target.length));
        limit.max(safety_margin + own.half_diagonal() + target.half_diagonal())
    }

    /// Part of [`Thresholds::STANDARD`].
    pub const STANDARD: Self = Self {
        time: 420.0,
        lengths: 2.0,
        distance: None,
        release_lengths: 1.5,
        evaluations: 2,
    };
}

impl ScoreLimits {
    /// Part of [`Thresholds::STANDARD`].
    pub const STANDARD: Self = Self {
        collision_lengths: 0.0,
        near_miss_lengths: 0.5,
        least_lengths: 1.0,
        preferred_lengths: 2.0,
        weight_least: 0.2,
        weight_near_miss: 0.3,
        weight_collision: 0.5,
        apparent: FRAC_PI_6,
        steady: radians_from_deg(2.0),
        steady_speed: 0.2,
        turn_rate: radians_from_deg(0.3),
        small_turns: 2,
        starboard: radians_from_deg(10.0),
        weight_starboard: 0.4,
        weight_delay: 0.2,
        weight_side: 0.6,
        ahead_lengths: 3.0,
        ahead_time: 60.0,
        weight_ahead_overtaking: 0.3,
        weight_ahead_crossing: 0.5,
        hold: radians_from_deg(10.0),
        stage_3_lengths: 12.0,
        stage_4_lengths: 4.0,
        overtaken_lengths: 28.0,
        ample_time: 240.0,
    };

    /// Distance ahead of a ship, metres, within which its course line must not be crossed.
    pub fn room_ahead(&self, length: f64, speed: f64) -> f64 {
        (self.ahead_lengths * length).max(self.ahead_time * speed)
    }
}

impl MonitorLimits {
    /// Part of [`Thresholds::STANDARD`].
    pub const STANDARD: Self = Self {
        turn: radians_from_deg(20.0),
        react: 60.0,
        manoeuvre: 70.0,
    };

    /// Seconds in which a ship that keeps clear alters its course.
    pub fn response(&self) -> f64 {
        self.react + 2.0 * self.manoeuvre
    }
}

/// Metres: own ships of this length and more act earlier.
pub const LARGE_M: f64 = 100.0;

/// Largest error of the sum of weights.
const WEIGHT_SUM_ERROR: f64 = 1e-9;

/// Mebibytes of a file of thresholds.
const FILE_MEBIBYTES: u64 = 1;

const DEGREES: Range = Range::between(0.0, 180.0);
const SPEED: Range = Range::between(0.0, 100.0);
const SECONDS: Range = Range::between(0.0, 86_400.0);
const LENGTHS: Range = Range::between(0.0, 1000.0);
const FRACTION: Range = Range::between(0.0, 1.0);

/// The place of a threshold.
macro_rules! at {
    ($($field:ident).+) => {
        |t| &mut t.$($field).+
    };
}

/// A number: its key in files, its range, its place. A key in degrees stands for radians here.
type Number = (&'static str, Range, fn(&mut Thresholds) -> &mut f64);

const NUMBERS: [Number; 35] = [
    ("head_on_deg", DEGREES, at!(sectors.head_on)),
    ("abaft_the_beam_deg", DEGREES, at!(sectors.abaft_the_beam)),
    ("at_rest_mps", SPEED, at!(sectors.at_rest)),
    ("closing_mps", SPEED, at!(sectors.closing)),
    ("risk_time_s", SECONDS, at!(risk.time)),
    (
        "large_factor",
        Range::between(1.0, 100.0),
        at!(large_factor),
    ),
    ("risk_lengths", LENGTHS, at!(risk.lengths)),
    ("release_lengths", LENGTHS, at!(risk.release_lengths)),
    ("collision_lengths", LENGTHS, at!(score.collision_lengths)),
    ("near_miss_lengths", LENGTHS, at!(score.near_miss_lengths)),
    ("least_lengths", LENGTHS, at!(score.least_lengths)),
    ("preferred_lengths", LENGTHS, at!(score.preferred_lengths)),
    ("weight_least", FRACTION, at!(score.weight_least)),
    ("weight_near_miss", FRACTION, at!(score.weight_near_miss)),
    ("weight_collision", FRACTION, at!(score.weight_collision)),
    ("apparent_deg", DEGREES, at!(score.apparent)),
    ("steady_deg", DEGREES, at!(score.steady)),
    ("steady_speed", FRACTION, at!(score.steady_speed)),
    ("turn_rate_deg_per_s", DEGREES, at!(score.turn_rate)),
    ("starboard_deg", DEGREES, at!(score.starboard)),
    ("weight_starboard", FRACTION, at!(score.weight_starboard)),
    ("weight_delay", FRACTION, at!(score.weight_delay)),
    ("weight_side", FRACTION, at!(score.weight_side)),
    ("ahead_lengths", LENGTHS, at!(score.ahead_lengths)),
    ("ahead_s", SECONDS, at!(score.ahead_time)),
    (
        "weight_ahead_overtaking",
        FRACTION,
        at!(score.weight_ahead_overtaking),
    ),
    (
        "weight_ahead_crossing",
        FRACTION,
        at!(score.weight_ahead_crossing),
    ),
    ("hold_deg", DEGREES, at!(score.hold)),
    ("stage_3_lengths", LENGTHS, at!(score.stage_3_lengths)),
    ("stage_4_lengths", LENGTHS, at!(score.stage_4_lengths)),
    ("overtaken_lengths", LENGTHS, at!(score.overtaken_lengths)),
    ("ample_time_s", SECONDS, at!(score.ample_time)),
    ("monitor_turn_deg", DEGREES, at!(monitor.turn)),
    ("react_s", SECONDS, at!(monitor.react)),
    ("manoeuvre_s", SECONDS, at!(monitor.manoeuvre)),
];

/// A count: its key in files, its range, its place.
type Count = (&'static str, Range, fn(&mut Thresholds) -> &mut usize);

const COUNTS: [Count; 2] = [
    (
        "evaluations",
        Range::between(1.0, 1000.0),
        at!(risk.evaluations),
    ),
    (
        "small_turns",
        Range::between(0.0, 1000.0),
        at!(score.small_turns),
    ),
];

static PUBLISHED: [Thresholds; 3] = [
    Thresholds::STANDARD,
    Thresholds::published(
        "dnv-trafficgen",
        "theta14 = 5 deg of the generator of baseline situations; the rest as searoom",
        radians_from_deg(5.0),
        radians_from_deg(10.0),
    ),
    Thresholds::published(
        "sfi-autoship",
        "theta_critical_ho = 13 deg and ranges for ships of the AIS of evaluator.yaml; the rest as searoom",
        radians_from_deg(13.0),
        radians_from_deg(20.0),
    ),
];

impl Thresholds {
    /// The set by which plans are made and judged unless another is asked for.
    pub const STANDARD: Self = Self::published(
        "searoom",
        "scaled by length; weights of an evaluator of the NTNU lineage (evaluator.yaml of the SFI AutoShip simulator)",
        radians_from_deg(10.0),
        radians_from_deg(10.0),
    );

    const fn published(
        name: &'static str,
        source: &'static str,
        head_on: f64,
        starboard: f64,
    ) -> Self {
        Self {
            name: Cow::Borrowed(name),
            source: Cow::Borrowed(source),
            sectors: Sectors {
                head_on,
                ..Sectors::STANDARD
            },
            risk: RiskLimits::STANDARD,
            score: ScoreLimits {
                starboard,
                ..ScoreLimits::STANDARD
            },
            monitor: MonitorLimits::STANDARD,
            large_factor: 3.0,
        }
    }

    /// Factor of the times for an own ship of a length, metres.
    pub fn time_factor(&self, own_length: f64) -> f64 {
        if own_length < LARGE_M {
            1.0
        } else {
            self.large_factor
        }
    }

    /// Rule 7: longest time to the closest approach for an own ship of a length, seconds.
    pub fn risk_time(&self, own_length: f64) -> f64 {
        self.risk.time * self.time_factor(own_length)
    }

    /// Rule 8(a): action is in ample time up to this many seconds before the closest approach.
    pub fn ample_time(&self, own_length: f64) -> f64 {
        self.score.ample_time * self.time_factor(own_length)
    }

    /// [`Thresholds::STANDARD`].
    pub fn standard() -> &'static Self {
        &PUBLISHED[0]
    }

    /// Every published set.
    pub fn all() -> &'static [Self] {
        &PUBLISHED
    }

    /// The published set of a name.
    pub fn named(name: &str) -> Option<&'static Self> {
        Self::all().iter().find(|t| t.name == name)
    }

    /// Reads a TOML file of thresholds (docs/rules.md). With `like = "NAME"` absent keys are those
    /// of a published set. The error holds every fault of the file.
    pub fn read(file: &Path) -> Result<Self, InputError> {
        let text = read_text(file, FILE_MEBIBYTES, "a file of thresholds")?;
        Self::parse(&text).map_err(|faults| InputError::faults(file, faults))
    }

    /// The JSON schema (draft 7) of a file of thresholds, for editors.
    pub fn schema() -> Value {
        let line = json!({ "type": "string", "minLength": 1, "maxLength": 200 });
        let like: Vec<&str> = PUBLISHED.iter().map(|set| &*set.name).collect();
        let mut properties = Map::new();
        properties.insert("name".to_owned(), line.clone());
        properties.insert("source".to_owned(), line);
        properties.insert("like".to_owned(), json!({ "enum": like }));
        let numbers = NUMBERS.iter().map(|(key, range, _)| (key, range, "number"));
        let counts = COUNTS.iter().map(|(key, range, _)| (key, range, "integer"));
        let all: Vec<_> = numbers.chain(counts).collect();
        properties.extend(all.iter().map(|(key, range, kind)| {
            let limits = json!({ "type": kind, "minimum": range.low, "maximum": range.high });
            ((**key).to_owned(), limits)
        }));
        let keys: Vec<_> = all.iter().map(|(key, ..)| key).collect();
        json!({
            "$schema": "http://json-schema.org/draft-07/schema#",
            "title": "Thresholds of Searoom's compliance monitors",
            "description": "docs/rules.md says what each key means; with 'like' absent keys are \
                            those of a published set",
            "type": "object",
            "required": ["name", "source"],
            "anyOf": [{ "required": ["like"] }, { "required": keys }],
            "additionalProperties": false,
            "properties": properties,
        })
    }

    /// [`Thresholds::read`] of a text.
    pub fn parse(text: &str) -> Result<Self, Vec<Fault>> {
        let faults = Faults::default();
        match parse(text, &faults) {
            Some(read) if faults.is_empty() => Ok(read),
            _ => Err(faults.take()),
        }
    }
}

fn parse(text: &str, faults: &Faults) -> Option<Thresholds> {
    let root = from_toml(text, faults)?;
    let mut table = Field::root(&root, faults).table("a table")?;
    let published: Vec<_> = PUBLISHED.iter().map(|set| (&*set.name, set)).collect();
    let name = table.require("name", LINE);
    let source = table.require("source", LINE);
    let like = table.take("like");
    let mut read = like
        .as_ref()
        .and_then(|like| like.choice(&published))
        .unwrap_or(&PUBLISHED[0])
        .clone();
    let mut field = |key, range| match like {
        Some(_) => table.take(key),
        None => table.require(key, range),
    };
    for (key, range, place) in NUMBERS {
        if let Some(number) = field(key, range).and_then(|field| field.number(range)) {
            *place(&mut read) = match key.contains("_deg") {
                true => radians_from_deg(number),
                false => number,
            };
        }
    }
    for (key, range, place) in COUNTS {
        if let Some(count) = field(key, range).and_then(|field| field.whole_number(range)) {
            *place(&mut read) = count;
        }
    }
    table.finish();
    let is_published = |name: &&Field| {
        name.any_text()
            .is_some_and(|n| Thresholds::named(n).is_some())
    };
    if let Some(name) = name.as_ref().filter(is_published) {
        let names: Vec<&str> = published.iter().map(|(name, _)| *name).collect();
        name.refuse::<()>(format_args!("another name than {}", names.join(", ")));
    }
    read.name = Cow::Owned(name?.line_of_text()?.to_owned());
    read.source = Cow::Owned(source?.line_of_text()?.to_owned());
    if faults.is_empty() {
        disagreements(&read, faults);
    }
    Some(read)
}

/// Notes numbers that are allowed each, but not together.
fn disagreements(read: &Thresholds, faults: &Faults) {
    let s = &read.score;
    let increasing = [
        ("collision_lengths", s.collision_lengths),
        ("near_miss_lengths", s.near_miss_lengths),
        ("least_lengths", s.least_lengths),
        ("preferred_lengths", s.preferred_lengths),
    ];
    for pair in increasing.windows(2) {
        let [(lower, low), (upper, high)] = [pair[0], pair[1]];
        if !(low < high) {
            let allowed = format_args!("more than {lower} = {low}");
            faults.note(Fault::new(upper, high, allowed));
        }
    }
    if !(s.stage_4_lengths < s.stage_3_lengths) {
        let allowed = format_args!("more than stage_4_lengths = {}", s.stage_4_lengths);
        faults.note(Fault::new("stage_3_lengths", s.stage_3_lengths, allowed));
    }
    let sum = s.weight_least + s.weight_near_miss + s.weight_collision;
    if !((sum - 1.0).abs() <= WEIGHT_SUM_ERROR) {
        let weights = "weight_least + weight_near_miss + weight_collision";
        faults.note(Fault::new(weights, sum, "1"));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frame::deg_from_radians;

    /// A set as the text of a file with every key.
    fn written(set: &Thresholds) -> Vec<String> {
        let mut set = set.clone();
        let source = format!("source = \"{}\"", set.source);
        let mut lines = vec!["name = 'mine'".to_owned(), source];
        for (key, _, place) in NUMBERS {
            let value = match key.contains("_deg") {
                true => deg_from_radians(*place(&mut set)),
                false => *place(&mut set),
            };
            lines.push(format!("{key} = {value:?}"));
        }
        lines.extend(COUNTS.map(|(key, _, place)| format!("{key} = {}", place(&mut set))));
        lines
    }

    /// Each published set is sound as a file: every key is known, within its limits and required.
    #[test]
    fn published_sets_are_what_a_file_may_hold() {
        for set in Thresholds::all() {
            let lines = written(set);
            let mut read = Thresholds::parse(&lines.join("\n")).expect("sound");
            let mut set = Thresholds {
                name: "mine".into(),
                ..set.clone()
            };
            for (key, _, place) in NUMBERS {
                let off = *place(&mut read) - *place(&mut set);
                assert!(off.abs() < 1e-12, "{key}");
                // conversion to degrees and back rounds
                *place(&mut read) = *place(&mut set);
            }
            assert_eq!(read, set);
            for missing in 0..lines.len() {
                let mut less = lines.clone();
                let line = less.remove(missing);
                let faults = Thresholds::parse(&less.join("\n")).expect_err("a key is missing");
                assert_eq!(faults.len(), 1, "{faults:?}");
                assert!(line.starts_with(&faults[0].path), "{faults:?}");
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
            several[..2],
            [
                "line 4: evaluations: found 2.5; allowed: a whole number from 1 to 1000",
                "line 5: ahead_s: found nan; allowed: a number from 0 to 86400",
            ]
        );
        let unknown = "line 6: head_on: found an unknown key, perhaps for 'head_on_deg'; allowed";
        assert!(several[2].starts_with(unknown), "{several:?}");
        for written in [r"a\nb", r"\u001b[31mred", r"\u202eback", " "] {
            let found = faults(&format!("name = \"{written}\""));
            assert_eq!(found.len(), 1);
            let acts = found[0].contains(['\n', '\u{1b}', '\u{202e}']);
            assert!(found[0].ends_with(LINE) && !acts, "{found:?}");
        }
        let key = faults("name = 'm'\n\"a\\u001b\" = 1");
        assert!(key[0].starts_with(r"line 4: a\u001b: found"), "{key:?}");
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
        let names = "\"searoom\", \"dnv-trafficgen\"";
        assert!(unknown[0].allowed.starts_with(names));
        let broken = Thresholds::parse("name = 'm'\nsource =").expect_err("no TOML");
        assert_eq!(broken[0].line, Some(2));
    }
}
