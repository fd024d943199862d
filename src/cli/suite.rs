//! `searoom suite`: many scenarios, one row each.

use std::path::Path;

use searoom::document::{
    INTERNAL_FAULT, NOT_APPLICABLE, SuiteDocument, SuiteRunDocument, UNREADABLE,
};
use searoom::pipeline::Run;
use searoom::report::page::Report;
use searoom::report::{Row, Summary, printable, suite_table};
use searoom::scenario::import::Assumed;

use super::args::SuiteArgs;
use super::files::{self, Found, shown};
use super::lint;
use super::output::Output;
use super::products::{Products, Wanted};
use super::runner::{Attempt, attempt};
use super::scenes::{self, Scene};
use super::status::Status;

/// Rows, entries of the document and the messages so far, in the order of the files.
#[derive(Default)]
struct Tally {
    rows: Vec<Row>,
    runs: Vec<SuiteRunDocument>,
    errors: Vec<String>,
    /// Runs of which something was assumed or not used.
    noted: usize,
    /// Scenarios of no use to what was asked for.
    skipped: usize,
    report: Report,
    status: Option<Status>,
}

impl Tally {
    fn reach(&mut self, status: Status) {
        self.status = self.status.max(Some(status));
    }

    fn run(&mut self, file: String, run: &Run, notes: Vec<String>) {
        self.reach(Status::of(run));
        self.rows.push(Row::Run(Summary::of(run)));
        self.noted += usize::from(!notes.is_empty());
        self.runs.push(SuiteRunDocument::of(file, run, notes));
    }

    /// A scenario that is no fault of anybody, but of no use to what was asked for.
    fn not_applicable(&mut self, file: &Path, title: String, reason: String) {
        self.skipped += 1;
        self.report
            .add_failure(&shown(file), NOT_APPLICABLE, &without_folder(file, &reason));
        let file = file.display().to_string();
        self.rows.push(Row::Failed {
            file: file.clone(),
            outcome: NOT_APPLICABLE,
        });
        self.runs
            .push(SuiteRunDocument::not_applicable(file, title, reason));
    }

    fn failed(&mut self, file: &Path, outcome: &'static str, error: String) {
        self.reach(if outcome == INTERNAL_FAULT {
            Status::InternalFault
        } else {
            Status::BadInput
        });
        self.errors.push(error.clone());
        self.report
            .add_failure(&shown(file), outcome, &without_folder(file, &error));
        let file = file.display().to_string();
        self.rows.push(Row::Failed {
            file: file.clone(),
            outcome,
        });
        self.runs
            .push(SuiteRunDocument::failed(file, outcome, error));
    }
}

/// Runs every scenario below the paths, one after another, so that each is timed alone.
pub fn suite(args: &SuiteArgs, output: &Output) -> Status {
    let assumed = args.assumed.assumed();
    let files = files::find(&args.paths, &files::ANY_FORMAT, output);
    let all = scenes::open(files, &assumed, output);
    if args.lint {
        return lint::suite(all, args, &assumed, output);
    }
    let found: Vec<Found> = all.iter().flatten().map(|s| s.found.clone()).collect();
    let wanted = Wanted {
        plans: args.plans.as_deref(),
        ..args.shared.written.wanted()
    };
    let products = match Products::prepare(&found, wanted) {
        Ok(products) => products,
        Err(error) => {
            output.error(&format_args!("{error:#}"));
            return Status::BadInput;
        }
    };
    let bar = output.progress(all.len());
    let mut tally = Tally::default();
    for entry in all {
        match entry {
            Ok(scene) => {
                bar.set_message(printable(&scene.label()));
                one(&scene, args, &assumed, &products, &mut tally);
            }
            Err(unread) => {
                tally.failed(&unread.file, UNREADABLE, unread.error);
            }
        }
        bar.inc(1);
    }
    bar.finish_and_clear();
    for error in &tally.errors {
        output.error(error);
    }
    if tally.noted > 0 {
        let (noted, plural) = (tally.noted, if tally.noted == 1 { "" } else { "s" });
        output.note(&format_args!(
            "{noted} scenario{plural} with assumptions: `searoom check`, and \"notes\" with --json, say which"
        ));
    }
    if tally.skipped > 0 {
        let (skipped, plural) = (tally.skipped, if tally.skipped == 1 { "" } else { "s" });
        output.note(&format_args!(
            "{skipped} scenario{plural} not applicable, skipped: \"reason\" with --json, and `searoom plan`, say why"
        ));
    }
    let document = SuiteDocument::of(tally.runs);
    let lead = document.summary.to_string();
    if let Err((status, error)) = products.write_report(&tally.report, "Searoom: a suite", &lead) {
        output.error(&error);
        tally.status = tally.status.max(Some(status));
    }
    let shown = if args.shared.written.json {
        output.document(&document)
    } else {
        let table = suite_table(&tally.rows, output.colour);
        output.result(&format!("{table}\n{}", document.summary))
    };
    tally.status.unwrap_or(Status::Good).max(shown)
}

fn one(scene: &Scene, args: &SuiteArgs, assumed: &Assumed, products: &Products, tally: &mut Tally) {
    let file = scene.found.file.as_path();
    match attempt(scene, &args.shared, assumed) {
        Attempt::Run(run, notes) => {
            tally.run(file.display().to_string(), &run, notes);
            if let Err((status, error)) = products.write(&scene.found.stem, &run, None) {
                tally.reach(status);
                tally.errors.push(error);
            }
            if products.wants_report() {
                let subject = products.subject(&scene.found.stem, shown(file));
                tally.report.add_run(&subject, &run);
            }
        }
        Attempt::Unreadable(error) => tally.failed(file, UNREADABLE, error.to_string()),
        Attempt::NotApplicable(title, reason) => {
            tally.not_applicable(file, title, reason.to_string());
        }
        Attempt::Fault(fault) => tally.failed(file, INTERNAL_FAULT, fault),
    }
}

/// A message about a file, which names it as a report does.
fn without_folder(file: &Path, message: &str) -> String {
    message.replace(&file.display().to_string(), &shown(file))
}
