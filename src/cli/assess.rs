//! `searoom assess`: risk, closest approach and velocity obstacle, without planning.

use searoom::document::AssessedSets;
use searoom::frame::Vector;
use searoom::obstacle::Obstacle;
use searoom::pipeline;
use searoom::report::assessment_text;
use searoom::report::figure::assessment_figure;
use searoom::scenario::Scenario;
use searoom::scenario::import::Imported;
use searoom::study::assess::{OwnSituation, Query, SpaceTimePoint, assess as answer};

use super::args::AssessArgs;
use super::input::rows;
use super::input::scenes::open_one;
use super::output::Output;
use super::output::products::prepare_figure;
use super::runner::guarded;
use super::status::ExitStatus;

pub fn assess(args: &AssessArgs, output: &Output) -> anyhow::Result<ExitStatus> {
    // before any computation
    args.drawn.refuse_dpi()?;
    let figure = args.drawn.figure.as_deref();
    figure.map_or(Ok(()), prepare_figure)?;
    let assessed = guarded(|| match read(args, output) {
        Ok((scenario, query)) => show(args, &scenario, &query, output),
        Err(errors) => {
            for error in errors {
                output.error(&error);
            }
            ExitStatus::BadInput
        }
    });
    let file = args.scenario.display();
    Ok(assessed.unwrap_or_else(|fault| output.fault(&format_args!("{file}: {fault}"))))
}

/// Reads all requested files, and returns all errors.
fn read(args: &AssessArgs, output: &Output) -> Result<(Scenario, Query), Vec<String>> {
    let mut errors = Vec::new();
    let scenario = open_one(&args.scenario, &args.assumed, output)
        .and_then(|scene| scene.scenario().map_err(|refused| refused.error))
        .map_err(|error| errors.push(error));
    let mut points = args.at.clone();
    if let Some(file) = &args.points {
        match rows::read(file, &rows::POINT) {
            Ok(rows) => points.extend(rows),
            Err(error) => errors.push(error.to_string()),
        }
    }
    let mut velocities = args.velocity.clone();
    if let Some(file) = &args.velocities {
        match rows::read(file, &rows::VELOCITY) {
            Ok(rows) => velocities.extend(rows),
            Err(error) => errors.push(error.to_string()),
        }
    }
    let query = Query {
        sections: args.section.clone(),
        points: points
            .into_iter()
            .map(|[east, north, time]| SpaceTimePoint {
                position: Vector::new(east, north),
                time,
            })
            .collect(),
        velocities: velocities
            .into_iter()
            .map(|[east, north]| Vector::new(east, north))
            .collect(),
    };
    match scenario {
        Ok(Imported {
            scenario, notes, ..
        }) if errors.is_empty() => {
            output.notes(None, &[(String::new(), notes)]);
            Ok((scenario, query))
        }
        _ => Err(errors),
    }
}

fn show(args: &AssessArgs, scenario: &Scenario, query: &Query, output: &Output) -> ExitStatus {
    let obstacles: Vec<Obstacle> = pipeline::sets(scenario)
        .into_iter()
        .map(|sets| match args.domains {
            true => sets.with_domain,
            false => sets.hard,
        })
        .collect();
    let situation = OwnSituation::of(scenario, &obstacles);
    let sets = match args.domains {
        true => AssessedSets::Domains,
        false => AssessedSets::Hard,
    };
    let assessment = answer(&scenario.title, sets, &situation, query);
    let drawn = args.drawn.figure.as_ref().map(|path| {
        let title = format!("{}, {sets} sets", scenario.title);
        let options = args.drawn.options(&[], false);
        let land = scenario.land.as_ref();
        let figure = assessment_figure(&situation, land, &query.sections, &options, &title);
        match figure.and_then(|figure| figure.write(path)) {
            Ok(()) => output.wrote(path),
            Err(error) => return output.refuse(&error),
        }
        ExitStatus::Good
    });
    drawn
        .unwrap_or_default()
        .max(output.show(args.json, &assessment, || {
            assessment_text(&situation, &assessment, output.display)
        }))
}
