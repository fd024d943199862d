//! A state: where a ship is, how she points and how fast she is, at a step.

use std::f64::consts::TAU;

use super::super::super::file::Range;
use super::super::super::limits;
use super::super::xml::Xml;
use super::shape::point;
use crate::frame::Vector;

/// Radians: twice the circle to either side.
const ANGLE: Range = Range::within(2.0 * TAU);
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
    /// m/s along the orientation, where it is said.
    pub(super) velocity: Option<f64>,
}

/// Reads a state; intervals and regions are refused.
pub(super) fn state(entry: &Xml) -> Option<State> {
    let position = entry
        .require("position", "a point")
        .and_then(|place| place.require("point", "x, y in metres"))
        .and_then(|place| point(&place));
    let orientation = match entry.take("orientation") {
        Some(angle) => angle.exact(ANGLE, "rad"),
        None => Some(0.0),
    };
    let time = entry.required_exact("time", STEPS, "steps");
    let velocity = match entry.take("velocity") {
        Some(velocity) => velocity.exact(VELOCITY, "m/s").map(Some),
        None => Some(None),
    };
    Some(State {
        position: position?,
        orientation: orientation?,
        time: time?,
        velocity: velocity?,
    })
}

/// Metres of a point.
pub(super) const COORDINATE: Range = limits::COORDINATE;
