//! `searoom verify`: independent check of plan documents from their own content.

use std::path::Path;

use anyhow::anyhow;
use searoom::document::{PLAN_MEBIBYTES, VerificationDocument, VerifiedPlanDocument};
use searoom::report::{Display, printable, simulation_verification_text, verification_text};
use searoom::verification::{
    SimulationVerification, Verification, is_simulation, verify as check, verify_simulations,
};

use super::args::VerifyArgs;
use super::input::files;
use super::output::Output;
use super::output::status::ExitStatus;
use super::runner::guarded_within;

/// Checks every file; an unreadable one does not stop the others.
pub fn verify(args: &VerifyArgs, output: &Output) -> ExitStatus {
    let mut status = ExitStatus::Good;
    let mut documents = Vec::new();
    let files = files::find(&args.plans, &files::PLANS, output);
    let alone = files.len() == 1;
    for found in files {
        let path = match found {
            Ok(found) => found.file,
            Err(refused) => {
                status = status.max(output.refused(&refused));
                let name = refused.file.display().to_string();
                documents.push(VerifiedPlanDocument::unreadable(name, refused.error));
                continue;
            }
        };
        let name = files::name(&path).display().to_string();
        let display = output.display;
        let reached = match guarded_within(args.budget_s, move || one(&path, display)) {
            None => {
                let budget = args.budget_s.as_secs_f64();
                let error = format!("{name}: not proven within the budget of {budget} s");
                documents.push(VerifiedPlanDocument::unproven(name, error.clone()));
                output.error(&error);
                ExitStatus::NoPlan
            }
            Some(Ok(Ok(all))) => {
                let mut reached = ExitStatus::Good;
                for (document, text) in all {
                    if !document.verified {
                        reached = reached.max(ExitStatus::NoPlan);
                    }
                    documents.push(document);
                    if args.json {
                        continue;
                    }
                    reached = reached.max(if alone {
                        output.result(&text)
                    } else {
                        output.result(&format!("{}: {text}", printable(&name)))
                    });
                }
                reached
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
    let checked = VerificationDocument::of(documents);
    let shown = if args.json {
        output.document(&checked)
    } else if checked.plans.len() > 1 {
        output.result(&format!("\n{checked}"))
    } else {
        ExitStatus::Good
    };
    status.max(shown)
}

/// Checks the documents of a file, each with its result as text.
fn one(file: &Path, display: Display) -> anyhow::Result<Vec<(VerifiedPlanDocument, String)>> {
    let text = if file.extension().is_some_and(|ending| ending == "rrd") {
        recorded(file)?
    } else {
        // the message already includes its source
        files::text(file, PLAN_MEBIBYTES, "a plan document").map_err(|error| anyhow!("{error}"))?
    };
    let name = || files::name(file).display().to_string();
    let plan = |plan: &Verification| {
        let document = VerifiedPlanDocument::of(name(), plan);
        (document, verification_text(plan, display))
    };
    let simulation = |sailed: &SimulationVerification| {
        let document = VerifiedPlanDocument::of_simulation(name(), sailed);
        (document, simulation_verification_text(sailed))
    };
    let checked = if is_simulation(&text) {
        verify_simulations(&text).map(|all| all.iter().map(simulation).collect())
    } else {
        check(&text).map(|checked| vec![plan(&checked)])
    };
    // the message already includes its field
    checked.map_err(|error| anyhow!("{error}"))
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
