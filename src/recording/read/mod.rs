//! Reads a recording back, offline and whole.

mod frames;
mod table;
mod values;

pub use crate::document::Checksum;
pub use table::{EntityRow, EntityTable};

use std::collections::{BTreeMap, BTreeSet};
use std::io::Read;
use std::path::{Path, PathBuf};

use rerun::external::re_log_encoding::{DecoderApp, RRD_FOURCC, StreamHeader};
use rerun::log::{Chunk, LogMsg};

use super::checksum::checksum_of;
use super::{APPLICATION, COMPARISON, DOCUMENT, SIMULATION, TIMELINE};
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
    /// Whether the bytes of the file are those that Searoom wrote.
    pub checksum: Checksum,
    /// The chunks of each entity, by its path.
    chunks: BTreeMap<String, Vec<Chunk>>,
}

/// Tests whether a file begins as recordings do.
pub fn is_recording(bytes: &[u8]) -> bool {
    bytes.starts_with(&RRD_FOURCC)
}

impl Recorded {
    /// Reads a file with one recording. Anything but a whole recording of Searoom is an error, and so
    /// are several. O(bytes).
    ///
    /// The checksum is tested before Rerun decodes anything. A damaged file therefore costs the
    /// memory of its bytes, and no length in it is believed. Where [`Self::checksum`] is gone, only
    /// the frames of the file and the sizes of its unpacked messages are tested.
    ///
    /// # Panics
    ///
    /// Rerun's decoder may panic, or run out of memory, where a file was crafted on purpose and has
    /// the right checksum, or was damaged after another program had written it again.
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
        let mut all = Self::read_all(path)?;
        match (all.pop(), all.len()) {
            (Some(one), 0) => Ok(one),
            (_, others) => Err(ReadError::Broken {
                path: path.to_owned(),
                reason: format!(
                    "{} recordings in one file; name the files that it was made from",
                    others + 1
                ),
            }),
        }
    }

    /// Reads the recordings of a file, at least one, in the order of their names; see
    /// [`Self::read`]. `rerun rrd merge` makes files with several.
    pub fn read_all(path: &Path) -> Result<Vec<Self>, ReadError> {
        let broken = |reason: String| ReadError::Broken {
            path: path.to_owned(),
            reason,
        };
        let bytes = file_bytes(path).map_err(|source| ReadError::Read {
            path: path.to_owned(),
            source,
        })?;
        let checksum = tested(&bytes).map_err(|reason| broken(reason.to_owned()))?;
        let all = Self::decode(&bytes, checksum)
            .map_err(|reason| broken(format!("damaged: {reason}")))?;
        match all.is_empty() {
            true => Err(broken("no recording of Searoom in it".to_owned())),
            false => Ok(all),
        }
    }

    fn decode(bytes: &[u8], checksum: Checksum) -> Result<Vec<Self>, Box<dyn std::error::Error>> {
        let mut all: BTreeMap<String, Self> = BTreeMap::new();
        for message in DecoderApp::decode_eager(bytes)? {
            let message = message?;
            let store = message.store_id();
            if !store.is_recording() || store.application_id().as_str() != APPLICATION {
                // a layout, or another program's
                continue;
            }
            let name = store.recording_id().to_string();
            let recorded = all.entry(name).or_insert_with(|| Self {
                version: None,
                bytes: bytes.len() as u64,
                checksum,
                chunks: BTreeMap::new(),
            });
            match message {
                LogMsg::SetStoreInfo(opened) => {
                    recorded.version = opened.info.store_version.map(|v| v.to_string());
                }
                LogMsg::ArrowMsg(_, message) => {
                    let chunk = Chunk::from_arrow_msg(&message)?;
                    let path = chunk.entity_path().to_string();
                    recorded.chunks.entry(path).or_default().push(chunk);
                }
                LogMsg::BlueprintActivationCommand(_) => {}
            }
        }
        Ok(all.into_values().collect())
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

/// The state of a file that can be a whole recording, or why it cannot; nothing of it is decoded.
fn tested(bytes: &[u8]) -> Result<Checksum, &'static str> {
    if bytes.is_empty() {
        return Err("an empty file");
    }
    if !is_recording(bytes) {
        return Err("no Rerun recording: it does not begin with RRF2");
    }
    if bytes.len() as u64 > FILE_BYTES {
        return Err("more than 1 GiB");
    }
    checksum_of(bytes, frames::are_whole)
        .ok_or("cut off, damaged, or without an end: its checksum is missing or wrong")
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
