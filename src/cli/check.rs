//! `searoom check`: reads and checks scenarios without planning.

use super::args::CheckArgs;
use super::input::scenes;
use super::output::Output;
use super::output::status::ExitStatus;

/// Prints one line per valid scenario with its assumptions, and every fault of the others.
pub fn check(args: &CheckArgs, output: &Output) -> ExitStatus {
    let mut status = ExitStatus::Good;
    for scene in scenes::open(&args.paths, &args.assumed, output) {
        let failed = match scene {
            Ok(scene) => match scene.scenario() {
                Ok(made) => {
                    status = status.max(output.result(&format!("{}: ok", scene.label())));
                    for note in made.notes {
                        output.note(&format_args!("{}: {note}", scene.label()));
                    }
                    continue;
                }
                Err(error) => error.to_string(),
            },
            Err(unread) => unread.error,
        };
        output.error(&failed);
        status = status.max(ExitStatus::BadInput);
    }
    status
}
