//! `searoom completions` and `searoom man`, generated from the argument definitions.

use clap::CommandFactory;
use clap_complete::generate;
use clap_mangen::Man;

use super::args::{Arguments, CompletionsArgs};
use super::output::Output;
use super::output::status::ExitStatus;

/// Prints the completions of a shell.
pub fn completions(args: &CompletionsArgs, output: &Output) -> ExitStatus {
    let mut command = Arguments::command();
    let name = command.get_name().to_owned();
    let mut text = Vec::new();
    generate(args.shell, &mut command, name, &mut text);
    print(text, output)
}

/// Prints the manual of the program and of each command.
pub fn man(output: &Output) -> ExitStatus {
    let mut command = Arguments::command();
    command.build();
    let mut text = Vec::new();
    let is_shown = |c: &&clap::Command| !c.is_hide_set() && c.get_name() != "help";
    let commands: Vec<clap::Command> = command
        .get_subcommands()
        .filter(is_shown)
        .cloned()
        .collect();
    let written = Man::new(command).render(&mut text).and_then(|()| {
        commands.into_iter().try_for_each(|command| {
            text.extend(format!(".SH {}\n", command.get_name().to_uppercase()).bytes());
            let page = Man::new(command);
            page.render_synopsis_section(&mut text)?;
            page.render_description_section(&mut text)?;
            page.render_options_section(&mut text)
        })
    });
    match written {
        // commands have no separate pages
        Ok(()) => print(one_page(text), output),
        Err(error) => {
            output.error(&format_args!("the manual cannot be written: {error}"));
            ExitStatus::InternalFault
        }
    }
}

/// Replaces references to command pages by the command names.
fn one_page(text: Vec<u8>) -> Vec<u8> {
    let text = String::from_utf8_lossy(&text);
    let lines = text.lines().map(|line| {
        let command = line
            .strip_prefix("searoom\\-")
            .and_then(|l| l.strip_suffix("(1)"));
        command.map_or_else(|| line.to_owned(), |command| format!("searoom {command}"))
    });
    lines.collect::<Vec<_>>().join("\n").into_bytes()
}

fn print(text: Vec<u8>, output: &Output) -> ExitStatus {
    output.result(String::from_utf8_lossy(&text).trim_end())
}
