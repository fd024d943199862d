//! `searoom import --at`: a scenario from the traffic at a time.

use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};

use anyhow::{Context, bail};
use chrono::{DateTime, Utc};
use searoom::frame::{
    Geographic, Georeference, Pose, Vector, heading_from_course_deg, mps_from_knots,
    radians_from_deg,
};
use searoom::input::InputError;
use searoom::report::write_atomically;
use searoom::scenario::import::{OwnInTraffic, Situation};
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
    at: DateTime<Utc>,
    route: &Path,
    output: &Output,
) -> anyhow::Result<ExitStatus> {
    let time = 1e-3 * at.timestamp_millis() as f64;
    let mut feed = Feed::new(&Settings::default(), 1, picture(args), time);
    for file in &args.files {
        if let Err(error) = read(file, &mut feed) {
            return Ok(output.refuse(&InputError::unread(&files::name(file), error)));
        }
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
    let own = match args.own_pose {
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
    let fastest = own.speed.max(args.assumed.own_speed_mps.unwrap_or(0.0));
    let reach = Reach {
        own_m: WITHIN_S * FASTER * fastest + NEAR_M,
        within_s: WITHIN_S,
    };
    around = Surroundings {
        own: Some(own.clone()),
        ..surroundings(feed.picture(), time, &earth, reach)
    };
    if own.age_s > OWN_NOW_S {
        let statement = format!(
            "its last fix is {:.0} s old; taken to have held course and speed since",
            own.age_s
        );
        around.remarks.note("own ship", statement);
    }
    let written = write(args, (at, route), earth, &own, around, output)?;
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

fn read(file: &Path, feed: &mut Feed) -> std::io::Result<()> {
    let mut source: Box<dyn Read> = match files::is_stdin(file) {
        true => Box::new(std::io::stdin()),
        false => Box::new(File::open(file)?),
    };
    let mut chunk = vec![0; CHUNK];
    loop {
        match source.read(&mut chunk)? {
            0 => break,
            read => feed.recorded(0, &chunk[..read]),
        }
    }
    // a file may end without the end of its line, and another one follows
    feed.recorded(0, b"\n");
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
    (at, route): (DateTime<Utc>, &Path),
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
    let date = at.format("%Y-%m-%d %H:%M:%S UTC");
    let name = own.name.as_ref().unwrap_or(&stem);
    let name = format!("{name}, {date}");
    let situation = Situation::of_traffic(
        &name,
        Some(at),
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
