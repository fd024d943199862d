//! `searoom compare`: every applicable planner and two baselines.

use std::path::PathBuf;

use rayon::prelude::*;
use searoom::document::{
    ComparisonDocument, INTERNAL_FAULT, ScenarioComparisonDocument, UNREADABLE,
};
use searoom::report::figure::comparison_figure;
use searoom::report::page::HtmlReport;
use searoom::report::{COMPARISON_COLUMNS, comparison_csv, comparison_table, write_atomically};
use searoom::scenario::Scenario;
use searoom::study::compare::{Candidate, Entry, Inapplicable, Method, candidates, methods};

use super::args::CompareArgs;
use super::input::files::shown;
use super::input::scenes::{self, Made, Scene};
use super::output::products::{Failure, Products, Wanted, prepare_figure, report_failure};
use super::output::status::ExitStatus;
use super::output::{Output, csv};
use super::runner::guarded;

/// Scenario with its candidates and their results, or the error.
struct Compared {
    file: PathBuf,
    stem: String,
    scenario: Result<Scenario, String>,
    candidates: Vec<Candidate>,
    inapplicable: Vec<Inapplicable>,
    entries: Vec<Entry>,
    /// Internal faults.
    faults: Vec<String>,
}

/// Compares all scenarios. Candidates run in parallel and are shown in a fixed order.
pub fn compare(args: &CompareArgs, output: &Output) -> anyhow::Result<ExitStatus> {
    // before any computation
    args.written
        .figure
        .as_deref()
        .map_or(Ok(()), prepare_figure)?;
    let all = scenes::open(&args.paths, &args.assumed, output);
    // one figure of all scenarios
    let wanted = Wanted {
        figures: None,
        ..args.written.wanted()
    };
    let products = Products::prepare(&scenes::found(&all), wanted)?;
    let asked = all.into_iter().map(|scene| match scene {
        Ok(scene) => ask(&scene, args),
        Err(unread) => Compared::refused(unread.file, unread.error),
    });
    let mut compared: Vec<Compared> = asked.collect();
    run(&mut compared, output);
    let mut status = ExitStatus::Good;
    for c in &compared {
        for error in c.scenario.as_ref().err().into_iter().chain(&c.faults) {
            output.error(error);
        }
        status = status.max(c.status());
    }
    let documents: Vec<_> = compared.iter().map(Compared::document).collect();
    match write(args, &compared, &documents) {
        Ok(()) => {
            let files = args.csv.iter().chain(&args.written.figure);
            files
                .filter(|file| file.exists())
                .for_each(|file| output.wrote(file));
        }
        Err(error) => status = status.max(output.refuse(&format_args!("{error:#}"))),
    }
    let mut written = ExitStatus::Good;
    for (c, document) in compared.iter().zip(&documents) {
        let Ok(scenario) = &c.scenario else {
            continue;
        };
        let result = products.write_comparison(&c.stem, scenario, &c.entries, document);
        written = written.max(output.written(result));
    }
    if products.wants_report() {
        written = written.max(output.written(report(&compared, &documents, &products)));
    }
    if compared.iter().any(|c| c.scenario.is_ok()) {
        products.announce(written, output);
    }
    Ok(status.max(written).max(show(args, documents, output)))
}

fn ask(scene: &Scene, args: &CompareArgs) -> Compared {
    let file = scene.found.file.clone();
    let mut scenario = match guarded(|| scene.scenario()) {
        Ok(Ok(Made { scenario, .. })) => scenario,
        Ok(Err(error)) => return Compared::refused(file, error.to_string()),
        Err(fault) => {
            let error = format!("{}: {fault}", file.display());
            return Compared::refused(file, error);
        }
    };
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
    Compared {
        file,
        stem: scene.found.stem.clone(),
        candidates: candidates(&found.methods, &risks),
        inapplicable: found.inapplicable,
        scenario: Ok(scenario),
        entries: Vec::new(),
        faults: Vec::new(),
    }
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

/// Runs all candidates of all scenarios in parallel.
fn run(compared: &mut [Compared], output: &Output) {
    let jobs: Vec<(usize, &Scenario, Candidate)> = compared
        .iter()
        .enumerate()
        .filter_map(|(index, c)| Some((index, c.scenario.as_ref().ok()?, &c.candidates)))
        .flat_map(|(index, scenario, all)| all.iter().map(move |c| (index, scenario, *c)))
        .collect();
    let bar = output.progress(jobs.len());
    let results: Vec<(usize, Result<Entry, String>)> = jobs
        .into_par_iter()
        .map(|(index, scenario, candidate)| {
            let entry = guarded(|| candidate.run(scenario)).map_err(|fault| {
                let file = compared[index].file.display();
                format!("{file}, {}: {fault}", candidate.method)
            });
            bar.inc(1);
            (index, entry)
        })
        .collect();
    bar.finish_and_clear();
    for (index, result) in results {
        match result {
            Ok(entry) => compared[index].entries.push(entry),
            Err(fault) => compared[index].faults.push(fault),
        }
    }
}

impl Compared {
    fn refused(file: PathBuf, error: String) -> Self {
        Self {
            file,
            stem: String::new(),
            scenario: Err(error),
            candidates: Vec::new(),
            inapplicable: Vec::new(),
            entries: Vec::new(),
            faults: Vec::new(),
        }
    }

    /// Builds this scenario's part of the document.
    fn document(&self) -> ScenarioComparisonDocument {
        let file = self.file.display().to_string();
        match &self.scenario {
            Ok(scenario) => {
                ScenarioComparisonDocument::of(file, scenario, &self.entries, &self.inapplicable)
            }
            Err(error) => ScenarioComparisonDocument::failed(file, error.clone()),
        }
    }

    /// Good if some planner has a clear plan. A plan that fails its verification is an internal
    /// fault.
    fn status(&self) -> ExitStatus {
        if self.scenario.is_err() {
            return ExitStatus::BadInput;
        }
        if !self.faults.is_empty() {
            return ExitStatus::InternalFault;
        }
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

/// Writes the requested files.
fn write(
    args: &CompareArgs,
    compared: &[Compared],
    documents: &[ScenarioComparisonDocument],
) -> anyhow::Result<()> {
    if let Some(file) = &args.csv {
        let mut rows = vec![COMPARISON_COLUMNS.split(',').map(str::to_owned).collect()];
        for document in documents {
            let entries = document.entries.iter();
            rows.extend(entries.map(|entry| comparison_csv(document, entry)));
        }
        write_atomically(file, &csv(rows)?)?;
    }
    if let Some(file) = &args.written.figure {
        let drawn: Vec<(&Scenario, &[Entry])> = compared
            .iter()
            .filter_map(|c| Some((c.scenario.as_ref().ok()?, c.entries.as_slice())))
            .collect();
        if !drawn.is_empty() {
            comparison_figure(&drawn).write(file)?;
        }
    }
    Ok(())
}

/// Builds the report of all scenarios, including unreadable ones.
fn report(
    compared: &[Compared],
    documents: &[ScenarioComparisonDocument],
    products: &Products,
) -> Result<(), Failure> {
    let mut report = HtmlReport::new();
    for (c, document) in compared.iter().zip(documents) {
        match &c.scenario {
            Ok(scenario) => {
                let subject = products.subject(&c.stem, shown(&c.file));
                report.add_comparison(&subject, document, scenario, &c.entries);
            }
            Err(error) => report_failure(&mut report, &c.file, UNREADABLE, error),
        }
        for fault in &c.faults {
            report_failure(&mut report, &c.file, INTERNAL_FAULT, fault);
        }
    }
    let lead = "Every planner that applies and two baselines on the same targets.";
    products.write_report(&report, "Searoom: a comparison", lead)
}

fn show(
    args: &CompareArgs,
    comparisons: Vec<ScenarioComparisonDocument>,
    output: &Output,
) -> ExitStatus {
    if args.written.json {
        return output.document(&ComparisonDocument { comparisons });
    }
    let read = comparisons.iter().filter(|c| c.error.is_none());
    let tables: Vec<String> = read
        .map(|compared| comparison_table(compared, output.colour))
        .collect();
    if tables.is_empty() {
        return ExitStatus::Good;
    }
    output.result(&tables.join("\n\n"))
}
