//! First contact of a straight motion with an ellipsoid obstacle, as the root of a cubic;
//! docs/reference/theory.md sections 3 and 10.

use crate::EllipsoidObstacle;
use crate::contact::{self, Interval, Line};
use crate::ellipsoid::MAX_STEPS;
use searoom_geometry::frame::{Vector, cross};
use searoom_geometry::tolerance;
use searoom_model::trajectory::Segment;

/// A cubic without its constant term: coefficients of `s`, `s²`, `s³`, `s = t - about`.
struct Cubic {
    about: f64,
    slopes: [f64; 3],
}

impl Cubic {
    fn slope(&self, time: f64) -> f64 {
        let [c1, c2, c3] = self.slopes;
        let s = time - self.about;
        c1 + s * (2.0 * c2 + 3.0 * s * c3)
    }

    /// Zeros of the slope; infinite or NaN where there are none.
    fn turning_points(&self) -> [f64; 2] {
        let [c1, c2, c3] = self.slopes;
        let (a, b, c) = (3.0 * c3, 2.0 * c2, c1);
        let discriminant = b * b - 4.0 * a * c;
        let q = -0.5 * (b + discriminant.max(0.0).sqrt().copysign(b));
        if discriminant >= 0.0 {
            [self.about + q / a, self.about + c / q]
        } else {
            [f64::NAN; 2]
        }
    }
}

impl EllipsoidObstacle {
    /// The interval during which a line (or a wait) is inside, from t = 0 on; at most one exists.
    /// O(1).
    pub fn line_contact(&self, line: &Segment) -> Option<Interval> {
        if let Some(flat) = &self.flat {
            return contact::line_contact(flat, line, 0.0);
        }
        let line = Line::of(line);
        let cubic = self.cubic(&line);
        let cuts = self.cuts(&cubic, &line);
        let start = self.enters(&cubic, cuts, &line)?;
        let reversed = [cuts[3], cuts[2], cuts[1], cuts[0]];
        let end = self.enters(&cubic, reversed, &line)?;
        Some(Interval { start, end })
    }

    /// The first time at which a straight motion is inside, in O(1): a root of a cubic in t,
    /// isolated by its turning points; docs/reference/theory.md section 3.
    pub(crate) fn line_start(&self, line: &Line) -> Option<f64> {
        if let Some(flat) = &self.flat {
            return contact::clip(flat, line, 0.0).map(|i| i.start);
        }
        let cubic = self.cubic(line);
        self.enters(&cubic, self.cuts(&cubic, line), line)
    }

    /// The time at which the motion enters between two successive `cuts`, searched in their order.
    fn enters(&self, cubic: &Cubic, cuts: [f64; 4], line: &Line) -> Option<f64> {
        if !(line.start <= line.end) {
            return None;
        }
        let origin = line.origin - self.initial.center();
        let velocity = self.relative(line);
        let value = |t: f64| self.excess(origin + velocity * t, t);
        // negated so that a NaN is inside
        let inside = |t: f64| !(value(t) > 0.0) && !self.is_beyond(origin + velocity * t, t);
        let first = cuts.iter().position(|t| inside(*t))?;
        if first == 0 {
            return Some(cuts[0]);
        }
        // Newton's method within the bracket; bisection where a step leaves it
        let (mut within, mut without) = (cuts[first], cuts[first - 1]);
        let mut at = 0.5 * (within + without);
        for _ in 0..MAX_STEPS {
            let found = value(at);
            if found > 0.0 {
                without = at;
            } else {
                within = at;
            }
            let (low, high) = (within.min(without), within.max(without));
            let next = at - found / cubic.slope(at);
            let next = if next > low && next < high {
                next
            } else {
                0.5 * (low + high)
            };
            if !((next - at).abs() > 2.0 * f64::EPSILON * at.abs().max(tolerance::TIME_S)) {
                break;
            }
            at = next;
        }
        Some(at)
    }

    /// Start, turning points, end.
    fn cuts(&self, cubic: &Cubic, line: &Line) -> [f64; 4] {
        let end = line.end.min(tolerance::FOREVER_S);
        let [a, b] = cubic.turning_points().map(|turn| {
            // an absent turning point is replaced by the start
            if turn.is_finite() {
                turn.clamp(line.start, end.max(line.start))
            } else {
                line.start
            }
        });
        [line.start, a.min(b), a.max(b), end]
    }

    pub(crate) fn relative(&self, line: &Line) -> Vector {
        line.velocity - self.velocity.center()
    }

    /// [`Self::excess`] along the line, expanded about the time at which the centres are nearest,
    /// so that a distant start costs no digits.
    fn cubic(&self, line: &Line) -> Cubic {
        let w = self.relative(line);
        let start = line.origin - self.initial.center();
        let about = if w.norm_squared() > 0.0 {
            (-start.dot(&w) / w.norm_squared()).max(line.start)
        } else {
            line.start
        };
        let y = start + w * about;
        // coefficients of (y + w s)' adj (y + w s)
        let square = |[a, b]: [Vector; 2]| {
            let (a0, a1, b0, b1) = (cross(y, a), cross(w, a), cross(y, b), cross(w, b));
            [
                a0 * a0 + b0 * b0,
                2.0 * (a0 * a1 + b0 * b1),
                a1 * a1 + b1 * b1,
            ]
        };
        let [n, g] = [square(self.axes[0]), square(self.axes[1])];
        let [d0, d1, d2] = self.determinant;
        let (r0, r1) = (self.reach(about), self.roots[1]);
        let (e0, e1) = (d0 + about * (d1 + about * d2), d1 + 2.0 * d2 * about);
        let slopes = [
            n[1] + g[0] + about * g[1] - (r0 * e1 + r1 * e0),
            n[2] + g[1] + about * g[2] - (r0 * d2 + r1 * e1),
            g[2] - r1 * d2,
        ];
        Cubic { about, slopes }
    }
}
