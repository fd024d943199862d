//! Files at the paths of a command, and the names of their results.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

use anyhow::Context;
use searoom::input::{Fault, InputError, read_from, read_text};

use super::super::found::{Found, Refused};
use super::super::output::Output;

/// Path that means standard input.
const STDIN: &str = "-";

/// Name of standard input in messages.
const STDIN_NAME: &str = "standard input";

/// Name of a file in messages.
pub fn name(file: &Path) -> PathBuf {
    match is_stdin(file) {
        // in the working directory, where the files that it names are
        true => PathBuf::from(STDIN_NAME),
        false => file.to_owned(),
    }
}

pub fn is_stdin(file: &Path) -> bool {
    file == Path::new(STDIN)
}

/// The text of a file, or of standard input to its end.
pub fn text(file: &Path, mebibytes: u64, kind: &str) -> Result<String, InputError> {
    if !is_stdin(file) {
        return read_text(file, mebibytes, kind);
    }
    let name = name(file);
    let text = read_from(std::io::stdin(), &name, mebibytes, kind)?;
    match text.trim() {
        "" => Err(InputError::faults(
            &name,
            vec![Fault::new("", "nothing", kind)],
        )),
        _ => Ok(text),
    }
}

/// Replacement of "/" in output names.
pub const SEPARATOR: &str = "__";

/// The kind of file that is looked for in a folder.
pub struct FileKind {
    name: &'static str,
    endings: &'static [&'static str],
}

pub const SCENARIOS: FileKind = FileKind {
    name: "scenarios (.toml, .json or .xml files)",
    endings: &["toml", "json", "xml"],
};

pub const PLANS: FileKind = FileKind {
    name: "plan documents (.json or .rrd files)",
    endings: &["json", "rrd"],
};

impl FileKind {
    fn holds(&self, file: &Path) -> bool {
        let ending = file.extension().and_then(|ending| ending.to_str());
        ending.is_some_and(|ending| self.endings.contains(&ending))
    }
}

/// Lists the files of a kind at `paths`, in the order of the arguments and sorted within each
/// folder. An unreadable folder gives an error. A repeated file is listed once, with a note.
pub fn find(paths: &[PathBuf], kind: &FileKind, output: &Output) -> Vec<Result<Found, Refused>> {
    let mut known = BTreeSet::new();
    let mut all = Vec::new();
    for found in meant(paths, kind) {
        // missing files are reported on reading
        let place = found.as_ref().ok().and_then(|f| f.file.canonicalize().ok());
        let again = place.is_some_and(|place| !known.insert(place));
        if let (Ok(found), true) = (&found, again) {
            let file = found.file.display();
            output.note(&format_args!("{file}: given more than once, taken once"));
        } else {
            all.push(found);
        }
    }
    all
}

fn meant(paths: &[PathBuf], kind: &FileKind) -> Vec<Result<Found, Refused>> {
    let mut all = Vec::new();
    for path in paths {
        if !path.is_dir() {
            // a missing file is reported on reading
            all.push(Ok(Found {
                file: path.clone(),
                stem: match path.to_str() {
                    Some(STDIN) => "stdin".to_owned(),
                    _ => stem(path.file_name().map(Path::new).unwrap_or(path)),
                },
                in_folder: false,
            }));
            continue;
        }
        let unread = |error: String| Err(Refused::unreadable(path, error));
        let mut files = Vec::new();
        match walk(path, kind, &mut files) {
            Ok(()) if files.is_empty() => {
                let (folder, kind) = (path.display(), kind.name);
                all.push(unread(format!("{folder}: a folder without {kind}")));
            }
            Ok(()) => all.extend(files.into_iter().map(|file| {
                let relative = file.strip_prefix(path).unwrap_or(&file);
                Ok(Found {
                    stem: stem(relative),
                    file,
                    in_folder: true,
                })
            })),
            Err(error) => all.push(unread(format!("{error:#}"))),
        }
    }
    all
}

/// Name of the outputs of a file.
pub fn stem(relative: &Path) -> String {
    let parts: Vec<_> = relative
        .with_extension("")
        .components()
        .map(|part| part.as_os_str().to_string_lossy().into_owned())
        .collect();
    parts.join(SEPARATOR)
}

/// Collects files of a kind, depth first in order of names. Hidden entries are skipped. Links to
/// folders are not followed, which prevents loops.
fn walk(folder: &Path, kind: &FileKind, files: &mut Vec<PathBuf>) -> anyhow::Result<()> {
    let unread = || format!("{}: cannot be read", folder.display());
    let mut entries = fs::read_dir(folder)
        .and_then(|entries| entries.collect::<Result<Vec<_>, _>>())
        .with_context(unread)?;
    entries.sort_by_key(|entry| entry.file_name());
    for entry in entries {
        let path = entry.path();
        if entry.file_name().to_string_lossy().starts_with('.') {
            continue;
        }
        if entry.file_type().with_context(unread)?.is_dir() {
            walk(&path, kind, files)?;
        } else if kind.holds(&path) && !path.is_dir() {
            files.push(path);
        }
    }
    Ok(())
}
