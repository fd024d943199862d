//! `searoom plan`: plans one scenario.

use searoom::document::PlanDocument;
use searoom::pipeline::{NoReturn, Run};
use searoom::report::page::HtmlReport;
use searoom::report::{no_return_line, no_return_reason, plan_document_text};

use super::args::PlanArgs;
use super::input::files::{Found, shown};
use super::input::{files, scenes};
use super::output::Output;
use super::output::products::{Failure, Products};
use super::output::status::ExitStatus;
use super::runner::{Attempt, attempt};

/// Plans one file and prints the verdict.
pub fn plan(args: &PlanArgs, output: &Output) -> ExitStatus {
    let file = &args.scenario;
    if file.is_dir() {
        output.error(&format_args!(
            "{}: a folder; `searoom suite` runs the scenarios in it",
            file.display()
        ));
        return ExitStatus::BadInput;
    }
    let assumed = args.assumed.assumed();
    let files = files::find(std::slice::from_ref(file), &files::ANY_FORMAT, output);
    let mut scenes = Vec::new();
    for scene in scenes::open(files, &assumed, output) {
        match scene {
            Ok(scene) => scenes.push(scene),
            Err(unread) => {
                output.error(&unread.error);
                return ExitStatus::BadInput;
            }
        }
    }
    if scenes.len() > 1 {
        let (file, count) = (file.display(), scenes.len());
        output.error(&format_args!(
            "{file}: {count} situations; `searoom suite` runs them"
        ));
        return ExitStatus::BadInput;
    }
    let found: Vec<_> = scenes.iter().map(|scene| scene.found.clone()).collect();
    let products = match Products::prepare(&found, args.shared.written.wanted()) {
        Ok(products) => products,
        Err(error) => {
            output.error(&format_args!("{error:#}"));
            return ExitStatus::BadInput;
        }
    };
    let mut status = ExitStatus::Good;
    for scene in scenes {
        let reached = match attempt(&scene, &args.shared, &assumed) {
            Attempt::Run(run, notes) => {
                for note in notes {
                    output.note(&note);
                }
                let no_return = args.no_return.then(|| run.no_return()).flatten();
                if args.no_return && no_return.is_none() {
                    output.note(&no_return_reason(&run));
                }
                let document = PlanDocument {
                    time_of_no_return_s: no_return.map(NoReturn::time),
                    ..PlanDocument::of(&run)
                };
                let shown = if args.shared.written.json {
                    output.document(&document)
                } else {
                    let line = no_return.map(|found| format!("\n{}", no_return_line(found)));
                    let text = plan_document_text(&document);
                    output.result(&format!("{text}{}", line.unwrap_or_default()))
                };
                let written = match write(&products, &scene.found, &run, &document) {
                    Ok(()) => ExitStatus::Good,
                    Err((status, error)) => {
                        output.error(&error);
                        status
                    }
                };
                shown.max(written).max(args.shared.status(&run, &document))
            }
            Attempt::Unreadable(error) | Attempt::NotApplicable(_, error) => {
                output.error(&error);
                ExitStatus::BadInput
            }
            Attempt::Fault(fault) => {
                output.error(&fault);
                ExitStatus::InternalFault
            }
        };
        status = status.max(reached);
    }
    status
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
