//! `searoom compare`: every applicable planner and two baselines.

use std::path::{Path, PathBuf};

use rayon::prelude::*;
use searoom::document::{ComparisonDocument, ScenarioComparisonDocument, SuiteOutcome};
use searoom::report::figure::{FigureError, comparison_figure};
use searoom::report::page::HtmlReport;
use searoom::report::{ResultTable, comparison_table};
use searoom::scenario::Scenario;
use searoom::scenario::import::Imported;
use searoom::study::compare::{
    Candidate, Entry, Inapplicable, Method, candidates, methods, without_repeats,
};

use super::args::CompareArgs;
use super::found::{Refused, shown};
use super::input::scenes::{self, Scene};
use super::output::Output;
use super::output::products::{Failure, Products, Wanted, prepare_figure, report_failure};
use super::runner::{guarded, guarded_on};
use super::status::ExitStatus;

struct Compared {
    file: PathBuf,
    stem: String,
    scenario: Scenario,
    candidates: Vec<Candidate>,
    inapplicable: Vec<Inapplicable>,
    entries: Vec<Entry>,
    faults: Vec<Refused>,
}

/// Compares all scenarios. Candidates run in parallel and are shown in a fixed order.
pub fn compare(args: &CompareArgs, output: &Output) -> anyhow::Result<ExitStatus> {
    // before any computation
    if args.written.panels {
        anyhow::bail!("--panels: found with compare; allowed: with plan, suite and simulate");
    }
    let figure = args.written.drawn.figure.as_deref();
    figure.map_or(Ok(()), prepare_figure)?;
    args.tables.prepare(&args.paths)?;
    let all = scenes::open(&args.paths, &args.assumed, output);
    // one figure of all scenarios
    let mut wanted = Wanted {
        figures: None,
        ..args.written.wanted()?
    };
    wanted.files.extend(args.tables.files());
    wanted
        .files
        .extend(figure.map(|figure| ("--figure", figure)));
    let products = Products::prepare(&scenes::found(&all), wanted)?;
    let asked = all.into_iter().map(|scene| ask(&scene?, args));
    let mut asked: Vec<Result<Compared, Refused>> = asked.collect();
    run(&mut asked, args.bound, output);
    let mut status = ExitStatus::Good;
    for compared in &asked {
        let faults = compared
            .as_ref()
            .map_or_else(std::slice::from_ref, |c| &c.faults);
        for refused in faults {
            status = status.max(output.refused(refused));
        }
        status = status.max(compared.as_ref().map_or(ExitStatus::Good, Compared::status));
    }
    let documents: Vec<_> = asked.iter().map(document).collect();
    let tables: Vec<ResultTable> = documents.iter().map(comparison_table).collect();
    status = status.max(args.tables.write(&tables, output));
    if let Some(figure) = figure {
        match draw(figure, args, &asked) {
            Ok(()) if figure.exists() => output.wrote(figure),
            Ok(()) => {}
            Err(error) => status = status.max(output.refuse(&error)),
        }
    }
    let mut written = ExitStatus::Good;
    for (compared, document) in asked.iter().zip(&documents) {
        if let Ok(c) = compared {
            let result = products.write_comparison(&c.stem, &c.scenario, &c.entries, document);
            written = written.max(output.written(result));
        }
    }
    if products.wants_report() {
        written = written.max(output.written(report(&asked, &documents, &products)));
    }
    if asked.iter().any(Result::is_ok) {
        products.announce(written, output);
    }
    let shown = match args.written.json {
        true => output.document(&ComparisonDocument {
            comparisons: documents,
        }),
        false => {
            // the errors say all of files that hold no scenario
            let read = asked.iter().zip(&tables).filter(|(asked, _)| asked.is_ok());
            let texts = read.map(|(_, table)| table.text(output.display));
            output.result(&texts.collect::<Vec<_>>().join("\n\n"))
        }
    };
    Ok(status.max(written).max(shown))
}

fn ask(scene: &Scene, args: &CompareArgs) -> Result<Compared, Refused> {
    let file = &scene.found.file;
    let Imported { mut scenario, .. } = guarded_on(file, || scene.scenario())?;
    args.asked.apply_rules(&mut scenario);
    let risks = if args.max_risk.is_empty() {
        vec![scenario.max_risk]
    } else {
        args.max_risk.clone()
    };
    let mut found = methods(&scenario);
    found.methods.retain(|method| is_wanted(method, args));
    found
        .inapplicable
        .retain(|other| is_wanted(&other.method, args));
    Ok(Compared {
        file: file.clone(),
        stem: scene.found.stem.clone(),
        candidates: candidates(&found.methods, &risks),
        inapplicable: found.inapplicable,
        scenario,
        entries: Vec::new(),
        faults: Vec::new(),
    })
}

fn is_wanted(method: &Method, args: &CompareArgs) -> bool {
    match method {
        Method::Planner {
            planner, search, ..
        } => {
            let asked = &args.asked;
            asked.planner.is_none_or(|p| p == *planner) && asked.search.is_none_or(|s| s == *search)
        }
        Method::HoldCourse | Method::ConstantVelocity => true,
    }
}

fn run(asked: &mut [Result<Compared, Refused>], bound: bool, output: &Output) {
    let jobs: Vec<(usize, &Compared, Candidate)> = (asked.iter().enumerate())
        .filter_map(|(index, compared)| Some((index, compared.as_ref().ok()?)))
        .flat_map(|(index, c)| c.candidates.iter().map(move |found| (index, c, *found)))
        .collect();
    let bar = output.progress(jobs.len());
    let results: Vec<(usize, Result<Entry, Refused>)> = jobs
        .into_par_iter()
        .map(|(index, c, candidate)| {
            let run = || match bound {
                true => candidate.run(&c.scenario).with_bound(),
                false => candidate.run(&c.scenario),
            };
            let entry = guarded(run).map_err(|fault| {
                let (file, method) = (c.file.display(), candidate.method);
                let error = format_args!("{file}, {method}: {fault}");
                Refused::new(&c.file, SuiteOutcome::InternalFault, error)
            });
            bar.inc(1);
            (index, entry)
        })
        .collect();
    bar.finish_and_clear();
    for (index, result) in results {
        match (&mut asked[index], result) {
            (Ok(compared), Ok(entry)) => compared.entries.push(entry),
            (Ok(compared), Err(fault)) => compared.faults.push(fault),
            // only scenarios are run
            (Err(_), _) => {}
        }
    }
    for compared in asked.iter_mut().flatten() {
        compared.entries = without_repeats(std::mem::take(&mut compared.entries));
    }
}

fn document(compared: &Result<Compared, Refused>) -> ScenarioComparisonDocument {
    match compared {
        Ok(c) => {
            let file = c.file.display().to_string();
            ScenarioComparisonDocument::of(file, &c.scenario, &c.entries, &c.inapplicable)
        }
        Err(refused) => {
            let file = refused.file.display().to_string();
            ScenarioComparisonDocument::failed(file, refused.error.clone())
        }
    }
}

impl Compared {
    /// Good if some planner has a clear plan. A plan that fails its verification is an internal
    /// fault.
    fn status(&self) -> ExitStatus {
        let of_planners: Vec<ExitStatus> = self
            .entries
            .iter()
            .filter_map(|entry| Some(ExitStatus::of(entry.run.as_ref()?)))
            .collect();
        if of_planners.contains(&ExitStatus::InternalFault) {
            ExitStatus::InternalFault
        } else {
            of_planners.into_iter().min().unwrap_or(ExitStatus::NoPlan)
        }
    }
}

fn draw(
    file: &Path,
    args: &CompareArgs,
    asked: &[Result<Compared, Refused>],
) -> Result<(), FigureError> {
    let drawn = asked.iter().flatten();
    let drawn: Vec<(&Scenario, &[Entry])> =
        drawn.map(|c| (&c.scenario, c.entries.as_slice())).collect();
    if drawn.is_empty() {
        return Ok(());
    }
    let options = args.written.drawn.options(&args.written.times, false);
    comparison_figure(&drawn, &options)?.write(file)
}

/// Builds the report of all scenarios, including unreadable ones.
fn report(
    asked: &[Result<Compared, Refused>],
    documents: &[ScenarioComparisonDocument],
    products: &Products,
) -> Result<(), Failure> {
    let mut report = HtmlReport::new();
    for (compared, document) in asked.iter().zip(documents) {
        match compared {
            Ok(c) => {
                let subject = products.subject(&c.stem, shown(&c.file));
                report.add_comparison(&subject, document, &c.scenario, &c.entries);
                for fault in &c.faults {
                    report_failure(&mut report, fault);
                }
            }
            Err(refused) => report_failure(&mut report, refused),
        }
    }
    let lead = "Every planner that applies and two baselines on the same targets.";
    products.write_report(&report, "Searoom: a comparison", lead)
}
