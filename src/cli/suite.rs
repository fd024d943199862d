//! `searoom suite`: many scenarios, one row each.

use std::path::Path;

use searoom::document::{
    INTERNAL_FAULT, NOT_APPLICABLE, PlanDocument, SuiteDocument, SuiteRunDocument, UNREADABLE,
};
use searoom::report::page::HtmlReport;
use searoom::report::{counted, printable, suite_table};

use super::args::SuiteArgs;
use super::input::files::shown;
use super::input::scenes::{self, Scene};
use super::lint;
use super::output::Output;
use super::output::products::{Products, Wanted, report_failure};
use super::output::status::ExitStatus;
use super::runner::{Attempt, attempt};

/// Document entries and messages so far, in the order of the files.
#[derive(Default)]
struct Tally {
    runs: Vec<SuiteRunDocument>,
    errors: Vec<String>,
    report: HtmlReport,
    status: ExitStatus,
    /// Whether all results could be written.
    written: ExitStatus,
}

impl Tally {
    fn reach(&mut self, status: ExitStatus) {
        self.status = self.status.max(status);
    }

    /// Adds a valid scenario that the requested planner or rules do not support.
    fn not_applicable(&mut self, file: &Path, title: String, reason: String) {
        report_failure(&mut self.report, file, NOT_APPLICABLE, &reason);
        let file = file.display().to_string();
        self.runs
            .push(SuiteRunDocument::not_applicable(file, title, reason));
    }

    fn failed(&mut self, file: &Path, outcome: &'static str, error: String) {
        self.reach(match outcome {
            INTERNAL_FAULT => ExitStatus::InternalFault,
            _ => ExitStatus::BadInput,
        });
        self.errors.push(error.clone());
        report_failure(&mut self.report, file, outcome, &error);
        let file = file.display().to_string();
        self.runs
            .push(SuiteRunDocument::failed(file, outcome, error));
    }
}

/// Runs every scenario below the paths sequentially, so that each is timed alone.
pub fn suite(args: &SuiteArgs, output: &Output) -> anyhow::Result<ExitStatus> {
    let all = scenes::open(&args.paths, &args.assumed, output);
    if args.lint {
        return Ok(lint::suite(all, args, output));
    }
    let wanted = Wanted {
        plans: args.plans.as_deref(),
        ..args.shared.written.wanted()
    };
    let products = Products::prepare(&scenes::found(&all), wanted)?;
    let bar = output.progress(all.len());
    let mut tally = Tally::default();
    for entry in all {
        match entry {
            Ok(scene) => {
                bar.set_message(printable(&scene.label()));
                one(&scene, args, &products, &mut tally);
            }
            Err(unread) => tally.failed(&unread.file, UNREADABLE, unread.error),
        }
        bar.inc(1);
    }
    bar.finish_and_clear();
    for error in &tally.errors {
        output.error(error);
    }
    let count = |wanted: fn(&SuiteRunDocument) -> bool| {
        let count = tally.runs.iter().filter(|run| wanted(run)).count();
        (count > 0).then(|| counted(count, "scenario"))
    };
    if let Some(scenarios) = count(|run| !run.notes.is_empty()) {
        output.note(&format_args!(
            "{scenarios} with assumptions: `searoom check`, and \"notes\" with --json, say which"
        ));
    }
    if let Some(scenarios) = count(|run| run.outcome == NOT_APPLICABLE) {
        output.note(&format_args!(
            "{scenarios} not applicable, skipped: \"reason\" with --json, and `searoom plan`, say why"
        ));
    }
    let document = SuiteDocument::of(tally.runs);
    let lead = document.summary.to_string();
    let report = products.write_report(&tally.report, "Searoom: a suite", &lead);
    let written = output.written(report);
    let shown = output.show(args.shared.written.json, &document, || {
        let table = suite_table(&document.runs, output.colour);
        format!("{table}\n{}", document.summary)
    });
    if document.runs.iter().any(|run| run.cost.is_some()) {
        products.announce(tally.written.max(written), output);
    }
    Ok(tally.status.max(written).max(shown))
}

fn one(scene: &Scene, args: &SuiteArgs, products: &Products, tally: &mut Tally) {
    let file = scene.found.file.as_path();
    match attempt(scene, &args.shared, None) {
        Attempt::Run(run, notes) => {
            let plan = PlanDocument::of(&run);
            let name = file.display().to_string();
            tally.reach(args.shared.status(&run, &plan));
            tally.runs.push(SuiteRunDocument::of(name, &plan, notes));
            if let Err((status, error)) = products.write(&scene.found.stem, &run, &plan) {
                tally.reach(status);
                tally.written = tally.written.max(status);
                tally.errors.push(error);
            }
            if products.wants_report() {
                let subject = products.subject(&scene.found.stem, shown(file));
                tally.report.add_run(&subject, &plan, &run);
            }
        }
        Attempt::Unreadable(error) => tally.failed(file, UNREADABLE, error.to_string()),
        Attempt::NotApplicable(title, reason) => {
            tally.not_applicable(file, title, reason.to_string());
        }
        Attempt::Fault(fault) => tally.failed(file, INTERNAL_FAULT, fault),
    }
}
