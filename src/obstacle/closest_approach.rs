//! Closest point of approach to an obstacle: paper eq. (26), docs/theory.md section 5.

use super::contact::clip;
use super::{MovingVertex, PolytopeObstacle, SpaceTimeObstacle};
use crate::frame::{Vector, cross};
use crate::tolerance;

/// Most distances of a search; ten are usual.
const MAX_LOOKS: usize = 200;

/// Of own speed. A distance that changes more slowly than this does not change.
const SLOPE: f64 = 1e-13;

/// The least distance to an obstacle and when it is reached.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ClosestApproach {
    /// dCPA, metres; 0 in contact.
    pub distance: f64,
    /// tCPA, seconds: the earliest instant at that distance, to [`tolerance::LENGTH_M`]; the first contact
    /// where there is one.
    pub time: f64,
    /// False when the distance goes on falling for ever without a horizon: then `distance` is what it falls to
    /// by [`tolerance::FOREVER_S`], and `time` is infinite.
    pub attained: bool,
}

impl ClosestApproach {
    /// In contact from `time` on.
    pub(super) fn contact(time: f64) -> Self {
        Self {
            distance: 0.0,
            time,
            attained: true,
        }
    }
}

/// What is not a number is in contact at once; a horizon that is none is infinite.
pub(super) fn usable_horizon(position: Vector, velocity: Vector, horizon: f64) -> Option<f64> {
    let finite = [position.x, position.y, velocity.x, velocity.y]
        .iter()
        .all(|v| v.is_finite());
    finite.then_some(if horizon.is_nan() {
        f64::INFINITY
    } else {
        horizon.max(0.0)
    })
}

/// The least of some candidates, and the least but one.
struct Nearest {
    squared: f64,
    time: f64,
    next: f64,
}

impl Nearest {
    fn offer(&mut self, squared: f64, time: f64) {
        if squared < self.squared {
            self.next = self.squared;
            self.squared = squared;
            self.time = time;
        } else if squared < self.next {
            self.next = squared;
        }
    }

    /// True when another candidate may be as near.
    fn is_tied(&self) -> bool {
        // (d + e)² from above
        self.next <= self.squared + 2.0 * tolerance::LENGTH_M * (1.0 + self.squared)
    }
}

/// The closest approach to a polytope in closed form: contact by its faces; otherwise the nearest point of the
/// hull of all relative positions lies on the way of a moving vertex, on an edge of `O_0`, or on an edge of the
/// section at the horizon. O(n + m).
pub(super) fn polytope_approach(
    obstacle: &PolytopeObstacle,
    position: Vector,
    velocity: Vector,
    horizon: f64,
) -> ClosestApproach {
    let Some(horizon) = usable_horizon(position, velocity, horizon) else {
        return ClosestApproach::contact(0.0);
    };
    if let Some(inside) = clip(obstacle, position, velocity, 0.0, horizon, 0.0) {
        return ClosestApproach::contact(inside.start);
    }
    let mut best = Nearest {
        squared: f64::INFINITY,
        time: 0.0,
        next: f64::INFINITY,
    };
    each_candidate(obstacle, position, velocity, horizon, |squared, time| {
        best.offer(squared, time);
    });
    let distance = best.squared.sqrt();
    let mut time = best.time;
    if time > 0.0 && best.is_tied() {
        each_candidate(obstacle, position, velocity, horizon, |squared, instant| {
            if instant < time && squared.sqrt() <= distance + tolerance::LENGTH_M {
                time = instant;
            }
        });
    }
    ClosestApproach {
        distance,
        time,
        attained: true,
    }
}

/// Offers squared distances and their times, the nearest among them, and the earliest of those that tie.
#[inline]
fn each_candidate(
    obstacle: &PolytopeObstacle,
    position: Vector,
    velocity: Vector,
    horizon: f64,
    mut offer: impl FnMut(f64, f64),
) {
    let moving = obstacle.moving();
    for vertex in moving {
        let (arm, relative) = (position - vertex.origin, velocity - vertex.velocity);
        let closing = -arm.dot(&relative);
        let mut time = 0.0;
        if closing > 0.0 {
            time = (closing / relative.norm_squared()).min(horizon);
        }
        offer((arm + relative * time).norm_squared(), time);
    }
    // the ends of the edges are vertices on their way
    let initial = obstacle.initial().vertices();
    let mut from = initial[initial.len() - 1];
    for to in initial {
        if let Some(squared) = beside_edge(position, from, *to) {
            offer(squared, 0.0);
        }
        from = *to;
    }
    if horizon.is_finite() {
        let end = position + velocity * horizon;
        let at = |vertex: &MovingVertex| vertex.origin + vertex.velocity * horizon;
        let mut from = at(&moving[moving.len() - 1]);
        for vertex in moving {
            let to = at(vertex);
            if let Some(squared) = beside_edge(end, from, to) {
                offer(squared, horizon);
            }
            from = to;
        }
    }
}

/// The squared distance from the line of an edge, where the nearest point is between its ends.
fn beside_edge(point: Vector, from: Vector, to: Vector) -> Option<f64> {
    let (arm, edge) = (point - from, to - from);
    let (along, squared) = (arm.dot(&edge), edge.norm_squared());
    (along > 0.0 && along < squared).then(|| cross(edge, arm).powi(2) / squared)
}

/// The shortest displacement from the edge to the point.
pub(super) fn from_edge(point: Vector, from: Vector, to: Vector) -> Vector {
    let (arm, edge) = (point - from, to - from);
    let squared = edge.norm_squared();
    if squared > 0.0 {
        arm - edge * (arm.dot(&edge) / squared).clamp(0.0, 1.0)
    } else {
        arm
    }
}

/// The closest approach to any convex obstacle that is not met within the horizon: the distance is convex in
/// time, and its derivative is `n . v - dh/dt (n, t)` with the normal `n` at the nearest point. Bracketed
/// root of it; some ten distances. The time is exact to rounding where the distance has a curvature.
pub(super) fn searched_approach<O: SpaceTimeObstacle>(
    obstacle: &O,
    position: Vector,
    velocity: Vector,
    horizon: f64,
    guess: f64,
) -> ClosestApproach {
    let end = horizon.min(tolerance::FOREVER_S);
    let look = |time: f64| {
        let away = obstacle.signed_distance(position + velocity * time, time);
        let slope = velocity.dot(&away.normal) - obstacle.support(away.normal, time).rate;
        Look {
            time,
            slope,
            distance: away.distance.max(0.0),
        }
    };
    let mut low = look(0.0);
    // a slope that is not a number ends the search where it is
    if !(low.slope < 0.0) || end <= 0.0 {
        return low.reached();
    }
    let guess = if guess.is_finite() { guess } else { 1.0 };
    let mut high = look(guess.clamp(f64::min(1.0, end), end));
    while high.slope < 0.0 {
        if high.time >= end {
            return if horizon > end {
                ClosestApproach {
                    time: f64::INFINITY,
                    attained: false,
                    ..high.reached()
                }
            } else {
                high.reached()
            };
        }
        low = high;
        high = look((2.0 * high.time).min(end));
    }
    let flat = SLOPE * velocity.norm();
    // the chord, with the weight of an end that stays put reduced (Anderson and Björck 1973); the middle when
    // three steps have not halved the bracket, as where the nearest point rounds the end of a needle
    let (mut weight_low, mut weight_high) = (low.slope, high.slope);
    let mut side = 0_i32;
    let mut widths = [f64::INFINITY; 3];
    for _ in 0..MAX_LOOKS {
        let width = high.time - low.time;
        if width <= 4.0 * f64::EPSILON * high.time {
            break;
        }
        let chord = low.time - weight_low * width / (weight_high - weight_low);
        let halved = width <= 0.5 * widths[0];
        widths = [widths[1], widths[2], width];
        let at = if halved && chord > low.time && chord < high.time {
            chord
        } else {
            side = 0;
            low.time + 0.5 * width
        };
        let found = look(at);
        if !(found.slope.abs() > flat) {
            return found.reached();
        }
        if found.slope < 0.0 {
            if side < 0 {
                weight_high *= reduction(found.slope, weight_low);
            }
            side = side.min(0) - 1;
            (low, weight_low) = (found, found.slope);
        } else {
            if side > 0 {
                weight_low *= reduction(found.slope, weight_high);
            }
            side = side.max(0) + 1;
            (high, weight_high) = (found, found.slope);
        }
    }
    high.reached()
}

/// How near at one instant, and how fast that changes.
#[derive(Clone, Copy)]
struct Look {
    time: f64,
    slope: f64,
    distance: f64,
}

impl Look {
    fn reached(&self) -> ClosestApproach {
        ClosestApproach {
            distance: self.distance,
            time: self.time,
            attained: true,
        }
    }
}

fn reduction(found: f64, before: f64) -> f64 {
    let share = 1.0 - found / before;
    if share > 0.0 { share } else { 0.5 }
}
