//! A report as a folder for a browser: one page and its figures, without network and script.
//!
//! No clock is in it: the same runs give the same bytes.

mod link;

use std::fs;
use std::path::Path;

use maud::{DOCTYPE, Markup, PreEscaped, html};

use super::comparison::{comparison_grid, remarks};
use super::figure::{Figure, Panel, comparison_panels, diagram_panels, plan_panels};
use super::plan::{TIME_COLUMN, TIME_LINE, headline, plan_lines, suite_grid};
use super::table::{Grid, Styled, Tone, verdict};
use super::write::{WriteError, write_atomically};
use crate::document::{PlanDocument, ScenarioComparisonDocument, SuiteRunDocument};
use crate::pipeline::Run;
use crate::scenario::Scenario;
use crate::study::compare::Entry;

pub use link::link_from;

/// The page.
const INDEX: &str = "index.html";

/// Its style sheet.
const STYLE: &str = include_str!("style.css");

/// One scenario of a report: the names of its files and links to other results.
#[derive(Debug, Clone, Default)]
pub struct Subject {
    /// Begins the names of its figures.
    pub stem: String,
    /// The scenario file.
    pub file: String,
    /// Names and addresses of linked files: a recording, a plan document.
    pub links: Vec<(String, String)>,
}

/// A report that grows scenario by scenario.
#[derive(Debug, Default)]
pub struct Report {
    /// The rows of the table over all plans: row i belongs to section i.
    runs: Vec<SuiteRunDocument>,
    sections: Vec<Markup>,
    figures: Vec<(String, String)>,
}

impl Report {
    /// A report without anything in it.
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds a plan: a row of the table, its verdict and costs, its chart and diagram.
    pub fn add_run(&mut self, subject: &Subject, plan: &PlanDocument, run: &Run) {
        let file = subject.file.clone();
        self.runs.push(SuiteRunDocument::of(file, plan, Vec::new()));
        let lines = plan_lines(plan).into_iter();
        let lines = lines.filter(|(name, _)| *name != TIME_LINE);
        let figures = self.draw(subject, plan_panels(run));
        self.section(html! {
            h2 { (headline(plan)) }
            (origin(subject))
            dl {
                @for (name, value) in lines { dt { (name) } dd { (value) } }
            }
            (figures)
        });
    }

    /// Adds a file that gave no plan: a row, and why.
    pub fn add_failure(&mut self, file: &str, outcome: &str, error: &str) {
        let failed = SuiteRunDocument::failed(file.to_owned(), outcome, error.to_owned());
        let (word, tone) = verdict(&failed.verdict);
        self.runs.push(failed);
        self.section(html! {
            h2 { (file) ": " (word) }
            p class=(if tone == Tone::Bad { "bad" } else { "quiet" }) { (error) }
        });
    }

    /// Adds a comparison: its table, its charts and the diagrams of plans along paths.
    pub fn add_comparison(
        &mut self,
        subject: &Subject,
        compared: &ScenarioComparisonDocument,
        scenario: &Scenario,
        entries: &[Entry],
    ) {
        let sweep = (entries.iter()).any(|e| e.candidate.max_risk != entries[0].candidate.max_risk);
        let mut panels = comparison_panels(scenario, entries, sweep);
        panels.extend(diagram_panels(entries));
        let figures = self.draw(subject, panels);
        let remarks = remarks(compared);
        self.section(html! {
            h2 { (scenario.title) }
            (origin(subject))
            (table(comparison_grid(&compared.entries), false))
            @if !remarks.is_empty() {
                ul.quiet { @for line in remarks { li { (line) } } }
            }
            (figures)
        });
    }

    fn section(&mut self, contents: Markup) {
        let id = format!("s{}", self.sections.len() + 1);
        self.sections.push(html! { section id=(id) { (contents) } });
    }

    /// Keeps the panels as figures of their own, and shows them.
    fn draw(&mut self, subject: &Subject, panels: Vec<Panel>) -> Markup {
        let mut shown = Vec::new();
        for (index, panel) in panels.into_iter().enumerate() {
            let title = panel.title().to_owned();
            let name = format!("{}-{}.svg", subject.stem, index + 1);
            self.figures
                .push((name.clone(), Figure::new(1, vec![panel]).svg()));
            let address = link::address(&name);
            shown.push(html! {
                figure { a href=(address) { img src=(address) alt=(title) loading="lazy"; } }
            });
        }
        html! { div.figures { @for figure in &shown { (figure) } } }
    }

    /// The page.
    pub fn html(&self, title: &str, lead: &str) -> String {
        let page = html! {
            (DOCTYPE)
            html lang="en" {
                head {
                    meta charset="utf-8";
                    meta name="viewport" content="width=device-width, initial-scale=1";
                    title { (title) }
                    style { (PreEscaped(STYLE)) }
                }
                body {
                    h1 { (title) }
                    p { (lead) }
                    @if !self.runs.is_empty() { (table(suite_grid(&self.runs), true)) }
                    @for section in &self.sections { (section) }
                    p.quiet { "Lengths in metres, times in seconds from the start, courses clockwise from true north." }
                }
            }
        };
        page.into_string()
    }

    /// Writes the figures and then the page into `folder`, which is made. Each file is whole or
    /// absent, and the page never shows a missing figure. Files of an earlier report stay.
    pub fn write(&self, folder: &Path, title: &str, lead: &str) -> Result<(), WriteError> {
        fs::create_dir_all(folder).map_err(|source| WriteError {
            file: folder.to_owned(),
            source,
        })?;
        for (name, svg) in &self.figures {
            write_atomically(&folder.join(name), svg.as_bytes())?;
        }
        let page = self.html(title, lead);
        write_atomically(&folder.join(INDEX), page.as_bytes())
    }
}

/// The file of a scenario, and links to other results.
fn origin(subject: &Subject) -> Markup {
    html! {
        p.quiet {
            (subject.file)
            @for (name, address) in &subject.links {
                " · " a href=(address) { (name) }
            }
        }
    }
}

/// A table that may be wider than the page. The first cell of a row names it, and leads to its
/// section where `linked`. Narrow pages show the columns' names in every row.
fn table(grid: Grid, linked: bool) -> Markup {
    // no clock is on the page
    let Grid {
        header,
        numbers,
        rows,
    } = grid.without(TIME_COLUMN);
    let number = |column: usize| numbers.contains(&column);
    html! {
        div.scroll {
            table {
                thead {
                    tr {
                        @for (i, name) in header.iter().enumerate() {
                            th scope="col" class=[number(i).then_some("number")] { (name) }
                        }
                    }
                }
                tbody {
                    @for (section, row) in rows.iter().enumerate() {
                        tr {
                            @for (i, (cell, name)) in row.iter().zip(&header).enumerate() {
                                @if i > 0 {
                                    td data-name=(name.replace('\n', " ")) class=[class(cell, number(i))] {
                                        span { (cell.0) }
                                    }
                                } @else if linked {
                                    th scope="row" { a href=(format!("#s{}", section + 1)) { (cell.0) } }
                                } @else {
                                    th scope="row" { (cell.0) }
                                }
                            }
                        }
                    }
                }
            }
        }
    }
}

fn class(cell: &Styled, number: bool) -> Option<String> {
    let tone = match cell.1 {
        Tone::Plain => None,
        Tone::Good => Some("good"),
        Tone::Fair => Some("fair"),
        Tone::Bad => Some("bad"),
    };
    let classes: Vec<&str> = number.then_some("number").into_iter().chain(tone).collect();
    (!classes.is_empty()).then(|| classes.join(" "))
}

#[cfg(test)]
mod tests;
