//! `searoom verify`: independent check of plan documents from their own content.

use std::path::Path;

use anyhow::anyhow;
use searoom::document::{VerificationDocument, VerifiedPlanDocument};
use searoom::input::read_text;
use searoom::report::verification_text;
use searoom::verification::{Verification, verify as check};

use super::args::VerifyArgs;
use super::output::Output;
use super::output::status::ExitStatus;
use super::runner::{PLAN_MEBIBYTES, guarded_within};

/// Checks every file; an unreadable one does not stop the others.
pub fn verify(args: &VerifyArgs, output: &Output) -> ExitStatus {
    let mut status = ExitStatus::Good;
    let mut documents = Vec::new();
    for file in &args.plans {
        let name = file.display().to_string();
        let path = file.clone();
        let reached = match guarded_within(args.budget_s, move || one(&path)) {
            None => {
                let budget = args.budget_s.as_secs_f64();
                let error = format!("{name}: not proven within the budget of {budget} s");
                documents.push(VerifiedPlanDocument::unproven(name, error.clone()));
                output.error(&error);
                ExitStatus::NoPlan
            }
            Some(Ok(Ok(verification))) => {
                let shown = if args.json {
                    documents.push(VerifiedPlanDocument::of(name, &verification));
                    ExitStatus::Good
                } else {
                    output.result(&verification_text(&verification, output.colour))
                };
                shown.max(if verification.verified() {
                    ExitStatus::Good
                } else {
                    ExitStatus::NoPlan
                })
            }
            Some(Ok(Err(error))) => {
                let error = format!("{error:#}");
                // a reader's message already includes the file
                let error = match error.strip_prefix(&format!("{name}: ")) {
                    Some(_) => error,
                    None => format!("{name}: {error}"),
                };
                documents.push(VerifiedPlanDocument::unreadable(name, error.clone()));
                output.refuse(&error)
            }
            Some(Err(fault)) => output.fault(&format_args!("{name}: {fault}")),
        };
        status = status.max(reached);
    }
    if args.json {
        status = status.max(output.document(&VerificationDocument::of(documents)));
    }
    status
}

fn one(file: &Path) -> anyhow::Result<Verification> {
    let text = if file.extension().is_some_and(|ending| ending == "rrd") {
        recorded(file)?
    } else {
        read_text(file, PLAN_MEBIBYTES, "a plan document")?
    };
    // the message already includes its field
    check(&text).map_err(|error| anyhow!("{error}"))
}

#[cfg(feature = "recording")]
fn recorded(file: &Path) -> anyhow::Result<String> {
    super::inspect::plan_document(file)
}

#[cfg(not(feature = "recording"))]
fn recorded(_: &Path) -> anyhow::Result<String> {
    Err(anyhow!(
        "a recording; this program was built without recordings"
    ))
}
