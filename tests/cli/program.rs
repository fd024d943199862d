//! The program as a user runs it, and what it says.

use std::fs;
use std::path::Path;

use assert_cmd::Command;
use assert_cmd::assert::Assert;
use serde_json::Value;

pub const HEAD_ON: &str = include_str!("../../scenarios/colregs/head-on.toml");

/// The head-on scenario without its planner section.
pub fn head_on_without_planner() -> String {
    let (before, rest) = HEAD_ON.split_once("[planner]").expect("a section");
    let (_, after) = rest.split_once("[[targets]]").expect("targets");
    format!("{before}[[targets]]{after}")
}

pub fn searoom(args: &[&str]) -> Assert {
    Command::new(env!("CARGO_BIN_EXE_searoom"))
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .args(args)
        .assert()
}

/// Runs the program with words that are separated by blanks.
pub fn run(words: &str) -> Assert {
    searoom(&words.split_whitespace().collect::<Vec<_>>())
}

pub fn text(path: &Path) -> &str {
    path.to_str().expect("a path that is text")
}

pub fn write(folder: &Path, name: &str, contents: impl AsRef<[u8]>) -> String {
    let file = folder.join(name);
    fs::create_dir_all(file.parent().expect("a folder")).expect("made");
    fs::write(&file, contents).expect("written");
    text(&file).to_owned()
}

pub fn stdout(assert: &Assert) -> String {
    String::from_utf8(assert.get_output().stdout.clone()).expect("text")
}

pub fn stderr(assert: &Assert) -> String {
    String::from_utf8(assert.get_output().stderr.clone()).expect("text")
}

pub fn document(assert: &Assert) -> Value {
    serde_json::from_str(&stdout(assert)).expect("one JSON document")
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
