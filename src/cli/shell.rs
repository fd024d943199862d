//! `searoom completions`, generated from the argument definitions.

use clap::CommandFactory;
use clap_complete::generate;

use super::args::{Arguments, CompletionsArgs};
use super::output::Output;
use super::output::status::ExitStatus;

pub fn completions(args: &CompletionsArgs, output: &Output) -> ExitStatus {
    let mut command = Arguments::command();
    let name = command.get_name().to_owned();
    let mut text = Vec::new();
    generate(args.shell, &mut command, name, &mut text);
    output.result(String::from_utf8_lossy(&text).trim_end())
}
