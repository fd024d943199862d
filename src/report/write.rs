//! Atomic file writes.

use std::path::{Path, PathBuf};

use crate::output::write_whole;

/// File that could not be written.
#[derive(Debug, thiserror::Error)]
#[error("{}: cannot be written: {source}", file.display())]
pub struct WriteError {
    /// File path.
    pub file: PathBuf,
    /// Operating system error.
    pub source: std::io::Error,
}

/// Writes `contents` to a temporary file beside `file` and renames it. After a crash, either the
/// old or the new file exists, never a part of it. The folder must exist. Symbolic links are
/// preserved: their target is replaced. Devices and pipes are written to and never replaced.
pub fn write_atomically(file: &Path, contents: &[u8]) -> Result<(), WriteError> {
    write_whole(file, contents).map_err(|source| WriteError {
        file: file.to_owned(),
        source,
    })
}
