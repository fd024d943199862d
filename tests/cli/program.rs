//! The program as a user runs it, and what it says.

use std::fmt::{self, Display, Formatter};
use std::fs;
use std::path::Path;

use assert_cmd::Command;
use assert_cmd::assert::Assert;
use serde_json::Value;
use tempfile::TempDir;

pub const HEAD_ON: &str = include_str!("../../scenarios/colregs/head-on.toml");

/// The head-on scenario without its planner section.
pub fn head_on_without_planner() -> String {
    let (before, rest) = HEAD_ON.split_once("[planner]").expect("a section");
    let (_, after) = rest.split_once("[[targets]]").expect("targets");
    format!("{before}[[targets]]{after}")
}

pub fn command(args: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_searoom"));
    command
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .env_remove("COLUMNS")
        .args(args);
    command
}

pub fn searoom(args: &[&str]) -> Assert {
    command(args).assert()
}

/// Runs the program with words that are separated by blanks.
pub fn run(words: &str) -> Assert {
    searoom(&words.split_whitespace().collect::<Vec<_>>())
}

pub fn text(path: &Path) -> &str {
    path.to_str().expect("a path that is text")
}

/// An empty folder for the files of a test; it is displayed as its path.
pub struct Folder(TempDir);

impl Display for Folder {
    fn fmt(&self, f: &mut Formatter) -> fmt::Result {
        f.write_str(text(self.path()))
    }
}

impl Folder {
    pub fn new() -> Self {
        Self(tempfile::tempdir().expect("a folder"))
    }

    pub fn path(&self) -> &Path {
        self.0.path()
    }

    /// The path of a file, which need not be there.
    pub fn at(&self, name: &str) -> String {
        text(&self.path().join(name)).to_owned()
    }

    /// Writes a file; folders are made.
    pub fn write(&self, name: &str, contents: impl AsRef<[u8]>) -> String {
        let file = self.path().join(name);
        fs::create_dir_all(file.parent().expect("a folder")).expect("made");
        fs::write(&file, contents).expect("written");
        self.at(name)
    }

    /// Names of the files, sorted.
    pub fn names(&self, folder: &str) -> Vec<String> {
        let entries = fs::read_dir(self.path().join(folder)).expect("a folder");
        let names = entries.map(|entry| entry.expect("an entry").file_name());
        let mut names: Vec<String> = names
            .map(|name| name.into_string().expect("text"))
            .collect();
        names.sort();
        names
    }

    /// Runs each command of a table: it ends with status 2, prints no result, and says what stands
    /// behind it, one text after each `|`. `DIR` is this folder.
    pub fn refuses(&self, table: &str) {
        for row in table.lines().map(str::trim).filter(|row| !row.is_empty()) {
            let row = row.replace("DIR", text(self.path()));
            let mut cells = row.split('|').map(str::trim);
            let refused = run(cells.next().expect("a command")).code(2).stdout("");
            let said = stderr(&refused);
            for expected in cells {
                assert!(said.contains(expected), "{row}: {said}");
            }
        }
    }
}

/// Checks that all of these, with ` | ` between them, are in a text.
pub fn says(text: &str, expected: &str) {
    for expected in expected.split(" | ") {
        assert!(text.contains(expected), "{expected}: {text}");
    }
}

pub fn stdout(assert: &Assert) -> String {
    String::from_utf8(assert.get_output().stdout.clone()).expect("text")
}

pub fn stderr(assert: &Assert) -> String {
    String::from_utf8(assert.get_output().stderr.clone()).expect("text")
}

/// The one JSON document that a successful command prints.
pub fn json(words: &str) -> Value {
    document(&run(words).success())
}

pub fn document(assert: &Assert) -> Value {
    serde_json::from_str(&stdout(assert)).expect("one JSON document")
}

/// The entries of a list of a document.
pub fn list(value: &Value) -> &[Value] {
    value.as_array().expect("a list")
}

/// A number of a document.
pub fn number(value: &Value) -> f64 {
    value.as_f64().expect("a number")
}

/// The document without its only wall-clock figures.
pub fn untimed(mut document: Value) -> Value {
    fn strip(value: &mut Value) {
        match value {
            Value::Object(map) => {
                map.remove("timing");
                map.values_mut().for_each(strip);
            }
            Value::Array(list) => list.iter_mut().for_each(strip),
            _ => {}
        }
    }
    strip(&mut document);
    document
}

/// Checks a document against lines of a pointer and its JSON value.
pub fn assert_values(document: &Value, lines: &str) {
    for line in lines.lines().filter(|line| !line.is_empty()) {
        let (pointer, expected) = line.split_once(' ').expect("a pointer and a value");
        let expected: Value = serde_json::from_str(expected).expect(line);
        assert_eq!(document.pointer(pointer), Some(&expected), "{pointer}");
    }
}

/// Rows of a table of texts, with `|` between the cells and `\\n` for a new line.
pub fn rows<const N: usize>(table: &'static str) -> impl Iterator<Item = [String; N]> {
    let rows = table.lines().filter(|row| !row.is_empty());
    rows.map(|row| {
        let cells = row.split('|').map(|cell| cell.trim().replace("\\n", "\n"));
        let cells: Vec<String> = cells.collect();
        cells.try_into().unwrap_or_else(|_| panic!("{row}"))
    })
}
