//! The picture around own ship as the targets of a scenario.

use searoom_traffic::{Kind, Listed, Note, Picture, Reach, Ship};

use crate::frame::{Georeference, Pose};
use crate::scenario::Remarks;
use crate::target::Target;
use crate::vessel::Hull;

/// Own ship in traffic.
#[derive(Debug, Clone, PartialEq)]
pub struct Own {
    /// As it sends it.
    pub name: Option<String>,
    /// On the plane.
    pub pose: Pose,
    /// m/s.
    pub speed: f64,
    /// The hull, where own ship sends its size.
    pub hull: Option<Hull>,
    /// Metres by which it may be elsewhere; zero where a user says where it is.
    pub radius_m: f64,
    /// Seconds since the fix.
    pub age_s: f64,
}

/// Own ship and the others at a time.
#[derive(Debug, Clone)]
pub struct Surroundings {
    /// `None` where own ship's position is not known, or too old.
    pub own: Option<Own>,
    /// Each with its sets.
    pub ships: Vec<Ship>,
    /// Number of ships that are too far to matter.
    pub beyond: usize,
    /// What is in no set.
    pub listed: Vec<Listed>,
    /// Cautions for ships that are in no set, and notes on the others.
    pub remarks: Remarks,
}

impl Surroundings {
    /// The ships as targets.
    pub fn targets(&self) -> Vec<Target> {
        self.ships.iter().map(|ship| ship.target.clone()).collect()
    }
}

/// Most ships that are named in one remark.
const MOST_NAMES: usize = 10;

/// Notes of reports that make a set wide, and why.
const NOTED: [(Note, &str); 6] = [
    (
        Note::NoSize,
        "no size sent; as large as any ship of the kind",
    ),
    (
        Note::NoAntenna,
        "the place of the antenna on the hull is not known; it may be anywhere",
    ),
    (Note::NotMeasured, "the place is not measured"),
    (
        Note::NoSpeed,
        "no speed sent; as fast as any ship of the kind, unless it lies",
    ),
    (
        Note::ZerosForUnknown,
        "speed, course and heading look as if they were not known",
    ),
    (
        Note::StatusContradictsSpeed,
        "the status contradicts the speed, and no set follows from it",
    ),
];

/// The first names, and how many there are more; `None` without any.
fn some<'a>(names: impl Iterator<Item = &'a str>) -> Option<String> {
    let names: Vec<&str> = names.collect();
    let first = names[..names.len().min(MOST_NAMES)].join(", ");
    match names.len().saturating_sub(MOST_NAMES) {
        0 if names.is_empty() => None,
        0 => Some(first),
        more => Some(format!("{first} and {more} more")),
    }
}

/// Own ship and the ships that may come within reach of it, at a time in seconds of Unix time.
pub fn surroundings(
    picture: &Picture,
    time: f64,
    plane: &Georeference,
    reach: Reach,
) -> Surroundings {
    let view = picture.at(time, plane, reach);
    let own = view.own.map(|own| Own {
        name: picture.own_name().map(str::to_owned),
        pose: own.pose,
        speed: own.speed,
        hull: own.size_m.map(|[length, beam]| Hull::new(length, beam)),
        radius_m: own.radius_m,
        age_s: own.age_s,
    });
    let mut remarks = Remarks::default();
    let is_ship = |listed: &&Listed| {
        !matches!(
            listed.kind,
            Kind::BaseStation | Kind::Aircraft | Kind::VirtualMark
        )
    };
    for why in [searoom_traffic::STALE, searoom_traffic::WITHOUT_PLACE] {
        let listed = view.listed.iter().filter(is_ship);
        if let Some(names) = some(listed.filter(|l| l.why == why).map(|l| l.name.as_str())) {
            remarks.caution("in no set", format_args!("{names}: {why}"));
        }
    }
    let others = view.listed.iter().filter(|listed| !is_ship(listed));
    if let Some(names) = some(others.map(|listed| listed.name.as_str())) {
        let what = "a station ashore, an aircraft, or a mark that is not in the water";
        remarks.note("in no set", format_args!("{names}: {what}"));
    }
    for (note, statement) in NOTED {
        let ships = view.ships.iter().filter(|ship| ship.notes.has(note));
        if let Some(names) = some(ships.map(|ship| ship.target.name.as_str())) {
            remarks.note(names, statement);
        }
    }
    Surroundings {
        own,
        ships: view.ships,
        beyond: view.beyond,
        listed: view.listed,
        remarks,
    }
}
