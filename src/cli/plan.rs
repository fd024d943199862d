//! `searoom plan`: one scenario.

use searoom::report::document::PlanDocument;
use searoom::report::plan_text;

use super::args::PlanArgs;
use super::files;
use super::output::Output;
use super::products::Products;
use super::runner::{Attempt, attempt};
use super::status::Status;

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
    let found: Vec<_> = files::find(std::slice::from_ref(file), output)
        .into_iter()
        .flatten()
        .collect();
    let products = match Products::prepare(&found, args.shared.wanted()) {
        Ok(products) => products,
        Err(error) => {
            output.error(&format_args!("{error:#}"));
            return Status::BadInput;
        }
    };
    let mut status = Status::Good;
    for found in found {
        let reached = match attempt(&found.file, &args.shared) {
            Attempt::Run(run) => {
                let shown = if args.shared.json {
                    output.document(&PlanDocument::of(&run))
                } else {
                    output.result(&plan_text(&run))
                };
                let written = match products.write(&found.stem, &run) {
                    Ok(()) => Status::Good,
                    Err((status, error)) => {
                        output.error(&error);
                        status
                    }
                };
                shown.max(written).max(Status::of(&run))
            }
            Attempt::Unreadable(error) => {
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
