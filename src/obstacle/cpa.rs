//! Closest point of approach to an obstacle: paper eq. (26), formulas section 5.

use super::contact::clip;
use super::{MovingVertex, PolytopeObstacle, SpaceTimeObstacle};
use crate::frame::{Vector, cross};
use crate::tolerance;

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
    let slope = |time: f64| {
        let away = obstacle.signed_distance(position + velocity * time, time);
        velocity.dot(&away.normal) - obstacle.support(away.normal, time).rate
    };
    let reached = |time: f64| {
        let away = obstacle.signed_distance(position + velocity * time, time);
        ClosestApproach {
            distance: away.distance.max(0.0),
            time,
            attained: true,
        }
    };
    let mut low = (0.0, slope(0.0));
    // a slope that is not a number ends the search where it is
    if !(low.1 < 0.0) || end <= 0.0 {
        return reached(0.0);
    }
    let guess = if guess.is_finite() { guess } else { 1.0 };
    let mut high = guess.clamp(f64::min(1.0, end), end);
    let mut high = loop {
        let found = slope(high);
        if !(found < 0.0) {
            break (high, found);
        }
        if high >= end {
            let last = reached(end);
            return if horizon > end {
                ClosestApproach {
                    time: f64::INFINITY,
                    attained: false,
                    ..last
                }
            } else {
                last
            };
        }
        low = (high, found);
        high = (2.0 * high).min(end);
    };
    // Illinois: the chord, with the weight of an end that stays put halved; the middle when it stalls
    let mut side = 0_i32;
    for _ in 0..200 {
        let width = high.0 - low.0;
        if width <= 4.0 * f64::EPSILON * high.0 {
            break;
        }
        let chord = low.0 - low.1 * width / (high.1 - low.1);
        let at = if side.abs() < 4 && chord > low.0 && chord < high.0 {
            chord
        } else {
            side = 0;
            low.0 + 0.5 * width
        };
        let found = slope(at);
        if found < 0.0 {
            if side < 0 {
                high.1 *= 0.5;
            }
            side = side.min(0) - 1;
            low = (at, found);
        } else if found > 0.0 {
            if side > 0 {
                low.1 *= 0.5;
            }
            side = side.max(0) + 1;
            high = (at, found);
        } else {
            return reached(at);
        }
        if found.abs() <= 1e-14 * velocity.norm() {
            return reached(at);
        }
    }
    reached(high.0)
}
