//! `searoom simulate`: scenarios sailed in the closed loop.

use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use searoom::document::{SimulatedDocument, SimulationDocument, SimulationsDocument, SuiteOutcome};
use searoom::report::page::HtmlReport;
use searoom::report::{simulation_text, simulations_line, write_atomically};
use searoom::scenario::import::Imported;
use searoom::scenario::{Scenario, ScenarioError};
use searoom::simulation::Simulation;
use searoom::study::lint::met_at_rest;

use super::args::SimulateArgs;
use super::found::{Refused, shown};
use super::input::scenes::{self, Scene};
use super::output::products::{Products, Wanted, report_failure};
use super::output::{Output, beyond_verify, json};
use super::runner::guarded_on;
use super::status::ExitStatus;

/// Sails every file, one after another; a broken one does not stop the others.
pub fn simulate(args: &SimulateArgs, output: &Output) -> anyhow::Result<ExitStatus> {
    let interrupted = catch_interrupt(output);
    let scenes = scenes::open(&args.paths, &args.assumed, output);
    let wanted = Wanted {
        plans: args.plans.as_deref(),
        ..args.written.wanted()?
    };
    let products = Products::prepare(&scenes::found(&scenes), wanted)?;
    let mut status = ExitStatus::Good;
    let mut documents = Vec::new();
    let mut failed = 0;
    let mut report = HtmlReport::new();
    let several = scenes.len() > 1;
    let mut all_written = ExitStatus::Good;
    for scene in scenes {
        let sailed = scene.and_then(|scene| {
            let file = &scene.found.file;
            guarded_on(file, || {
                let made = scene.scenario()?;
                sail(
                    &scene,
                    made,
                    args,
                    &interrupted,
                    &products,
                    &mut report,
                    output,
                )
                .map_err(|error| {
                    Refused::new(file, SuiteOutcome::NotApplicable, format_args!("{error:#}"))
                })
            })
        });
        status = status.max(match sailed {
            Ok((document, written)) => {
                let shown = if args.written.json {
                    ExitStatus::Good
                } else {
                    output.result(&format!("{}\n", simulation_text(&document, output.display)))
                };
                let reached = match document.is_success() {
                    true => ExitStatus::Good,
                    false => ExitStatus::NoPlan,
                };
                documents.push(document);
                all_written = all_written.max(written);
                shown.max(written).max(reached)
            }
            Err(refused) => {
                failed += 1;
                report_failure(&mut report, &refused);
                output.refused(&refused)
            }
        });
        if interrupted.load(Ordering::Relaxed) {
            output.note(&"interrupted; no more scenarios are sailed");
            status = ExitStatus::Interrupted;
            break;
        }
    }
    let lead = "Sailed by Searoom in the closed loop.";
    let written = output.written(products.write_report(&report, "Searoom: simulations", lead));
    status = status.max(written);
    all_written = all_written.max(written);
    let sailed = !documents.is_empty();
    if args.written.json {
        let document = match documents.pop() {
            Some(document) if !several => SimulatedDocument::One(Box::new(document)),
            last => {
                documents.extend(last);
                SimulatedDocument::Several(SimulationsDocument {
                    simulations: documents,
                })
            }
        };
        status = status.max(output.verifiable(&document));
    } else if several && sailed {
        status = status.max(output.result(&simulations_line(&documents, failed)));
    }
    if sailed {
        products.announce(all_written, output);
    }
    Ok(status)
}

/// A flag that Ctrl-C sets. A second one ends the program at once.
pub fn catch_interrupt(output: &Output) -> Arc<AtomicBool> {
    let interrupted = Arc::new(AtomicBool::new(false));
    let flag = Arc::clone(&interrupted);
    let handler = move || {
        if flag.swap(true, Ordering::Relaxed) {
            std::process::exit(ExitStatus::Interrupted.code().into());
        }
    };
    if let Err(error) = ctrlc::set_handler(handler) {
        output.note(&format_args!("Ctrl-C ends the program at once: {error}"));
    }
    interrupted
}

fn sail(
    scene: &Scene,
    made: Imported,
    args: &SimulateArgs,
    interrupted: &AtomicBool,
    products: &Products,
    report: &mut HtmlReport,
    output: &Output,
) -> anyhow::Result<(SimulationDocument, ExitStatus)> {
    let file = &scene.found.file;
    let mut scenario = made.scenario;
    let refused = |faults| ScenarioError::faults(file, scene.located(faults));
    args.asked.apply(&mut scenario).map_err(refused)?;
    let notes = made.notes.into_iter().chain(sailed_in_parts(&scenario));
    let notes = notes.chain(met_at_rest(&scenario));
    output.notes(None, &[(String::new(), notes.collect())]);
    let settings = &mut scenario.simulation;
    settings.seed = args.seed.unwrap_or(settings.seed);
    settings.duration = args.duration_s.or(settings.duration);
    let begin = match args.plans.is_some() || args.written.rrd.is_some() {
        true => Simulation::keeping_plans,
        false => Simulation::new,
    };
    let mut simulation = begin(scenario.clone(), args.measured_delay).map_err(refused)?;
    while !simulation.finished() {
        simulation.step();
        if interrupted.load(Ordering::Relaxed) {
            break;
        }
    }
    if let Some(folder) = &args.plans {
        write_plans(folder, &scene.found.stem, &simulation, output)?;
    }
    let document = simulation.record();
    let written = products.write_simulation(&scene.found.stem, &scenario, &simulation, &document);
    if products.wants_report() {
        let subject = products.subject(&scene.found.stem, shown(file));
        report.add_simulation(&subject, &scenario, &document);
    }
    Ok((document, output.written(written)))
}

/// A note where plans lead to intermediate ends.
fn sailed_in_parts(scenario: &Scenario) -> Option<String> {
    let (horizon, duration) = (scenario.horizon, scenario.desired.duration());
    Simulation::sails_in_parts(scenario).then(|| {
        format!(
            "horizon_s: {horizon} s are too few for the {duration:.0} s of the mission at its \
             speeds, with time to give way, so it is sailed in parts"
        )
    })
}

fn write_plans(
    folder: &Path,
    stem: &str,
    simulation: &Simulation,
    output: &Output,
) -> anyhow::Result<()> {
    let file = |index: usize| folder.join(format!("{stem}-{index:03}.json"));
    for (index, plan) in simulation.plans().iter().enumerate() {
        let text = json(plan)?;
        write_atomically(&file(index), text.as_bytes())?;
        if let Some(note) = beyond_verify(text.len()) {
            output.note(&format_args!("{}: {note}", shown(&file(index))));
        }
    }
    let next = file(simulation.plans().len());
    if next.exists() {
        output.note(&format_args!(
            "{}: this plan, and any after it, is of an earlier run",
            shown(&next)
        ));
    }
    Ok(())
}
