//! CommonOcean scenarios (XML 2022a, and 2020a with other names of some elements). Metres, m/s,
//! seconds; angles counter-clockwise from east in radians; times in steps.

mod geometry;
mod problem;

use roxmltree::Document;

use super::situation::{Declared, GivenHull, Other, Own, Situation};
use super::xml::Xml;
use crate::frame::{Pose, Vector, wrap};
use crate::input::{Fault, Faults, Range, abbreviated};
use crate::scenario::limits;
use crate::target::route::{RouteLeg, RoutePoint, Track};
use crate::text::is_line;
use crate::vessel::Hull;
use geometry::{Shape, State, shapes, state};

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

/// Elements that are read, or that say nothing about where ships may be.
const KNOWN: [&str; 12] = [
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
];

const VERSIONS: [&str; 2] = ["2022a", "2020a"];

/// The situations of a file, one per planning problem.
pub(super) fn situations(
    document: &Document,
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
    let mut notes = Vec::new();
    unused(&root, &mut notes);
    let problems: Vec<Xml> = root.all("planningProblem").collect();
    if problems.is_empty() {
        root.fault("no planningProblem", "at least one");
    }
    let others = step.and_then(|step| others(&root, step, &mut notes));
    let owns: Vec<Option<Own>> = problems
        .iter()
        .map(|entry| step.and_then(|step| problem::own(entry, step, &mut notes)))
        .collect();
    let noted = faults.take();
    let (Some(others), Some(name), true) = (others, name, noted.is_empty()) else {
        return Err(noted);
    };
    let several = owns.len() > 1;
    let situation = |(entry, own): (&Xml, Option<Own>)| {
        let id = several.then(|| format!("{name}-{}", entry.attribute("id").unwrap_or_default()));
        let own = own.ok_or_else(Vec::new)?;
        // relative to own ship's start: coordinates may be those of a global grid
        let origin = own.pose.position;
        let moved = |other: &Other| other.translated(-origin);
        Ok(Situation {
            name: id.clone().unwrap_or_else(|| name.to_owned()),
            id,
            own: Own {
                pose: Pose::new(Vector::zeros(), own.pose.heading),
                route: own.route.iter().map(|p| p - origin).collect(),
                ..own
            },
            others: others.iter().map(moved).collect(),
            earth: None,
            declared: Declared::default(),
            notes: notes.clone(),
        })
    };
    Ok(problems.iter().zip(owns).map(situation).collect())
}

fn unused(root: &Xml, notes: &mut Vec<String>) {
    let count = |name: &str| root.all(name).count();
    let ways = count("waterway") + count("waters");
    if ways > 0 {
        notes.push(format!(
            "{ways} waterways: not used, own ship may leave them"
        ));
    }
    for (name, said) in [
        ("navigationableArea", "not used, own ship may leave it"),
        ("trafficSign", "not used"),
    ] {
        if count(name) > 0 {
            notes.push(format!("{} {name}: {said}", count(name)));
        }
    }
    for element in root.elements().filter(|e| !KNOWN.contains(&e.name())) {
        notes.push(format!("{}: not used", element.path()));
    }
}

/// Every obstacle and every shallow. `None` if one is faulty.
fn others(root: &Xml, step: f64, notes: &mut Vec<String>) -> Option<Vec<Other>> {
    let mut others = Vec::new();
    let mut sound = true;
    for element in root.elements() {
        let found = match element.name() {
            "staticObstacle" => fixed(&element),
            "shallow" | "draft" => shallow(&element),
            "dynamicObstacle" => moving(&element, step, notes).map(|other| vec![other]),
            _ => continue,
        };
        match found {
            Some(found) => others.extend(found),
            None => sound = false,
        }
    }
    let shallows = root.all("shallow").count() + root.all("draft").count();
    if shallows > 0 {
        notes.push(format!(
            "{shallows} shallows: own draught is not in the file, so all are kept out of, \
             whatever their depth"
        ));
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
fn fixed(element: &Xml) -> Option<Vec<Other>> {
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
    let placed = parts.iter().enumerate().map(|(index, part)| Other::Fixed {
        name: named(element, kind, several.then_some(index)),
        shape: part
            .outline
            .rotated(initial.orientation)
            .translated(initial.position),
        ground,
    });
    Some(placed.collect())
}

fn shallow(element: &Xml) -> Option<Vec<Other>> {
    let parts = shapes(&element.require("shape", "a rectangle, circle or polygon")?)?;
    let several = parts.len() > 1;
    let part = |(index, part): (usize, Shape)| Other::Fixed {
        name: named(element, "shallow", several.then_some(index)),
        shape: part.outline,
        ground: true,
    };
    Some(parts.into_iter().enumerate().map(part).collect())
}

/// A ship with its recorded states.
fn moving(element: &Xml, step: f64, notes: &mut Vec<String>) -> Option<Other> {
    let kind = kind(element);
    let hull = match element.take("shape") {
        Some(entry) => shapes(&entry).and_then(|parts| hull(&entry, &parts)),
        None => Some(GivenHull::Missing(format!("{}/shape", element.path()))),
    };
    let initial = element
        .require("initialState", "position, orientation, time, velocity")
        .and_then(|entry| state(&entry));
    if let Some(sets) = element.take("occupancySet") {
        return sets.reject("occupancies", "a trajectory of states");
    }
    let states: Option<Vec<State>> = element
        .take("trajectory")
        .map_or(Some(Vec::new()), |entry| {
            entry.all("state").map(|entry| state(&entry)).collect()
        });
    let (kind, hull, initial, states) = (kind?, hull?, initial?, states?);
    let name = named(element, kind, None);
    let track = track(element, &initial, &states, step, &name, notes)?;
    Some(Other::Ship { name, hull, track })
}

fn hull(entry: &Xml, parts: &[Shape]) -> Option<GivenHull> {
    let [only] = parts else {
        return entry.reject(
            format_args!("{} shapes", parts.len()),
            "one shape, the hull of the ship",
        );
    };
    Some(GivenHull::Known(Hull::new(only.length, only.width)))
}

/// Track with a leg between consecutive states, at the speed that it takes.
fn track(
    element: &Xml,
    initial: &State,
    states: &[State],
    step: f64,
    name: &str,
    notes: &mut Vec<String>,
) -> Option<Track> {
    if states.len() > limits::TRACK_POINTS {
        return element.reject(
            format_args!("{} states", states.len()),
            format_args!("at most {}", limits::TRACK_POINTS),
        );
    }
    let appears = initial.time * step;
    let mut points = vec![RoutePoint {
        position: initial.position,
        turn_radius: Some(0.0),
    }];
    let mut legs: Vec<RouteLeg> = Vec::new();
    let (mut last, mut rests) = (*initial, 0);
    for state in states {
        let took = (state.time - last.time) * step;
        let way = (state.position - last.position).norm();
        if !(took > 0.0) {
            return element.reject(
                format_args!(
                    "a state of step {} after one of step {}",
                    state.time, last.time
                ),
                "states whose times increase",
            );
        }
        let speed = way / took;
        if !limits::SHIP_SPEED.contains(speed) {
            return element.reject(
                format_args!("{way:.1} m from step {} to step {}", last.time, state.time),
                format_args!("at most {} m/s between two states", limits::SHIP_SPEED.high),
            );
        }
        if way >= limits::LENGTH.low {
            points.push(RoutePoint {
                position: state.position,
                turn_radius: Some(0.0),
            });
            legs.push(RouteLeg {
                slow: if rests > 0 { 0.0 } else { speed },
                fast: speed,
            });
            rests = 0;
        } else {
            rests += 1;
        }
        last = *state;
    }
    // the motion after a rest at the end is unknown: the ship may stay
    if rests > 0
        && let Some(leg) = legs.last_mut()
    {
        leg.slow = 0.0;
    }
    let track = match legs.last() {
        None if states.is_empty() => Track::straight(
            initial.position,
            wrap(initial.orientation),
            initial.velocity?,
        ),
        None => Track::straight(initial.position, wrap(initial.orientation), 0.0),
        Some(_) => Track::along(&points, &legs, 0.0, None).ok()?,
    };
    if appears > 0.0 {
        notes.push(format!(
            "{name}: appears after {appears} s; taken to stand there until then"
        ));
    }
    Some(track.appearing(appears.max(0.0)))
}
