//! A ship with recorded states, and its track from the step at which own ship begins.

use super::super::situation::{GivenHull, Other};
use super::super::xml::Xml;
use super::geometry::State;
use crate::limits;
use searoom_geometry::frame::{Vector, direction, wrap};
use searoom_input::Remarks;
use searoom_model::target::Status;
use searoom_model::target::route::{RouteLeg, RoutePoint, Track};

/// A recorded ship. Steps beyond the speed of any ship, as a late report by AIS makes them, are taken
/// out of its places: the ship is then off them by at most the sum of these steps.
#[derive(Debug, Clone)]
pub(super) struct Recorded {
    name: String,
    hull: GivenHull,
    status: Option<Status>,
    /// Radians and m/s at the first state.
    orientation: f64,
    velocity: Option<f64>,
    places: Vec<Place>,
}

/// A state without the steps before it that are beyond the speed of any ship.
#[derive(Debug, Clone, Copy)]
struct Place {
    /// In steps.
    time: f64,
    /// Metres.
    position: Vector,
    /// The sum of these steps, metres: position and this are the recorded position.
    off: Vector,
}

impl Recorded {
    /// With a navigational status.
    pub(super) fn with_status(self, status: Option<Status>) -> Self {
        Self { status, ..self }
    }

    /// Checks the states. Where most of the steps are too fast their units are wrong, which is a
    /// fault.
    pub(super) fn new(
        element: &Xml,
        name: String,
        hull: GivenHull,
        states: &[State],
        step: f64,
        remarks: &mut Remarks,
    ) -> Option<Self> {
        if states.len() > limits::TRACK_POINTS {
            return element.reject(
                format_args!("{} states", states.len()),
                format_args!("at most {}", limits::TRACK_POINTS),
            );
        }
        let initial = states.first()?;
        let mut jumps: Vec<(f64, &State, &State)> = Vec::new();
        let mut velocity = match initial.velocity {
            Some(speed) => direction(initial.orientation) * speed,
            None => Vector::zeros(),
        };
        let mut last = Place {
            time: initial.time,
            position: initial.position,
            off: Vector::zeros(),
        };
        let mut places = vec![last];
        for pair in states.windows(2) {
            let [before, here] = [&pair[0], &pair[1]];
            let took = (here.time - before.time) * step;
            let way = here.position - before.position;
            if !(took > 0.0) {
                return element.reject(
                    format_args!(
                        "a state of step {} after one of step {}",
                        here.time, before.time
                    ),
                    "states whose times increase",
                );
            }
            match limits::SHIP_SPEED.contains(way.norm() / took) {
                true => velocity = way / took,
                false => {
                    last.off += way - velocity * took;
                    jumps.push((way.norm(), before, here));
                }
            }
            last.position = here.position - last.off;
            last.time = here.time;
            places.push(last);
        }
        if let Some((way, before, here)) = jumps.first() {
            if 2 * jumps.len() >= states.len() - 1 {
                return element.reject(
                    format_args!("{way:.1} m from step {} to step {}", before.time, here.time),
                    format_args!("at most {} m/s between two states", limits::SHIP_SPEED.high),
                );
            }
            let statement = format_args!(
                "{} of its steps are beyond {} m/s, the first of {way:.0} m at step {}; they are \
                 taken as gaps, and its sets hold it before and after them",
                jumps.len(),
                limits::SHIP_SPEED.high,
                here.time
            );
            remarks.note(&name, statement);
        }
        if states.len() == 1 && initial.velocity.is_none() {
            return element.reject(
                "one state without a velocity",
                "a velocity, or a trajectory",
            );
        }
        Some(Self {
            name,
            hull,
            status: None,
            orientation: initial.orientation,
            velocity: initial.velocity,
            places,
        })
    }

    /// The ship from a step on, the time of which is then 0. It has a leg between consecutive states,
    /// at the speed that it takes. `None` for one that is gone by then.
    pub(super) fn from(&self, begins: f64, step: f64, remarks: &mut Remarks) -> Option<Other> {
        let (first, last) = (self.places.first()?, self.places.last()?);
        let is_single = self.places.len() == 1;
        if last.time < begins && !is_single {
            let statement = format_args!(
                "left out: gone after step {}, before own ship's step {begins}",
                last.time
            );
            remarks.caution(format_args!("'{}'", self.name), statement);
            return None;
        }
        let velocity = direction(self.orientation) * self.velocity.unwrap_or(0.0);
        let start = match self.places.windows(2).find(|pair| pair[1].time > begins) {
            _ if first.time >= begins => *first,
            Some(pair) => {
                let share = (begins - pair[0].time) / (pair[1].time - pair[0].time);
                Place {
                    time: begins,
                    position: pair[0].position + share * (pair[1].position - pair[0].position),
                    off: pair[0].off,
                }
            }
            None if is_single => Place {
                time: begins,
                position: first.position + velocity * ((begins - first.time) * step),
                ..*first
            },
            None => *last,
        };
        let later = self.places.iter().filter(|place| place.time > start.time);
        let off = later.clone().map(|place| (place.off - start.off).norm());
        let off = off.fold(0.0, f64::max);
        let mut points = vec![point(start.position)];
        let mut legs: Vec<RouteLeg> = Vec::new();
        let (mut before, mut rests) = (start, 0);
        for place in later {
            let way = (place.position - before.position).norm();
            let speed = way / ((place.time - before.time) * step);
            if way >= limits::LENGTH.low {
                points.push(point(place.position));
                legs.push(RouteLeg {
                    slow: if rests > 0 { 0.0 } else { speed },
                    fast: speed,
                });
                rests = 0;
            } else {
                rests += 1;
            }
            before = *place;
        }
        // the motion after a rest at the end is unknown: the ship may stay
        if rests > 0
            && let Some(leg) = legs.last_mut()
        {
            leg.slow = 0.0;
        }
        let speed = if is_single { velocity.norm() } else { 0.0 };
        let astern = self.velocity.is_some_and(|speed| speed < 0.0);
        let heading = wrap(self.orientation + if astern { std::f64::consts::PI } else { 0.0 });
        let mut track = match legs.is_empty() {
            true => Track::straight(start.position, heading, speed),
            false => Track::along(&points, &legs, 0.0, None).ok()?,
        };
        // what is off the places at own ship's first step is no error: the ship is there
        track.translate(start.off);
        let appears = (start.time - begins) * step;
        if appears > 0.0 {
            let statement =
                format_args!("appears after {appears} s; taken to stand there until then");
            remarks.note(&self.name, statement);
        }
        Some(Other::Ship {
            name: self.name.clone(),
            hull: self.hull.clone(),
            track: track.appearing(appears.max(0.0)),
            off,
            status: self.status,
        })
    }
}

fn point(position: Vector) -> RoutePoint {
    RoutePoint {
        position,
        turn_radius: Some(0.0),
    }
}
