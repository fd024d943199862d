//! Tables for a terminal, and number formats of tables.

use comfy_table::{Cell, CellAlignment, Color, ContentArrangement, Table, presets};
use textwrap::core::display_width;

use crate::text::{broken, printable_lines};

/// Least width for which columns are dropped, in characters. Narrower tables are cards.
const CARD_WIDTH: usize = 80;

/// Columns that a table drops first where it is too wide, in this order. Cards have none of them.
const DETAILS: [&str; 10] = [
    "arc J", "nodes", "time", METHOD, "risk", "delay", "duration", "length", "to", "leg",
];

/// Column of what made a plan. In a comparison it names the rows, and is not dropped.
const METHOD: &str = "method";

/// Columns that a table drops next, in this order.
const FURTHER: [&str; 8] = [
    "behaviour",
    "acts before",
    "passing",
    "encounter",
    "verified",
    "manoeuvre",
    "J",
    "clearance",
];

/// Where a text is shown. The default is a file: no colour, and as wide as need be.
#[derive(Debug, Clone, Copy, Default)]
pub struct Display {
    /// Colour in tables and headlines.
    pub colour: bool,
    /// Width of the terminal in characters.
    pub width: Option<usize>,
}

/// Rating of a cell: good, bad or neither.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Tone {
    Plain,
    Good,
    Fair,
    Bad,
}

pub(super) type Styled = (String, Tone);

const MISSING: &str = "–";

#[derive(Clone)]
pub(super) struct Grid {
    /// Column names. Units are on a second line, to fit a terminal.
    pub header: Vec<&'static str>,
    /// Range of numeric columns.
    pub numbers: std::ops::Range<usize>,
    pub rows: Vec<Vec<Styled>>,
    /// The columns whose lines may be broken where the table is too wide, and their least widths.
    breaking: Vec<(&'static str, usize)>,
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
            breaking: Vec::new(),
        }
    }

    /// Allows lines of a column to be broken, to no less than this width, after those before.
    pub fn breaking(mut self, name: &'static str, least: usize) -> Self {
        self.breaking.push((name, least));
        self
    }

    /// Removes the column whose name has this first line, if there is one.
    pub fn without(mut self, name: &str) -> Self {
        let is_it = |header: &&str| header.lines().next() == Some(name);
        let found = self.header.iter().position(is_it);
        if let Some(column) = found.filter(|column| *column > 0 || name != METHOD) {
            self.header.remove(column);
            self.numbers.start -= usize::from(column < self.numbers.start);
            self.numbers.end -= usize::from(column < self.numbers.end);
            self.rows
                .iter_mut()
                .for_each(|row| drop(row.remove(column)));
        }
        self
    }

    /// The table without details.
    pub fn brief(self) -> Self {
        DETAILS.into_iter().fold(self, Self::without)
    }

    /// Formats the table for a terminal. A table that is too wide breaks the lines of one column and
    /// drops others until it fits, and breaks all lines if it still does not. A narrow terminal
    /// shows a card per row instead.
    pub fn text(self, display: Display) -> String {
        self.text_and_columns(display).0
    }

    /// [`Grid::text`], and the header of the columns that are left.
    pub fn text_and_columns(self, display: Display) -> (String, Vec<&'static str>) {
        let Some(width) = display.width else {
            return (self.table(display).trim_fmt(), self.header);
        };
        if width < CARD_WIDTH && self.width(display) > width {
            let grid = self.brief();
            return (grid.cards(display), grid.header);
        }
        let mut grid = self;
        for name in DETAILS.into_iter().chain(FURTHER) {
            grid = match grid.fitted(width, display) {
                Ok(fitted) => return (fitted.table(display).trim_fmt(), fitted.header),
                Err(wide) => wide.without(name),
            };
        }
        let text = wrapped(grid.table(display), display).trim_fmt();
        (text, grid.header)
    }

    fn width(&self, display: Display) -> usize {
        // the border, a single line, is as wide as the table
        let table = self.table(display);
        table.lines().next().map_or(0, |line| line.chars().count())
    }

    /// The table with lines broken so that it fits; itself where it is too wide for that.
    fn fitted(self, width: usize, display: Display) -> Result<Self, Self> {
        let mut broken = self.clone();
        for (name, least) in &self.breaking {
            let excess = broken.width(display).saturating_sub(width);
            if excess == 0 {
                break;
            }
            if let Some(column) = self.header.iter().position(|header| header == name) {
                broken.narrow(column, excess, *least);
            }
        }
        match broken.width(display) <= width {
            true => Ok(broken),
            false => Err(self),
        }
    }

    /// Makes a column narrower by breaking its lines.
    fn narrow(&mut self, column: usize, by: usize, least: usize) {
        let cells = self.rows.iter().map(|row| &row[column].0);
        let widest = cells.flat_map(|cell| cell.lines()).map(display_width).max();
        let room = widest.unwrap_or(0).saturating_sub(by).max(least);
        for row in &mut self.rows {
            let lines = row[column].0.lines().map(|line| broken(line, room, "  "));
            row[column].0 = lines.collect::<Vec<_>>().join("\n");
        }
    }

    fn table(&self, display: Display) -> Table {
        let mut table = styled(display);
        table
            .load_style(presets::UTF8_HORIZONTAL_ONLY)
            .set_content_arrangement(ContentArrangement::Disabled)
            .set_header(&self.header);
        table.style_mut().row_separator = presets::NOTHING.row_separator;
        for (index, column) in table.column_iter_mut().enumerate() {
            column.set_padding((0, 1));
            if self.numbers.contains(&index) {
                column.set_cell_alignment(CellAlignment::Right);
            }
        }
        for row in &self.rows {
            table.add_row(row.iter().map(cell));
        }
        table
    }

    /// Names and values of each row below one another, without values that are missing.
    fn cards(&self, display: Display) -> String {
        let card = |row: &Vec<Styled>| {
            let mut table = wrapped(styled(display), display);
            table.load_style(presets::NOTHING);
            for (name, (text, tone)) in self.header.iter().zip(row) {
                if !["", MISSING].contains(&text.as_str()) {
                    let value = cell(&(text.clone(), *tone));
                    table.add_row([Cell::new(name.replace('\n', " ")), value]);
                }
            }
            for column in table.column_iter_mut() {
                column.set_padding((0, 1));
            }
            table.trim_fmt()
        };
        let cards: Vec<String> = self.rows.iter().map(card).collect();
        cards.join("\n\n")
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

fn styled(display: Display) -> Table {
    let mut table = Table::new();
    if display.colour {
        table.enforce_styling();
    } else {
        table.force_no_tty();
    }
    table
}

fn wrapped(mut table: Table, display: Display) -> Table {
    if let Some(width) = display.width {
        table
            .set_content_arrangement(ContentArrangement::Dynamic)
            .set_width(u16::try_from(width).unwrap_or(u16::MAX));
    }
    table
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
    plain(text.unwrap_or_else(|| MISSING.to_owned()))
}

/// A text in the colour of its rating, as in a table.
pub(super) fn painted((text, tone): Styled, display: Display) -> String {
    let code = match tone {
        Tone::Good if display.colour => 10,
        Tone::Fair if display.colour => 11,
        Tone::Bad if display.colour => 9,
        _ => return text,
    };
    format!("\u{1b}[38;5;{code}m{text}\u{1b}[39m")
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

#[cfg(test)]
mod tests {
    use super::*;

    fn shown(width: impl Into<Option<usize>>, colour: bool) -> String {
        let row = ["a.toml", "solved", "19847", "118.0", "4", "0.62", "yes"];
        let row = row.map(plain).to_vec();
        let header = "scenario, outcome, J\n[m²], clearance\n[m], nodes, time\n[ms], safe";
        let mut grid = Grid::new(header, 2..6, [row.clone(), row]);
        grid.rows[0][6].1 = Tone::Good;
        grid.rows[1][0].0 = "a name of many words, ".repeat(3);
        grid.rows[1][3] = or_dash(None);
        let width = width.into();
        grid.text(Display { colour, width })
    }

    #[test]
    fn a_table_drops_columns_until_it_fits() {
        let names = |width| shown(width, false).lines().nth(1).map(str::to_owned);
        let widest = names(None).expect("a header");
        let widths = [(113, 7), (112, 6), (105, 5), (99, 4), (88, 3)];
        for (width, count) in widths {
            let names = names(Some(width)).expect("a header");
            assert_eq!(names.split_whitespace().count(), count, "{width}: {widest}");
            let text = shown(width, false);
            assert!(text.lines().all(|line| line.chars().count() <= width));
        }
        assert_eq!(names(Some(113)), Some(widest));
        // words stay whole
        let broken = shown(80, false);
        assert!(
            broken.lines().all(|line| line.chars().count() <= 80),
            "{broken}"
        );
        assert!(
            broken.contains("scenario") && !broken.contains("clearance"),
            "{broken}"
        );
    }

    #[test]
    fn a_narrow_terminal_shows_cards() {
        let text = shown(40, false);
        let first = "scenario      a.toml\noutcome       solved\nJ [m²]        19847\nclearance [m] 118.0\nsafe          yes\n\n";
        assert!(text.starts_with(first), "{text}");
        assert!(
            text.lines().all(|line| line.chars().count() <= 40),
            "{text}"
        );
        assert_eq!(text.matches("clearance").count(), 1, "{text}");
        assert!(shown(40, true).contains("\u{1b}[38;5;10myes"));
    }
}
