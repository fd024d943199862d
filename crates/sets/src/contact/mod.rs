//! First contact of a line or an arc in time with a space-time polytope: exact,
//! docs/reference/theory.md section 10 (iv) and (v).
//!
//! Contact at depth `d` is contact with the body whose faces are moved inward by `d` metres. At
//! depth 0 this is the closed set itself; at a positive depth touching does not count.

use std::f64::consts::{PI, TAU};

pub(crate) mod advancement;
mod decision;

pub use decision::meets;

use crate::{HalfSpace, PolytopeObstacle};
use searoom_geometry::frame::{Vector, heading_of, to_port};
use searoom_model::trajectory::Segment;

/// A time interval, seconds.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Interval {
    /// First instant.
    pub start: f64,
    /// Last instant.
    pub end: f64,
}

/// A straight motion: `origin` is own ship's position at t = 0, extrapolated from `[start, end]`.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Line {
    pub origin: Vector,
    pub velocity: Vector,
    pub start: f64,
    pub end: f64,
}

impl Line {
    /// The motion from `origin` at t = 0 to `end` seconds.
    pub(crate) fn ahead(origin: Vector, velocity: Vector, end: f64) -> Self {
        Self {
            origin,
            velocity,
            start: 0.0,
            end,
        }
    }

    /// The motion of a straight segment, from t = 0 on.
    pub(crate) fn of(segment: &Segment) -> Self {
        let velocity = segment.start.ahead() * segment.speed;
        Self {
            origin: segment.start.position - velocity * segment.start_time,
            velocity,
            start: segment.start_time.max(0.0),
            end: segment.end_time(),
        }
    }
}

/// Longest arc per chord, radians.
pub(crate) const CHORD_RAD: f64 = 0.4;

/// The first time at which the segment is at least `depth` metres inside the obstacle, or `None`.
///
/// A segment or depth that is not finite is in contact at once. Obstacles exist from t = 0 on.
/// O(n + m) on a line; O((n + m)(1 + turn/pi)) root findings on an arc that comes near.
pub fn first_contact(obstacle: &PolytopeObstacle, segment: &Segment, depth: f64) -> Option<f64> {
    if !(segment.is_valid() && depth.is_finite()) {
        return Some(segment.start_time);
    }
    if segment.end_time() < 0.0 {
        return None;
    }
    if segment.is_arc() {
        arc_contacts(obstacle, segment, depth)
            .first()
            .map(|i| i.start)
    } else {
        line_contact(obstacle, segment, depth).map(|i| i.start)
    }
}

/// The interval during which a straight segment (or a wait) is at least `depth` inside, in O(n +
/// m).
///
/// Cyrus-Beck clipping by the faces, docs/reference/theory.md section 10 (iv). The body is convex,
/// so there is at most one interval.
pub fn line_contact(obstacle: &PolytopeObstacle, line: &Segment, depth: f64) -> Option<Interval> {
    clip(obstacle, &Line::of(line), depth)
}

/// [`line_contact`] of a motion whose end may be infinite.
pub(crate) fn clip(obstacle: &PolytopeObstacle, line: &Line, depth: f64) -> Option<Interval> {
    let mut inside = Interval {
        start: line.start,
        end: line.end,
    };
    if inside.start > inside.end {
        return None;
    }
    for face in obstacle.faces() {
        let rate = face.normal.dot(&line.velocity) - face.velocity_support;
        let reach = face.initial_support - depth - face.normal.dot(&line.origin);
        if rate > 0.0 {
            inside.end = inside.end.min(reach / rate);
        } else if rate < 0.0 {
            inside.start = inside.start.max(reach / rate);
        } else if reach < 0.0 {
            return None;
        }
        if inside.start > inside.end {
            return None;
        }
    }
    Some(inside)
}

/// All intervals during which an arc is at least `depth` inside, in order.
///
/// An arc can leave and enter again. Each face gives the roots between its stationary points,
/// docs/reference/theory.md section 10 (v).
pub fn arc_contacts(obstacle: &PolytopeObstacle, arc: &Segment, depth: f64) -> Vec<Interval> {
    let start = arc.start_time.max(0.0);
    let mut inside = vec![Interval {
        start,
        end: arc.end_time(),
    }];
    if inside[0].start > inside[0].end {
        return Vec::new();
    }
    let circle = Circle::of(arc);
    for face in obstacle.faces() {
        let below = circle.below(face, depth, start, arc.end_time());
        inside = intersect(&inside, &below);
        if inside.is_empty() {
            break;
        }
    }
    inside
}

/// An arc as `centre + radius e(phase + rate t)`.
struct Circle {
    centre: Vector,
    radius: f64,
    phase: f64,
    rate: f64,
}

impl Circle {
    fn of(arc: &Segment) -> Self {
        let radius = arc.radius();
        let quarter = if radius > 0.0 { -PI / 2.0 } else { PI / 2.0 };
        Self {
            centre: arc.start.position + to_port(arc.start.ahead()) * radius,
            radius: radius.abs(),
            phase: arc.start.heading + quarter - arc.turn_rate * arc.start_time,
            rate: arc.turn_rate,
        }
    }

    /// The intervals of `[from, to]` in which the arc is at least `depth` behind the face.
    fn below(&self, face: &HalfSpace, depth: f64, from: f64, to: f64) -> Vec<Interval> {
        let offset = face.normal.dot(&self.centre) - face.initial_support + depth;
        let phase = self.phase - heading_of(face.normal);
        let value = |t: f64| {
            offset + self.radius * (phase + self.rate * t).cos() - face.velocity_support * t
        };
        let mut cuts = vec![from];
        let k = -face.velocity_support / (self.radius * self.rate);
        if k.abs() < 1.0 {
            let (low, high) = {
                let (a, b) = (phase + self.rate * from, phase + self.rate * to);
                (a.min(b), a.max(b))
            };
            for base in [k.asin(), PI - k.asin()] {
                let first = ((low - base) / TAU).ceil();
                let mut angle = base + TAU * first;
                while angle < high {
                    cuts.push(((angle - phase) / self.rate).clamp(from, to));
                    angle += TAU;
                }
            }
            cuts.sort_by(f64::total_cmp);
        }
        cuts.push(to);
        let mut below: Vec<Interval> = Vec::new();
        let mut keep = |start: f64, end: f64| match below.last_mut() {
            Some(last) if last.end >= start => last.end = last.end.max(end),
            _ => below.push(Interval { start, end }),
        };
        for pair in cuts.windows(2) {
            let (a, b) = (pair[0], pair[1]);
            let (fa, fb) = (value(a), value(b));
            match (fa <= 0.0, fb <= 0.0) {
                (true, true) => keep(a, b),
                // the outer end of the root's bracket: the interval errs to the long side
                (true, false) => keep(a, bisect(value, a, b).1),
                (false, true) => keep(bisect(value, b, a).1, b),
                (false, false) => {}
            }
        }
        below
    }
}

/// Root of a monotone function, given a point where it is `<= 0` and one where it is positive.
///
/// Returns the pair (last point `<= 0`, first point `> 0`), adjacent to rounding.
fn bisect(value: impl Fn(f64) -> f64, mut inside: f64, mut outside: f64) -> (f64, f64) {
    let (mut fi, mut fo) = (value(inside), value(outside));
    for step in 0..100 {
        let width = outside - inside;
        if width.abs() <= 1e-12 * (1.0 + inside.abs()) {
            break;
        }
        // alternating secant and bisection steps: the bracket halves at least every second step
        let chord = inside + width * (fi / (fi - fo));
        let at = if step % 2 == 0 && chord.is_finite() {
            let guard = 1e-3 * width;
            let (low, high) = (inside + guard, outside - guard);
            chord.clamp(low.min(high), low.max(high))
        } else {
            inside + 0.5 * width
        };
        let f = value(at);
        if f <= 0.0 {
            (inside, fi) = (at, f);
        } else {
            (outside, fo) = (at, f);
        }
    }
    (inside, outside)
}

fn intersect(a: &[Interval], b: &[Interval]) -> Vec<Interval> {
    let mut both = Vec::with_capacity(a.len() + b.len());
    for x in a {
        for y in b {
            let part = Interval {
                start: x.start.max(y.start),
                end: x.end.min(y.end),
            };
            if part.start <= part.end {
                both.push(part);
            }
        }
    }
    both
}

#[cfg(test)]
mod tests {
    mod parry;

    use super::*;
    use searoom_geometry::ConvexPolygon;
    use searoom_geometry::frame::Pose;

    #[test]
    fn an_arc_that_leaves_and_enters_again_has_two_contacts() {
        let wall = ConvexPolygon::rectangle(Vector::zeros(), 300.0, 10.0);
        let o = PolytopeObstacle::new("wall", wall, ConvexPolygon::point(Vector::zeros()));
        let arc = Segment::new(Pose::new(Vector::new(0.0, 0.0), 0.2), 0.0, 130.0, 5.0, 0.05);
        assert_eq!(arc_contacts(&o, &arc, 0.0).len(), 2);
    }

    #[test]
    fn touching_counts_only_at_depth_zero() {
        let square = searoom_geometry::outer_disc(10.0, 0.0);
        let o = PolytopeObstacle::new("still", square, ConvexPolygon::point(Vector::zeros()));
        let along = Segment::straight(Pose::new(Vector::new(-100.0, 10.0), 0.0), 0.0, 40.0, 5.0);
        assert!(first_contact(&o, &along, 0.0).is_some());
        assert!(first_contact(&o, &along, 1e-9).is_none());
    }
}
