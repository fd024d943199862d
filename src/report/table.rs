//! Tables for a terminal, and number formats of tables.

use comfy_table::{Cell, CellAlignment, Color, ContentArrangement, Table, presets};

use crate::text::printable_lines;

/// Rating of a cell: good, bad or neither.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Tone {
    Plain,
    Good,
    Fair,
    Bad,
}

pub(super) type Styled = (String, Tone);

pub(super) struct Grid {
    /// Column names. Units are on a second line, to fit a terminal.
    pub header: Vec<&'static str>,
    /// Range of numeric columns.
    pub numbers: std::ops::Range<usize>,
    pub rows: Vec<Vec<Styled>>,
}

impl Grid {
    /// Rows under columns whose names have `, ` between them.
    pub fn new(
        names: &'static str,
        numbers: std::ops::Range<usize>,
        rows: impl IntoIterator<Item = Vec<Styled>>,
    ) -> Self {
        Self {
            header: names.split(", ").collect(),
            numbers,
            rows: rows.into_iter().collect(),
        }
    }

    /// Removes one numeric column.
    pub fn without(mut self, name: &str) -> Self {
        if let Some(column) = self.header.iter().position(|n| *n == name) {
            self.header.remove(column);
            self.numbers.end -= 1;
            self.rows
                .iter_mut()
                .for_each(|row| drop(row.remove(column)));
        }
        self
    }

    /// Formats the table for a terminal. Colour only when `colour`.
    pub fn text(&self, colour: bool) -> String {
        let mut table = Table::new();
        table
            .load_style(presets::UTF8_HORIZONTAL_ONLY)
            .set_content_arrangement(ContentArrangement::Disabled)
            .set_header(&self.header);
        table.style_mut().row_separator = presets::NOTHING.row_separator;
        if colour {
            table.enforce_styling();
        } else {
            table.force_no_tty();
        }
        for (index, column) in table.column_iter_mut().enumerate() {
            column.set_padding((0, 1));
            if self.numbers.contains(&index) {
                column.set_cell_alignment(CellAlignment::Right);
            }
        }
        for row in &self.rows {
            table.add_row(row.iter().map(cell));
        }
        table.trim_fmt()
    }

    /// Formats the table as markdown.
    pub fn markdown(&self) -> String {
        let line = |cells: Vec<String>| format!("| {} |", cells.join(" | "));
        let mut lines = vec![
            line(self.header.iter().map(|name| in_cell(name)).collect()),
            format!("|{}", "---|".repeat(self.header.len())),
        ];
        let rows = self.rows.iter();
        lines.extend(rows.map(|row| line(row.iter().map(|(text, _)| in_cell(text)).collect())));
        lines.join("\n")
    }
}

pub(super) fn in_cell(text: &str) -> String {
    text.replace('|', "\\|").replace(['\n', '\r'], " ")
}

/// Creates a coloured cell without control characters.
fn cell((text, tone): &Styled) -> Cell {
    let cell = Cell::new(printable_lines(text));
    match tone {
        Tone::Plain => cell,
        Tone::Good => cell.fg(Color::Green),
        Tone::Fair => cell.fg(Color::Yellow),
        Tone::Bad => cell.fg(Color::Red),
    }
}

pub(super) fn plain(text: impl Into<String>) -> Styled {
    (text.into(), Tone::Plain)
}

pub(super) fn or_dash(text: Option<String>) -> Styled {
    plain(text.unwrap_or_else(|| "–".to_owned()))
}

/// Outcome in words for the reader, with its rating.
pub(super) fn verdict(word: &str) -> Styled {
    let tone = match word {
        _ if word.contains("deadline") => Tone::Bad,
        "solved" | "clear" => Tone::Good,
        "relaxed" | "not by the rules" => Tone::Fair,
        "not applicable" => Tone::Plain,
        _ if word.starts_with("at risk") => Tone::Fair,
        _ => Tone::Bad,
    };
    (word.to_owned(), tone)
}

/// Result of the independent checker. A plan that is not safe is never rated good.
pub(super) fn verified(verified: Option<bool>, safe: Option<bool>) -> Styled {
    match yes_or_no(verified) {
        (word, Tone::Good) if safe != Some(true) => (word, Tone::Plain),
        other => other,
    }
}

pub(super) fn yes_or_no(fact: Option<bool>) -> Styled {
    match fact {
        Some(true) => ("yes".to_owned(), Tone::Good),
        Some(false) => ("NO".to_owned(), Tone::Bad),
        None => or_dash(None),
    }
}
