//! `searoom import` and `searoom init`: scenario files from other formats, and one to begin with.

mod traffic;

use searoom::report::write_atomically;

use super::args::{ImportArgs, InitArgs};
use super::found::refuse_clashes;
use super::input::scenes::{self, Scene};
use super::output::Output;
use super::output::products::make_folder;
use super::status::ExitStatus;

/// Two ships in sight, every line explained.
const TEMPLATE: &str = include_str!("../../scenarios/template.toml");

/// Writes the template to a new file, and nothing over another one.
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

/// Writes one scenario file per situation. Scenario files are not changed.
pub fn import(args: &ImportArgs, output: &Output) -> anyhow::Result<ExitStatus> {
    if let (Some(at), Some(route)) = (args.at, &args.route) {
        return traffic::import(args, at, route, output);
    }
    let scenes = scenes::open(&args.files, &args.assumed, output);
    refuse_clashes(&scenes::found(&scenes))?;
    make_folder(&args.out)?;
    let mut status = ExitStatus::Good;
    for scene in scenes {
        let reached = match scene {
            Ok(scene) => one(&scene, args, output),
            Err(refused) => output.refused(&refused),
        };
        status = status.max(reached);
    }
    Ok(status)
}

fn one(scene: &Scene, args: &ImportArgs, output: &Output) -> ExitStatus {
    if !scene.is_imported() {
        let label = scene.label();
        output.note(&format_args!("{label}: a scenario file already, left out"));
        return ExitStatus::Good;
    }
    let imported = match scene.scenario() {
        Ok(imported) => imported,
        Err(refused) => return output.refused(&refused),
    };
    let file = args.out.join(format!("{}.toml", scene.found.stem));
    match write_atomically(&file, imported.text.as_bytes()) {
        Ok(()) => output.result(&format!("{}: {}", scene.label(), file.display())),
        Err(error) => output.refuse(&error),
    }
}
