//! Tables for a terminal, Markdown and LaTeX, their rows as data, and number formats of tables.

use comfy_table::{Cell, CellAlignment, Color, ContentArrangement, Table, presets};
use textwrap::core::display_width;

use crate::text::{broken, printable, printable_lines};

/// Least width for which columns are dropped, in characters. Narrower tables are cards.
const CARD_WIDTH: usize = 80;

/// Columns that a table drops first where it is too wide, in this order. Cards have none of them.
const DETAILS: [&str; 10] = [
    "arc J", "duration", "length", "nodes", "time", METHOD, "risk", "delay", "to", "leg",
];

/// Column of what made a plan. In a comparison it names the rows, and is not dropped.
const METHOD: &str = "method";

/// Columns that a table drops next, in this order.
const FURTHER: [&str; 6] = [
    "behaviour",
    "acts before",
    "passing",
    "encounter",
    "verified",
    "manoeuvre",
];

/// Columns that a table drops where it is too wide with all its lines broken.
const LAST: [&str; 2] = ["J", "clearance"];

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
    /// Whether each column is numeric.
    pub numbers: Vec<bool>,
    pub rows: Vec<Vec<Styled>>,
    /// The columns whose lines may be broken where the table is too wide, and their least widths.
    breaking: Vec<(&'static str, usize)>,
    /// Those whose lines are broken only instead of dropping a column of [`LAST`].
    breaking_last: Vec<(&'static str, usize)>,
}

impl Grid {
    /// Rows under columns whose names have `, ` between them.
    pub fn new(
        names: &'static str,
        numbers: std::ops::Range<usize>,
        rows: impl IntoIterator<Item = Vec<Styled>>,
    ) -> Self {
        let header: Vec<_> = names.split(", ").collect();
        Self {
            numbers: (0..header.len()).map(|i| numbers.contains(&i)).collect(),
            header,
            rows: rows.into_iter().collect(),
            breaking: Vec::new(),
            breaking_last: Vec::new(),
        }
    }

    /// Allows lines of a column to be broken, to no less than this width, after those before.
    pub fn breaking(mut self, name: &'static str, least: usize) -> Self {
        self.breaking.push((name, least));
        self
    }

    /// Allows lines of a column to be broken only after most other columns are dropped, so that in a
    /// wide terminal each row is one line.
    pub fn breaking_last(mut self, name: &'static str, least: usize) -> Self {
        self.breaking_last.push((name, least));
        self
    }

    /// Removes the column whose name has this first line, if there is one.
    pub fn without(mut self, name: &str) -> Self {
        let is_it = |header: &&str| header.lines().next() == Some(name);
        let found = self.header.iter().position(is_it);
        if let Some(column) = found.filter(|column| *column > 0 || name != METHOD) {
            self.header.remove(column);
            self.numbers.remove(column);
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
        for name in DETAILS.into_iter().chain(FURTHER).chain(LAST) {
            if name == LAST[0] {
                let last = std::mem::take(&mut grid.breaking_last);
                grid.breaking.extend(last);
            }
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
        for (column, is_number) in table.column_iter_mut().zip(&self.numbers) {
            column.set_padding((0, 1));
            if *is_number {
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
        let mut lines = self.lines(in_cell, line);
        lines.insert(1, format!("|{}", "---|".repeat(self.header.len())));
        lines.join("\n")
    }

    /// Formats the table as a `tabular` of LaTeX with the rules of its package booktabs.
    pub fn tex(&self) -> String {
        let columns = self.numbers.iter().map(|is| if *is { 'r' } else { 'l' });
        let columns: String = columns.collect();
        let line = |cells: Vec<String>| format!("  {} \\\\", cells.join(" & "));
        let mut lines = self.lines(in_tex, line);
        lines.insert(0, format!("\\begin{{tabular}}{{{columns}}}\n  \\toprule"));
        lines.insert(2, "  \\midrule".to_owned());
        lines.push("  \\bottomrule\n\\end{tabular}".to_owned());
        lines.join("\n")
    }

    /// The header and the rows, each on one line.
    fn lines(&self, cell: fn(&str) -> String, line: fn(Vec<String>) -> String) -> Vec<String> {
        let header = self
            .header
            .iter()
            .map(|name| cell(&name.replace('\n', " ")));
        let rows = self.rows.iter().map(|row| {
            // a line of a cell may have commas
            let cells = row.iter().map(|(text, _)| cell(&text.replace('\n', "; ")));
            line(cells.collect())
        });
        std::iter::once(line(header.collect()))
            .chain(rows)
            .collect()
    }
}

/// A text for a cell of Markdown: no character of it is markup, or ends the cell.
pub(super) fn in_cell(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '\\' | '|' | '<' | '*' | '_' | '`' => escaped.extend(['\\', c]),
            '\n' | '\r' => escaped.push(' '),
            _ => escaped.push(c),
        }
    }
    escaped
}

/// A text for LaTeX in any font encoding: no character of it is a command.
fn in_tex(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    // `\\` of the row before would read it as its argument
    if text.starts_with(['[', '*']) {
        escaped.push_str("{}");
    }
    let text = match text.strip_prefix('-') {
        Some(figure) if figure.starts_with(|c: char| c.is_ascii_digit()) => {
            escaped.push_str("$-$");
            figure
        }
        _ => text,
    };
    for c in printable(text).chars() {
        match c {
            '&' | '%' | '_' | '#' | '$' | '{' | '}' => escaped.extend(['\\', c]),
            '\\' => escaped.push_str("\\textbackslash{}"),
            '~' => escaped.push_str("\\textasciitilde{}"),
            '^' => escaped.push_str("\\textasciicircum{}"),
            '<' => escaped.push_str("\\textless{}"),
            '>' => escaped.push_str("\\textgreater{}"),
            '|' => escaped.push_str("\\textbar{}"),
            '²' => escaped.push_str("$^2$"),
            '°' => escaped.push_str("$^\\circ$"),
            '–' => escaped.push_str("--"),
            _ => escaped.push(c),
        }
    }
    escaped
}

/// Value of a row: as a table shows it, and as data.
pub(super) struct Field {
    shown: Styled,
    datum: String,
    is_number: bool,
}

/// A value with its text in tables; not a number is missing.
pub(super) fn number(value: Option<f64>, text: impl Fn(f64) -> String) -> Field {
    let value = value.filter(|v| v.is_finite());
    Field {
        shown: or_dash(value.map(text)),
        datum: value.map_or_else(String::new, |v| v.to_string()),
        is_number: true,
    }
}

pub(super) fn both(shown: Styled, datum: impl Into<String>) -> Field {
    Field {
        shown,
        datum: datum.into(),
        is_number: false,
    }
}

/// A fact as it is shown, and as data.
pub(super) fn fact(shown: Styled, fact: Option<bool>) -> Field {
    both(
        shown,
        fact.map_or_else(String::new, |fact| fact.to_string()),
    )
}

/// A value of data alone.
pub(super) fn datum(datum: impl Into<String>) -> Field {
    both(plain(""), datum)
}

/// A result as a table, described once for every format.
#[derive(Clone)]
pub struct ResultTable {
    title: Option<String>,
    pub(super) grid: Grid,
    /// Sentences below the table, each with the name of the column it explains, or an empty one.
    pub(super) remarks: Vec<(&'static str, String)>,
    /// The keys of the data, and the values of each row.
    records: Vec<Vec<String>>,
}

impl ResultTable {
    /// Rows below columns with a name in tables, the unit on a second line, and a key in data.
    /// Either may be empty: the column is then in data alone, or in tables alone.
    pub(super) fn new(columns: &[(&'static str, &'static str)], rows: Vec<Vec<Field>>) -> Self {
        let keys = columns.iter().map(|(_, key)| *key);
        let mut records = vec![
            keys.filter(|key| !key.is_empty())
                .map(str::to_owned)
                .collect(),
        ];
        let mut grid = Grid {
            header: columns
                .iter()
                .map(|(name, _)| *name)
                .filter(|name| !name.is_empty())
                .collect(),
            numbers: Vec::new(),
            rows: Vec::new(),
            breaking: Vec::new(),
            breaking_last: Vec::new(),
        };
        grid.numbers = vec![false; grid.header.len()];
        for row in rows {
            let (mut cells, mut record) = (Vec::new(), Vec::new());
            for ((name, key), field) in columns.iter().zip(row) {
                if !name.is_empty() {
                    grid.numbers[cells.len()] |= field.is_number;
                    cells.push(field.shown);
                }
                if !key.is_empty() {
                    record.push(field.datum);
                }
            }
            grid.rows.push(cells);
            records.push(record);
        }
        Self {
            title: None,
            grid,
            remarks: Vec::new(),
            records,
        }
    }

    pub(super) fn titled(self, title: &str) -> Self {
        let title = Some(title.to_owned());
        Self { title, ..self }
    }

    /// Changes what is shown of the table.
    pub(super) fn showing(mut self, change: impl FnOnce(Grid) -> Grid) -> Self {
        self.grid = change(self.grid);
        self
    }

    pub(super) fn remark(&mut self, column: &'static str, remark: impl Into<String>) {
        self.remarks.push((column, remark.into()));
    }

    /// The table without details, so that it fits a pane of a viewer.
    pub fn brief(self) -> Self {
        self.showing(Grid::brief)
    }

    /// Formats the table for a terminal, with the remarks on the columns that are left.
    pub fn text(&self, display: Display) -> String {
        let (table, columns) = self.grid.clone().text_and_columns(display);
        let is_shown = |name: &str| columns.iter().any(|c| c.lines().next() == Some(name));
        let remarks = self.remarks.iter();
        let remarks = remarks.filter(|(column, _)| column.is_empty() || is_shown(column));
        let lines = self.title.iter().chain([&table]);
        let lines: Vec<&str> = lines
            .chain(remarks.map(|(_, remark)| remark))
            .map(String::as_str)
            .collect();
        lines.join("\n")
    }

    /// Formats the title, the table and the remarks as markdown.
    pub fn markdown(&self) -> String {
        let title = self.title.iter();
        let mut lines: Vec<String> = title.map(|t| format!("# {}\n", in_cell(t))).collect();
        lines.extend([self.grid.markdown(), String::new()]);
        let remarks = self.remarks.iter();
        lines.extend(remarks.map(|(_, remark)| format!("- {}", in_cell(remark))));
        lines.join("\n")
    }

    /// Formats the table for LaTeX, to be read by `\input`. The title and the remarks are comments.
    pub fn tex(&self) -> String {
        let remarks = self.remarks.iter().map(|(_, remark)| remark);
        let comments = self.title.iter().chain(remarks);
        let mut lines: Vec<String> = comments.map(|c| format!("% {}", printable(c))).collect();
        lines.push(self.grid.tex());
        lines.join("\n")
    }

    /// Keys of the data, then the values of each row: whole numbers in SI units, missing ones empty.
    pub fn records(&self) -> &[Vec<String>] {
        &self.records
    }
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
