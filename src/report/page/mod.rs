//! HTML report in a folder: one page and its figures, without network access and scripts.
//!
//! The page contains no timestamps: equal runs give equal bytes.

mod link;

use std::fs;
use std::path::Path;

use maud::{DOCTYPE, Markup, PreEscaped, html};

use super::campaign::{CLEARANCES, EVENTS, bounds, clearances, counts, groups, worst_grid};
use super::comparison::{comparison_table, is_sweep};
use super::figure::{
    Figure, Panel, Style, comparison_panels, diagram_panels, distribution_panel, plan_panels,
    simulation_panel,
};
use super::plan::{TIME_COLUMN, legs_grid, suite_table};
use super::simulation::{
    TIMES, alarm_lines, conduct_lines, headline as simulation_headline, judges_grid, replans_grid,
    targets_grid,
};
use super::table::{Grid, ResultTable, Styled, Tone, verdict};
use crate::document::{
    CampaignDocument, PlanDocument, ScenarioComparisonDocument, SimulationDocument, SuiteDocument,
    SuiteOutcome, SuiteRunDocument, TIME_LINE, headline, plan_lines,
};
use crate::output::{WriteError, write_atomically};
use crate::pipeline::Run;
use crate::scenario::Scenario;
use crate::study::compare::Entry;
use crate::text::Times;

pub use link::link_from;

const INDEX: &str = "index.html";
const STYLE: &str = include_str!("style.css");

/// One scenario of a report: its file names and links to other results.
#[derive(Debug, Clone, Default)]
pub struct Subject {
    /// Prefix of the figure names.
    pub stem: String,
    /// Scenario file.
    pub file: String,
    /// Names and URLs of linked files, such as a recording or a plan document.
    pub links: Vec<(String, String)>,
}

/// Report as HTML pages, built scenario by scenario.
#[derive(Debug, Default)]
pub struct HtmlReport {
    /// Rows of the table over all plans, and the number of the section of each.
    runs: Vec<SuiteRunDocument>,
    run_sections: Vec<usize>,
    sections: Vec<Markup>,
    figures: Vec<(String, String)>,
}

impl HtmlReport {
    /// Creates an empty report.
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds a plan: a table row, its verdict and costs, its chart and diagram.
    pub fn add_run(&mut self, subject: &Subject, plan: &PlanDocument, run: &Run) {
        let file = subject.file.clone();
        self.row(SuiteRunDocument::of(file, plan, Vec::new()));
        let figures = self.draw(subject, plan_panels(run, plan, &Style::default()));
        let legs = legs_grid(plan);
        self.section(html! {
            h2 { (headline(plan)) }
            (origin(subject))
            (named_lines(plan_lines(plan, Times::Seconds), TIME_LINE))
            (figures)
            @if !legs.rows.is_empty() { (table(legs, &[])) }
        });
    }

    /// Adds a file without a plan: a table row and the reason.
    pub fn add_failure(&mut self, file: &str, outcome: SuiteOutcome, error: &str) {
        let failed = SuiteRunDocument::failed(file.to_owned(), outcome, error.to_owned());
        let (word, tone) = verdict(&failed.verdict);
        self.row(failed);
        self.section(html! {
            h2 { (file) ": " (word) }
            p class=(if tone == Tone::Bad { "bad" } else { "quiet" }) { (error) }
        });
    }

    /// Adds a comparison: its table, its charts, and the diagrams of path-time plans.
    pub fn add_comparison(
        &mut self,
        subject: &Subject,
        compared: &ScenarioComparisonDocument,
        scenario: &Scenario,
        entries: &[Entry],
    ) {
        let mut panels = comparison_panels(
            scenario,
            entries,
            is_sweep(&compared.entries),
            &Style::default(),
        );
        panels.extend(diagram_panels(entries));
        let figures = self.draw(subject, panels);
        let compared = comparison_table(compared);
        self.section(html! {
            h2 { (scenario.title) }
            (origin(subject))
            (remarked(compared, &[]))
            (figures)
        });
    }

    /// Adds a simulation: its outcome, chart, targets and rules, the plans that differ from the one
    /// before, and the alarms.
    pub fn add_simulation(
        &mut self,
        subject: &Subject,
        scenario: &Scenario,
        simulation: &SimulationDocument,
    ) {
        let figures = self.draw(
            subject,
            vec![simulation_panel(scenario, simulation, &Style::default())],
        );
        let targets = &simulation.targets;
        self.section(html! {
            h2 { (simulation_headline(simulation, Times::Seconds)) }
            (origin(subject))
            (named_lines(conduct_lines(simulation, Times::Seconds), TIMES))
            (figures)
            @if !targets.is_empty() {
                h3 { "Targets" }
                (table(targets_grid(targets, Times::Seconds), &[]))
                h3 { "Rules, by both judges" }
                (table(judges_grid(targets), &[]))
            }
            h3 { "Plans that differ from the one before" }
            (table(replans_grid(&simulation.replans), &[]))
            @if !simulation.alarms.is_empty() {
                h3 { "Alarms" }
                ul { @for line in alarm_lines(simulation, Times::Seconds) { li { (line) } } }
            }
        });
    }

    /// Adds the summary of a campaign: counts, bounds, distributions, and the worst rows.
    ///
    /// `values` has the title and the axis of each distribution, and its values in each stratum, in
    /// order. `folder` is where the campaign is, for commands.
    pub fn add_campaign(
        &mut self,
        summary: &CampaignDocument,
        values: &[(&str, &str, Vec<Vec<f64>>)],
        folder: &str,
    ) {
        let panels = values.iter().map(|(title, axis, values)| {
            let names = summary.strata.iter().map(|stratum| stratum.name.as_str());
            let strata: Vec<_> = names.zip(values.iter().map(Vec::as_slice)).collect();
            distribution_panel(title, axis, &strata)
        });
        let subject = Subject {
            stem: "campaign".to_owned(),
            ..Subject::default()
        };
        let figures = self.draw(&subject, panels.collect());
        let groups = groups(summary);
        let confidence = 100.0 * summary.confidence;
        self.section(html! {
            h2 { "Rows" }
            (table(counts(&groups).without("late"), &[]))
            h2 { "Probabilities in percent" }
            p.quiet {
                (format!("{confidence:.0} % confidence; \"anytime\" holds for a run that is watched."))
            }
            (table(bounds(&groups, &EVENTS[..EVENTS.len() - 1]), &[]))
            h2 { "Distributions" }
            (figures)
            h2 { "Least clearance" }
            p.quiet { (CLEARANCES) }
            (table(clearances(&groups), &[]))
            (table(worst_grid(&summary.worst, folder), &[]))
        });
    }

    /// Adds the row of the section that follows.
    fn row(&mut self, run: SuiteRunDocument) {
        self.run_sections.push(self.sections.len() + 1);
        self.runs.push(run);
    }

    fn section(&mut self, contents: Markup) {
        let id = format!("s{}", self.sections.len() + 1);
        self.sections.push(html! { section id=(id) { (contents) } });
    }

    /// Stores the panels as separate figures and embeds them.
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

    /// Renders the page.
    pub fn html(&self, title: &str, lead: &str) -> String {
        // the section of a single plan says all of its row
        let overview = (!self.runs.is_empty() && self.sections.len() > 1).then(|| {
            let mut table = suite_table(&SuiteDocument::of(self.runs.clone()));
            // the lead counts the outcomes
            table.remarks.pop();
            remarked(table, &self.run_sections)
        });
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
                    @if let Some(overview) = overview { (overview) }
                    @for section in &self.sections { (section) }
                    p.quiet {
                        "Lengths in metres, speeds in knots, times in seconds from the start, \
                         courses clockwise from true north."
                    }
                }
            }
        };
        page.into_string()
    }

    /// Creates `folder` and writes the figures, then the page. Each file is written atomically, and
    /// the page never shows a missing figure. Files of an earlier report are not deleted.
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

/// Renders named lines without that of the planning time.
fn named_lines(lines: Vec<(&'static str, String)>, time: &str) -> Markup {
    let lines = lines.into_iter().filter(|(name, _)| *name != time);
    html! {
        dl {
            @for (name, value) in lines { dt { (name) } dd { (value) } }
        }
    }
}

/// Renders a table and the remarks below it.
fn remarked(shown: ResultTable, sections: &[usize]) -> Markup {
    html! {
        (table(shown.grid, sections))
        @if !shown.remarks.is_empty() {
            ul.quiet { @for (_, line) in shown.remarks { li { (line) } } }
        }
    }
}

/// Renders a table that may be wider than the page. The first cell names the row, and links to
/// its section if `sections` has one. Narrow pages repeat the column names in every row.
fn table(grid: Grid, sections: &[usize]) -> Markup {
    // the page contains no timestamps
    let Grid {
        header,
        numbers,
        rows,
        ..
    } = grid.without(TIME_COLUMN);
    let number = |column: usize| numbers[column];
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
                    @for (index, row) in rows.iter().enumerate() {
                        tr {
                            @for (i, (cell, name)) in row.iter().zip(&header).enumerate() {
                                @let name = name.replace('\n', " ");
                                @if i > 0 {
                                    td data-name=(name) class=[class(cell, number(i))] {
                                        span { (cell.0) }
                                    }
                                } @else if let Some(section) = sections.get(index) {
                                    th scope="row" { a href=(format!("#s{section}")) { (cell.0) } }
                                } @else {
                                    // a number alone names no row of a narrow page
                                    @let name = number(0).then_some(name);
                                    th scope="row" data-name=[name] { span { (cell.0) } }
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
