//! `searoom init`: writes a scenario to begin with.

use searoom::report::write_atomically;

use super::args::InitArgs;
use super::output::Output;
use super::output::status::ExitStatus;

/// Two ships in sight, every line explained.
const TEMPLATE: &str = include_str!("../../scenarios/template.toml");

/// Writes the file, and nothing over another one.
pub fn init(args: &InitArgs, output: &Output) -> ExitStatus {
    let file = args.file.display();
    if args.file.symlink_metadata().is_ok() {
        return output.refuse(&format_args!("{file}: found a file; allowed: a new name"));
    }
    match write_atomically(&args.file, TEMPLATE.as_bytes()) {
        Ok(()) => output.result(&format!("wrote {file}; next: searoom plan {file}")),
        Err(error) => output.refuse(&error),
    }
}
