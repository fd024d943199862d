//! `searoom suite`: many scenarios, one row each.

use searoom::pipeline::Run;
use searoom::report::document::{INTERNAL_FAULT, SuiteDocument, SuiteRunDocument, UNREADABLE};
use searoom::report::{Row, Summary, suite_table};

use super::args::SuiteArgs;
use super::files::{self, Found};
use super::output::Output;
use super::products::{Products, Wanted};
use super::runner::{Attempt, attempt};
use super::status::Status;

/// Rows, entries of the document and the messages so far, in the order of the files.
#[derive(Default)]
struct Tally {
    rows: Vec<Row>,
    runs: Vec<SuiteRunDocument>,
    errors: Vec<String>,
    status: Option<Status>,
}

impl Tally {
    fn reach(&mut self, status: Status) {
        self.status = self.status.max(Some(status));
    }

    fn run(&mut self, file: String, run: &Run) {
        self.reach(Status::of(run));
        self.rows.push(Row::Run(Summary::of(run)));
        self.runs.push(SuiteRunDocument::of(file, run));
    }

    fn failed(&mut self, file: String, outcome: &'static str, error: String) {
        self.reach(if outcome == INTERNAL_FAULT {
            Status::InternalFault
        } else {
            Status::BadInput
        });
        self.errors.push(error.clone());
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
    let all = files::find(&args.paths, output);
    let found: Vec<Found> = all.iter().flatten().cloned().collect();
    let wanted = Wanted {
        plans: args.plans.as_deref(),
        ..args.shared.wanted()
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
            Ok(found) => {
                bar.set_message(found.file.display().to_string());
                one(&found, args, &products, &mut tally);
            }
            Err((path, error)) => {
                tally.failed(path.display().to_string(), UNREADABLE, format!("{error:#}"));
            }
        }
        bar.inc(1);
    }
    bar.finish_and_clear();
    for error in &tally.errors {
        output.error(error);
    }
    let document = SuiteDocument::of(tally.runs);
    let shown = if args.shared.json {
        output.document(&document)
    } else {
        let table = suite_table(&tally.rows, output.colour);
        output.result(&format!("{table}\n{}", document.summary))
    };
    tally.status.unwrap_or(Status::Good).max(shown)
}

fn one(found: &Found, args: &SuiteArgs, products: &Products, tally: &mut Tally) {
    let file = found.file.display().to_string();
    match attempt(&found.file, &args.shared) {
        Attempt::Run(run) => {
            tally.run(file, &run);
            if let Err((status, error)) = products.write(&found.stem, &run) {
                tally.reach(status);
                tally.errors.push(error);
            }
        }
        Attempt::Unreadable(error) => tally.failed(file, UNREADABLE, error.to_string()),
        Attempt::Fault(fault) => tally.failed(file, INTERNAL_FAULT, fault),
    }
}
