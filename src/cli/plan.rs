//! `searoom plan`: plans one scenario.

use std::path::Path;

use anyhow::{Context, anyhow};
use searoom::document::PlanDocument;
use searoom::pipeline::{NoReturn, Run};
use searoom::report::page::HtmlReport;
use searoom::report::{
    NO_BOUND, RouteError, RouteFormat, bound_line, legs_text, no_return_line, no_return_reason,
    plan_document_text, write_atomically,
};
use searoom::scenario::Scenario;
use searoom::study::bound::lower_bound;
use searoom::study::lint::{findings, met_at_rest};

use super::args::PlanArgs;
use super::found::{Found, shown};
use super::input::scenes;
use super::output::Output;
use super::output::products::{Failure, Products, make_parent};
use super::runner::{Previous, attempt};
use super::status::ExitStatus;

/// The note on an RTZ file without times.
const NO_DATE: &str =
    "the route has speeds but no times of arrival: 'start_utc' in the scenario gives them";

pub fn plan(args: &PlanArgs, output: &Output) -> anyhow::Result<ExitStatus> {
    let scene = scenes::open_one(&args.scenario, &args.assumed, output);
    let scene = scene.map_err(anyhow::Error::msg)?;
    let found = std::slice::from_ref(&scene.found);
    let mut wanted = args.shared.written.wanted()?;
    let route = args.route.as_deref().map(Route::at).transpose()?;
    wanted
        .files
        .extend(route.as_ref().map(|route| ("--route", route.file)));
    wanted.read.extend(args.previous.as_deref());
    let products = Products::prepare(found, wanted)?;
    let previous = args.previous.as_ref();
    let previous = previous.map(|file| Previous::read(file, args.ignore_previous));
    let previous = previous.transpose().map_err(anyhow::Error::msg)?;
    Ok(match attempt(&scene, &args.shared, previous.as_ref()) {
        Ok((run, mut notes)) => {
            notes.extend(findings(&run.scenario, &scene.declared()));
            notes.extend(seen_late(&run.scenario));
            // the text has them below the verdict
            let cautions = &run.scenario.remarks.cautions;
            notes.retain(|note| args.shared.written.json || !cautions.contains(note));
            // the verdict says it for the arrival of the plan, where there is one
            if run.planned.outcome.plan().is_some() {
                let of_mission = met_at_rest(&run.scenario);
                notes.retain(|note| !of_mission.contains(note));
            }
            output.notes(None, &[(String::new(), notes)]);
            let no_return = args.no_return.then(|| run.no_return()).flatten();
            if args.no_return && no_return.is_none() {
                output.note(&no_return_reason(&run));
            }
            let bound = args.bound.then(|| lower_bound(&run)).flatten();
            if args.bound && bound.is_none() {
                output.note(&NO_BOUND);
            }
            let document = PlanDocument {
                lower_bound: bound,
                time_of_no_return_s: no_return.map(NoReturn::time),
                ..PlanDocument::of(&run)
            };
            let text = || {
                let line = no_return.map(|found| format!("\n{}", no_return_line(found)));
                let text = plan_document_text(&document, output.display);
                let legs = legs_text(&document, output.display);
                let bound = bound_line(&document).map(|line| format!("\n{line}"));
                format!(
                    "{text}{}{}\n{legs}",
                    bound.unwrap_or_default(),
                    line.unwrap_or_default()
                )
            };
            let shown = match args.shared.written.json {
                true => output.verifiable(&document),
                false => output.result(&text()),
            };
            let written = output.written(write(&products, &scene.found, &run, &document));
            let undated = run.scenario.start.is_none()
                && (route.as_ref()).is_some_and(|route| route.format == RouteFormat::Rtz);
            let routed = route.map_or(Ok(()), |route| route.write(&run, &document));
            let routed = match routed {
                Ok(()) => ExitStatus::Good,
                Err(error) => {
                    output.error(&format_args!("{error:#}"));
                    match error.downcast_ref() {
                        Some(RouteError::NoPlan | RouteError::NotSafe) => ExitStatus::NoPlan,
                        _ => ExitStatus::BadInput,
                    }
                }
            };
            products.announce(written, output);
            if let (ExitStatus::Good, Some(file)) = (routed, &args.route) {
                output.wrote(file);
                if undated {
                    output.note(&NO_DATE);
                }
            }
            shown
                .max(written)
                .max(routed)
                .max(args.shared.status(&run, &document))
        }
        Err(refused) => output.refused(&refused),
    })
}

/// A note on the targets that `simulate` hides until later.
fn seen_late(scenario: &Scenario) -> Option<String> {
    let targets = scenario.targets.iter().zip(&scenario.simulation.seen_from);
    let late = targets.filter(|(_, from)| **from > 0.0);
    let late: Vec<String> = late
        .map(|(target, from)| format!("'{}' from {from} s on", target.name))
        .collect();
    (!late.is_empty()).then(|| {
        format!(
            "seen_from_s: the plan knows of every target; in `simulate` own ship sees {}",
            late.join(", ")
        )
    })
}

struct Route<'a> {
    file: &'a Path,
    format: RouteFormat,
}

impl<'a> Route<'a> {
    fn at(file: &'a Path) -> anyhow::Result<Self> {
        let format = RouteFormat::of(file).with_context(|| {
            let (found, allowed) = (file.display(), RouteFormat::ENDINGS);
            format!("--route: found {found}; allowed: a file that ends in {allowed}")
        })?;
        make_parent(file)?;
        Ok(Self { file, format })
    }

    fn write(&self, run: &Run, plan: &PlanDocument) -> anyhow::Result<()> {
        let scenario = &run.scenario;
        let earth = scenario.earth.as_ref();
        let route = self.format.write(plan, earth, scenario.present());
        let route = route.with_context(|| format!("--route {}", self.file.display()))?;
        // the message already includes its cause
        write_atomically(self.file, route.as_bytes()).map_err(|error| anyhow!("{error}"))
    }
}

fn write(
    products: &Products,
    found: &Found,
    run: &Run,
    plan: &PlanDocument,
) -> Result<(), Failure> {
    products.write(&found.stem, run, plan)?;
    let mut report = HtmlReport::new();
    if products.wants_report() {
        let subject = products.subject(&found.stem, shown(&found.file));
        report.add_run(&subject, plan, run);
    }
    products.write_report(&report, &plan.scenario, "Planned by Searoom.")
}
