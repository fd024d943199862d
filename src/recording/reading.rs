//! `.rrd` → what it holds, read offline and whole.

use std::collections::BTreeMap;
use std::io::Read;
use std::path::{Path, PathBuf};

use rerun::external::re_log_types::TimeType;
use rerun::log::Chunk;

use super::document::{joined, unpacked};
use super::messages::Messages;
use super::table::{EntityTable, text_of};
use super::{APPLICATION, COMPARISON, DOCUMENT, TIMING, frames};

/// Bytes, 1 GiB: more is no plan of ours, and would have to fit into memory.
const FILE_BYTES: u64 = 1 << 30;

/// Nanoseconds of a second: what durations and moments are counted in.
const NANOSECONDS: f64 = 1e9;

/// Why a recording cannot be read.
///
/// # Examples
///
/// ```
/// use searoom::recording::{ReadError, Recorded};
///
/// let error = Recorded::read("scenarios/README.md".as_ref()).expect_err("no recording");
/// assert!(matches!(error, ReadError::Broken { .. }));
/// ```
#[derive(Debug, thiserror::Error)]
pub enum ReadError {
    /// The file cannot be read.
    #[error("{}: cannot be read: {source}", path.display())]
    Read {
        /// Which.
        path: PathBuf,
        /// What the system says.
        source: std::io::Error,
    },
    /// The file is no recording, or not a whole one.
    #[error("{}: {reason}", path.display())]
    Broken {
        /// Which.
        path: PathBuf,
        /// In words.
        reason: String,
    },
}

/// A recording that was read: its own store, not that of its layout.
///
/// # Examples
///
/// ```
/// # use searoom::{pipeline, scenario::Scenario};
/// use searoom::recording::{Recorded, write};
///
/// let scenario = Scenario::read("scenarios/colregs/head-on.toml".as_ref())?;
/// # let folder = tempfile::tempdir()?;
/// let file = folder.path().join("head-on.rrd");
/// write(&pipeline::run(scenario), None, &file)?;
/// let recorded = Recorded::read(&file)?;
/// assert!(recorded.is_ours() && recorded.document().is_none(), "none was put in");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct Recorded {
    /// The program that made it.
    pub application: String,
    /// Of the Rerun that wrote it; `None` where it does not say.
    pub version: Option<String>,
    /// Of the file.
    pub bytes: u64,
    /// By their paths.
    chunks: BTreeMap<String, Vec<Chunk>>,
    /// That of a plan or of a comparison.
    document: Option<String>,
    comparison: Option<String>,
}

/// What one entity holds.
///
/// # Examples
///
/// ```
/// # use searoom::{pipeline, scenario::Scenario};
/// use searoom::recording::{EntityContents, Recorded, write};
///
/// let scenario = Scenario::read("scenarios/colregs/head-on.toml".as_ref())?;
/// # let folder = tempfile::tempdir()?;
/// let file = folder.path().join("head-on.rrd");
/// write(&pipeline::run(scenario), None, &file)?;
/// let entities: Vec<EntityContents> = Recorded::read(&file)?.entities();
/// assert!(entities.len() > 5 && entities.iter().all(|entity| !entity.components.is_empty()));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct EntityContents {
    /// With a leading slash.
    pub path: String,
    /// Of all its columns together.
    pub rows: usize,
    /// Names, sorted.
    pub components: Vec<String>,
    /// None for what holds at all times.
    pub timelines: Vec<TimelineContents>,
}

/// A timeline and what of it is used.
///
/// # Examples
///
/// ```
/// # use searoom::{pipeline, scenario::Scenario};
/// use searoom::recording::{Recorded, TimelineContents, write};
///
/// let scenario = Scenario::read("scenarios/colregs/head-on.toml".as_ref())?;
/// # let folder = tempfile::tempdir()?;
/// let file = folder.path().join("head-on.rrd");
/// write(&pipeline::run(scenario), None, &file)?;
/// let timelines: Vec<TimelineContents> = Recorded::read(&file)?.timelines();
/// assert!(timelines.iter().any(|line| line.first <= 0.0 && line.last >= 300.0), "seconds of the plan");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct TimelineContents {
    /// Its name.
    pub name: String,
    /// `"s"` for durations and for moments since 1970, else empty.
    pub unit: &'static str,
    /// The first time.
    pub first: f64,
    /// The last time.
    pub last: f64,
}

impl Recorded {
    /// Reads a file. Anything that is no whole recording is an error that says what was found. O(bytes).
    pub fn read(path: &Path) -> Result<Self, ReadError> {
        let unread = |source| ReadError::Read {
            path: path.to_owned(),
            source,
        };
        let broken = |reason: String| ReadError::Broken {
            path: path.to_owned(),
            reason,
        };
        // a pipe would be waited for, a device read for ever
        if !std::fs::metadata(path).map_err(unread)?.is_file() {
            let kind = std::io::ErrorKind::InvalidInput;
            return Err(unread(std::io::Error::new(kind, "not a regular file")));
        }
        let mut bytes = Vec::new();
        let mut file = std::fs::File::open(path).map_err(unread)?;
        // what is no recording is not read to its end
        let mut head = file.by_ref().take(frames::HEADER as u64);
        head.read_to_end(&mut bytes).map_err(unread)?;
        if frames::is_recording(&bytes) {
            let mut rest = file.take(FILE_BYTES + 1 - bytes.len() as u64);
            rest.read_to_end(&mut bytes).map_err(unread)?;
        }
        if bytes.len() as u64 > FILE_BYTES {
            return Err(broken("more than 1 GiB".to_owned()));
        }
        let frames = frames::frames(&bytes).map_err(broken)?;
        let damaged = |reason| broken(format!("damaged: {reason}"));
        let messages = Messages::of(&frames).map_err(damaged)?;
        Self::of(messages, bytes.len() as u64).map_err(damaged)
    }

    fn of(messages: Messages, bytes: u64) -> Result<Self, String> {
        let mut read = Self {
            application: String::new(),
            version: None,
            bytes,
            chunks: BTreeMap::new(),
            document: None,
            comparison: None,
        };
        let mut timing = None;
        let mut recordings: Vec<_> = messages.stores.into_iter().collect();
        recordings.retain(|info| info.store_id.is_recording());
        recordings.dedup_by(|a, b| a.store_id == b.store_id);
        if recordings.len() > 1
            && (recordings.iter())
                .any(|info| info.store_id.application_id().as_str() == APPLICATION)
        {
            return Err(format!("{} recordings in one file", recordings.len()));
        }
        if let Some(info) = recordings.pop() {
            read.application = info.store_id.application_id().to_string();
            read.version = info.store_version.map(|v| v.to_string());
        }
        for (store, chunk) in messages.chunks {
            let path = chunk.entity_path().to_string();
            if store.is_recording() {
                read.chunks.entry(path).or_default().push(chunk);
            } else if path == format!("/{TIMING}") {
                timing = text_of(&[chunk]);
            }
        }
        // the order of writing, which row ids keep, whatever the order in the file
        for chunks in read.chunks.values_mut() {
            chunks.sort_by_key(Chunk::row_id_range);
        }
        if read.is_ours() {
            let document = |entity: &str| {
                let chunks = read.chunks.get(&format!("/{entity}"));
                let text = chunks.map(|chunks| unpacked(chunks)).transpose()?;
                Ok::<_, String>(text.map(|text| joined(&text, timing.as_deref())))
            };
            (read.document, read.comparison) = (document(DOCUMENT)?, document(COMPARISON)?);
        }
        Ok(read)
    }

    /// True for one of Searoom's.
    pub fn is_ours(&self) -> bool {
        self.application == APPLICATION
    }

    /// The plan document as `plan --json` wrote it; `None` in another program's recording, and in one that was cut short.
    pub fn document(&self) -> Option<&str> {
        self.document.as_deref()
    }

    /// The document of a comparison: that of `compare --json` for its one scenario; `None` in a recording of anything else.
    pub fn comparison(&self) -> Option<&str> {
        self.comparison.as_deref()
    }

    /// Every entity, sorted by path.
    pub fn entities(&self) -> Vec<EntityContents> {
        let all = self.chunks.iter();
        all.map(|(path, chunks)| contents(path, chunks)).collect()
    }

    /// Every timeline over all entities, sorted by name.
    pub fn timelines(&self) -> Vec<TimelineContents> {
        spans(self.chunks.values().flatten())
    }

    /// All rows of an entity, in order of time; `None` when there is no such entity. A leading slash may be left out.
    pub fn table(&self, path: &str) -> Option<EntityTable> {
        let path = path.trim_start_matches('/');
        let chunks = self.chunks.get(&format!("/{path}"))?;
        Some(EntityTable::of(chunks))
    }
}

fn contents(path: &str, chunks: &[Chunk]) -> EntityContents {
    let mut components: Vec<String> = chunks
        .iter()
        .flat_map(|chunk| chunk.components_identifiers())
        .map(|component| component.to_string())
        .collect();
    components.sort();
    components.dedup();
    EntityContents {
        path: path.to_owned(),
        rows: chunks.iter().map(Chunk::num_rows).sum(),
        components,
        timelines: spans(chunks),
    }
}

fn spans<'a>(chunks: impl IntoIterator<Item = &'a Chunk>) -> Vec<TimelineContents> {
    let mut spans: BTreeMap<String, TimelineContents> = BTreeMap::new();
    for column in chunks.into_iter().flat_map(|c| c.timelines().values()) {
        let (unit, scale) = scale(column.timeline().typ());
        let times = column.times_raw();
        let (Some(first), Some(last)) = (times.iter().min(), times.iter().max()) else {
            continue;
        };
        let (first, last) = (*first as f64 / scale, *last as f64 / scale);
        let span = spans
            .entry(column.name().to_owned())
            .or_insert_with(|| TimelineContents {
                name: column.name().to_owned(),
                unit,
                first,
                last,
            });
        span.first = span.first.min(first);
        span.last = span.last.max(last);
    }
    spans.into_values().collect()
}

/// The unit of a timeline in words, and how many of its counts are one.
pub(super) fn scale(kind: TimeType) -> (&'static str, f64) {
    match kind {
        TimeType::Sequence => ("", 1.0),
        TimeType::DurationNs | TimeType::TimestampNs => ("s", NANOSECONDS),
    }
}
