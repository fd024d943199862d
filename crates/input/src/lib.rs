#![doc = include_str!("../README.md")]
#![forbid(unsafe_code)]
#![warn(missing_docs)]

mod field;
pub mod schema;
mod table;
pub mod text;
mod value;

pub use field::{DATE_TIME, Field, Range, abbreviated, date_time, every};
use table::Key;
pub use table::Table;
pub use value::{Node, from_json, from_toml};

use std::cell::RefCell;
use std::collections::BTreeSet;
use std::fmt::{self, Display};
use std::fs::File;
use std::io::{Error, ErrorKind, Read};
use std::path::{Path, PathBuf};
use std::rc::Rc;

use text::{LINE_CHARS, counted, printable};

/// One thing wrong in a file: its place, what was found, what is allowed.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Fault {
    /// The field, as in `targets[0].speed_mps`; empty if the fault concerns the whole file.
    pub path: String,
    /// Content of the file there.
    pub found: String,
    /// Allowed content.
    pub allowed: String,
    /// Line in the file, from 1, where one can be named.
    pub line: Option<usize>,
}

impl Fault {
    /// A fault without a line.
    pub fn new(path: impl Into<String>, found: impl Display, allowed: impl Display) -> Self {
        Self {
            path: path.into(),
            found: found.to_string(),
            allowed: allowed.to_string(),
            line: None,
        }
    }

    /// This fault at a line of the file, where one is known.
    #[must_use]
    pub fn at_line(self, line: impl Into<Option<usize>>) -> Self {
        Self {
            line: line.into(),
            ..self
        }
    }
}

impl std::error::Error for Fault {}

impl Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(line) = self.line {
            write!(f, "line {line}: ")?;
        }
        if !self.path.is_empty() {
            write!(f, "{}: ", self.path)?;
        }
        write!(f, "found {}; allowed: {}", self.found, self.allowed)
    }
}

/// Why an input file could not be used.
#[derive(Debug, thiserror::Error)]
pub enum InputError {
    /// The file cannot be read.
    #[error("{}: cannot be read: {source}{}", file.display(), meant(near))]
    Read {
        /// The file.
        file: PathBuf,
        /// The error of the operating system.
        source: std::io::Error,
        /// Where there is no such file, the one in its folder whose name is most like it.
        near: Option<PathBuf>,
    },
    /// The file was read and is wrong.
    #[error("{}: {}", file.display(), listed(faults))]
    Faults {
        /// The file.
        file: PathBuf,
        /// Everything wrong with it, in order of lines. Never empty.
        faults: Vec<Fault>,
    },
}

fn meant(near: &Option<PathBuf>) -> String {
    let near = near.as_ref().map(|near| near.display());
    near.map_or(String::new(), |near| format!("; perhaps {near}?"))
}

/// Likeness from which a name of another file is offered, from 0 to 1.
const ALIKE: f64 = 0.85;

impl InputError {
    /// A file that cannot be read. Where there is none, a similar name is looked for.
    pub fn unread(file: &Path, source: Error) -> Self {
        let near = (source.kind() == ErrorKind::NotFound).then(|| near(file));
        Self::Read {
            file: file.to_owned(),
            source,
            near: near.flatten(),
        }
    }

    /// Faults of a file.
    pub fn faults(file: &Path, faults: Vec<Fault>) -> Self {
        Self::Faults {
            file: file.to_owned(),
            faults,
        }
    }
}

/// The path with each missing entry replaced by the one whose name is most like it in its folder.
/// Among equals the first by name.
fn near(file: &Path) -> Option<PathBuf> {
    let name = file.file_name()?.to_str()?.to_lowercase();
    let mut folder = file.parent().unwrap_or(Path::new("")).to_owned();
    if folder != Path::new("") && !folder.is_dir() {
        folder = near(&folder)?;
        let there = folder.join(file.file_name()?);
        if there.exists() {
            return Some(there);
        }
    }
    let folder = folder.as_path();
    let listed = match folder == Path::new("") {
        true => Path::new("."),
        false => folder,
    };
    let entries = std::fs::read_dir(listed).ok()?.flatten();
    let names = entries.filter_map(|entry| entry.file_name().into_string().ok());
    let alike = names.map(|other| (strsim::jaro_winkler(&name, &other.to_lowercase()), other));
    let alike = alike.filter(|(alike, _)| *alike >= ALIKE);
    let best = alike.max_by(|a, b| a.0.total_cmp(&b.0).then(b.1.cmp(&a.1)));
    best.map(|(_, other)| folder.join(other))
}

/// Maximum number of faults that a message lists; the rest is counted.
const LISTED: usize = 100;

/// Maximum number of faults that are counted; reading a file with more keeps no others.
const COUNTED: usize = 1000;

/// The number of faults, then one fault on each line.
fn listed(faults: &[Fault]) -> String {
    let shown = faults.iter().take(LISTED);
    let lines: String = shown.map(|fault| format!("\n  {fault}")).collect();
    if faults.len() > COUNTED {
        return format!("more than {COUNTED} faults{lines}\n  and more");
    }
    let more = match faults.len().saturating_sub(LISTED) {
        0 => String::new(),
        more => format!("\n  and {more} more"),
    };
    format!("{}{lines}{more}", counted(faults.len(), "fault"))
}

/// Collects faults while a file is read.
#[derive(Debug, Default)]
pub struct Faults {
    noted: RefCell<Vec<Fault>>,
    /// The tables that were read: where each is, and its known keys.
    tables: RefCell<Vec<(Rc<str>, Vec<Key>)>>,
    /// Faults of unknown keys that are like no known one, and the keys.
    unknown: RefCell<Vec<(Fault, String)>>,
}

impl Faults {
    /// Adds a fault; without effect where there are too many already.
    pub fn note(&self, fault: Fault) {
        if !self.is_full() {
            self.noted.borrow_mut().push(fault);
        }
    }

    /// Adds the fault of an unknown key, which another table may have.
    fn note_unknown(&self, key: &str, fault: Fault) {
        if !self.is_full() {
            self.unknown.borrow_mut().push((fault, key.to_owned()));
        }
    }

    /// Adds a table, unless one of the last ones was like it: targets are many, and alike.
    fn add_table(&self, path: &Rc<str>, known: Vec<Key>) {
        let mut tables = self.tables.borrow_mut();
        let mut last = tables.iter().rev().take(LAST_TABLES);
        if !last.any(|(other, keys)| *keys == known && is_alike(other, path)) {
            tables.push((Rc::clone(path), known));
        }
    }

    /// True where there are more faults than a message counts.
    fn is_full(&self) -> bool {
        self.noted.borrow().len() + self.unknown.borrow().len() > COUNTED
    }

    /// True where no fault was noted since the last [`Self::take`].
    pub fn is_empty(&self) -> bool {
        self.noted.borrow().is_empty() && self.unknown.borrow().is_empty()
    }

    /// The faults noted so far, in order of lines; afterwards there is none.
    pub fn take(&self) -> Vec<Fault> {
        let mut faults = self.noted.take();
        let tables = self.tables.take();
        faults.extend(self.unknown.take().into_iter().map(|(mut fault, key)| {
            let knows = |known: &[Key]| known.iter().any(|known| known.is(&key));
            let owners = tables.iter().filter(|(_, known)| knows(known));
            let owners: BTreeSet<String> = owners.map(|(path, _)| without_index(path)).collect();
            // where several tables have the key, nobody knows which is meant
            if let (Some(path), 1) = (owners.first(), owners.len()) {
                fault.found = match path.as_str() {
                    "" => "a key that belongs above all tables".to_owned(),
                    path => format!("a key that belongs in '{path}'"),
                };
            }
            fault
        }));
        faults.sort_by_key(|fault| fault.line);
        faults
    }
}

/// Number of tables with which another one is compared.
const LAST_TABLES: usize = 8;

/// True for paths that differ in the places in lists alone.
fn is_alike(a: &str, b: &str) -> bool {
    let is_word = |byte: &u8| !byte.is_ascii_digit();
    a.bytes().filter(is_word).eq(b.bytes().filter(is_word))
}

/// The path of a table without the places in lists: `targets` for `targets[0]`.
fn without_index(path: &str) -> String {
    let parts = path.split('[');
    parts
        .map(|part| part.split_once(']').map_or(part, |(_, rest)| rest))
        .collect()
}

/// Assumptions made, and input left out, when files were read.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Remarks {
    /// Assumptions and unused parts, in sentences of the form `subject: statement`.
    pub notes: Vec<String>,
    /// Likewise, unused parts that bear on safety. Their subjects appear beside the verdict on a
    /// plan: it is safe in spite of them only if somebody else takes care of them.
    pub cautions: Vec<String>,
}

impl Remarks {
    /// Adds a note.
    pub fn note(&mut self, subject: impl Display, statement: impl Display) {
        self.notes.push(format!("{subject}: {statement}"));
    }

    /// Adds a caution, as one line that a scenario file may have.
    pub fn caution(&mut self, subject: impl Display, statement: impl Display) {
        let whole = printable(&format!("{subject}: {statement}"));
        let mut text: String = whole.chars().take(LINE_CHARS).collect();
        if text.len() < whole.len() {
            text.pop();
            text.push('…');
        }
        if !self.cautions.contains(&text) {
            self.cautions.push(text);
        }
    }

    /// Adds all notes and cautions of others.
    pub fn extend(&mut self, more: &Self) {
        self.notes.extend_from_slice(&more.notes);
        self.cautions.extend_from_slice(&more.cautions);
    }

    /// The cautions, then the notes.
    pub fn all(&self) -> Vec<String> {
        self.cautions.iter().chain(&self.notes).cloned().collect()
    }

    /// The subjects of the cautions, each once.
    pub fn ignored(cautions: &[String]) -> Vec<&str> {
        let mut subjects = Vec::new();
        for caution in cautions {
            let subject = caution.split_once(": ").map_or(&**caution, |(who, _)| who);
            if !subjects.contains(&subject) {
                subjects.push(subject);
            }
        }
        subjects
    }
}

const MEBIBYTE: u64 = 1024 * 1024;

/// Text of a regular file of at most `mebibytes`; a larger file is refused before it is read.
pub fn read_text(file: &Path, mebibytes: u64, kind: &str) -> Result<String, InputError> {
    let unread = |source| InputError::unread(file, source);
    // opening a pipe would block, a device may have no end
    let about = std::fs::metadata(file).map_err(unread)?;
    if !about.is_file() {
        let error = Error::new(ErrorKind::InvalidInput, "not a regular file");
        return Err(unread(error));
    }
    if about.len() > mebibytes * MEBIBYTE {
        return Err(too_large(file, mebibytes, kind));
    }
    // the file may have grown since
    read_from(File::open(file).map_err(unread)?, file, mebibytes, kind)
}

fn too_large(file: &Path, mebibytes: u64, kind: &str) -> InputError {
    let found = format_args!("more than {mebibytes} MiB");
    let allowed = format_args!("{kind} of at most {mebibytes} MiB");
    InputError::faults(file, vec![Fault::new("", found, allowed)])
}

/// [`read_text`] from an open source, which errors name as `file`.
pub fn read_from(
    source: impl Read,
    file: &Path,
    mebibytes: u64,
    kind: &str,
) -> Result<String, InputError> {
    let most = mebibytes * MEBIBYTE;
    let mut bytes = Vec::new();
    let mut limited = source.take(most + 1);
    limited
        .read_to_end(&mut bytes)
        .map_err(|source| InputError::unread(file, source))?;
    if bytes.len() as u64 > most {
        return Err(too_large(file, mebibytes, kind));
    }
    String::from_utf8(bytes).map_err(|error| {
        let at = error.utf8_error().valid_up_to();
        let found = format_args!("bytes that are not text at byte {at}");
        InputError::faults(file, vec![Fault::new("", found, "UTF-8 text")])
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_message_lists_a_hundred_faults_and_counts_the_rest() {
        let faults = |count| vec![Fault::new("speed_mps", "-1", "at least 0"); count];
        let message = |count| InputError::faults(Path::new("a.toml"), faults(count)).to_string();
        assert_eq!(message(100).lines().count(), 101);
        assert!(!message(100).contains("more"));
        assert!(message(1_000).starts_with("a.toml: 1000 faults\n"));
        assert!(message(1_000).ends_with("\n  and 900 more"));
        assert_eq!(message(1_000).lines().count(), 102);
    }

    #[test]
    fn a_file_of_nothing_but_faults_is_not_listed_to_its_end() {
        let noted = Faults::default();
        for line in 1..=2000 {
            noted.note(Fault::new("speed_mps", "-1", "at least 0").at_line(line));
        }
        let faults = noted.take();
        assert_eq!(faults.len(), 1001);
        let message = InputError::faults(Path::new("a.toml"), faults).to_string();
        assert!(message.starts_with("a.toml: more than 1000 faults\n  line 1: "));
        assert!(message.ends_with("\n  and more") && message.lines().count() == 102);
        let text = "a b = 0x\n".repeat(100_000);
        assert!(from_toml(&text, &noted).is_none());
        assert_eq!(noted.take().len(), 1);
    }
}
