//! Closest point of approach to an obstacle: paper eq. (26), docs/reference/theory.md section 5.

use super::contact::{Line, clip};
use super::{MovingVertex, PolytopeObstacle, SpaceTimeObstacle};
use searoom_geometry::frame::{Vector, cross};
use searoom_geometry::tolerance;

/// Bound on the distance evaluations of a search; ten are usual.
const MAX_EVALUATIONS: usize = 200;

/// Relative to own speed. A distance that changes more slowly is constant.
const SLOPE: f64 = 1e-13;

/// The least distance to an obstacle and its time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ClosestApproach {
    /// dCPA, metres; 0 in contact.
    pub distance: f64,
    /// tCPA, seconds: the earliest time of that distance, to [`tolerance::LENGTH_M`], or of the
    /// first contact.
    pub time: f64,
    /// False when the distance decreases for ever, which needs an infinite horizon. Then `distance`
    /// is its value at [`tolerance::FOREVER_S`], and `time` is infinite.
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

/// [`from_zero`]; `None` where position or velocity is not finite,
/// which counts as contact at once.
pub(super) fn usable_horizon(position: Vector, velocity: Vector, horizon: f64) -> Option<f64> {
    let finite = [position.x, position.y, velocity.x, velocity.y]
        .iter()
        .all(|v| v.is_finite());
    finite.then_some(from_zero(horizon))
}

/// The horizon, at least 0; infinite for a NaN.
pub(super) fn from_zero(horizon: f64) -> f64 {
    if horizon.is_nan() {
        f64::INFINITY
    } else {
        horizon.max(0.0)
    }
}

/// The smallest and the second smallest candidate.
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

    /// True when another candidate may be equally near.
    fn is_tied(&self) -> bool {
        // (d + e)² bounded from above
        self.next <= self.squared + 2.0 * tolerance::LENGTH_M * (1.0 + self.squared)
    }
}

/// The closest approach to a polytope in closed form, in O(n + m).
///
/// Contact follows from the faces. Otherwise the nearest point of the hull of all relative
/// positions lies on the track of a moving vertex, on an edge of `O_0`, or on an edge of the
/// section at the horizon.
pub(super) fn polytope_approach(
    obstacle: &PolytopeObstacle,
    position: Vector,
    velocity: Vector,
    horizon: f64,
) -> ClosestApproach {
    let Some(horizon) = usable_horizon(position, velocity, horizon) else {
        return ClosestApproach::contact(0.0);
    };
    if let Some(inside) = clip(obstacle, &Line::ahead(position, velocity, horizon), 0.0) {
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

/// Offers squared distances and their times, among them the nearest, and the earliest of equal
/// ones.
#[inline]
fn each_candidate(
    obstacle: &PolytopeObstacle,
    position: Vector,
    velocity: Vector,
    horizon: f64,
    mut offer: impl FnMut(f64, f64),
) {
    let moving = obstacle.moving_vertices();
    for vertex in moving {
        let (arm, relative) = (position - vertex.origin, velocity - vertex.velocity);
        let closing = -arm.dot(&relative);
        let mut time = 0.0;
        if closing > 0.0 {
            time = (closing / relative.norm_squared()).min(horizon);
        }
        offer((arm + relative * time).norm_squared(), time);
    }
    // the ends of edges are covered by the moving vertices
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

/// Squared distance from the line of an edge, where the nearest point lies between its ends.
fn beside_edge(point: Vector, from: Vector, to: Vector) -> Option<f64> {
    let (arm, edge) = (point - from, to - from);
    let (along, squared) = (arm.dot(&edge), edge.norm_squared());
    (along > 0.0 && along < squared).then(|| cross(edge, arm).powi(2) / squared)
}

/// Shortest displacement from the edge to the point.
pub(super) fn from_edge(point: Vector, from: Vector, to: Vector) -> Vector {
    let (arm, edge) = (point - from, to - from);
    let squared = edge.norm_squared();
    if squared > 0.0 {
        arm - edge * (arm.dot(&edge) / squared).clamp(0.0, 1.0)
    } else {
        arm
    }
}

/// The closest approach to a convex obstacle that is not met within the horizon, in about ten
/// distance evaluations.
///
/// The distance is convex in time, and its derivative is `n . v - dh/dt (n, t)` with the normal `n`
/// at the nearest point. A bracketing search finds the root of the derivative. The time is exact to
/// rounding where the distance has curvature.
pub(super) fn searched_approach<O: SpaceTimeObstacle>(
    obstacle: &O,
    position: Vector,
    velocity: Vector,
    horizon: f64,
    guess: f64,
) -> ClosestApproach {
    let end = horizon.min(tolerance::FOREVER_S);
    let sample = |time: f64| {
        let away = obstacle.signed_distance(position + velocity * time, time);
        let slope = velocity.dot(&away.normal) - obstacle.support(away.normal, time).rate;
        Sample {
            time,
            slope,
            distance: away.distance.max(0.0),
        }
    };
    let mut low = sample(0.0);
    // a NaN slope ends the search at the start
    if !(low.slope < 0.0) || end <= 0.0 {
        return low.reached();
    }
    let guess = if guess.is_finite() { guess } else { 1.0 };
    let mut high = sample(guess.clamp(f64::min(1.0, end), end));
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
        high = sample((2.0 * high.time).min(end));
    }
    let flat = SLOPE * velocity.norm();
    // regula falsi with the retained end's weight reduced (Anderson and Björck 1973); bisection
    // when three steps have not halved the bracket, as near the rounded end of a needle
    let (mut weight_low, mut weight_high) = (low.slope, high.slope);
    let mut side = 0_i32;
    let mut widths = [f64::INFINITY; 3];
    for _ in 0..MAX_EVALUATIONS {
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
        let found = sample(at);
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

/// Distance at one time, and its derivative.
#[derive(Clone, Copy)]
struct Sample {
    time: f64,
    slope: f64,
    distance: f64,
}

impl Sample {
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
