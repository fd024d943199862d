//! Foreign formats, told apart by what is in the file, whatever its name: each is read into a [`Situation`], and every
//! situation becomes a scenario in one way.

mod ais_words;
mod assumed;
mod commonocean;
mod dnv;
mod imazu;
mod json;
mod situation;
mod text;
mod track;
mod xml;

pub use assumed::{Assumed, Assumption};
pub use situation::{Declared, Situation};
pub use text::Imported;

use std::cell::RefCell;
use std::path::Path;

use super::fault::Fault;
use super::reading::text_of;
use super::{ScenarioError, limits};
use json::Json;

/// What a file is.
///
/// # Examples
///
/// ```
/// use searoom::scenario::formats::{Assumed, Contents, Format};
///
/// let file = "scenarios/dnv/traffic_situation_01.json".as_ref();
/// let Contents::Situations { format, mut situations } = Contents::read(file, &Assumed::default())? else {
///     panic!("situations");
/// };
/// assert_eq!((format, situations.len()), (Format::Dnv, 1));
/// # situations.clear();
/// # Ok::<(), searoom::scenario::ScenarioError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Format {
    /// A scenario file.
    Scenario,
    /// A DNV traffic situation.
    Dnv,
    /// Imazu's cases.
    Imazu,
    /// A CommonOcean scenario.
    CommonOcean,
}

/// What is in a file.
///
/// # Examples
///
/// ```
/// use searoom::scenario::formats::{Assumed, Contents};
///
/// let assumed = Assumed::default();
/// let of = |file: &str| Contents::read(file.as_ref(), &assumed);
/// assert!(matches!(of("scenarios/colregs/head-on.toml")?, Contents::Scenario));
/// assert!(matches!(of("scenarios/commonocean/sample-head-on.xml")?, Contents::Situations { .. }));
/// assert!(matches!(of("maps/trondheim-harbour.geojson")?, Contents::Other(_)));
/// # Ok::<(), searoom::scenario::ScenarioError>(())
/// ```
#[derive(Debug)]
pub enum Contents {
    /// A scenario file, or what can only be meant as one: [`Scenario::read`](super::Scenario::read) says more.
    Scenario,
    /// Situations of a foreign format, one after another, each good or with its own faults.
    Situations {
        /// Which format.
        format: Format,
        /// At least one.
        situations: Vec<Result<Situation, Vec<Fault>>>,
    },
    /// A document of ours or a map, of no use here: which.
    Other(&'static str),
}

impl Contents {
    /// Reads a file of at most 16 MiB; more is refused before it is read.
    pub fn read(file: &Path, assumed: &Assumed) -> Result<Self, ScenarioError> {
        let text = text_of(file, limits::FILE_BYTES)?;
        Self::parse(&text, assumed).map_err(|faults| ScenarioError::Faults {
            file: file.to_owned(),
            faults,
        })
    }

    /// The same from a text.
    pub fn parse(text: &str, assumed: &Assumed) -> Result<Self, Vec<Fault>> {
        // a mark of the byte order is no part of the text
        let text = text.trim_start_matches('\u{feff}').trim_start();
        match text.chars().next() {
            Some('{') => in_json(text, assumed),
            Some('<') => in_xml(text),
            _ => Ok(Self::Scenario),
        }
    }
}

fn in_xml(text: &str) -> Result<Contents, Vec<Fault>> {
    let document = xml::parse(text).map_err(|fault| vec![fault])?;
    let root = document.root_element().tag_name().name();
    if root != "commonOcean" {
        return Err(vec![Fault {
            path: root.to_owned(),
            found: format!("XML that begins with {root}"),
            allowed: "a CommonOcean scenario (commonOcean)".to_owned(),
            line: None,
        }]);
    }
    Ok(Contents::Situations {
        format: Format::CommonOcean,
        situations: commonocean::situations(&document)?,
    })
}

fn in_json(text: &str, assumed: &Assumed) -> Result<Contents, Vec<Fault>> {
    let value = json::parse(text).map_err(|fault| vec![fault])?;
    let faults = RefCell::default();
    let root = Json::root(&value, &faults);
    let has = |key: &str| value.get(key).is_some();
    let says = |key: &str| value.get(key).and_then(|v| v.as_str()).unwrap_or_default();
    if has("ownShip") || has("targetShips") {
        return Ok(Contents::Situations {
            format: Format::Dnv,
            situations: vec![dnv::situation(&root, &faults)],
        });
    }
    if has("cases") || has("own_ship") {
        let situations = imazu::situations(&root, &faults, assumed.variants())?;
        return Ok(Contents::Situations {
            format: Format::Imazu,
            situations,
        });
    }
    if says("format").starts_with("searoom-") || (has("runs") && has("summary")) {
        return Ok(Contents::Other("a result document"));
    }
    if ["FeatureCollection", "Feature"].contains(&says("type")) {
        return Ok(Contents::Other("a GeoJSON map"));
    }
    let keys: Vec<&str> = root.keys().take(5).collect();
    Err(vec![Fault {
        path: String::new(),
        found: format!("JSON with the keys {}", keys.join(", ")),
        allowed:
            "a DNV traffic situation (ownShip, targetShips) or Imazu's cases (own_ship, cases)"
                .to_owned(),
        line: None,
    }])
}
