//! `searoom verify`: independent check of plan documents from their own content.

use std::path::Path;

use anyhow::{anyhow, bail};
use searoom::document::{PLAN_MEBIBYTES, VerificationDocument, VerifiedPlanDocument};
use searoom::report::{
    Display, printable, simulation_verification_text, verification_line, verification_text,
};
use searoom::scenario::import::{A_PLAN, Assumed, Contents};
use searoom::verification::{
    SimulationVerification, Verification, is_simulation, verify as check, verify_simulations,
};

use super::args::VerifyArgs;
use super::input::files;
use super::output::Output;
use super::runner::guarded_within;
use super::status::ExitStatus;

/// Checks every file; an unreadable one does not stop the others. Results of other commands are left
/// out where they lie in a folder.
pub fn verify(args: &VerifyArgs, output: &Output) -> ExitStatus {
    let mut status = ExitStatus::Good;
    let mut documents = Vec::new();
    let files = files::find(&args.plans, &files::PLANS, output);
    let alone = files.len() == 1;
    for found in files {
        let (path, in_folder) = match found {
            Ok(found) => (found.file, found.in_folder),
            Err(refused) => {
                status = status.max(output.refused(&refused));
                let name = refused.file.display().to_string();
                documents.push(VerifiedPlanDocument::unreadable(name, refused.error));
                continue;
            }
        };
        let name = files::name(&path).display().to_string();
        // among several a line is enough for one that is all right
        let display = output.display;
        let checked = move || one(&path, in_folder, alone, display);
        let reached = match guarded_within(args.budget_s, checked) {
            None => {
                let budget = args.budget_s.as_secs_f64();
                let error = format!("{name}: not proven within the budget of {budget} s");
                documents.push(VerifiedPlanDocument::unproven(name, error.clone()));
                output.error(&error);
                ExitStatus::NoPlan
            }
            Some(Ok(Ok(Checked::Other(kind)))) => {
                output.note(&format_args!("{name}: {kind}, left out"));
                continue;
            }
            Some(Ok(Ok(Checked::Documents(all, note)))) => {
                if let Some(note) = note {
                    output.note(&format_args!("{name}: {note}"));
                }
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
    if documents.is_empty() {
        status = status.max(output.refuse(&"nothing to verify: everything was left out"));
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

enum Checked {
    /// The documents of a file, each with its result as text, and what there is to note.
    Documents(Vec<(VerifiedPlanDocument, String)>, Option<&'static str>),
    /// The kind of a file in a folder that has none.
    Other(&'static str),
}

fn one(file: &Path, in_folder: bool, is_alone: bool, display: Display) -> anyhow::Result<Checked> {
    let name = || files::name(file).display().to_string();
    let plan = |plan: &Verification| {
        let document = VerifiedPlanDocument::of(name(), plan);
        let text = match is_alone {
            false if plan.violations.is_empty() && plan.safe() => verification_line(plan),
            _ => verification_text(plan, display),
        };
        (document, text)
    };
    let simulation = |sailed: &SimulationVerification| {
        let document = VerifiedPlanDocument::of_simulation(name(), sailed);
        (document, simulation_verification_text(sailed))
    };
    if file.extension().is_some_and(|ending| ending == "rrd") {
        let recorded = recorded(file)?;
        return match recorded.texts {
            Ok(texts) => {
                let checked = texts
                    .iter()
                    .map(|text| check(text).map(|checked| plan(&checked)));
                let checked = checked.collect::<Result<_, _>>();
                let checked = checked.map_err(|error| anyhow!("{error}"))?;
                Ok(Checked::Documents(checked, recorded.note))
            }
            Err(other) if in_folder => Ok(Checked::Other(other)),
            Err(other) => bail!("{other}; `searoom inspect --json` prints its own"),
        };
    }
    // the message already includes its source
    let text = files::text(file, PLAN_MEBIBYTES, "a plan document");
    let text = text.map_err(|error| anyhow!("{error}"))?;
    let checked = if is_simulation(&text) {
        verify_simulations(&text).map(|all| all.iter().map(simulation).collect())
    } else if let Some(other) = other(&text).filter(|_| in_folder) {
        return Ok(Checked::Other(other));
    } else {
        check(&text).map(|checked| vec![plan(&checked)])
    };
    // the message already includes its field
    let checked = checked.map_err(|error| anyhow!("{error}"))?;
    Ok(Checked::Documents(checked, None))
}

/// The kind of a known text that is no plan document.
fn other(text: &str) -> Option<&'static str> {
    match Contents::parse(text, &Assumed::default()) {
        Ok(Contents::Other(kind)) if kind != A_PLAN => Some(kind),
        Ok(Contents::Situations(_)) => Some("a scenario"),
        _ => None,
    }
}

/// Content of a recording that this command reads.
pub struct RecordedPlans {
    /// The plan documents, or the kind of a recording without.
    pub texts: Result<Vec<String>, &'static str>,
    /// Notes.
    pub note: Option<&'static str>,
}

#[cfg(feature = "recording")]
fn recorded(file: &Path) -> anyhow::Result<RecordedPlans> {
    super::inspect::plan_documents(file)
}

#[cfg(not(feature = "recording"))]
fn recorded(_: &Path) -> anyhow::Result<RecordedPlans> {
    Err(anyhow!(
        "a recording; this program was built without recordings"
    ))
}
