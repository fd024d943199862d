//! Atomic writing of files.

use std::collections::BTreeSet;
use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::Mutex;

use tempfile::NamedTempFile;

/// File that could not be written.
#[derive(Debug, thiserror::Error)]
#[error("{}: cannot be written: {source}", file.display())]
pub struct WriteError {
    /// File path.
    pub file: PathBuf,
    /// Operating system error.
    pub source: io::Error,
}

/// Writes `contents` to a temporary file beside `file` and renames it, so that a crash leaves the
/// old or the new file, never half of it. The folder must exist. The target of a link is replaced,
/// not the link; devices and pipes are written to and never replaced.
pub fn write_atomically(file: &Path, contents: &[u8]) -> Result<(), WriteError> {
    write_whole(file, contents).map_err(|source| WriteError {
        file: file.to_owned(),
        source,
    })
}

/// [`write_atomically`] with the error of the system.
pub(crate) fn write_whole(file: &Path, contents: &[u8]) -> io::Result<()> {
    write_with(file, |open| open.write_all(contents))
}

/// [`write_atomically`] what `write` writes; the file is on the disk when this returns.
pub(crate) fn write_durably(
    file: &Path,
    write: impl FnOnce(&mut fs::File) -> io::Result<()>,
) -> Result<(), WriteError> {
    let synced = |open: &mut fs::File| write(open).and_then(|()| open.sync_all());
    write_with(file, synced).map_err(|source| WriteError {
        file: file.to_owned(),
        source,
    })
}

fn write_with(file: &Path, write: impl FnOnce(&mut fs::File) -> io::Result<()>) -> io::Result<()> {
    let file = match fs::metadata(file) {
        Ok(there) if there.is_dir() => file.to_owned(),
        Ok(there) if !there.is_file() || is_of_the_system(file) => {
            let mut open = fs::OpenOptions::new().write(true).open(file)?;
            return write(&mut open);
        }
        Ok(_) => fs::canonicalize(file)?,
        Err(_) => file.to_owned(),
    };
    let folder = folder_of(&file);
    remove_left_over(&folder);
    let mut builder = tempfile::Builder::new();
    builder.prefix(PREFIX);
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        // a temporary file is private by default, a result is not; the umask still applies
        builder.permissions(fs::Permissions::from_mode(0o666));
    }
    let mut temporary = locked(|| builder.tempfile_in(&folder))?;
    write(temporary.as_file_mut())?;
    temporary.persist(&file).map_err(|error| error.error)?;
    Ok(())
}

const PREFIX: &str = ".searoom-";

/// A locked temporary file: the lock tells other processes that it is in use. One of them may
/// remove it as left over before it is locked; then another is made.
fn locked(make: impl Fn() -> io::Result<NamedTempFile>) -> io::Result<NamedTempFile> {
    loop {
        let temporary = make()?;
        // on a system without locks nothing is removed
        if temporary.as_file().lock().is_err() || temporary.path().exists() {
            return Ok(temporary);
        }
    }
}

/// Removes temporary files that killed processes left in a folder: nobody holds their lock. Each
/// folder is searched once.
fn remove_left_over(folder: &Path) {
    static LOOKED_THROUGH: Mutex<BTreeSet<PathBuf>> = Mutex::new(BTreeSet::new());
    let known = LOOKED_THROUGH
        .lock()
        .map(|mut known| !known.insert(folder.to_owned()));
    if known.unwrap_or(true) {
        return;
    }
    for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
        let is_file = entry.file_type().is_ok_and(|kind| kind.is_file());
        if is_file && entry.file_name().to_string_lossy().starts_with(PREFIX) {
            let left = fs::OpenOptions::new().write(true).open(entry.path());
            if let Ok(left) = left
                && left.try_lock().is_ok()
            {
                // a file that cannot be removed stays
                let _ = fs::remove_file(entry.path());
            }
        }
    }
}

pub(crate) fn folder_of(file: &Path) -> PathBuf {
    match file.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder.to_owned(),
        _ => PathBuf::from("."),
    }
}

/// Device files; `/dev/stdout` may lead to a regular file that others write to.
fn is_of_the_system(file: &Path) -> bool {
    file.starts_with("/dev") || file.starts_with("/proc")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_is_replaced_whole_and_a_failure_leaves_nothing() {
        let folder = tempfile::tempdir().expect("a folder");
        let file = folder.path().join("plan.json");
        write_whole(&file, b"one").expect("written");
        write_whole(&file, b"two").expect("replaced");
        assert_eq!(fs::read(&file).expect("there"), b"two");
        let taken = folder.path().join("taken");
        fs::create_dir_all(taken.join("inside")).expect("made");
        write_whole(&taken, b"three").expect_err("a folder is in the way");
        assert_eq!(fs::read_dir(folder.path()).expect("there").count(), 2);
        assert!(write_whole(&folder.path().join("no/such"), b"").is_err());
    }

    /// The next run removes the temporary file of a killed run, but not that of a run that still
    /// writes.
    #[test]
    fn what_killed_runs_have_left_is_removed_and_what_is_written_is_not() {
        let folder = tempfile::tempdir().expect("a folder");
        let make = |name: &str| {
            let made = tempfile::Builder::new()
                .prefix(PREFIX)
                .tempfile_in(folder.path());
            let (open, path) = made.expect(name).keep().expect(name);
            (open, path)
        };
        let (dead, left) = make("left over");
        drop(dead);
        let (alive, written) = make("being written");
        alive.lock().expect("a lock");
        let other = folder.path().join("searoom-notes");
        fs::write(&other, b"mine").expect("written");
        write_whole(&folder.path().join("plan.json"), b"one").expect("written");
        assert!(!left.exists() && written.exists() && other.exists());
    }

    #[cfg(unix)]
    #[test]
    fn links_and_devices_stay_what_they_are() {
        let folder = tempfile::tempdir().expect("a folder");
        let [file, link] = ["a", "b"].map(|name| folder.path().join(name));
        write_whole(&file, b"one").expect("written");
        std::os::unix::fs::symlink(&file, &link).expect("a link");
        write_whole(&link, b"two").expect("written");
        assert!(link.is_symlink());
        assert_eq!(fs::read(&file).expect("there"), b"two");
        let nothing = folder.path().join("nothing");
        std::os::unix::fs::symlink("/dev/null", &nothing).expect("a link");
        write_whole(&nothing, b"three").expect("written");
        assert!(nothing.is_symlink());
        assert!(!Path::new("/dev/null").is_file());
    }
}
