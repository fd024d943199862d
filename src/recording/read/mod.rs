//! Reads a recording back, offline and whole.

mod table;
mod values;

pub use table::{EntityRow, EntityTable};

use std::collections::{BTreeMap, BTreeSet};
use std::io::Read;
use std::path::{Path, PathBuf};

use rerun::external::re_log_encoding::{DecoderApp, RRD_FOURCC, StreamHeader};
use rerun::log::{Chunk, LogMsg};

use super::checksum::is_sealed;
use super::{COMPARISON, DOCUMENT, SIMULATION, TIMELINE};
use crate::document::{EntityContents, TimelineContents};

/// Longest file that is read: 1 GiB. The whole file is held in memory.
const FILE_BYTES: u64 = 1 << 30;

/// Nanoseconds of a second: the unit of durations and of instants.
const NANOSECONDS: f64 = 1e9;

/// Why a recording cannot be read.
#[derive(Debug, thiserror::Error)]
pub enum ReadError {
    /// The file cannot be read.
    #[error("{}: cannot be read: {source}", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// Error of the system.
        source: std::io::Error,
    },
    /// The file is no recording of Searoom, or not a whole one.
    #[error("{}: {reason}", path.display())]
    Broken {
        /// The file.
        path: PathBuf,
        /// Fault that was found.
        reason: String,
    },
}

/// A recording that was read, without its layout.
#[derive(Debug)]
pub struct Recorded {
    /// Version of the Rerun library that wrote it; `None` where the file does not tell.
    pub version: Option<String>,
    /// Size of the file.
    pub bytes: u64,
    /// The chunks of each entity, by its path.
    chunks: BTreeMap<String, Vec<Chunk>>,
}

/// Tests whether a file begins as recordings do.
pub fn is_recording(bytes: &[u8]) -> bool {
    bytes.starts_with(&RRD_FOURCC)
}

impl Recorded {
    /// Reads a file. Anything but a whole recording of Searoom is an error. O(bytes).
    ///
    /// The checksum is tested before Rerun decodes anything. A damaged file therefore costs the
    /// memory of its bytes, and no length in it is believed.
    ///
    /// # Panics
    ///
    /// Rerun's decoder may panic, or run out of memory, where a file was crafted on purpose and has
    /// the right checksum.
    ///
    /// # Examples
    ///
    /// ```
    /// use searoom::recording::{ReadError, Recorded};
    ///
    /// let error = Recorded::read("scenarios/README.md".as_ref()).expect_err("no recording");
    /// assert!(matches!(error, ReadError::Broken { .. }));
    /// ```
    pub fn read(path: &Path) -> Result<Self, ReadError> {
        let broken = |reason: String| ReadError::Broken {
            path: path.to_owned(),
            reason,
        };
        let bytes = file_bytes(path).map_err(|source| ReadError::Read {
            path: path.to_owned(),
            source,
        })?;
        if let Some(reason) = fault(&bytes) {
            return Err(broken(reason.to_owned()));
        }
        Self::decode(&bytes).map_err(|reason| broken(format!("damaged: {reason}")))
    }

    fn decode(bytes: &[u8]) -> Result<Self, Box<dyn std::error::Error>> {
        let mut chunks: BTreeMap<String, Vec<Chunk>> = BTreeMap::new();
        let mut version = None;
        for message in DecoderApp::decode_eager(bytes)? {
            match message? {
                LogMsg::SetStoreInfo(opened) if opened.info.store_id.is_recording() => {
                    version = opened.info.store_version.map(|v| v.to_string());
                }
                LogMsg::ArrowMsg(store, message) if store.is_recording() => {
                    let chunk = Chunk::from_arrow_msg(&message)?;
                    let path = chunk.entity_path().to_string();
                    chunks.entry(path).or_default().push(chunk);
                }
                // the layout
                _ => {}
            }
        }
        Ok(Self {
            version,
            bytes: bytes.len() as u64,
            chunks,
        })
    }

    /// The plan document as `plan --json` wrote it; `None` in a recording without one.
    pub fn document(&self) -> Option<String> {
        self.table(DOCUMENT)?.text()
    }

    /// The document of a comparison: that of `compare --json` for its one scenario; `None` in a
    /// recording of anything else.
    pub fn comparison(&self) -> Option<String> {
        self.table(COMPARISON)?.text()
    }

    /// The document of a simulation, without the motions and the estimates; `None` in a recording
    /// of anything else.
    pub fn simulation(&self) -> Option<String> {
        self.table(SIMULATION)?.text()
    }

    /// Lists every entity, sorted by path.
    pub fn entities(&self) -> Vec<EntityContents> {
        let all = self.chunks.iter();
        all.map(|(path, chunks)| contents(path, chunks)).collect()
    }

    /// The timeline of all entities.
    pub fn timelines(&self) -> Vec<TimelineContents> {
        span(self.chunks.values().flatten())
    }

    /// All rows of an entity, in order of time; `None` when there is no such entity. A leading
    /// slash may be left out.
    pub fn table(&self, path: &str) -> Option<EntityTable> {
        let path = path.trim_start_matches('/');
        let chunks = self.chunks.get(&format!("/{path}"))?;
        Some(EntityTable::of(chunks))
    }
}

/// The bytes of a file; of a file that is no recording the first only.
fn file_bytes(path: &Path) -> std::io::Result<Vec<u8>> {
    // a pipe would be waited for, a device read for ever
    if !std::fs::metadata(path)?.is_file() {
        let kind = std::io::ErrorKind::InvalidInput;
        return Err(std::io::Error::new(kind, "not a regular file"));
    }
    let mut bytes = Vec::new();
    let mut file = std::fs::File::open(path)?.take(FILE_BYTES + 1);
    let header = StreamHeader::ENCODED_SIZE_BYTES as u64;
    file.by_ref().take(header).read_to_end(&mut bytes)?;
    if is_recording(&bytes) {
        file.read_to_end(&mut bytes)?;
    }
    Ok(bytes)
}

/// Why a file cannot be a whole recording; nothing of it is decoded.
fn fault(bytes: &[u8]) -> Option<&'static str> {
    if bytes.is_empty() {
        return Some("an empty file");
    }
    if !is_recording(bytes) {
        return Some("no Rerun recording: it does not begin with RRF2");
    }
    if bytes.len() as u64 > FILE_BYTES {
        return Some("more than 1 GiB");
    }
    let sealed = is_sealed(bytes);
    (!sealed).then_some(
        "cut off, damaged, or rewritten by another program: its checksum is missing or wrong",
    )
}

fn contents(path: &str, chunks: &[Chunk]) -> EntityContents {
    EntityContents {
        path: path.to_owned(),
        rows: chunks.iter().map(Chunk::num_rows).sum(),
        components: components(chunks),
        timelines: span(chunks),
    }
}

fn components(chunks: &[Chunk]) -> Vec<String> {
    let names = chunks.iter().flat_map(Chunk::components_identifiers);
    let names: BTreeSet<String> = names.map(|name| name.to_string()).collect();
    names.into_iter().collect()
}

/// The times of a chunk's rows, in seconds; none for what holds at all times.
fn seconds(chunk: &Chunk) -> impl Iterator<Item = f64> {
    let columns = chunk.timelines().values();
    let times = columns.flat_map(|column| column.times_raw());
    times.map(|time| *time as f64 / NANOSECONDS)
}

/// The timeline of some chunks; none for what holds at all times.
fn span<'a>(chunks: impl IntoIterator<Item = &'a Chunk>) -> Vec<TimelineContents> {
    let times: Vec<f64> = chunks.into_iter().flat_map(seconds).collect();
    let first = times.iter().copied().reduce(f64::min);
    let last = times.iter().copied().reduce(f64::max);
    let span = first.zip(last).map(|(first, last)| TimelineContents {
        name: TIMELINE.to_owned(),
        unit: "s",
        first,
        last,
    });
    span.into_iter().collect()
}
