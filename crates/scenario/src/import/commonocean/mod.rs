//! CommonOcean scenarios (XML 2022a, and 2020a with other names of some elements). Metres, m/s,
//! seconds; angles counter-clockwise from east in radians; times in steps.

mod geometry;
mod problem;
mod recorded;

use roxmltree::Document;

use super::assumed::Assumed;
use super::situation::{Declared, GivenHull, Other, Own, Situation};
use super::xml::{Names, Xml};
use crate::limits;
use crate::status;
use geometry::{Body, State, body, shapes, state};
use recorded::Recorded;
use searoom_geometry::ConvexPolygon;

use searoom_input::text::is_line;
use searoom_input::{Fault, Faults, Range, Remarks, abbreviated};

/// Seconds of a step.
const STEP: Range = Range::between(1e-3, 3600.0);

/// Types of obstacles, static or not.
const TYPES: [&str; 14] = [
    "unknown",
    "buoy",
    "land",
    "motorvessel",
    "sailingvessel",
    "fishingvessel",
    "militaryvessel",
    "cargoship",
    "vesselNotUnderCommand",
    "restrictedManeuverabilityVessel",
    "anchoredvessel",
    "windfarm",
    "oilrig",
    "watersboundary",
];

/// Types of ships to which Rule 18 gives a right.
const OF_RULE_18: [&str; 4] = [
    "sailingvessel",
    "fishingvessel",
    "vesselNotUnderCommand",
    "restrictedManeuverabilityVessel",
];

/// Metres between the position and the middle of a shape at rest from which on they are not one.
const FIXED_OFF_M: f64 = 1e-3;

/// Names that are read of each element, or say nothing about where ships may be.
const NAMES: Names = &[
    (
        "commonOcean",
        &[
            "timeStepSize",
            "commonOceanVersion",
            "author",
            "affiliation",
            "source",
            "benchmarkID",
            "date",
            "schemaLocation",
            "location",
            "scenarioTags",
            "navigationableArea",
            "waterway",
            "waters",
            "shallow",
            "draft",
            "trafficSign",
            "staticObstacle",
            "dynamicObstacle",
            "planningProblem",
            "additionalInformation",
        ],
    ),
    // the depth has a note of its own
    ("shallow", &["id", "shape", "depth", "watersType"]),
    ("draft", &["id", "shape", "depth", "watersType"]),
    (
        "staticObstacle",
        &["id", "type", "depth", "shape", "initialState"],
    ),
    (
        "dynamicObstacle",
        &[
            "id",
            "type",
            "depth",
            "shape",
            "initialState",
            "trajectory",
            "occupancySet",
        ],
    ),
    ("shape", &["rectangle", "circle", "polygon"]),
    ("rectangle", &["length", "width", "orientation", "center"]),
    ("circle", &["radius", "center"]),
    ("polygon", &["point"]),
    ("center", &["x", "y"]),
    ("point", &["x", "y"]),
    ("trajectory", &["state"]),
    (
        "initialState",
        &["position", "orientation", "time", "velocity"],
    ),
    ("state", &["position", "orientation", "time", "velocity"]),
    (
        "position",
        &["point", "rectangle", "circle", "polygon", "water"],
    ),
    (
        "planningProblem",
        &[
            "id",
            "initialState",
            "goalState",
            "waypoint",
            "maxLateralDeviation",
        ],
    ),
    // orientation and velocity have a note of their own
    (
        "goalState",
        &["position", "time", "orientation", "velocity"],
    ),
    ("waypoint", &["id", "position"]),
];

const VERSIONS: [&str; 2] = ["2022a", "2020a"];

/// Own ship and the others of one planning problem, with what was assumed.
type Read = (Own, Vec<Other>, Remarks);

/// The situations of a file, one per planning problem.
pub(super) fn situations(
    document: &Document,
    assumed: &Assumed,
) -> Result<Vec<Result<Situation, Vec<Fault>>>, Vec<Fault>> {
    let faults = Faults::default();
    let root = Xml::root(document, &faults);
    let version = root.attribute("commonOceanVersion").unwrap_or_default();
    if !VERSIONS.contains(&version) {
        root.fault(
            format_args!("commonOceanVersion {}", abbreviated(version)),
            format_args!("one of {}", VERSIONS.join(", ")),
        );
        return Err(faults.take());
    }
    let step = root.attribute_number("timeStepSize", STEP.in_unit("s"));
    let name = match root.attribute("benchmarkID") {
        Some(id) if is_line(id) => Some(id.trim()),
        Some(id) => root.reject(
            format_args!("benchmarkID {}", abbreviated(id)),
            "a name on one line",
        ),
        None => Some("CommonOcean scenario"),
    };
    let mut remarks = Remarks::default();
    unused(&root, &mut remarks);
    let problems: Vec<Xml> = root.all("planningProblem").collect();
    if problems.is_empty() {
        root.fault("no planningProblem", "at least one");
    }
    let others = step.and_then(|step| others(&root, step, &mut remarks));
    let own = |entry| {
        let mut remarks = remarks.clone();
        let (own, begins) = problem::own(entry, step?, assumed.own_speed, &mut remarks)?;
        let others = others.as_ref()?.iter();
        let others = others.filter_map(|other| other.from(begins, step?, &mut remarks));
        Some((own, others.collect::<Vec<Other>>(), remarks))
    };
    let owns: Vec<_> = problems.iter().map(own).collect();
    let noted = faults.take();
    let (Some(name), true) = (name, noted.is_empty()) else {
        return Err(noted);
    };
    let several = owns.len() > 1;
    let situation = |(entry, read): (&Xml, Option<Read>)| {
        let id = several.then(|| format!("{name}-{}", entry.attribute("id").unwrap_or_default()));
        let (own, others, remarks) = read.ok_or_else(Vec::new)?;
        // relative to own ship's start: coordinates may be those of a global grid
        let origin = own.pose.position;
        let moved = |other: &Other| other.translated(-origin);
        Ok(Situation {
            name: id.clone().unwrap_or_else(|| name.to_owned()),
            id,
            start_utc: None,
            own: own.translated(-origin),
            others: others.iter().map(moved).collect(),
            earth: None,
            declared: Declared::default(),
            remarks,
        })
    };
    Ok(problems.iter().zip(owns).map(situation).collect())
}

fn unused(root: &Xml, remarks: &mut Remarks) {
    let count = |name: &str| root.all(name).count();
    let ways = count("waterway") + count("waters");
    if ways > 0 {
        let ways = format_args!("{ways} waterways");
        remarks.note(ways, "not used, own ship may leave them");
    }
    for (name, statement) in [
        ("navigationableArea", "not used, own ship may leave it"),
        ("trafficSign", "not used"),
    ] {
        if count(name) > 0 {
            remarks.note(format_args!("{} {name}", count(name)), statement);
        }
    }
    for name in root.unread(NAMES) {
        remarks.note(name, "not used");
    }
}

/// An obstacle of a file.
enum Obstacle {
    Fixed(Other),
    Ship(Recorded),
}

impl Obstacle {
    /// The obstacle from a step on, the time of which is then 0. `None` for a ship that is gone.
    fn from(&self, begins: f64, step: f64, remarks: &mut Remarks) -> Option<Other> {
        match self {
            Self::Fixed(other) => Some(other.clone()),
            Self::Ship(ship) => ship.from(begins, step, remarks),
        }
    }
}

/// Every obstacle and every shallow. `None` if one is faulty.
fn others(root: &Xml, step: f64, remarks: &mut Remarks) -> Option<Vec<Obstacle>> {
    let mut others = Vec::new();
    let mut sound = true;
    for element in root.elements() {
        let found = match element.name() {
            "staticObstacle" => fixed(&element, remarks),
            "shallow" | "draft" => shallow(&element),
            "dynamicObstacle" => {
                moving(&element, step, remarks).map(|ship| vec![Obstacle::Ship(ship)])
            }
            _ => continue,
        };
        match found {
            Some(found) => others.extend(found),
            None => sound = false,
        }
    }
    let shallows = root.all("shallow").count() + root.all("draft").count();
    if shallows > 0 {
        let statement =
            "own draught is not in the file, so all are kept out of, whatever their depth";
        remarks.note(format_args!("{shallows} shallows"), statement);
    }
    if others.len() > limits::SHIPS {
        return root.reject(
            format_args!("{} obstacles and shallows", others.len()),
            format_args!("at most {}", limits::SHIPS),
        );
    }
    sound.then_some(others)
}

fn kind<'a>(element: &Xml<'a>) -> Option<&'a str> {
    let entry = element.require("type", "the type of the obstacle")?;
    let kind = entry.text();
    if TYPES.contains(&kind) {
        return Some(kind);
    }
    entry.reject(
        abbreviated(kind),
        format_args!("one of {}", TYPES.join(", ")),
    )
}

fn named(element: &Xml, kind: &str, part: Option<usize>) -> String {
    let id = element.attribute("id").unwrap_or("without id");
    match part {
        Some(part) => format!("{kind} {id} ({})", part + 1),
        None => format!("{kind} {id}"),
    }
}

/// The convex parts of an object at rest.
fn fixed(element: &Xml, remarks: &mut Remarks) -> Option<Vec<Obstacle>> {
    let kind = kind(element);
    let parts = element
        .require("shape", "a rectangle, circle or polygon")
        .and_then(|entry| shapes(&entry));
    let initial = element
        .require("initialState", "position, orientation, time")
        .and_then(|entry| state(&entry));
    let (kind, parts, initial) = (kind?, parts?, initial?);
    let ground = ["land", "watersboundary"].contains(&kind);
    let several = parts.len() > 1;
    if initial.orientation != 0.0
        && parts
            .iter()
            .any(|part| part.centroid().norm() > FIXED_OFF_M)
    {
        remarks.note(
            named(element, kind, None),
            "its shape is turned about its position; CommonOcean's library turns it about its middle",
        );
    }
    let placed = parts.iter().enumerate().map(|(index, part)| {
        Obstacle::Fixed(Other::Fixed {
            name: named(element, kind, several.then_some(index)),
            shape: part
                .rotated(initial.orientation)
                .translated(initial.position),
            ground,
        })
    });
    Some(placed.collect())
}

fn shallow(element: &Xml) -> Option<Vec<Obstacle>> {
    let parts = shapes(&element.require("shape", "a rectangle, circle or polygon")?)?;
    let several = parts.len() > 1;
    let part = |(index, shape): (usize, ConvexPolygon)| {
        Obstacle::Fixed(Other::Fixed {
            name: named(element, "shallow", several.then_some(index)),
            shape,
            ground: true,
        })
    };
    Some(parts.into_iter().enumerate().map(part).collect())
}

/// A ship with its recorded states.
fn moving(element: &Xml, step: f64, remarks: &mut Remarks) -> Option<Recorded> {
    let kind = kind(element);
    let body = match element.take("shape") {
        Some(entry) => body(&entry),
        None => Some(Body {
            hull: GivenHull::Missing(format!("{}/shape", element.path())),
            off: 0.0,
        }),
    };
    let initial = element
        .require("initialState", "position, orientation, time, velocity")
        .and_then(|entry| state(&entry));
    if let Some(sets) = element.take("occupancySet") {
        return sets.reject("occupancies", "a trajectory of states");
    }
    let later: Option<Vec<State>> = element
        .take("trajectory")
        .map_or(Some(Vec::new()), |entry| {
            entry.all("state").map(|entry| state(&entry)).collect()
        });
    let (kind, body, initial, later) = (kind?, body?, initial?, later?);
    let name = named(element, kind, None);
    if body.off > 0.0 {
        let statement = format_args!(
            "its shape is {:.1} m off its position; the hull taken holds it on every side, as \
             CommonOcean's library turns shapes about their middle",
            body.off
        );
        remarks.note(&name, statement);
    }
    let states = [vec![initial], later].concat();
    let status = OF_RULE_18.contains(&kind).then(|| status::of_word(kind));
    let recorded = Recorded::new(element, name, body.hull, &states, step, remarks)?;
    Some(recorded.with_status(status.flatten()))
}
