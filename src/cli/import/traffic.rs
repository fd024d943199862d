//! `searoom import --at`: a scenario from the traffic at a time.

use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};

use anyhow::{Context, bail};
use searoom::frame::{
    Geographic, Georeference, Pose, Vector, heading_from_course_deg, mps_from_knots,
    radians_from_deg,
};
use searoom::input::InputError;
use searoom::report::write_atomically;
use searoom::scenario::import::{OwnInTraffic, Situation};
use searoom::scenario::unix_time;
use searoom::traffic::{
    Feed, Identity, Own, PictureSettings, Reach, Settings, Surroundings, surroundings,
};

use super::super::args::{AssumedArgs, ImportArgs};
use super::super::found::Refused;
use super::super::input::files;
use super::super::output::Output;
use super::super::output::products::make_folder;
use super::super::status::ExitStatus;

/// Bytes that are read at once.
const CHUNK: usize = 1 << 16;

/// Seconds within which ships may come near: twice the mission's part of a horizon.
const WITHIN_S: f64 = 1800.0;

/// Own ship's greatest speed over that of the present.
const FASTER: f64 = 1.2;

/// Own ship is at rest below this speed, m/s.
const AT_REST_MPS: f64 = 0.25;

/// Seconds from which a fix of own ship is not of the present.
const OWN_NOW_S: f64 = 2.0;

/// Metres beside own ship that matter.
const NEAR_M: f64 = 2000.0;

/// Seconds that own ship's last fix may be before the time that is asked for: reports in archives are minutes
/// apart.
const OWN_AGE_S: f64 = 360.0;

/// Reads the traffic until a time, and writes the scenario that own ship is in then.
pub fn import(
    args: &ImportArgs,
    time: f64,
    route: &Path,
    output: &Output,
) -> anyhow::Result<ExitStatus> {
    let mut feed = Feed::new(&Settings::default(), args.files.len(), picture(args), time);
    for (source, file) in args.files.iter().enumerate() {
        if let Err(error) = read(file, source, &mut feed) {
            return Ok(output.refuse(&InputError::unread(&files::name(file), error)));
        }
    }
    if let Some((source, column)) = feed.missing_columns().next() {
        let file = args
            .files
            .get(source)
            .map(|file| files::name(file).display().to_string());
        return Ok(output.refuse(&format_args!("{}: {column}", file.unwrap_or_default())));
    }
    if feed.reports() == 0 {
        let names: Vec<String> = args
            .files
            .iter()
            .map(|file| files::name(file).display().to_string())
            .collect();
        let lines = feed.counted().join(", ");
        return Ok(output.refuse(&format_args!(
            "{}: found no report of a ship ({lines}); allowed: sentences of NMEA 0183, CSV of AIS reports, \
             or Signal K deltas",
            names.join(", ")
        )));
    }
    output.notes(None, &[("traffic".to_owned(), feed.counted())]);
    let place = match args.own_pose {
        Some([lat_deg, lon_deg, ..]) => Geographic { lat_deg, lon_deg },
        None => match feed.picture().own_place() {
            Some(place) => place,
            None => return Ok(output.refuse(&nowhere(args))),
        },
    };
    let earth =
        Georeference::new(place).context("own ship: found a pole; allowed: lower latitudes")?;
    let mut around = surroundings(feed.picture(), time, &earth, Reach::ALL);
    let mut own = match args.own_pose {
        Some([.., course_deg, knots]) => Own {
            name: None,
            pose: Pose::new(Vector::zeros(), heading_from_course_deg(course_deg)),
            speed: mps_from_knots(knots),
            hull: None,
            radius_m: 0.0,
            age_s: 0.0,
        },
        None => match around.own.take() {
            Some(own) => own,
            None => return Ok(output.refuse(&nowhere(args))),
        },
    };
    // the least step of a speed is no way
    if own.speed < AT_REST_MPS {
        own.speed = 0.0;
    }
    let fastest = own.speed.max(args.assumed.own_speed_mps.unwrap_or(0.0));
    let reach = Reach {
        own_m: WITHIN_S * FASTER * fastest + NEAR_M,
        within_s: WITHIN_S,
    };
    around = Surroundings {
        own: Some(own.clone()),
        ..surroundings(feed.picture(), time, &earth, reach)
    };
    if own.radius_m > 0.0 {
        let statement = format!(
            "taken to be where its fix has it, which is right to {:.0} m",
            own.radius_m
        );
        around.remarks.caution("own ship", statement);
    }
    if own.age_s > OWN_NOW_S {
        let statement = format!(
            "its last fix is {:.0} s old; taken to have held course and speed since",
            own.age_s
        );
        around.remarks.note("own ship", statement);
    }
    let written = write(args, (time, route), earth, &own, around, output)?;
    Ok(written.unwrap_or_else(|refused| output.refused(&refused)))
}

/// The settings of the picture, with what the user assumes.
fn picture(args: &ImportArgs) -> PictureSettings {
    let AssumedArgs {
        speed_spread_mps,
        course_spread_deg,
        ..
    } = args.assumed;
    let usual = PictureSettings::default();
    PictureSettings {
        speed_spread_mps: speed_spread_mps.unwrap_or(usual.speed_spread_mps),
        course_spread: course_spread_deg.map_or(usual.course_spread, radians_from_deg),
        own: args.own.map(Identity::Mmsi),
        own_stale_s: OWN_AGE_S,
        own_is_exact: true,
        ..usual
    }
}

fn read(file: &Path, source: usize, feed: &mut Feed) -> std::io::Result<()> {
    let mut bytes: Box<dyn Read> = match files::is_stdin(file) {
        true => Box::new(std::io::stdin()),
        false => Box::new(File::open(file)?),
    };
    let mut chunk = vec![0; CHUNK];
    loop {
        match bytes.read(&mut chunk)? {
            0 => break,
            read => feed.recorded(source, &chunk[..read]),
        }
    }
    feed.finish(source);
    Ok(())
}

/// Why own ship is not known.
fn nowhere(args: &ImportArgs) -> String {
    match args.own {
        Some(mmsi) => format!(
            "--own {mmsi}: found no position, course and speed of it in the 6 minutes before \
             --at; \
             allowed: a ship of the files at that time, or --own-pose"
        ),
        None => "own ship: found no position of it in the files (VDO); allowed: --own with its \
                 MMSI, or --own-pose"
            .to_owned(),
    }
}

fn write(
    args: &ImportArgs,
    (time, route): (f64, &Path),
    earth: Georeference,
    own: &Own,
    around: Surroundings,
    output: &Output,
) -> anyhow::Result<Result<ExitStatus, Refused>> {
    if let Err(error) = File::open(route) {
        bail!("{}", InputError::unread(route, error));
    }
    make_folder(&args.out)?;
    let first = args.files.first().map_or(Path::new("-"), PathBuf::as_path);
    let stem = match files::is_stdin(first) {
        true => "stdin".to_owned(),
        false => files::stem(first.file_name().map_or(first, Path::new)),
    };
    let file = args.out.join(format!("{stem}.toml"));
    let beside = link(route, &args.out)?;
    let at = unix_time(time);
    let date = at.map_or_else(String::new, |at| {
        at.format("%Y-%m-%d %H:%M:%S UTC").to_string()
    });
    let name = own.name.as_ref().unwrap_or(&stem);
    let name = format!("{name}, {date}");
    let situation = Situation::of_traffic(
        &name,
        at,
        earth,
        &OwnInTraffic {
            pose: own.pose,
            speed: own.speed,
            hull: own.hull,
            route_file: beside,
        },
        around.targets(),
        around.remarks,
    );
    let imported = match situation.scenario_beside(&args.assumed.assumed(), &args.out) {
        Ok(imported) => imported,
        Err(faults) => {
            let error = InputError::faults(&file, faults);
            return Ok(Err(Refused::input(&file, error)));
        }
    };
    output.notes(None, &[(file.display().to_string(), imported.notes)]);
    if let Err(error) = write_atomically(&file, imported.text.as_bytes()) {
        return Ok(Ok(output.refuse(&error)));
    }
    let (ships, beyond) = (around.ships.len(), around.beyond);
    Ok(Ok(output.result(&format!(
        "{}: own ship and {ships} others; {beyond} too far to matter",
        file.display()
    ))))
}

/// A file as one in a folder names it.
fn link(file: &Path, folder: &Path) -> anyhow::Result<String> {
    let [file, folder] = [file, folder].map(Path::canonicalize);
    let (file, folder) = (file?, folder?);
    let way = pathdiff::diff_paths(&file, &folder).unwrap_or(file);
    let way = way
        .to_str()
        .context("--route: found a name that is not UTF-8")?;
    Ok(way.replace('\\', "/"))
}
