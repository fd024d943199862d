//! What is wrong with a map.

use std::fmt;
use std::path::PathBuf;

/// One thing wrong in a map: where, what was found, what is allowed.
///
/// # Examples
///
/// ```
/// use searoom::frame::{Geographic, Georeference};
/// use searoom::map::{Map, MapFault};
///
/// let earth = Georeference::new(Geographic { lat_deg: 63.0, lon_deg: 10.0 }).expect("an origin");
/// let buoy = r#"{ "type": "Point", "coordinates": [10.0, 63.0] }"#;
/// let faults: Vec<MapFault> = Map::parse(buoy, &earth).expect_err("no land");
/// assert_eq!(faults.len(), 1);
/// assert!(faults[0].to_string().contains("allowed: "));
/// ```
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct MapFault {
    /// Which feature, from 0; `None` when the file as a whole is meant.
    pub feature: Option<usize>,
    /// What the file says there.
    pub found: String,
    /// What it may say.
    pub allowed: String,
}

impl MapFault {
    /// What was found, with the feature.
    pub fn place_and_found(&self) -> String {
        match self.feature {
            Some(index) => format!("features[{index}]: {}", self.found),
            None => self.found.clone(),
        }
    }
}

impl fmt::Display for MapFault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (found, allowed) = (self.place_and_found(), &self.allowed);
        write!(f, "found {found}; allowed: {allowed}")
    }
}

/// Why a file gives no map.
///
/// # Examples
///
/// ```
/// use searoom::frame::{Geographic, Georeference};
/// use searoom::map::{Map, MapError};
///
/// let earth = Georeference::new(Geographic { lat_deg: 63.0, lon_deg: 10.0 }).expect("an origin");
/// let error = Map::read("maps/nowhere.geojson".as_ref(), &earth).expect_err("no such file");
/// assert!(matches!(&error, MapError::Read { .. }));
/// assert!(error.to_string().starts_with("maps/nowhere.geojson: cannot be read"));
/// ```
#[derive(Debug, thiserror::Error)]
pub enum MapError {
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
        /// Everything wrong with it, in order of features. Never empty.
        faults: Vec<MapFault>,
    },
}

/// How many, then one on each line.
pub(crate) fn listed<F: fmt::Display>(faults: &[F]) -> String {
    let plural = if faults.len() == 1 { "" } else { "s" };
    let mut text = format!("{} fault{plural}", faults.len());
    for fault in faults {
        text.push_str(&format!("\n  {fault}"));
    }
    text
}
