//! What is odd about scenarios, looked at without planning: where the ships would meet if nobody altered, who never
//! matters, ships that are missing, geometry that is mirrored, scenarios that repeat others.

mod likeness;

pub use likeness::{Likeness, likenesses};

use crate::colregs::Role;
use crate::frame::{Side, relative_bearing};
use crate::geometry::DISC_SIDES;
use crate::obstacle::SpaceTimeObstacle;
use crate::pipeline::sets;
use crate::scenario::Scenario;
use crate::scenario::import::Declared;
use crate::target::{Motion, Target};

/// Instants at which sets and own ship are compared.
const INSTANTS: usize = 400;

/// Radians. A target nearer to ahead or astern than this is on no side: 2°.
const ON_NO_SIDE: f64 = std::f64::consts::PI / 90.0;

/// How much a target matters to own ship within the horizon, at sampled instants.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Weight {
    /// Own ship, undisturbed, comes into her hard set.
    Meets,
    /// She does not, but could: at one of her speeds, on some course.
    Reachable,
    /// She could not, whatever she did: the target never matters.
    Never,
}

impl Weight {
    /// In one word.
    pub fn word(self) -> &'static str {
        match self {
            Self::Meets => "meets",
            Self::Reachable => "clear",
            Self::Never => "never",
        }
    }
}

/// One target of a scenario, undisturbed.
#[derive(Debug, Clone, PartialEq)]
pub struct TargetLint {
    /// Her name.
    pub name: String,
    /// Own ship's role.
    pub role: Role,
    /// Least distance of the hulls, metres; of explicit sets, of own position to the set.
    pub dcpa: f64,
    /// And when, seconds.
    pub tcpa: f64,
    /// Least distance of own ship's centre, undisturbed, to the hard set, metres; negative inside.
    pub to_set: f64,
    /// How much she matters.
    pub weight: Weight,
}

/// What was found about one scenario.
#[derive(Debug, Clone, PartialEq)]
pub struct Lint {
    /// In the scenario's order.
    pub targets: Vec<TargetLint>,
    /// What is odd, in sentences.
    pub findings: Vec<String>,
}

/// Looks at a scenario, and at what its file says of it besides. O(targets × instants).
pub fn lint(scenario: &Scenario, declared: &Declared) -> Lint {
    let sets = sets(scenario);
    let fastest = scenario.own_ship.max_speed();
    let start = scenario.own_ship.pose.position;
    let step = scenario.horizon / INSTANTS as f64;
    let targets: Vec<TargetLint> = scenario
        .targets
        .iter()
        .zip(&sets)
        .map(|(target, sets)| {
            let (mut to_set, mut to_reach) = (f64::INFINITY, f64::INFINITY);
            for instant in 0..=INSTANTS {
                let time = step * instant as f64;
                let distance = |place| sets.hard.signed_distance(place, time).distance;
                to_reach = to_reach.min(distance(start) - fastest * time);
                // nothing is claimed after arrival
                if time <= scenario.desired.duration() {
                    to_set = to_set.min(distance(scenario.desired.position_at(time)));
                }
            }
            // negated on purpose: a NaN matters
            let weight = if !(to_set > 0.0) {
                Weight::Meets
            } else if !(to_reach > (fastest + top_speed(target)) * step) {
                Weight::Reachable
            } else {
                Weight::Never
            };
            TargetLint {
                name: target.name.clone(),
                role: sets.encounter.role,
                dcpa: sets.encounter.undisturbed_dcpa,
                tcpa: sets.encounter.undisturbed_tcpa,
                to_set,
                weight,
            }
        })
        .collect();
    let mut findings = against_declared(scenario, declared);
    for target in targets.iter().filter(|t| t.weight == Weight::Never) {
        findings.push(format!(
            "{}: never matters, out of reach within the horizon",
            target.name
        ));
    }
    if targets.is_empty() {
        findings.push("no targets".to_owned());
    } else if targets.iter().all(|t| t.weight != Weight::Meets) {
        findings.push("no target in the way: own ship may hold her course".to_owned());
    }
    for target in targets.iter().filter(|t| t.dcpa < 0.0 && t.tcpa == 0.0) {
        findings.push(format!("{}: overlaps own ship at the start", target.name));
    }
    Lint { targets, findings }
}

/// m/s that the target never exceeds, but for what polygons are larger than arcs.
fn top_speed(target: &Target) -> f64 {
    match &target.motion {
        Motion::Ship(ship) => ship.speed + ship.speed_spread,
        Motion::Sets { velocity, .. } => velocity.reach(),
        Motion::Ellipses { velocity, .. } => velocity.outer_polygon(DISC_SIDES).reach(),
        Motion::Spells { spells, .. } => {
            let speeds = spells.iter().map(|spell| spell.velocities.reach());
            speeds.fold(0.0, f64::max)
        }
    }
}

fn against_declared(scenario: &Scenario, declared: &Declared) -> Vec<String> {
    let mut findings = Vec::new();
    let found = scenario.targets.len();
    if let Some(ships) = declared.ships
        && ships != found
    {
        let what = if found < ships {
            "ships are missing"
        } else {
            "more ships than said"
        };
        findings.push(format!("{what}: {ships} said, {found} found"));
    }
    for (target, said) in scenario.targets.iter().zip(&declared.sides) {
        let bearing = relative_bearing(&scenario.own_ship.pose, target.position_at(0.0));
        let off = bearing.abs().min(std::f64::consts::PI - bearing.abs());
        let side = if bearing > 0.0 {
            Side::Starboard
        } else {
            Side::Port
        };
        if let Some(said) = said
            && off > ON_NO_SIDE
            && side != *said
        {
            findings.push(format!(
                "{}: said to {said}, found to {side}: mirrored?",
                target.name
            ));
        }
    }
    findings
}
