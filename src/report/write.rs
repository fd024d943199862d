//! Files that are whole or not there.

use std::io::Write;
use std::path::{Path, PathBuf};

/// A file that could not be written.
///
/// # Examples
///
/// ```
/// use searoom::report::{WriteError, write_atomically};
///
/// let nowhere = std::path::Path::new("Cargo.toml/plan.json");
/// let WriteError { file, .. } = write_atomically(nowhere, b"{}").expect_err("no folder");
/// assert_eq!(file, nowhere);
/// ```
#[derive(Debug, thiserror::Error)]
#[error("{}: cannot be written: {source}", file.display())]
pub struct WriteError {
    /// The file.
    pub file: PathBuf,
    /// The system's answer.
    pub source: std::io::Error,
}

/// Writes `contents` under a temporary name beside `file` and renames it, so that a crash leaves the
/// old file or the new one, never half of it. The folder must exist.
pub fn write_atomically(file: &Path, contents: &[u8]) -> Result<(), WriteError> {
    let failed = |source| WriteError {
        file: file.to_owned(),
        source,
    };
    let folder = match file.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    };
    let mut builder = tempfile::Builder::new();
    builder.prefix(".searoom-");
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        // a temporary file is private by default, a result is not; the umask still applies
        builder.permissions(std::fs::Permissions::from_mode(0o666));
    }
    let mut temporary = builder.tempfile_in(folder).map_err(failed)?;
    temporary.write_all(contents).map_err(failed)?;
    temporary
        .persist(file)
        .map_err(|error| failed(error.error))?;
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_is_replaced_whole_and_a_failure_leaves_nothing() {
        let folder = tempfile::tempdir().expect("a folder");
        let file = folder.path().join("plan.json");
        write_atomically(&file, b"one").expect("written");
        write_atomically(&file, b"two").expect("replaced");
        assert_eq!(std::fs::read(&file).expect("there"), b"two");
        let taken = folder.path().join("taken");
        std::fs::create_dir_all(taken.join("inside")).expect("made");
        let error = write_atomically(&taken, b"three").expect_err("a folder is in the way");
        assert!(error.to_string().contains("taken"));
        assert_eq!(std::fs::read_dir(folder.path()).expect("there").count(), 2);
        assert!(write_atomically(&folder.path().join("no/such"), b"").is_err());
    }
}
