//! Output of the program: results to standard output, everything else to standard error.

pub mod products;

use std::borrow::Cow;
use std::fmt;
use std::io::{ErrorKind, IsTerminal, Write};
use std::path::Path;
use std::process::ExitCode;
use std::sync::atomic::{AtomicBool, Ordering};

use anyhow::Context;
use comfy_table::Table;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use searoom::document::PLAN_MEBIBYTES;
use searoom::report::{Display, broken, printable_lines};
use serde::Serialize;
use textwrap::core::display_width;

use super::found::Refused;
use super::status::ExitStatus;
use products::Failure;

/// Escape codes of red, green, yellow, and their ends, as used in tables.
const COLOURS: [&str; 5] = [
    "\u{1b}[38;5;9m",
    "\u{1b}[38;5;10m",
    "\u{1b}[38;5;11m",
    "\u{1b}[39m",
    "\u{1b}[0m",
];

/// A line whose first words are followed by two spaces goes on below the words after them, where
/// these begin before this column.
const VALUE_COLUMN: usize = 20;

/// Width of the help, in characters, where there is no terminal.
const HELP_WIDTH: usize = 100;

/// Name of a scenario in its file, or nothing, and the notes on it.
pub type Noted = (String, Vec<String>);

#[derive(Debug)]
pub struct Output {
    pub display: Display,
    /// Width of standard error in characters, where it is a terminal.
    messages: Option<usize>,
    /// Only documents and errors.
    pub quiet: bool,
    /// True where standard output was closed by its reader.
    closed: AtomicBool,
}

impl Output {
    /// Enables colour on a terminal, unless `NO_COLOR` or `TERM=dumb` forbids it. Texts are as wide
    /// as `COLUMNS` or the terminal.
    pub fn new(quiet: bool) -> Self {
        let terminal = std::io::stdout().is_terminal();
        let wanted = std::env::var_os("NO_COLOR").is_none_or(|value| value.is_empty());
        let columns = asked_columns().filter(|columns| *columns > 0);
        // a terminal of no columns does not know its width
        let measured = |table: &Table| table.width().map(usize::from).filter(|width| *width > 0);
        let mut on_stderr = Table::new();
        on_stderr.use_stderr();
        let messages = || {
            std::io::stderr()
                .is_terminal()
                .then(|| measured(&on_stderr))
        };
        let results = || terminal.then(|| measured(&Table::new()));
        Self {
            quiet,
            closed: AtomicBool::new(false),
            messages: columns.or_else(|| messages().flatten()),
            display: Display {
                colour: wanted && terminal && !is_dumb(),
                width: columns.or_else(|| results().flatten()),
            },
        }
    }

    /// Prints a result as text, in lines that fit the terminal; nothing where there is none.
    pub fn result(&self, text: &str) -> ExitStatus {
        match self.quiet || text.is_empty() {
            true => ExitStatus::Good,
            false => self.print(&wrapped(text, self.display.width)),
        }
    }

    /// True where nobody reads standard output any more.
    pub fn is_closed(&self) -> bool {
        self.closed.load(Ordering::Relaxed)
    }

    /// Prints a result in place of the one before, where there is a terminal.
    pub fn screen(&self, text: &str) -> ExitStatus {
        if self.display.width.is_some() && self.display.colour && !self.quiet {
            let mut stdout = std::io::stdout().lock();
            // a terminal that cannot be written to is found by what comes next
            let _ = stdout.write_all(b"\x1b[H\x1b[2J");
        }
        self.result(text)
    }

    /// Prints what was asked for and nothing else, as it is, also where the command is quiet.
    /// Reports a bad status if printing fails; a closed pipe is not an error.
    pub fn print(&self, text: &str) -> ExitStatus {
        let mut stdout = std::io::stdout().lock();
        let text = self.shown(text);
        match writeln!(stdout, "{text}").and_then(|()| stdout.flush()) {
            Ok(()) => ExitStatus::Good,
            Err(error) if error.kind() == ErrorKind::BrokenPipe => {
                self.closed.store(true, Ordering::Relaxed);
                ExitStatus::Good
            }
            Err(error) => {
                self.error(&format_args!("standard output: {error}"));
                ExitStatus::BadInput
            }
        }
    }

    /// Escapes control characters, except the colour codes of tables. Coloured tables are already
    /// escaped.
    fn shown<'t>(&self, text: &'t str) -> Cow<'t, str> {
        if !self.display.colour {
            return printable_lines(text);
        }
        let mut out = String::with_capacity(text.len());
        let mut rest = text;
        while let Some(at) = rest.find('\u{1b}') {
            out.push_str(&printable_lines(&rest[..at]));
            let mut colours = COLOURS.into_iter();
            let known = colours.find(|colour| rest[at..].starts_with(colour));
            let length = known.map_or(1, str::len);
            match known {
                Some(colour) => out.push_str(colour),
                None => out.push_str(&printable_lines(&rest[at..=at])),
            }
            rest = &rest[at + length..];
        }
        Cow::Owned(out + &printable_lines(rest))
    }

    pub fn document(&self, document: &impl Serialize) -> ExitStatus {
        match json(document) {
            Ok(text) => self.print(text.trim_end()),
            Err(error) => self.fault(&format_args!("{error:#}")),
        }
    }

    /// Prints a document that `verify` checks; a note says where it is too large for that.
    pub fn verifiable(&self, document: &impl Serialize) -> ExitStatus {
        match json(document) {
            Ok(text) => {
                if let Some(note) = beyond_verify(text.len()) {
                    self.note(&note);
                }
                self.print(text.trim_end())
            }
            Err(error) => self.fault(&format_args!("{error:#}")),
        }
    }

    pub fn show(
        &self,
        json: bool,
        document: &impl Serialize,
        text: impl FnOnce() -> String,
    ) -> ExitStatus {
        if json {
            self.document(document)
        } else {
            self.result(&text())
        }
    }

    pub fn error(&self, error: &impl fmt::Display) {
        // an error of standard error cannot be reported
        let _ = writeln!(std::io::stderr(), "{}", self.message("error", error));
    }

    /// Prints an error of the input or of its use.
    pub fn refuse(&self, error: &impl fmt::Display) -> ExitStatus {
        self.error(error);
        ExitStatus::BadInput
    }

    pub fn refused(&self, refused: &Refused) -> ExitStatus {
        self.error(&refused.error);
        refused.status()
    }

    pub fn fault(&self, fault: &impl fmt::Display) -> ExitStatus {
        self.error(fault);
        ExitStatus::InternalFault
    }

    /// Prints why a result could not be written, if it could not.
    pub fn written(&self, result: Result<(), Failure>) -> ExitStatus {
        result.map_or_else(
            |(status, error)| {
                self.error(&error);
                status
            },
            |()| ExitStatus::Good,
        )
    }

    pub fn note(&self, note: &impl fmt::Display) {
        if self.quiet {
            return;
        }
        let _ = writeln!(std::io::stderr(), "{}", self.message("note", note));
    }

    /// Prints the notes on a scenario, or on several of the same `file`, which have names. What is
    /// noted of several subjects is one note.
    pub fn notes(&self, file: Option<&str>, noted: &[Noted]) {
        let of_each = noted.iter().flat_map(|(name, notes)| {
            let split = notes
                .iter()
                .map(|note| note.split_once(": ").unwrap_or(("", note)));
            let groups = grouped(split.map(|(who, what)| (who, what.to_owned())));
            groups
                .into_iter()
                .map(move |(who, what)| (name.as_str(), in_front(&who, what)))
        });
        for (names, note) in grouped(of_each) {
            let note = in_front(&names, note);
            self.note(&in_front(file.as_slice(), note));
        }
    }

    /// A message in lines that fit standard error.
    fn message(&self, kind: &str, message: &impl fmt::Display) -> String {
        let message = message.to_string();
        let text = format!("{kind}: {}", printable_lines(&message));
        wrapped(&text, self.messages).into_owned()
    }

    pub fn wrote(&self, file: &Path) {
        self.note(&format_args!("wrote {}", file.display()));
    }

    /// Creates a progress bar on standard error; hidden unless that is a terminal.
    pub fn progress(&self, steps: usize) -> ProgressBar {
        if self.quiet || is_dumb() {
            return ProgressBar::hidden();
        }
        let bar = ProgressBar::with_draw_target(Some(steps as u64), ProgressDrawTarget::stderr());
        match ProgressStyle::with_template("{bar:30} {pos}/{len} {msg}") {
            Ok(style) => bar.with_style(style),
            Err(_) => bar,
        }
    }
}

/// The width that `COLUMNS` asks for; 0 is none.
fn asked_columns() -> Option<usize> {
    std::env::var("COLUMNS").ok()?.parse().ok()
}

/// Width of the help in characters where it is neither asked for nor known; `None` where the parser
/// finds it.
pub fn help_width() -> Option<usize> {
    (asked_columns() == Some(0)).then_some(HELP_WIDTH)
}

/// True for a terminal without escape codes.
fn is_dumb() -> bool {
    std::env::var_os("TERM").is_some_and(|term| term == "dumb")
}

/// Breaks lines that are too wide, between words. They go on indented below their value.
fn wrapped(text: &str, width: Option<usize>) -> Cow<'_, str> {
    let Some(width) = width.filter(|width| text.lines().any(|line| display_width(line) > *width))
    else {
        return Cow::Borrowed(text);
    };
    let lines = text.split('\n').map(|line| {
        let words = line.trim_start();
        let begin = line.len() - words.len();
        let value = words.find("  ").map(|end| {
            let gap = words[end..].len() - words[end..].trim_start().len();
            display_width(&line[..begin + end + gap])
        });
        let column = value
            .filter(|column| *column < VALUE_COLUMN)
            .unwrap_or(begin);
        broken(line, width, &" ".repeat(column + 2))
    });
    Cow::Owned(lines.collect::<Vec<_>>().join("\n"))
}

/// Those with the same message, in the order of the first of each.
fn grouped<'w>(all: impl Iterator<Item = (&'w str, String)>) -> Vec<(Vec<&'w str>, String)> {
    let mut groups: Vec<(Vec<&str>, String)> = Vec::new();
    for (who, what) in all {
        match groups.iter_mut().find(|(_, other)| *other == what) {
            Some((names, _)) => names.push(who),
            None => groups.push((vec![who], what)),
        }
    }
    groups
}

/// `names: text`, or the text alone where there are no names.
fn in_front(names: &[&str], text: String) -> String {
    let names: Vec<&str> = names
        .iter()
        .copied()
        .filter(|name| !name.is_empty())
        .collect();
    match names.is_empty() {
        true => text,
        false => format!("{}: {text}", names.join(", ")),
    }
}

/// The note on a document of more bytes than `verify` reads.
pub fn beyond_verify(bytes: usize) -> Option<String> {
    const MEBIBYTE: u64 = 1 << 20;
    let bytes = bytes as u64;
    (bytes > PLAN_MEBIBYTES * MEBIBYTE).then(|| {
        let size = bytes.div_ceil(MEBIBYTE);
        format!(
            "the document has {size} MiB, and `searoom verify` reads {PLAN_MEBIBYTES} MiB: it \
             cannot be verified"
        )
    })
}

pub fn json(document: &impl Serialize) -> anyhow::Result<String> {
    searoom::document::json(document).context("a document cannot be written")
}

/// A document on one line.
pub fn json_line(document: &impl Serialize) -> anyhow::Result<String> {
    serde_json::to_string(document).context("a document cannot be written")
}

pub fn csv(rows: Vec<Vec<String>>) -> anyhow::Result<Vec<u8>> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    for row in rows {
        writer.write_record(row)?;
    }
    writer.into_inner().context("the rows cannot be written")
}

pub fn usage(error: &clap::Error) -> ExitCode {
    // an error of this stream cannot be reported
    let _ = error.print();
    if error.use_stderr() {
        ExitStatus::BadInput.into()
    } else {
        ExitStatus::Good.into()
    }
}

#[test]
fn a_document_that_verify_does_not_read_is_noted() {
    let limit = PLAN_MEBIBYTES as usize * (1 << 20);
    assert_eq!(beyond_verify(limit), None);
    let note = beyond_verify(limit + 1).expect("a note");
    assert!(
        note.contains("65 MiB") && note.contains("reads 64 MiB"),
        "{note}"
    );
}
