//! `searoom compare`: every applicable planner and two baselines.

use std::path::Path;

use anyhow::Context;
use rayon::prelude::*;
use searoom::document::{
    ComparisonDocument, INTERNAL_FAULT, ScenarioComparisonDocument, UNREADABLE,
};
use searoom::report::figure::comparison_figure;
use searoom::report::page::HtmlReport;
use searoom::report::{
    COMPARISON_COLUMNS, comparison_csv, comparison_markdown, comparison_table, write_atomically,
};
use searoom::scenario::Scenario;
use searoom::scenario::import::Assumed;
use searoom::study::compare::{Candidate, Entry, Inapplicable, Method, candidates, methods};

use super::args::CompareArgs;
use super::input::files::{self, Found};
use super::input::scenes::{self, Made, Scene};
use super::output::Output;
use super::output::products::{Failure, Products, ScenarioCompared, Wanted, prepare_figure};
use super::output::status::ExitStatus;
use super::runner::guarded;

/// Scenario with its candidates, or the error.
struct Asked {
    file: String,
    stem: String,
    scenario: Result<Scenario, String>,
    candidates: Vec<Candidate>,
    inapplicable: Vec<Inapplicable>,
}

/// Scenario with its entries and internal faults.
struct Compared {
    asked: Asked,
    entries: Vec<Entry>,
    faults: Vec<String>,
}

/// Compares all scenarios. Candidates run in parallel and are shown in a fixed order.
pub fn compare(args: &CompareArgs, output: &Output) -> anyhow::Result<ExitStatus> {
    // before any computation
    args.written
        .figure
        .as_deref()
        .map_or(Ok(()), prepare_figure)?;
    let assumed = args.assumed.assumed();
    let all = scenes::open(
        files::find(&args.paths, &files::SCENARIOS, output),
        &assumed,
        output,
    );
    let found: Vec<Found> = all.iter().flatten().map(|s| s.found.clone()).collect();
    // one figure of all scenarios
    let wanted = Wanted {
        figures: None,
        ..args.written.wanted()
    };
    let products = Products::prepare(&found, wanted)?;
    let asked: Vec<Asked> = all
        .into_iter()
        .map(|scene| match scene {
            Ok(scene) => ask(&scene, args, &assumed),
            Err(unread) => Asked::refused(unread.file.display().to_string(), unread.error),
        })
        .collect();
    let compared = run(asked, output);
    let mut status = ExitStatus::Good;
    for c in &compared {
        for error in c.asked.scenario.as_ref().err().into_iter().chain(&c.faults) {
            output.error(error);
        }
        status = status.max(c.status());
    }
    let documents: Vec<_> = compared.iter().map(Compared::document).collect();
    if let Err(error) = write(args, &compared, &documents) {
        status = status.max(output.refuse(&format_args!("{error:#}")));
    }
    for (c, document) in compared.iter().zip(&documents) {
        let Ok(scenario) = &c.asked.scenario else {
            continue;
        };
        let side = ScenarioCompared {
            scenario,
            entries: &c.entries,
            table: comparison_markdown(document),
            document: ComparisonDocument {
                comparisons: vec![document.clone()],
            },
        };
        status = status.max(output.written(products.write_comparison(&c.asked.stem, &side)));
    }
    if products.wants_report() {
        status = status.max(output.written(report(&compared, &documents, &products)));
    }
    Ok(status.max(show(args, documents, output)))
}

impl Asked {
    fn refused(file: String, error: String) -> Self {
        Self {
            file,
            stem: String::new(),
            scenario: Err(error),
            candidates: Vec::new(),
            inapplicable: Vec::new(),
        }
    }
}

fn ask(scene: &Scene, args: &CompareArgs, assumed: &Assumed) -> Asked {
    let name = scene.found.file.display().to_string();
    let mut scenario = match guarded(|| scene.scenario(assumed)) {
        Ok(Ok(Made { scenario, .. })) => scenario,
        Ok(Err(error)) => return Asked::refused(name, error.to_string()),
        Err(fault) => return Asked::refused(name.clone(), format!("{name}: {fault}")),
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
    Asked {
        file: name,
        stem: scene.found.stem.clone(),
        candidates: candidates(&found.methods, &risks),
        inapplicable: found.inapplicable,
        scenario: Ok(scenario),
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
fn run(asked: Vec<Asked>, output: &Output) -> Vec<Compared> {
    let jobs: Vec<(usize, &Scenario, Candidate)> = asked
        .iter()
        .enumerate()
        .filter_map(|(index, a)| Some((index, a.scenario.as_ref().ok()?, &a.candidates)))
        .flat_map(|(index, scenario, all)| all.iter().map(move |c| (index, scenario, *c)))
        .collect();
    let bar = output.progress(jobs.len());
    let results: Vec<(usize, Result<Entry, String>)> = jobs
        .into_par_iter()
        .map(|(index, scenario, candidate)| {
            let entry = guarded(|| candidate.run(scenario))
                .map_err(|fault| format!("{}, {}: {fault}", asked[index].file, candidate.method));
            bar.inc(1);
            (index, entry)
        })
        .collect();
    bar.finish_and_clear();
    let mut compared: Vec<Compared> = asked
        .into_iter()
        .map(|asked| Compared {
            asked,
            entries: Vec::new(),
            faults: Vec::new(),
        })
        .collect();
    for (index, result) in results {
        match result {
            Ok(entry) => compared[index].entries.push(entry),
            Err(fault) => compared[index].faults.push(fault),
        }
    }
    compared
}

impl Compared {
    /// Builds this scenario's part of the document.
    fn document(&self) -> ScenarioComparisonDocument {
        let file = self.asked.file.clone();
        match &self.asked.scenario {
            Ok(scenario) => ScenarioComparisonDocument::of(
                file,
                scenario,
                &self.entries,
                &self.asked.inapplicable,
            ),
            Err(error) => ScenarioComparisonDocument::failed(file, error.clone()),
        }
    }

    /// Good if some planner has a clear plan. A plan that fails its verification is an internal
    /// fault.
    fn status(&self) -> ExitStatus {
        if self.asked.scenario.is_err() {
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
        let mut writer = csv::Writer::from_writer(Vec::new());
        writer.write_record(COMPARISON_COLUMNS.split(','))?;
        for document in documents {
            for entry in &document.entries {
                writer.write_record(comparison_csv(document, entry))?;
            }
        }
        let bytes = writer.into_inner().context("the rows cannot be written")?;
        write_atomically(file, &bytes)?;
    }
    if let Some(file) = &args.written.figure {
        let drawn: Vec<(&Scenario, &[Entry])> = compared
            .iter()
            .filter_map(|c| Some((c.asked.scenario.as_ref().ok()?, c.entries.as_slice())))
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
        let file = files::shown(Path::new(&c.asked.file));
        match &c.asked.scenario {
            Ok(scenario) => {
                let subject = products.subject(&c.asked.stem, file);
                report.add_comparison(&subject, document, scenario, &c.entries);
            }
            Err(error) => {
                let error = error.replace(&c.asked.file, &file);
                report.add_failure(&file, UNREADABLE, &error);
            }
        }
        for fault in &c.faults {
            report.add_failure(
                &files::shown(Path::new(&c.asked.file)),
                INTERNAL_FAULT,
                fault,
            );
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
