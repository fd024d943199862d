//! Command line: one file per command. Only `output` prints.

mod args;
mod assess;
mod campaign;
mod check;
mod compare;
mod found;
mod import;
mod input;
#[cfg(feature = "recording")]
mod inspect;
mod lint;
mod output;
mod plan;
mod runner;
mod shell;
mod simulate;
mod status;
mod suite;
mod verify;
mod watch;

use std::process::ExitCode;

use clap::{CommandFactory, FromArgMatches};

use args::{Arguments, Command};
use output::Output;

pub fn main() -> ExitCode {
    runner::keep_panics_quiet();
    let parser = match output::help_width() {
        Some(width) => Arguments::command().term_width(width),
        None => Arguments::command(),
    };
    let parsed = parser.try_get_matches();
    let arguments = match parsed.and_then(|found| Arguments::from_arg_matches(&found)) {
        Ok(arguments) => arguments,
        Err(error) => return output::usage(&error),
    };
    let output = Output::new(arguments.quiet);
    let run = || match &arguments.command {
        Command::Init(args) => Ok(import::init(args, &output)),
        Command::Check(args) => Ok(check::check(args, &output)),
        Command::Assess(args) => assess::assess(args, &output),
        Command::Plan(args) => plan::plan(args, &output),
        Command::Suite(args) => suite::suite(args, &output),
        Command::Simulate(args) => simulate::simulate(args, &output),
        Command::Campaign(args) => campaign::campaign(&args.command, &output),
        Command::Import(args) => import::import(args, &output),
        Command::Watch(args) => watch::watch(args, &output),
        Command::Compare(args) => compare::compare(args, &output),
        #[cfg(feature = "recording")]
        Command::Inspect(args) => inspect::inspect(args, &output),
        #[cfg(not(feature = "recording"))]
        Command::Inspect(_) => anyhow::bail!(
            "inspect: this program was built without recordings; \
             build it with its default features, `cargo build`"
        ),
        Command::Verify(args) => Ok(verify::verify(args, &output)),
        Command::Completions(args) => Ok(shell::completions(args, &output)),
        Command::Schema(args) => Ok(shell::schema(args, &output)),
    };
    let status = match runner::guarded(run) {
        Ok(Ok(status)) => status,
        Ok(Err(error)) => output.refuse(&error_chain(&error)),
        Err(fault) => output.fault(&fault),
    };
    status.into()
}

/// An error and its causes. Some texts hold that of their cause, which is not repeated.
fn error_chain(error: &anyhow::Error) -> String {
    error.chain().fold(String::new(), |chain, cause| {
        let cause = cause.to_string();
        match chain.as_str() {
            "" => cause,
            _ if chain.contains(&cause) => chain,
            _ => format!("{chain}: {cause}"),
        }
    })
}
