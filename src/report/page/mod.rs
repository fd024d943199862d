//! A report as a folder for a browser: one page and its figures, which need no network and no script.
//!
//! The same runs give the same bytes: no clock is in it.

mod parts;

use std::fs;
use std::path::Path;

use maud::{DOCTYPE, Markup, PreEscaped, html};

use super::comparison::{self, ComparisonRow};
use super::figure::{Figure, Panel, comparison_panels, diagram_panels, plan_panels};
use super::summary::Summary;
use super::table::{self, Tone, plan_lines};
use super::write::{WriteError, write_atomically};
use crate::evaluation::outcome;
use crate::pipeline::Run;
use crate::scenario::Scenario;
use crate::study::compare::{Entry, Inapplicable};
use parts::{Link, address, list, table_of};

pub use parts::link_from;

/// The page.
const INDEX: &str = "index.html";

/// How it looks.
const STYLE: &str = include_str!("style.css");

/// One scenario of a report: what its files are called, where it came from, and what else was written of it.
#[derive(Debug, Clone, Default)]
pub struct Subject {
    /// Begins the names of its figures.
    pub stem: String,
    /// The scenario file.
    pub file: String,
    /// What is linked, with its address: a recording, a plan document.
    pub links: Vec<(String, String)>,
}

/// A report that grows scenario by scenario.
#[derive(Debug, Default)]
pub struct Report {
    rows: Vec<Markup>,
    sections: Vec<Markup>,
    figures: Vec<(String, String)>,
    /// Of the table over all; none where every scenario has its own.
    header: Option<Markup>,
}

impl Report {
    /// A report without anything in it.
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds a plan: a row of the table, its verdict and costs, its chart and diagram.
    pub fn add_run(&mut self, subject: &Subject, run: &Run) {
        self.head();
        let texts = without(table::TIME, table::texts(&Summary::of(run)));
        let names = without(table::TIME, table::HEADER);
        let id = self.sections.len() + 1;
        self.rows
            .push(parts::row(&names, &texts, Some(id), parts::plan_number));
        let (head, lines) = plan_lines(run);
        let lines = lines.iter().filter(|(name, _)| *name != table::TIME_LINE);
        let figures = self.draw(subject, plan_panels(run));
        self.sections.push(html! {
            section id=(format!("s{id}")) {
                h2 { (head) }
                (origin(subject))
                dl {
                    @for (name, value) in lines { dt { (name) } dd { (value) } }
                }
                (figures)
            }
        });
    }

    /// Adds a file that gave no plan: a row, and why.
    pub fn add_failure(&mut self, file: &str, ended: &str, error: &str) {
        self.head();
        let (word, tone) = outcome(ended, None, 0.0);
        let mut texts = vec![(file.to_owned(), Tone::Plain), (word.clone(), tone)];
        let names = without(table::TIME, table::HEADER);
        texts.resize(names.len(), ("–".to_owned(), Tone::Plain));
        let id = self.sections.len() + 1;
        self.rows
            .push(parts::row(&names, &texts, Some(id), parts::plan_number));
        self.sections.push(html! {
            section id=(format!("s{id}")) {
                h2 { (file) ": " (word) }
                p class=(if tone == Tone::Bad { "bad" } else { "quiet" }) { (error) }
            }
        });
    }

    /// Adds a comparison: its table, its charts and the diagrams of those that keep to paths.
    pub fn add_comparison(
        &mut self,
        subject: &Subject,
        scenario: &Scenario,
        entries: &[Entry],
        inapplicable: &[Inapplicable],
    ) {
        let rows: Vec<ComparisonRow> = entries
            .iter()
            .map(|entry| ComparisonRow::of(scenario, entry))
            .collect();
        let sweep = comparison::is_sweep(&rows);
        let mut names = without(comparison::TIME, comparison::HEADER);
        if sweep {
            names.insert(2, comparison::ACCEPTED);
        }
        let lines = rows.iter().map(|row| {
            let mut texts = without(comparison::TIME, comparison::texts(row));
            if sweep {
                texts.insert(2, (row.max_risk.to_string(), Tone::Plain));
            }
            parts::row(&names, &texts, None, parts::comparison_number)
        });
        let lines: Vec<Markup> = lines.collect();
        let mut panels = comparison_panels(scenario, entries, sweep);
        panels.extend(diagram_panels(entries));
        let figures = self.draw(subject, panels);
        let id = self.sections.len() + 1;
        self.sections.push(html! {
            section id=(format!("s{id}")) {
                h2 { (scenario.title) }
                (origin(subject))
                (table_of(&parts::header(&names, parts::comparison_number), &lines))
                (list(&comparison::remarks(&rows, inapplicable)))
                (figures)
            }
        });
    }

    fn head(&mut self) {
        self.header.get_or_insert_with(|| {
            parts::header(&without(table::TIME, table::HEADER), parts::plan_number)
        });
    }

    /// Keeps the panels as figures of their own, and shows them.
    fn draw(&mut self, subject: &Subject, panels: Vec<Panel>) -> Markup {
        let mut shown = Vec::new();
        for (index, panel) in panels.into_iter().enumerate() {
            let title = panel.title().to_owned();
            let name = format!("{}-{}.svg", subject.stem, index + 1);
            self.figures
                .push((name.clone(), Figure::new(1, vec![panel]).svg()));
            let address = address(&name);
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
                    @if let Some(header) = &self.header { (table_of(header, &self.rows)) }
                    @for section in &self.sections { (section) }
                    p.quiet { "Lengths in metres, times in seconds from the start, courses clockwise from true north." }
                }
            }
        };
        page.into_string()
    }

    /// Writes the figures and then the page into `folder`, which is made: each file is whole or not there, and the page never
    /// shows a figure that is not. Files of an earlier report that this one has not are left.
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

/// Where a scenario came from, and what was written of it.
fn origin(subject: &Subject) -> Markup {
    html! {
        p.quiet {
            (subject.file)
            @for (name, address) in &subject.links {
                " · " (Link { name, address })
            }
        }
    }
}

/// All but one of a row.
fn without<T: Clone, const N: usize>(left_out: usize, all: [T; N]) -> Vec<T> {
    let mut all = all.to_vec();
    all.remove(left_out);
    all
}

#[cfg(test)]
mod tests;
