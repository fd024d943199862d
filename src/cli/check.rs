//! `searoom check`: reads and checks, plans nothing.

use searoom::scenario::Scenario;

use super::args::CheckArgs;
use super::files;
use super::output::Output;
use super::status::Status;

/// One line for each good file, every fault of the others.
pub fn check(args: &CheckArgs, output: &Output) -> Status {
    let mut status = Status::Good;
    for found in files::find(&args.paths, output) {
        let failed = match found {
            Ok(found) => match Scenario::read(&found.file) {
                Ok(_) => {
                    status = status.max(output.result(&format!("{}: ok", found.file.display())));
                    continue;
                }
                Err(error) => error.to_string(),
            },
            Err((_, error)) => format!("{error:#}"),
        };
        output.error(&failed);
        status = status.max(Status::BadInput);
    }
    status
}
