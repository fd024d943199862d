//! Import of files of other programs. The contents of a file tell its format, not its name. Each
//! format is read into a [`Situation`], and every situation becomes a scenario in one way.
//!
//! A new format needs a file here that makes a [`Situation`], and its detection in
//! [`Contents::parse`].

mod assumed;
mod commonocean;
mod dnv;
mod imazu;
mod scenario_text;
mod situation;
mod traffic;
pub(super) mod xml;

pub use assumed::{Assumed, Assumption};
pub use scenario_text::Imported;
pub use situation::{Declared, Situation};
pub use traffic::OwnInTraffic;

use std::path::Path;

use super::limits;
use searoom_input::{Fault, Faults, Field, InputError, from_json, from_toml, read_text};

/// Contents of a file.
#[derive(Debug)]
pub enum Contents {
    /// A scenario file, or a text that can only be meant as one; to be read by
    /// [`Scenario::read`](super::Scenario::read).
    Scenario,
    /// Situations of another program, in order, at least one, each good or with its own faults.
    Situations(Vec<Result<Situation, Vec<Fault>>>),
    /// A result document or a map, which is not a scenario: its kind.
    Other(&'static str),
}

impl Contents {
    /// Reads a file of at most 16 MiB; more is refused before it is read.
    pub fn read(file: &Path, assumed: &Assumed) -> Result<Self, InputError> {
        let text = read_text(file, limits::FILE_MEBIBYTES, "a scenario file")?;
        Self::parse(&text, assumed).map_err(|faults| InputError::faults(file, faults))
    }

    /// [`Contents::read`] of a text.
    pub fn parse(text: &str, assumed: &Assumed) -> Result<Self, Vec<Fault>> {
        // a byte order mark is not part of the text
        let text = text.trim_start_matches('\u{feff}').trim_start();
        match text.chars().next() {
            Some('{') => in_json(text, assumed),
            Some('<') => in_xml(text, assumed),
            // the reader of scenarios says the rest, and parses a large file alone
            _ if !text.contains(STRATA) && rows(text).is_none() => Ok(Self::Scenario),
            _ => match from_toml(text, &Faults::default()) {
                Some(root) if root.get(STRATA).is_some() => Ok(Self::Other(
                    "the specification of a campaign, which `searoom campaign run` reads",
                )),
                Some(_) => Ok(Self::Scenario),
                None => rows(text).map_or(Ok(Self::Scenario), |found| {
                    Err(vec![Fault::new("", found, READ)])
                }),
            },
        }
    }
}

/// The key by which the specification of a campaign is known.
const STRATA: &str = "strata";

/// The formats that are read.
const READ: &str = "a scenario file (TOML), DNV's traffic situations or Imazu's cases (JSON), or \
                    CommonOcean's scenarios (XML); what AIS reports of a ship goes into [[targets]]";

/// Separators of the values of a row, and the name of such rows.
const SEPARATORS: [(char, &str); 3] = [(';', "CSV with semicolons"), ('\t', "TSV"), (',', "CSV")];

/// The kind of a text of rows, which is no TOML: sentences of a receiver, separated values, or values
/// of JSON.
fn rows(text: &str) -> Option<String> {
    let mut lines = text.lines().filter(|line| !line.trim().is_empty());
    let [first, second] = [lines.next()?, lines.next().unwrap_or_default()];
    // after a tag block, and a time
    let is_sentence = |line: &str| {
        let begins = |sign: &str| line.split(sign).nth(1).and_then(|rest| rest.get(..5));
        let begins = ["!", "$"].into_iter().find_map(begins);
        begins.is_some_and(|word| word.chars().all(|c| c.is_ascii_uppercase()))
            && line.contains(',')
    };
    if is_sentence(first) {
        return Some("NMEA sentences, as of an AIS receiver".to_owned());
    }
    let head = format!("{first}{second}").to_lowercase();
    let what = match head.contains("mmsi") {
        true => "rows of AIS reports",
        false => "rows of values",
    };
    let is_list = || first.starts_with('[') && from_json(text).is_ok();
    if first.starts_with('{') && head.replace(' ', "").starts_with("{\"class\":") {
        return Some("reports of gpsd (JSON)".to_owned());
    }
    if first.starts_with('{') || is_list() {
        return Some(format!("{what} (JSON)"));
    }
    let is_row = |line: &str, sign: char| line.matches(sign).count() >= 2 && !line.contains('=');
    let separated = |(sign, _): &&(char, &str)| {
        is_row(first, *sign) && (is_row(second, *sign) || second.is_empty())
    };
    let (_, form) = SEPARATORS.iter().find(separated)?;
    Some(format!("{what} ({form})"))
}

/// Keys by which result documents without a format are known.
const RESULTS: [&str; 6] = [
    "summary",
    "comparisons",
    "simulations",
    "plans",
    "hold_course",
    "entities",
];

/// The kind of a plan document.
pub const A_PLAN: &str = "a plan document, which `searoom verify` checks";

fn in_xml(text: &str, assumed: &Assumed) -> Result<Contents, Vec<Fault>> {
    let document = xml::parse(text).map_err(|fault| vec![fault])?;
    let root = document.root_element().tag_name().name();
    if root != "commonOcean" {
        let found = format_args!("XML that begins with {root}");
        let allowed = match root {
            "route" => "a scenario: one whose [mission] has 'route' reads this file",
            _ => READ,
        };
        return Err(vec![Fault::new(root, found, allowed)]);
    }
    Ok(Contents::Situations(commonocean::situations(
        &document, assumed,
    )?))
}

fn in_json(text: &str, assumed: &Assumed) -> Result<Contents, Vec<Fault>> {
    let is_whole = |line: &str| line.starts_with('{') && from_json(line).is_ok();
    let value = from_json(text).map_err(|fault| {
        let mut lines = text.lines().filter(|line| !line.trim().is_empty());
        // each line is a value of its own, as of gpsd
        match lines.next().is_some_and(is_whole) && lines.next().is_some_and(is_whole) {
            true => vec![Fault::new("", rows(text).unwrap_or_default(), READ)],
            false => vec![fault],
        }
    })?;
    let faults = Faults::default();
    let root = Field::root(&value, &faults);
    let has = |key: &str| value.get(key).is_some();
    let text_at = |key: &str| value.get(key).and_then(|v| v.as_text()).unwrap_or_default();
    // before Imazu's cases, which have an own_ship, too
    let format = text_at("format");
    if format.starts_with("searoom-plan/") {
        return Ok(Contents::Other(A_PLAN));
    }
    if has("ownShip") || has("targetShips") {
        let situation = dnv::situation(&root, &faults, assumed);
        return Ok(Contents::Situations(vec![situation]));
    }
    if has("cases") || has("own_ship") {
        let situations = imazu::situations(&root, &faults, assumed.variants)?;
        return Ok(Contents::Situations(situations));
    }
    if format.starts_with("searoom-") || RESULTS.into_iter().any(has) {
        return Ok(Contents::Other("a result document"));
    }
    if ["FeatureCollection", "Feature"].contains(&text_at("type")) {
        return Ok(Contents::Other("a GeoJSON map"));
    }
    let keys: Vec<&str> = root.keys().take(5).collect();
    let found = format_args!("JSON with the keys {}", keys.join(", "));
    let allowed =
        "a DNV traffic situation (ownShip, targetShips) or Imazu's cases (own_ship, cases)";
    Err(vec![Fault::new("", found, allowed)])
}
