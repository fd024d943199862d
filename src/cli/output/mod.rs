//! Output of the program: results to standard output, everything else to standard error.

pub mod products;
pub mod status;

use std::borrow::Cow;
use std::fmt;
use std::io::{ErrorKind, IsTerminal, Write};
use std::path::Path;
use std::process::ExitCode;

use anyhow::Context;
use comfy_table::Table;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use searoom::report::{Display, printable_lines};
use serde::Serialize;

use super::input::files::Refused;
use products::Failure;
use status::ExitStatus;

/// Escape codes of red, green, yellow, and their ends, as used in tables.
const COLOURS: [&str; 5] = [
    "\u{1b}[38;5;9m",
    "\u{1b}[38;5;10m",
    "\u{1b}[38;5;11m",
    "\u{1b}[39m",
    "\u{1b}[0m",
];

#[derive(Debug)]
pub struct Output {
    pub display: Display,
    /// Only documents and errors.
    pub quiet: bool,
}

impl Output {
    /// Enables colour on a terminal, unless `NO_COLOR` forbids it. Tables are as wide as `COLUMNS`
    /// or the terminal.
    pub fn new(quiet: bool) -> Self {
        let terminal = std::io::stdout().is_terminal();
        let wanted = std::env::var_os("NO_COLOR").is_none_or(|value| value.is_empty());
        let columns = std::env::var("COLUMNS").ok();
        let columns = columns.and_then(|n| n.parse().ok().filter(|n| *n > 0));
        let measured = || terminal.then(|| Table::new().width()).flatten();
        Self {
            quiet,
            display: Display {
                colour: wanted && terminal,
                width: columns.or_else(|| measured().map(usize::from)),
            },
        }
    }

    /// Prints a result as text.
    pub fn result(&self, text: &str) -> ExitStatus {
        match self.quiet {
            true => ExitStatus::Good,
            false => self.print(text),
        }
    }

    /// Prints to standard output. Reports a bad status if printing fails; a closed pipe is not an error.
    fn print(&self, text: &str) -> ExitStatus {
        let mut stdout = std::io::stdout().lock();
        let text = self.shown(text);
        match writeln!(stdout, "{text}").and_then(|()| stdout.flush()) {
            Ok(()) => ExitStatus::Good,
            Err(error) if error.kind() == ErrorKind::BrokenPipe => ExitStatus::Good,
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
        let error = error.to_string();
        let _ = writeln!(std::io::stderr(), "error: {}", printable_lines(&error));
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
        let note = note.to_string();
        let _ = writeln!(std::io::stderr(), "note: {}", printable_lines(&note));
    }

    pub fn wrote(&self, file: &Path) {
        self.note(&format_args!("wrote {}", file.display()));
    }

    /// Creates a progress bar on standard error; hidden unless that is a terminal.
    pub fn progress(&self, steps: usize) -> ProgressBar {
        if self.quiet {
            return ProgressBar::hidden();
        }
        let bar = ProgressBar::with_draw_target(Some(steps as u64), ProgressDrawTarget::stderr());
        match ProgressStyle::with_template("{bar:30} {pos}/{len} {msg}") {
            Ok(style) => bar.with_style(style),
            Err(_) => bar,
        }
    }
}

pub fn json(document: &impl Serialize) -> anyhow::Result<String> {
    searoom::document::json(document).context("a document cannot be written")
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
