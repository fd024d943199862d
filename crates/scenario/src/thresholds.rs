//! Files of thresholds, by which own ship's motion is judged.

use std::borrow::Cow;
use std::path::Path;

use serde_json::Value;

use searoom_colregs::Thresholds;
use searoom_geometry::frame::radians_from_deg;
use searoom_input::schema::{Schema, choice, having, line_of_text, number, whole_number};
use searoom_input::text::LINE;
use searoom_input::{Fault, Faults, Field, InputError, Range, from_toml, read_text};

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

/// Reads a TOML file of thresholds (docs/reference/rules.md). With `like = "NAME"` absent keys are
/// those of a published set. The error holds every fault of the file.
pub fn read_thresholds(file: &Path) -> Result<Thresholds, InputError> {
    let text = read_text(file, FILE_MEBIBYTES, "a file of thresholds")?;
    parse_thresholds(&text).map_err(|faults| InputError::faults(file, faults))
}

/// The JSON schema (draft 7) of a file of thresholds, for editors.
pub fn thresholds_schema() -> Value {
    let about = "docs/reference/rules.md says what each key means; with 'like' absent keys are \
                 those of a published set";
    let like: Vec<_> = Thresholds::all().iter().map(|s| (&*s.name, ())).collect();
    let numbers = NUMBERS.iter().map(|(key, range, _)| (*key, number(*range)));
    let counts = COUNTS
        .iter()
        .map(|(key, range, _)| (*key, whole_number(*range)));
    let all: Vec<_> = numbers.chain(counts).collect();
    let keys: Vec<&str> = all.iter().map(|(key, _)| *key).collect();
    let table = Schema::table(about)
        .with("$schema", "http://json-schema.org/draft-07/schema#")
        .with("title", "Thresholds of Searoom's compliance monitors")
        .with("anyOf", having(&[&["like"], &keys]))
        .require("name", line_of_text(), "")
        .require("source", line_of_text(), "")
        .optional("like", choice(&like), "");
    let add = |table: Schema, (key, value)| table.optional(key, value, "");
    all.into_iter().fold(table, add).finish()
}

/// [`read_thresholds`] of a text.
pub fn parse_thresholds(text: &str) -> Result<Thresholds, Vec<Fault>> {
    let faults = Faults::default();
    match parse(text, &faults) {
        Some(read) if faults.is_empty() => Ok(read),
        _ => Err(faults.take()),
    }
}

fn parse(text: &str, faults: &Faults) -> Option<Thresholds> {
    let root = from_toml(text, faults)?;
    let mut table = Field::root(&root, faults).table("a table")?;
    let published: Vec<_> = Thresholds::all()
        .iter()
        .map(|set| (&*set.name, set))
        .collect();
    let name = table.require("name", LINE);
    let source = table.require("source", LINE);
    let like = table.take("like");
    let mut read = like
        .as_ref()
        .and_then(|like| like.choice(&published))
        .unwrap_or(Thresholds::standard())
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
    use searoom_geometry::frame::deg_from_radians;

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
            let mut read = parse_thresholds(&lines.join("\n")).expect("sound");
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
                let faults = parse_thresholds(&less.join("\n")).expect_err("a key is missing");
                assert_eq!(faults.len(), 1, "{faults:?}");
                assert!(line.starts_with(&faults[0].path), "{faults:?}");
            }
        }
    }

    #[test]
    fn every_fault_is_named_with_what_is_allowed() {
        let faults = |text: &str| -> Vec<String> {
            let text = format!("source = 'a'\nlike = 'searoom'\n{text}");
            let faults = parse_thresholds(&text).expect_err("faulty");
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
            parse_thresholds("name = 'm'\nsource = 'a'\nlike = 'nobody'").expect_err("faulty");
        assert_eq!(unknown.len(), 1);
        let names = "\"searoom\", \"dnv-trafficgen\"";
        assert!(unknown[0].allowed.starts_with(names));
        let broken = parse_thresholds("name = 'm'\nsource =").expect_err("no TOML");
        assert_eq!(broken[0].line, Some(2));
    }
}
