//! `searoom check`: reads and checks scenarios without planning.

use super::args::CheckArgs;
use super::input::scenes;
use super::output::Output;
use super::output::status::ExitStatus;

/// Prints one line per valid scenario with its assumptions, and every fault of the others.
pub fn check(args: &CheckArgs, output: &Output) -> ExitStatus {
    let mut status = ExitStatus::Good;
    for scene in scenes::open(&args.paths, &args.assumed, output) {
        let made = scene.and_then(|scene| Ok((scene.label(), scene.scenario()?)));
        status = status.max(match made {
            Ok((label, made)) => {
                let shown = output.result(&format!("{label}: ok"));
                for note in made.notes {
                    output.note(&format_args!("{label}: {note}"));
                }
                shown
            }
            Err(refused) => output.refused(&refused),
        });
    }
    status
}
