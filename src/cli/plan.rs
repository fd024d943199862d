//! `searoom plan`: one scenario.

use searoom::pipeline::{NoReturn, Run};
use searoom::report::page::Report;
use searoom::report::{no_return_line, no_return_reason, plan_text};

use super::args::PlanArgs;
use super::files::{Found, shown};
use super::output::Output;
use super::products::{Products, document};
use super::runner::{Attempt, attempt};
use super::status::Status;
use super::{files, scenes};

/// Plans one file and prints the verdict.
pub fn plan(args: &PlanArgs, output: &Output) -> Status {
    let file = &args.scenario;
    if file.is_dir() {
        output.error(&format_args!(
            "{}: a folder; `searoom suite` runs the scenarios in it",
            file.display()
        ));
        return Status::BadInput;
    }
    let assumed = args.assumed.assumed();
    let files = files::find(std::slice::from_ref(file), &files::ANY_FORMAT, output);
    let mut scenes = Vec::new();
    for scene in scenes::open(files, &assumed, output) {
        match scene {
            Ok(scene) => scenes.push(scene),
            Err(unread) => {
                output.error(&unread.error);
                return Status::BadInput;
            }
        }
    }
    if scenes.len() > 1 {
        let (file, count) = (file.display(), scenes.len());
        output.error(&format_args!(
            "{file}: {count} situations; `searoom suite` runs them"
        ));
        return Status::BadInput;
    }
    let found: Vec<_> = scenes.iter().map(|scene| scene.found.clone()).collect();
    let products = match Products::prepare(&found, args.shared.written.wanted()) {
        Ok(products) => products,
        Err(error) => {
            output.error(&format_args!("{error:#}"));
            return Status::BadInput;
        }
    };
    let mut status = Status::Good;
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
                let shown = if args.shared.written.json {
                    output.document(&document(&run, no_return))
                } else {
                    let said = no_return.map(|found| format!("\n{}", no_return_line(found)));
                    output.result(&format!("{}{}", plan_text(&run), said.unwrap_or_default()))
                };
                let written = match write(&products, &scene.found, &run, no_return) {
                    Ok(()) => Status::Good,
                    Err((status, error)) => {
                        output.error(&error);
                        status
                    }
                };
                shown.max(written).max(Status::of(&run))
            }
            Attempt::Unreadable(error) | Attempt::NotApplicable(_, error) => {
                output.error(&error);
                Status::BadInput
            }
            Attempt::Fault(fault) => {
                output.error(&fault);
                Status::InternalFault
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
    no_return: Option<NoReturn>,
) -> Result<(), (Status, String)> {
    products.write(&found.stem, run, no_return)?;
    let mut report = Report::new();
    if products.wants_report() {
        let subject = products.subject(&found.stem, shown(&found.file));
        report.add_run(&subject, run);
    }
    products.write_report(&report, &run.scenario.title, "Planned by Searoom.")
}
