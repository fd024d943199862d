//! Shapes (rectangles, circles, polygons) in convex parts, and states of ships at a step.

use std::f64::consts::TAU;

use super::super::xml::Xml;
use crate::frame::{Pose, Vector};
use crate::geometry::{ConvexPolygon, outer_disc};
use crate::input::{Range, every};
use crate::scenario::limits;
use crate::vessel::Hull;

/// Metres: sizes of objects and regions.
const SIZE: Range = Range::between(1e-3, 1e6);
/// Radians.
const ANGLE: Range = Range::within(4.0 * std::f64::consts::PI);

#[derive(Debug, Clone, PartialEq)]
pub(super) struct Shape {
    /// Metres.
    pub(super) outline: ConvexPolygon,
    /// Size of a hull that contains it, along and across.
    pub(super) length: f64,
    pub(super) width: f64,
}

/// A point in metres.
pub(super) fn point(entry: &Xml) -> Option<Vector> {
    let x = entry.required_number("x", limits::COORDINATE.in_unit("m"));
    let y = entry.required_number("y", limits::COORDINATE.in_unit("m"));
    Some(Vector::new(x?, y?))
}

/// The shapes in an element, at least one.
pub(super) fn shapes(entry: &Xml) -> Option<Vec<Shape>> {
    if entry.elements().next().is_none() {
        return entry.reject("no shape", "a rectangle, a circle or a polygon");
    }
    every(entry.elements().map(|shape| one(&shape)))
}

fn one(entry: &Xml) -> Option<Shape> {
    let center = (entry.take("center")).map_or(Some(Vector::zeros()), |center| point(&center))?;
    let outline = match entry.name() {
        "rectangle" => {
            let length = entry.required_number("length", SIZE.in_unit("m"));
            let width = entry.required_number("width", SIZE.in_unit("m"));
            let angle = entry.take("orientation");
            let angle = angle.map_or(Some(0.0), |angle| angle.number(ANGLE.in_unit("rad")))?;
            let hull = Hull::new(length?, width?);
            hull.polygon(&Pose::new(center, angle))
        }
        "circle" => {
            let radius = entry.required_number("radius", SIZE.in_unit("m"))?;
            outer_disc(radius, 0.0).translated(center)
        }
        "polygon" => {
            let points = every(entry.all("point").map(|p| point(&p)))?;
            let count = points.len();
            if !(3..=limits::TRACK_POINTS).contains(&count) {
                return entry.reject(format_args!("{count} points"), "at least 3");
            }
            // an outer approximation: a bay becomes land
            ConvexPolygon::hull(&points).ok()?
        }
        other => {
            return entry.reject(other, "a rectangle, a circle or a polygon");
        }
    };
    let reach = |axis: Vector| 2.0 * outline.support(axis).max(outline.support(-axis));
    Some(Shape {
        length: reach(Vector::x()),
        width: reach(Vector::y()),
        outline,
    })
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
