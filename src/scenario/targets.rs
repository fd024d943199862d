//! The targets of a scenario file.

use std::collections::BTreeMap;

use super::check::{hull, pose};
use super::explicit_sets;
use super::limits;
use super::plane::Plane;
use crate::frame::radians_from_deg;
use crate::input::{Field, Table};
use crate::target::{DomainKind, Motion, Representation, ShipTrack, Target};
use crate::text::LINE;

/// The list `targets`, which may be absent.
pub(super) fn targets(root: &mut Table, plane: &Plane) -> Option<Vec<Target>> {
    let Some(field) = root.take("targets") else {
        return Some(Vec::new());
    };
    let fields = field.list(0..=usize::MAX, "tables")?;
    let mut names: BTreeMap<&str, usize> = BTreeMap::new();
    let mut targets = Vec::with_capacity(fields.len());
    for (index, field) in fields.iter().enumerate() {
        let Some(mut table) = field.table("a table") else {
            targets.push(None);
            continue;
        };
        let name = table.require("name", LINE);
        let text = name.as_ref().and_then(|name| name.line_of_text());
        if let (Some(name), Some(text)) = (&name, text)
            && let first = *names.entry(text).or_insert(index)
            && first != index
        {
            name.fault(
                format_args!("{text:?}, the name of targets[{first}] too"),
                "a name that no other target has",
            );
        }
        let known = known(&mut table, plane);
        table.finish();
        targets.push(text.zip(known).map(|(name, known)| Target {
            name: name.to_owned(),
            motion: known.motion,
            representation: known.representation,
        }));
    }
    targets.into_iter().collect()
}

/// Motion and representation of a target.
struct Known {
    motion: Motion,
    representation: Representation,
}

fn known(table: &mut Table, plane: &Plane) -> Option<Known> {
    let asked = table.take("representation");
    let representation = asked.as_ref().map(|field| {
        field.choice(&[
            ("polytope", Representation::Polytope),
            ("ellipsoid", Representation::Ellipsoid),
        ])
    });
    let explicit = ["initial_set", "velocity_set", "velocity_sets"].map(|key| table.has(key));
    let motion = if explicit.contains(&true) {
        explicit_sets::sets(table).map(Motion::Sets)
    } else {
        ship(table, plane).map(Motion::Ship)
    };
    let representation = match representation {
        Some(chosen) => chosen?,
        None => Representation::Polytope,
    };
    let motion = motion?;
    let refused = match (&motion, representation) {
        (Motion::Sets(sets), Representation::Polytope) if sets.initial.as_ellipse().is_some() => {
            "\"ellipsoid\", or nothing: the sets are ellipses"
        }
        (Motion::Sets(sets), Representation::Ellipsoid)
            if sets.initial.as_polygon().is_some() && sets.velocities.len() > 1 =>
        {
            "\"polytope\": polygons of velocities one after another have no ellipsoid"
        }
        (Motion::Ship(ship), Representation::Ellipsoid) if ship.turn_rate > 0.0 => {
            "\"polytope\": a ship that may turn has velocity sets one after another, \
             which have no ellipsoid"
        }
        _ => "",
    };
    if let Some(field) = asked.filter(|_| !refused.is_empty()) {
        return field.refuse(refused);
    }
    Some(Known {
        motion,
        representation,
    })
}

fn ship(table: &mut Table, plane: &Plane) -> Option<ShipTrack> {
    let pose = pose(table, plane);
    let speed = table.required_speed("speed", limits::SPEED);
    let hull = hull(table);
    let position_std = table.number("position_std_m", limits::DISTANCE);
    let speed_spread = table.speed("speed_spread", limits::SPEED);
    let course_spread = table.number("course_spread_deg", limits::COURSE_SPREAD);
    let turn_rate = table.number("turn_rate_deg_per_s", limits::TURN_RATE);
    let domain = match table.take("domain") {
        Some(field) => domain(&field),
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

fn domain(field: &Field) -> Option<DomainKind> {
    if !field.is_table() {
        return field.choice(&[
            ("colregs", DomainKind::Colregs),
            ("paper", DomainKind::Paper),
            ("hull", DomainKind::Hull),
        ]);
    }
    let mut table = field.table("a table")?;
    let [fore, aft, port, starboard] = ["fore_m", "aft_m", "port_m", "starboard_m"]
        .map(|key| table.required_number(key, limits::DISTANCE));
    table.finish();
    Some(DomainKind::Custom {
        fore: fore?,
        aft: aft?,
        port: port?,
        starboard: starboard?,
    })
}
