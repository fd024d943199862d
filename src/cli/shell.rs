//! `searoom completions` and `searoom schema`: for shells and editors.

use clap::CommandFactory;
use clap_complete::generate;

use searoom::document::SCHEMAS;
use searoom::scenario::{scenario_schema, thresholds_schema};

use super::args::{Arguments, CompletionsArgs, SchemaArgs};
use super::output::Output;
use super::status::ExitStatus;

/// The kinds of schema that are of files, not of documents.
const SCENARIO: &str = "scenario";
const THRESHOLDS: &str = "thresholds";

/// Prints the completion script, generated from the argument definitions.
pub fn completions(args: &CompletionsArgs, output: &Output) -> ExitStatus {
    let mut command = Arguments::command();
    let name = command.get_name().to_owned();
    let mut text = Vec::new();
    generate(args.shell, &mut command, name, &mut text);
    output.print(String::from_utf8_lossy(&text).trim_end())
}

/// The files and documents that have a schema.
pub fn schema_kinds() -> impl Iterator<Item = &'static str> {
    let files = [SCENARIO, THRESHOLDS].into_iter();
    files.chain(SCHEMAS.iter().map(|(kind, _)| *kind))
}

/// Prints a JSON schema.
pub fn schema(args: &SchemaArgs, output: &Output) -> ExitStatus {
    match SCHEMAS.iter().find(|(kind, _)| *kind == args.kind) {
        Some((_, schema)) => output.document(&schema()),
        None if args.kind == THRESHOLDS => output.document(&thresholds_schema()),
        None => output.document(&scenario_schema()),
    }
}
