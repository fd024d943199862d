//! `searoom suite`: many scenarios, one row each.

use searoom::pipeline::Run;
use searoom::report::document::{INTERNAL_FAULT, SuiteDocument, SuiteRunDocument, UNREADABLE};
use searoom::report::page::Report;
use searoom::report::{Row, Summary, suite_table};
use searoom::scenario::formats::Assumed;

use super::args::SuiteArgs;
use super::files::{self, Found};
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

    fn failed(&mut self, file: String, outcome: &'static str, error: String) {
        self.reach(if outcome == INTERNAL_FAULT {
            Status::InternalFault
        } else {
            Status::BadInput
        });
        self.errors.push(error.clone());
        self.report.add_failure(&file, outcome, &error);
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
                bar.set_message(scene.label());
                one(&scene, args, &assumed, &products, &mut tally);
            }
            Err(unread) => {
                tally.failed(unread.file.display().to_string(), UNREADABLE, unread.error);
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
    let file = scene.found.file.display().to_string();
    match attempt(scene, &args.shared, assumed) {
        Attempt::Run(run, notes) => {
            tally.run(file.clone(), &run, notes);
            if let Err((status, error)) = products.write(&scene.found.stem, &run, None) {
                tally.reach(status);
                tally.errors.push(error);
            }
            if products.wants_report() {
                let subject = products.subject(&scene.found.stem, file);
                tally.report.add_run(&subject, &run);
            }
        }
        Attempt::Unreadable(error) => tally.failed(file, UNREADABLE, error.to_string()),
        Attempt::Fault(fault) => tally.failed(file, INTERNAL_FAULT, fault),
    }
}
