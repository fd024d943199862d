//! Pieces of a page: tables, lists, links.

use std::path::Path;

use maud::{Markup, Render, html};
use percent_encoding::{AsciiSet, NON_ALPHANUMERIC, utf8_percent_encode};

use crate::report::table::{self, Tone};

/// What stays as it is in the address of a file.
const PLAIN: AsciiSet = NON_ALPHANUMERIC
    .remove(b'-')
    .remove(b'_')
    .remove(b'.')
    .remove(b'~')
    .remove(b'/');

/// A name that leads somewhere.
pub(super) struct Link<'a> {
    pub name: &'a str,
    pub address: &'a str,
}

impl Render for Link<'_> {
    fn render(&self) -> Markup {
        html! { a href=(self.address) { (self.name) } }
    }
}

/// The address of a file beside the page.
pub(super) fn address(name: &str) -> String {
    // a name that begins like a scheme is none behind "./"
    format!("./{}", utf8_percent_encode(name, &PLAIN))
}

/// The address of `file` for a page in `folder`: how to get from one to the other. Both have to exist; the file's own path
/// where they do not, or where there is no way.
pub fn link_from(folder: &Path, file: &Path) -> String {
    let both = folder
        .canonicalize()
        .and_then(|a| Ok((a, file.canonicalize()?)));
    let way = both.ok().and_then(|(a, b)| pathdiff::diff_paths(b, a));
    let way = way.unwrap_or_else(|| file.to_owned());
    let way = way
        .to_string_lossy()
        .replace(std::path::MAIN_SEPARATOR, "/");
    if way.starts_with('/') {
        return utf8_percent_encode(&way, &PLAIN).to_string();
    }
    address(&way)
}

/// Numbers of a plan's row, the time left out.
pub(super) fn plan_number(column: usize) -> bool {
    table::NUMBERS.contains(&column) && column + 1 < table::NUMBERS.end
}

/// Numbers of a contender's row.
pub(super) fn comparison_number(column: usize) -> bool {
    column >= 2
}

/// The names of the columns.
pub(super) fn header(names: &[&str], is_number: fn(usize) -> bool) -> Markup {
    html! {
        tr {
            @for (i, name) in names.iter().enumerate() {
                th scope="col" class=[is_number(i).then_some("number")] { (name) }
            }
        }
    }
}

/// A row; its first cell names it, and leads to section `to` where there is one. Narrow pages show the columns' names
/// in every row.
pub(super) fn row(
    names: &[&str],
    cells: &[(String, Tone)],
    to: Option<usize>,
    is_number: fn(usize) -> bool,
) -> Markup {
    html! {
        tr {
            @for (i, ((text, tone), name)) in cells.iter().zip(names).enumerate() {
                @if i == 0 {
                    th scope="row" {
                        @if let Some(section) = to { a href=(format!("#s{section}")) { (text) } }
                        @else { (text) }
                    }
                } @else {
                    td data-name=(name.replace('\n', " ")) class=[class(*tone, is_number(i))] { span { (text) } }
                }
            }
        }
    }
}

fn class(tone: Tone, number: bool) -> Option<&'static str> {
    match (tone, number) {
        (Tone::Plain, false) => None,
        (Tone::Plain, true) => Some("number"),
        (Tone::Good, false) => Some("good"),
        (Tone::Fair, false) => Some("fair"),
        (Tone::Bad, false) => Some("bad"),
        (Tone::Good, true) => Some("number good"),
        (Tone::Fair, true) => Some("number fair"),
        (Tone::Bad, true) => Some("number bad"),
    }
}

/// A table that may be wider than the page.
pub(super) fn table_of(header: &Markup, rows: &[Markup]) -> Markup {
    html! {
        div.scroll {
            table {
                thead { (header) }
                tbody { @for row in rows { (row) } }
            }
        }
    }
}

/// Sentences, or nothing.
pub(super) fn list(lines: &[String]) -> Markup {
    html! {
        @if !lines.is_empty() {
            ul.quiet { @for line in lines { li { (line) } } }
        }
    }
}
