//! The targets of a file.

use std::collections::BTreeMap;

use super::check::{hull, pose};
use super::explicit_sets;
use super::file::Entry;
use super::limits;
use super::plane::Plane;
use super::section::Section;
use crate::frame::radians_from_deg;
use crate::target::{DomainKind, Motion, Representation, ShipTrack, Target};
use crate::text::LINE;

/// The targets; none is a list of none.
pub(super) fn targets(root: &mut Section, plane: &Plane) -> Option<Vec<Target>> {
    let Some(entry) = root.take("targets") else {
        return Some(Vec::new());
    };
    let entries = entry.list(0, "tables")?;
    let mut names: BTreeMap<String, usize> = BTreeMap::new();
    let mut targets = Vec::with_capacity(entries.len());
    for (index, entry) in entries.iter().enumerate() {
        let Some(mut section) = entry.section("a table") else {
            targets.push(None);
            continue;
        };
        let name = section.require("name", LINE);
        let text = name.as_ref().and_then(|name| name.text());
        if let (Some(name), Some(text)) = (&name, &text)
            && let first = *names.entry(text.clone()).or_insert(index)
            && first != index
        {
            name.fault(
                format_args!("{text:?}, the name of targets[{first}] too"),
                "a name that no other target has",
            );
        }
        let known = known(&mut section, plane);
        section.finish();
        targets.push(text.zip(known).map(|(name, known)| Target {
            name,
            motion: known.motion,
            representation: known.representation,
        }));
    }
    targets.into_iter().collect()
}

/// What a target is known by.
struct Known {
    motion: Motion,
    representation: Representation,
}

fn known(section: &mut Section, plane: &Plane) -> Option<Known> {
    let asked = section.take("representation");
    let representation = asked.as_ref().map(|entry| {
        entry.choice(&[
            ("polytope", Representation::Polytope),
            ("ellipsoid", Representation::Ellipsoid),
        ])
    });
    let explicit = ["initial_set", "velocity_set", "velocity_sets"].map(|key| section.has(key));
    let motion = if explicit.contains(&true) {
        explicit_sets::motion(section)
    } else {
        ship(section, plane).map(Motion::Ship)
    };
    let representation = match representation {
        Some(chosen) => chosen?,
        None => Representation::Polytope,
    };
    let motion = motion?;
    let refused = match (&motion, representation) {
        (Motion::Ellipses { .. }, Representation::Polytope) => {
            "\"ellipsoid\", or nothing: the sets are ellipses"
        }
        (Motion::Spells { .. }, Representation::Ellipsoid) => {
            "\"polytope\": velocity sets one after another have no ellipsoid"
        }
        (Motion::Ship(ship), Representation::Ellipsoid) if ship.turn_rate > 0.0 => {
            "\"polytope\": a ship that may turn has velocity sets one after another, which have no ellipsoid"
        }
        _ => "",
    };
    if let Some(entry) = asked.filter(|_| !refused.is_empty()) {
        return entry.refuse(refused);
    }
    Some(Known {
        motion,
        representation,
    })
}

fn ship(section: &mut Section, plane: &Plane) -> Option<ShipTrack> {
    let pose = pose(section, plane);
    let speed = section.required_speed("speed", limits::SPEED);
    let hull = hull(section);
    let position_std = section.number("position_std_m", limits::DISTANCE);
    let speed_spread = section.speed("speed_spread", limits::SPEED);
    let course_spread = section.number("course_spread_deg", limits::COURSE_SPREAD);
    let turn_rate = section.number("turn_rate_deg_per_s", limits::TURN_RATE);
    let domain = match section.take("domain") {
        Some(entry) => domain(&entry),
        None => Some(DomainKind::Colregs),
    };
    Some(ShipTrack {
        pose: pose?,
        speed: speed?,
        hull: hull?,
        position_std: position_std.unwrap_or(0.0),
        speed_spread: speed_spread.unwrap_or(0.0),
        course_spread: radians_from_deg(course_spread.unwrap_or(0.0)),
        turn_rate: radians_from_deg(turn_rate.unwrap_or(0.0)),
        domain: domain?,
    })
}

fn domain(entry: &Entry) -> Option<DomainKind> {
    if !entry.is_table() {
        return entry.choice(&[
            ("colregs", DomainKind::Colregs),
            ("paper", DomainKind::Paper),
            ("hull", DomainKind::Hull),
        ]);
    }
    let mut section = entry.section("a table")?;
    let [fore, aft, port, starboard] = ["fore_m", "aft_m", "port_m", "starboard_m"]
        .map(|key| section.required_number(key, limits::DISTANCE));
    section.finish();
    Some(DomainKind::Custom {
        fore: fore?,
        aft: aft?,
        port: port?,
        starboard: starboard?,
    })
}
