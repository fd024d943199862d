//! The targets of a file.

use std::collections::BTreeMap;

use super::check::{hull, pose};
use super::file::{Entry, Range, TEXT, Word};
use super::limits;
use super::section::Section;
use crate::frame::{Vector, radians_from_deg};
use crate::geometry::{ConvexPolygon, GeometryError};
use crate::target::{DomainKind, Motion, ShipTrack, Target};

/// What a target with explicit sets cannot have beside them.
const BESIDE_SETS: &str =
    "nothing beside initial_set and velocity_set: the sets are taken as they are";

/// Keys of a tracked ship, speeds aside.
const SHIP_KEYS: [&str; 8] = [
    "position",
    "course_deg",
    "length_m",
    "beam_m",
    "position_std_m",
    "course_spread_deg",
    "turn_rate_deg_per_s",
    "domain",
];

/// The keys of an explicit set.
struct SetKeys {
    vertices: &'static str,
    ellipsoid: [&'static str; 2],
    range: Range,
}

const INITIAL: SetKeys = SetKeys {
    vertices: "vertices_m",
    ellipsoid: ["center_m", "shape_m2"],
    range: limits::COORDINATE,
};

const VELOCITY: SetKeys = SetKeys {
    vertices: "vertices_mps",
    ellipsoid: ["center_mps", "shape_m2_per_s2"],
    range: limits::VELOCITY,
};

/// The targets; none is a list of none.
pub(super) fn targets(root: &mut Section) -> Option<Vec<Target>> {
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
        let name = section.require("name", TEXT);
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
        let motion = motion(&mut section);
        section.finish();
        targets.push(
            text.zip(motion)
                .map(|(name, motion)| Target { name, motion }),
        );
    }
    targets.into_iter().collect()
}

fn motion(section: &mut Section) -> Option<Motion> {
    section.choice(
        "representation",
        &[("polytope", Word::Means(())), ("ellipsoid", Word::NotBuilt)],
    );
    let several = section.not_built("velocity_sets");
    let (initial, velocity) = (section.has("initial_set"), section.has("velocity_set"));
    if initial || velocity || several {
        explicit_sets(section, several)
    } else {
        ship(section).map(Motion::Ship)
    }
}

fn explicit_sets(section: &mut Section, several: bool) -> Option<Motion> {
    for key in SHIP_KEYS {
        section.forbid(key, BESIDE_SETS);
    }
    for key in [
        "speed_mps",
        "speed_kn",
        "speed_spread_mps",
        "speed_spread_kn",
    ] {
        section.forbid(key, BESIDE_SETS);
    }
    let initial = section
        .require("initial_set", "a table { vertices_m }")
        .and_then(|entry| set(&entry, &INITIAL));
    let velocity = if several {
        section.take("velocity_set")
    } else {
        section.require("velocity_set", "a table { vertices_mps }")
    }
    .and_then(|entry| set(&entry, &VELOCITY));
    Some(Motion::Sets {
        initial: initial?,
        velocity: velocity?,
    })
}

/// A convex set from its vertices.
fn set(entry: &Entry, keys: &SetKeys) -> Option<ConvexPolygon> {
    let mut section = entry.section(&format!("a table {{ {} }}", keys.vertices))?;
    let [center, shape] = keys.ellipsoid;
    let ellipsoid = section.not_built(center) | section.not_built(shape);
    let list = if ellipsoid {
        section.take(keys.vertices)
    } else {
        section.require(keys.vertices, "a list of at least 1 [east, north]")
    };
    section.finish();
    let list = list?;
    let vertices = list.list(1, "[east, north]")?;
    let points: Vec<Option<Vector>> = vertices
        .iter()
        .map(|vertex| vertex.pair(keys.range))
        .collect();
    let points: Vec<Vector> = points.into_iter().collect::<Option<_>>()?;
    match ConvexPolygon::from_vertices(&points) {
        Ok(polygon) => Some(polygon),
        Err(error) => {
            let place = match error {
                GeometryError::NotConvex { index, .. } | GeometryError::NotFinite { index } => {
                    vertices.get(index).unwrap_or(&list)
                }
                GeometryError::Empty => &list,
            };
            place.fault(
                error,
                "the corners of a convex set, each on its boundary, in any order",
            );
            None
        }
    }
}

fn ship(section: &mut Section) -> Option<ShipTrack> {
    let pose = pose(section);
    let speed = section.required_speed("speed", limits::SPEED);
    let hull = hull(section);
    let position_std = section.number("position_std_m", limits::DISTANCE);
    let speed_spread = section.speed("speed_spread", limits::SPEED);
    let course_spread = section.number("course_spread_deg", limits::COURSE_SPREAD);
    section.only_zero("turn_rate_deg_per_s");
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
        domain: domain?,
    })
}

fn domain(entry: &Entry) -> Option<DomainKind> {
    if !entry.is_table() {
        return entry.choice(&[
            ("colregs", Word::Means(DomainKind::Colregs)),
            ("paper", Word::Means(DomainKind::Paper)),
            ("hull", Word::Means(DomainKind::Hull)),
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
