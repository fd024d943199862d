//! `searoom check`: reads and checks scenarios without planning.

use searoom::document::{CheckDocument, CheckedDocument, FaultDocument};
use searoom::planner::Minimises;
use searoom::scenario::Scenario;

use super::args::CheckArgs;
use super::input::files::Refused;
use super::input::scenes;
use super::output::status::ExitStatus;
use super::output::{Noted, Output};

/// Prints one line per valid scenario, every fault of the others, and then the assumptions.
pub fn check(args: &CheckArgs, output: &Output) -> ExitStatus {
    let mut status = ExitStatus::Good;
    let mut document = CheckDocument::default();
    // by file
    let mut noted: Vec<(String, Vec<Noted>)> = Vec::new();
    for scene in scenes::open(&args.paths, &args.assumed, output) {
        let made = scene.and_then(|scene| Ok((scene.scenario()?, scene)));
        match made.map(|(mut made, scene)| {
            made.notes.extend(wide_hulls(&made.scenario));
            made.notes.extend(short_horizon(&made.scenario));
            (made, scene)
        }) {
            Ok((made, scene)) if args.json => document.files.push(CheckedDocument {
                file: scene.found.file.display().to_string(),
                scenario: Some(made.scenario.title),
                notes: made.notes,
                ..CheckedDocument::default()
            }),
            Ok((made, scene)) => {
                status = status.max(output.result(&format!("{}: ok", scene.label())));
                let file = scene.found.file.display().to_string();
                let notes = (scene.name().unwrap_or_default().to_owned(), made.notes);
                match noted.last_mut().filter(|(last, _)| *last == file) {
                    Some((_, all)) => all.push(notes),
                    None => noted.push((file, vec![notes])),
                }
            }
            Err(refused) => {
                status = status.max(output.refused(&refused));
                document.files.push(wrong(refused));
            }
        }
    }
    for (file, notes) in noted {
        output.notes(Some(&file), &notes);
    }
    match args.json {
        true => status.max(output.document(&document)),
        false => status,
    }
}

/// Hulls that are wider than long: length and beam may be exchanged.
fn wide_hulls(scenario: &Scenario) -> impl Iterator<Item = String> {
    let own = [("own_ship", scenario.own_ship.hull)].into_iter();
    let ships =
        (scenario.targets.iter()).filter_map(|target| Some((&*target.name, target.ship()?.hull)));
    let wide = own.chain(ships).filter(|(_, hull)| hull.beam > hull.length);
    wide.map(|(name, hull)| {
        let (beam, length) = (hull.beam, hull.length);
        format!("{name}: beam_m, {beam}, is greater than length_m, {length}")
    })
}

/// A horizon before the end of the mission, where one plan has to arrive.
pub fn short_horizon(scenario: &Scenario) -> Option<String> {
    let (horizon, duration) = (scenario.horizon, scenario.desired.duration());
    let facts = scenario.planner.facts();
    let arrives = !matches!(facts.minimises, Minimises::Own(_));
    let in_parts = match facts.follows_paths {
        true => "",
        false => ". `simulate` sails it in parts",
    };
    // less is a rounding of the file
    (arrives && horizon + 0.5 < duration).then(|| {
        format!(
            "horizon_s: {horizon} s are less than the {duration:.0} s of the mission at its \
             speeds, and a plan has to arrive by then; take more, with time to give way{in_parts}"
        )
    })
}

fn wrong(refused: Refused) -> CheckedDocument {
    CheckedDocument {
        file: refused.file.display().to_string(),
        error: Some(refused.error),
        faults: refused.faults.into_iter().map(FaultDocument::of).collect(),
        ..CheckedDocument::default()
    }
}
