//! Shapes (rectangles, circles, polygons) in convex parts, and states of ships at a step.

use std::f64::consts::TAU;

use super::super::situation::GivenHull;
use super::super::xml::Xml;
use crate::limits;
use searoom_geometry::frame::{Pose, Vector};
use searoom_geometry::{ConvexPolygon, outer_disc};
use searoom_input::{Range, every};
use searoom_model::vessel::Hull;

/// Metres: sizes of objects and regions.
const SIZE: Range = Range::between(1e-3, 1e6);
/// Radians.
const ANGLE: Range = Range::within(4.0 * std::f64::consts::PI);

/// A hull, and how far its shape is off the position of the ship.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Body {
    pub(super) hull: GivenHull,
    /// Metres from the position to the middle of the shape.
    pub(super) off: f64,
}

/// A point in metres.
pub(super) fn point(entry: &Xml) -> Option<Vector> {
    let x = entry.required_number("x", limits::COORDINATE.in_unit("m"));
    let y = entry.required_number("y", limits::COORDINATE.in_unit("m"));
    Some(Vector::new(x?, y?))
}

/// The hull of a ship from its only shape, equally far to both sides of its position. A shape with a
/// size of 0 is of unknown size, as ships that tell none by AIS are written.
///
/// The format does not say about which point a shape is turned. Here it is the position of the ship;
/// CommonOcean's library (commonocean-io 2025.1) turns it about its own middle, which stays as far
/// east and north of the position as the file has it (`findings/commonocean-off-centre-shape.sh`). The hull
/// holds both: the shape about its middle, on every side of the position.
pub(super) fn body(entry: &Xml) -> Option<Body> {
    let all: Vec<Xml> = entry.elements().collect();
    let [only] = &all[..] else {
        return entry.reject(
            format_args!("{} shapes", all.len()),
            "one shape, the hull of the ship",
        );
    };
    let sizes = |names: [&str; 2]| {
        let sizes = names.map(|name| only.required_number(name, SIZE.or_zero().in_unit("m")));
        Some([sizes[0]?, sizes[1]?].map(|size| Some(size).filter(|size| *size > 0.0)))
    };
    let [length, beam] = match only.name() {
        "rectangle" => sizes(["length", "width"])?,
        "circle" => sizes(["radius"; 2])?,
        _ => [Some(0.0); 2],
    };
    if length.is_none() || beam.is_none() {
        if let Some(center) = only.take("center") {
            let middle = point(&center)?;
            if middle != Vector::zeros() {
                return center.reject("a middle of a shape without size", "0, 0, or none");
            }
        }
        let hull = GivenHull::Unknown { length, beam };
        return Some(Body { hull, off: 0.0 });
    }
    let outline = one(only)?;
    let middle = match only.take("center") {
        Some(center) if only.name() != "polygon" => point(&center)?,
        None if only.name() != "polygon" => Vector::zeros(),
        _ => outline.centroid(),
    };
    let off = match middle.norm() {
        // no more than the rounding of a centroid
        off if off > limits::LENGTH.low => off,
        _ => 0.0,
    };
    let reach = |axis: Vector| {
        let side = |axis: Vector| match off > 0.0 {
            true => outline.support(axis) - middle.dot(&axis) + off,
            false => outline.support(axis),
        };
        2.0 * side(axis).max(side(-axis))
    };
    Some(Body {
        hull: GivenHull::Known(Hull::new(reach(Vector::x()), reach(Vector::y()))),
        off,
    })
}

/// The shapes in an element, at least one.
pub(super) fn shapes(entry: &Xml) -> Option<Vec<ConvexPolygon>> {
    if entry.elements().next().is_none() {
        return entry.reject("no shape", "a rectangle, a circle or a polygon");
    }
    every(entry.elements().map(|shape| one(&shape)))
}

fn one(entry: &Xml) -> Option<ConvexPolygon> {
    let center = (entry.take("center")).map_or(Some(Vector::zeros()), |center| point(&center))?;
    match entry.name() {
        "rectangle" => {
            let length = entry.required_number("length", SIZE.in_unit("m"));
            let width = entry.required_number("width", SIZE.in_unit("m"));
            let angle = entry.take("orientation");
            let angle = angle.map_or(Some(0.0), |angle| angle.number(ANGLE.in_unit("rad")))?;
            let hull = Hull::new(length?, width?);
            Some(hull.polygon(&Pose::new(center, angle)))
        }
        "circle" => {
            let radius = entry.required_number("radius", SIZE.in_unit("m"))?;
            Some(outer_disc(radius, 0.0).translated(center))
        }
        "polygon" => {
            let points = every(entry.all("point").map(|p| point(&p)))?;
            let count = points.len();
            if !(3..=limits::TRACK_POINTS).contains(&count) {
                return entry.reject(format_args!("{count} points"), "at least 3");
            }
            // an outer approximation: a bay becomes land
            ConvexPolygon::hull(&points).ok()
        }
        other => entry.reject(other, "a rectangle, a circle or a polygon"),
    }
}

/// Radians: twice the circle to either side.
const HEADING: Range = Range::within(2.0 * TAU);
/// Steps.
const STEPS: Range = Range::between(0.0, 1e9);
/// m/s; astern is negative.
const VELOCITY: Range = Range::within(50.0);

/// A state whose values are exact.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct State {
    /// Metres.
    pub(super) position: Vector,
    /// Radians, counter-clockwise from east.
    pub(super) orientation: f64,
    /// Steps.
    pub(super) time: f64,
    /// m/s along the orientation, if the file has it.
    pub(super) velocity: Option<f64>,
}

/// Reads a state; intervals and regions are refused.
pub(super) fn state(entry: &Xml) -> Option<State> {
    let position = entry
        .require("position", "a point")
        .and_then(|place| place.require("point", "x, y in metres"))
        .and_then(|place| point(&place));
    let orientation = entry.take("orientation");
    let orientation = orientation.map_or(Some(0.0), |angle| angle.exact(HEADING.in_unit("rad")));
    let steps = STEPS.in_unit("steps");
    let time = entry.require("time", steps).and_then(|t| t.exact(steps));
    let velocity = entry.take("velocity");
    let velocity = velocity.map_or(Some(None), |v| v.exact(VELOCITY.in_unit("m/s")).map(Some));
    Some(State {
        position: position?,
        orientation: orientation?,
        time: time?,
        velocity: velocity?,
    })
}
