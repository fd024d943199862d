//! The specification of a campaign: read from a file, checked in full; each row has its scenario.

use std::collections::BTreeSet;
use std::path::Path;

use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use sha2::{Digest, Sha256};

use super::encounter::{Distribution, Encounter, EncounterKind, Miss};
use crate::frame::radians_from_deg;
use crate::input::{Fault, Faults, Field, InputError, Range, Table, from_toml, read_text};
use crate::scenario::{
    FILE_MEBIBYTES, Scenario, SimulationSettings, open_water, simulation_of, true_motion,
};
use crate::simulation::Simulation;
use crate::target::{Motion, Representation, ShipTrack, Target};
use crate::text::LINE;
use crate::vessel::Hull;

/// Wall-clock seconds of one plan, far more than needed: no row depends on the clock.
const DEADLINE: f64 = 60.0;

/// Draws with which a class is tried when a specification is read, and how many have to succeed.
const TRIALS: usize = 1000;
const ENOUGH: usize = 10;

const ROWS: Range = Range::between(1.0, 1e9);
const SEED: Range = Range::between(0.0, 9e15);
const SHARE: Range = Range::between(1.0, 1e6);
const STRATA: usize = 1000;
const TIME: Range = Range::between(1.0, 86_400.0);
const MISS_M: Range = Range::within(1e5);
const MISS_LENGTHS: Range = Range::within(1000.0);
const BEARING: Range = Range::within(360.0);
const SPEED: Range = Range::between(0.0, 100.0);
const LENGTH: Range = Range::between(0.1, 2000.0);
const SLENDERNESS: Range = Range::between(1.0, 100.0);
const POSITION_STD: Range = Range::between(0.0, 1e4);
const SPREAD_DEG: Range = Range::between(0.0, 180.0);
const TURN_DEG: Range = Range::within(180.0);
const TURN_RATE: Range = Range::between(0.0, 90.0);

/// A checked specification (docs/guide/campaigns.md).
#[derive(Debug, Clone)]
pub struct Specification {
    /// Its name.
    pub name: String,
    /// Seed of every random number, with the row.
    pub seed: u64,
    /// Number of rows.
    pub rows: u64,
    /// The strata, in the order of the file.
    pub strata: Vec<Stratum>,
    /// SHA-256 of its text and of all that it names, in hexadecimal digits.
    pub hash: String,
    /// The text.
    pub text: String,
}

searoom_geometry::words! {
    /// What the rows of a stratum have in common: own ship's role, or a scenario file.
    pub enum StratumClass {
        /// Nearly reciprocal courses.
        HeadOn => "head-on",
        /// The target crosses from starboard.
        GiveWay => "give-way",
        /// The target crosses from port.
        StandOn => "stand-on",
        /// Own ship comes up from astern.
        Overtaking => "overtaking",
        /// The target comes up from astern.
        Overtaken => "overtaken",
        /// The scenario of a file.
        Scenario => "scenario",
    }
}

impl From<EncounterKind> for StratumClass {
    fn from(kind: EncounterKind) -> Self {
        match kind {
            EncounterKind::HeadOn => Self::HeadOn,
            EncounterKind::GiveWay => Self::GiveWay,
            EncounterKind::StandOn => Self::StandOn,
            EncounterKind::Overtaking => Self::Overtaking,
            EncounterKind::Overtaken => Self::Overtaken,
        }
    }
}

/// A part of the rows that are drawn alike.
#[derive(Debug, Clone)]
pub struct Stratum {
    /// Its name.
    pub name: String,
    /// Own ship's role, or that it is of a scenario file.
    pub class: StratumClass,
    /// Rows of each cycle.
    share: u64,
    /// The scenario that its rows have in common.
    scenario: Scenario,
    /// The distributions that are drawn from; `None` for a scenario that has its targets.
    drawn: Option<Drawn>,
}

#[derive(Debug, Clone)]
struct Drawn {
    encounter: Encounter,
    starboard_turn: f64,
    turn_rate: f64,
}

/// The scenario of a row.
#[derive(Debug, Clone)]
pub struct RowScenario {
    /// Ready to be sailed.
    pub scenario: Scenario,
    /// Draws that were not of the class and were replaced.
    pub redrawn: usize,
}

impl Specification {
    /// Reads and checks a file. The error holds every fault.
    pub fn read(file: &Path) -> Result<Self, InputError> {
        let text = read_text(file, FILE_MEBIBYTES, "a specification of a campaign")?;
        let folder = file.parent().unwrap_or(Path::new(""));
        Self::parse(&text, folder).map_err(|faults| InputError::faults(file, faults))
    }

    /// Checks the text of a file in `folder`, from where its scenarios are read.
    pub fn parse(text: &str, folder: &Path) -> Result<Self, Vec<Fault>> {
        let faults = Faults::default();
        match specification(text, folder, &faults) {
            Some(specification) if faults.is_empty() => Ok(specification),
            _ => Err(faults.take()),
        }
    }

    /// The stratum of a row: the strata take turns, each with as many rows as its share.
    pub fn stratum(&self, row: u64) -> &Stratum {
        let cycle: u64 = self.strata.iter().map(|stratum| stratum.share).sum();
        let mut at = row % cycle;
        let own = self.strata.iter().find(|stratum| {
            let is_here = at < stratum.share;
            at = at.saturating_sub(stratum.share);
            is_here
        });
        own.unwrap_or(&self.strata[0])
    }

    /// The scenario of a row, from the seed and the row alone; `None` where 10,000 draws are of
    /// another class.
    pub fn scenario(&self, row: u64) -> Option<RowScenario> {
        let mut rng = ChaCha8Rng::seed_from_u64(self.seed);
        rng.set_stream(row);
        let mut drawn = self.stratum(row).draw(&mut rng)?;
        drawn.scenario.title += &format!(", row {row}");
        Some(drawn)
    }
}

impl Stratum {
    /// A scenario of this stratum; `None` where 10,000 draws are of another class.
    pub(super) fn draw(&self, rng: &mut impl Rng) -> Option<RowScenario> {
        let mut scenario = self.scenario.clone();
        scenario.title.clone_from(&self.name);
        // a number of a document has 53 bits
        scenario.simulation.seed = rng.random::<u64>() >> 12;
        let mut redrawn = 0;
        if let Some(drawn) = &self.drawn {
            let (ship, replaced) = drawn.encounter.draw(&scenario.own_ship, rng)?;
            redrawn = replaced;
            scenario.targets = vec![drawn.target(ship)];
        }
        Some(RowScenario { scenario, redrawn })
    }
}

impl Drawn {
    fn target(&self, ship: ShipTrack) -> Target {
        Target {
            name: "target".to_owned(),
            motion: Motion::Ship(ShipTrack {
                starboard_turn: self.starboard_turn,
                turn_rate: self.turn_rate,
                ..ship
            }),
            representation: Representation::Polytope,
            status: None,
        }
    }
}

fn specification(text: &str, folder: &Path, faults: &Faults) -> Option<Specification> {
    let root = from_toml(text, faults)?;
    let mut table = Field::root(&root, faults).table("a table")?;
    let name = (table.require("name", LINE)).and_then(|field| field.line_of_text());
    let rows = (table.require("rows", ROWS)).and_then(|field| field.whole_number(ROWS));
    let seed = (table.require("seed", SEED)).and_then(|field| field.whole_number(SEED));
    let strata = table.require("strata", "[[strata]], at least one");
    let strata = strata.and_then(|field| field.list(1..=STRATA, "tables"));
    let needs_own_ship = |field: &Field| field.is_table() && field.get("class").is_some();
    let drawn = strata.iter().flatten().any(needs_own_ship);
    let base = drawn.then(|| open_water(&mut table, "a campaign", DEADLINE));
    let base = base.flatten();
    if !drawn {
        for key in ["horizon_s", "path_length_m", "own_ship", "planner"] {
            table.forbid(key, "nothing: no stratum has a class");
        }
    }
    let shared_loop = simulation_of(&mut table);
    let mut hash = Sha256::new();
    hash_part(&mut hash, text.as_bytes());
    let mut names = BTreeSet::new();
    let mut found = Vec::new();
    for field in strata.iter().flatten() {
        let Some(mut own) = field.table("a table") else {
            continue;
        };
        let name = own.require("name", LINE);
        if let Some(text) = name.as_ref().and_then(Field::any_text)
            && !names.insert(text)
        {
            let name = name.as_ref()?;
            name.refuse::<()>("a name that no other stratum has");
        }
        let name = name.and_then(|field| field.line_of_text());
        let share = own.read_or("share", 1, |field| field.whole_number(SHARE));
        let read = match own.take("scenario") {
            Some(file) => {
                own.forbid("class", "nothing beside scenario");
                scenario_stratum(&file, folder, &mut hash)
            }
            None => class_stratum(&mut own, base.as_ref(), &shared_loop),
        };
        let own_loop = own.has("simulation");
        let settings = own_loop.then(|| simulation_of(&mut own));
        own.finish();
        let (Some((class, mut scenario, drawn)), Some(name)) = (read, name) else {
            continue;
        };
        scenario.deadline = DEADLINE;
        if let Some(settings) = settings {
            let of_file = scenario.simulation;
            scenario.simulation = SimulationSettings {
                behaviours: of_file.behaviours,
                not_reported: of_file.not_reported,
                seen_from: of_file.seen_from,
                ..settings
            };
        }
        let stratum = Stratum {
            name: name.to_owned(),
            class,
            share: share as u64,
            scenario,
            drawn,
        };
        // one fault leads to others
        if faults.is_empty() {
            try_out(&stratum, field, own_loop, &mut |fault| {
                let mut located = Scenario::located(text, vec![fault]);
                located.drain(..).for_each(|fault| faults.note(fault));
            });
        }
        found.push(stratum);
    }
    table.finish();
    Some(Specification {
        name: name?.to_owned(),
        seed: seed? as u64,
        rows: rows? as u64,
        strata: found,
        hash: hex(hash),
        text: text.to_owned(),
    })
}

/// Adds a part of known length.
fn hash_part(hash: &mut Sha256, part: &[u8]) {
    hash.update((part.len() as u64).to_le_bytes());
    hash.update(part);
}

pub(super) fn hex(hash: Sha256) -> String {
    let bytes = hash.finalize();
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
}

type Read = (StratumClass, Scenario, Option<Drawn>);

fn scenario_stratum(field: &Field, folder: &Path, hash: &mut Sha256) -> Option<Read> {
    let file = field.file_in(folder)?;
    let text = read_text(&file, FILE_MEBIBYTES, "a scenario file");
    let read = text.and_then(|text| {
        hash_part(hash, text.as_bytes());
        let beside = file.parent().unwrap_or(Path::new(""));
        Scenario::parse_beside(&text, beside).map_err(|faults| InputError::faults(&file, faults))
    });
    let scenario = field.contents(&file, read, "a scenario file")?;
    // what it reads from other files: its map and its route
    let land = scenario.land.as_ref().map(|land| land.map.polygons());
    hash_part(hash, format!("{:?}{land:?}", scenario.desired).as_bytes());
    Some((StratumClass::Scenario, scenario, None))
}

fn class_stratum(
    own: &mut Table,
    base: Option<&Scenario>,
    shared_loop: &SimulationSettings,
) -> Option<Read> {
    let classes = EncounterKind::ALL.map(|kind| (kind.name(), kind));
    let words = classes.map(|(word, _)| format!("\"{word}\"")).join(", ");
    let class = own.require("class", format_args!("{words}; or scenario, a file"));
    let kind = class.and_then(|field| field.choice(&classes));
    let own_speed = base.map_or(1.0, |base| base.own_ship.speed);
    let standard = Encounter::of(kind.unwrap_or(EncounterKind::HeadOn), own_speed);
    let degrees = |own: &mut Table, key, range, or: Distribution| {
        let found = own.take(key).and_then(|field| distribution(&field, range));
        found.map_or(or, |found| found.map(radians_from_deg))
    };
    let mut number = |key, range, or| own.read_or(key, or, |field| distribution(field, range));
    let (length, slenderness) = (
        number("length_m", LENGTH, standard.length),
        number("slenderness", SLENDERNESS, standard.slenderness),
    );
    let encounter = Encounter {
        kind: standard.kind,
        tcpa: number("tcpa_s", TIME, standard.tcpa),
        speed: number("speed_mps", SPEED, standard.speed),
        length,
        slenderness,
        position_std: number("position_std_m", POSITION_STD, standard.position_std),
        speed_spread: number("speed_spread_mps", SPEED, standard.speed_spread),
        miss: match own.take("cpa_m") {
            Some(field) => {
                own.forbid("cpa_lengths", "nothing beside cpa_m");
                distribution(&field, MISS_M).map_or(standard.miss, Miss::Metres)
            }
            None => own.read_or("cpa_lengths", standard.miss, |field| {
                distribution(field, MISS_LENGTHS).map(Miss::Lengths)
            }),
        },
        bearing: degrees(own, "bearing_deg", BEARING, standard.bearing),
        course_spread: degrees(own, "course_spread_deg", SPREAD_DEG, standard.course_spread),
    };
    let drawn = Drawn {
        encounter,
        starboard_turn: radians_from_deg(own.number_or("starboard_turn_deg", TURN_DEG, 0.0)),
        turn_rate: radians_from_deg(own.number_or("turn_rate_deg_per_s", TURN_RATE, 0.0)),
    };
    let target = true_motion(own);
    let scenario = Scenario {
        simulation: SimulationSettings {
            behaviours: vec![target.behaviour],
            not_reported: vec![target.not_reported],
            seen_from: vec![target.seen_from],
            ..shared_loop.clone()
        },
        ..base?.clone()
    };
    kind.map(|kind| (kind.into(), scenario, Some(drawn)))
}

/// A number, or a table of two between which it is uniform.
fn distribution(field: &Field, range: Range) -> Option<Distribution> {
    if !field.is_table() {
        let both = format_args!("{range}, or a table {{ from, to }} of two");
        let value = field.any_number().filter(|value| range.contains(*value));
        return value.map_or_else(
            || field.refuse(both),
            |value| Some(Distribution::Fixed(value)),
        );
    }
    let mut table = field.table("a table { from, to }")?;
    let from = table.required_number("from", range);
    let to = table.required_number("to", range);
    table.finish();
    let (from, to) = (from?, to?);
    if from > to {
        let found = format_args!("from = {from}, which is above to = {to}");
        return field.reject(found, "from at most as large as to");
    }
    Some(Distribution::Uniform(from, to))
}

/// Notes why the rows of a stratum could not be drawn or sailed.
fn try_out(stratum: &Stratum, field: &Field, own_loop: bool, note: &mut dyn FnMut(Fault)) {
    let mut scenario = stratum.scenario.clone();
    if let Some(drawn) = &stratum.drawn {
        let mut rng = ChaCha8Rng::seed_from_u64(0);
        let encounter = &drawn.encounter;
        let tried = (0..TRIALS).filter_map(|_| encounter.draw_once(&scenario.own_ship, &mut rng));
        let mut ships: Vec<ShipTrack> = tried.collect();
        if ships.len() < ENOUGH {
            let found = format_args!("{} of {TRIALS} draws of this class", ships.len());
            let allowed = "bearings, speeds, times and distances of which more are: at the start \
                           and 30 s before it, and outside the safety margin";
            field.fault_at("class", found, allowed);
            return;
        }
        // the largest hull that can be drawn
        let length = encounter.length.largest();
        let beam = length / encounter.slenderness.smallest();
        let largest = ships.pop().map(|ship| ShipTrack {
            hull: Hull::new(length, beam),
            ..ship
        });
        scenario.targets = largest.into_iter().map(|ship| drawn.target(ship)).collect();
    }
    let unfit = scenario.unfit().into_iter();
    for fault in unfit.chain(Simulation::unfit(&scenario)) {
        let place = field.path();
        let path = fault.path.as_str();
        let path = match (&stratum.drawn, path.strip_prefix("targets[0]")) {
            (None, _) => format!("{place}.scenario"),
            (Some(_), Some(key)) => format!("{place}{key}"),
            (Some(_), None) if own_loop && path.starts_with("simulation") => {
                format!("{place}.{path}")
            }
            (Some(_), None) => path.to_owned(),
        };
        let found = match &stratum.drawn {
            None => format!("{}: {}", fault.path, fault.found),
            Some(_) => fault.found,
        };
        note(Fault {
            path,
            found,
            ..fault
        });
    }
}
