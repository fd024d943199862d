//! Files that are whole or not there.

use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

/// Writes `contents` under a temporary name beside `file` and renames it, so that a crash leaves the old file or the new one, never
/// half of it. The folder must exist. A link stays one, and what it leads to is replaced; what is no regular file, a device
/// or a pipe, is written to and never replaced.
pub(crate) fn write_whole(file: &Path, contents: &[u8]) -> io::Result<()> {
    let file = match fs::metadata(file) {
        Ok(there) if there.is_dir() => file.to_owned(),
        Ok(there) if !there.is_file() || is_of_the_system(file) => {
            let mut open = fs::OpenOptions::new().write(true).open(file)?;
            return open.write_all(contents);
        }
        Ok(_) => fs::canonicalize(file)?,
        Err(_) => file.to_owned(),
    };
    let mut builder = tempfile::Builder::new();
    builder.prefix(".searoom-");
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        // a temporary file is private by default, a result is not; the umask still applies
        builder.permissions(fs::Permissions::from_mode(0o666));
    }
    let mut temporary = builder.tempfile_in(folder_of(&file))?;
    temporary.write_all(contents)?;
    temporary.persist(&file).map_err(|error| error.error)?;
    Ok(())
}

/// The folder that a file is in.
pub(crate) fn folder_of(file: &Path) -> PathBuf {
    match file.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder.to_owned(),
        _ => PathBuf::from("."),
    }
}

/// Standard output by name, which may lead to a regular file that others are writing to.
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
