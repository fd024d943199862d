//! Files that are whole or not there.

use std::path::{Path, PathBuf};

use crate::output::write_whole;

/// A file that could not be written.
#[derive(Debug, thiserror::Error)]
#[error("{}: cannot be written: {source}", file.display())]
pub struct WriteError {
    /// The file.
    pub file: PathBuf,
    /// The system's answer.
    pub source: std::io::Error,
}

/// Writes `contents` under a temporary name beside `file` and renames it, so that a crash leaves
/// the old file or the new one, never half of it. The folder must exist. A link stays one, and what
/// it leads to is replaced; a device or a pipe is written to and never replaced.
pub fn write_atomically(file: &Path, contents: &[u8]) -> Result<(), WriteError> {
    write_whole(file, contents).map_err(|source| WriteError {
        file: file.to_owned(),
        source,
    })
}
