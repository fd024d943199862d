//! `searoom suite`: many scenarios, one row each.

use searoom::document::{PlanDocument, SuiteDocument, SuiteOutcome, SuiteRunDocument};
use searoom::report::page::HtmlReport;
use searoom::report::{counted, printable, suite_table};

use super::args::SuiteArgs;
use super::found::{Refused, shown};
use super::input::scenes::{self, Scene};
use super::lint;
use super::output::Output;
use super::output::products::{Products, Wanted, report_failure};
use super::runner::attempt;
use super::status::ExitStatus;

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

    /// Adds a file without a run. A scenario that does not apply is no fault of it.
    fn refused(&mut self, refused: Refused) {
        report_failure(&mut self.report, &refused);
        if refused.title.is_none() {
            self.reach(refused.status());
            self.errors.push(refused.error.clone());
        }
        let (file, error) = (refused.file.display().to_string(), refused.error);
        self.runs.push(match refused.title {
            Some(title) => SuiteRunDocument::not_applicable(file, title, error),
            None => SuiteRunDocument::failed(file, refused.outcome, error),
        });
    }
}

/// Runs every scenario below the paths sequentially, so that each is timed alone.
pub fn suite(args: &SuiteArgs, output: &Output) -> anyhow::Result<ExitStatus> {
    let all = scenes::open(&args.paths, &args.assumed, output);
    if args.lint {
        return Ok(lint::suite(all, args, output));
    }
    let mut wanted = Wanted {
        plans: args.plans.as_deref(),
        ..args.shared.written.wanted()?
    };
    wanted.files.extend(args.tables.files());
    args.tables.prepare(&args.paths)?;
    let products = Products::prepare(&scenes::found(&all), wanted)?;
    let bar = output.progress(all.len());
    let mut tally = Tally::default();
    for entry in all {
        match entry {
            Ok(scene) => {
                bar.set_message(printable(&scene.label()));
                one(&scene, args, &products, &mut tally);
            }
            Err(refused) => tally.refused(refused),
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
    if let Some(scenarios) = count(|run| !run.cautions.is_empty()) {
        output.note(&format_args!(
            "{scenarios} with input on safety that no plan uses: `searoom check`, and \
             \"cautions\" with --json, say which"
        ));
    }
    if let Some(scenarios) = count(|run| run.outcome == SuiteOutcome::NotApplicable) {
        output.note(&format_args!(
            "{scenarios} not applicable, skipped: \"reason\" with --json, and `searoom plan`, \
             say why"
        ));
    }
    let document = SuiteDocument::of(tally.runs);
    let lead = document.summary.to_string();
    let report = products.write_report(&tally.report, "Searoom: a suite", &lead);
    let written = output.written(report);
    let table = suite_table(&document);
    let tabled = args.tables.write(std::slice::from_ref(&table), output);
    let shown = output.show(args.shared.written.json, &document, || {
        // the errors say all of files that hold no scenario
        if document.runs.iter().all(|run| run.scenario.is_none()) {
            return String::new();
        }
        table.text(output.display)
    });
    if document.runs.iter().any(|run| run.cost.is_some()) {
        products.announce(tally.written.max(written), output);
    }
    Ok(tally.status.max(written).max(tabled).max(shown))
}

fn one(scene: &Scene, args: &SuiteArgs, products: &Products, tally: &mut Tally) {
    let file = scene.found.file.as_path();
    match attempt(scene, &args.shared, None) {
        Ok((run, notes)) => {
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
        Err(refused) => tally.refused(refused),
    }
}
