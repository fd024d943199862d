//! Interception of a moving vertex by a turn and a line, docs/reference/theory.md section 10 (vi).

use std::f64::consts::TAU;

use searoom_geometry::frame::{Pose, Side, Vector, cross, to_port, wrap};
use searoom_sets::{HalfSpace, MovingVertex};

/// Own ship's turn and line at one speed that shall meet a moving point.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Interceptor {
    position: Vector,
    heading: f64,
    ahead: Vector,
    centre: Vector,
    radius: f64,
    /// Sign of the turn, to port positive.
    sigma: f64,
    time: f64,
    speed: f64,
    /// Turning radius over speed: seconds per radian.
    seconds_per_radian: f64,
}

/// Limits of an interception.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Limits {
    /// Largest turn, radians.
    pub turn: f64,
    /// Latest time, seconds.
    pub time: f64,
}

/// Interception of a moving point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Interception {
    /// Turn, radians, not negative.
    pub turn: f64,
    /// Length of the line after the turn, metres.
    pub line: f64,
    /// Time, seconds.
    pub time: f64,
}

/// Metres. Own ship and the vertex are at most this far apart when they meet.
const MEETING_M: f64 = 1e-7;

/// Radians. A turn this close to a full circle counts as zero.
const DEAD_AHEAD_RAD: f64 = 1e-12;

/// Radians. After a Newton step this small the turn is exact to rounding.
const LAST_STEP_RAD: f64 = 1e-9;

/// Largest number of iterations for a root; Newton on a concave piece needs about five.
const MAX_ITERATIONS: usize = 60;

impl Interceptor {
    /// From a pose (metres, radians) at a time (seconds), at a positive speed (m/s), turning to one
    /// side with a radius (metres).
    pub(crate) fn new(pose: &Pose, time: f64, speed: f64, radius: f64, side: Side) -> Self {
        let (ahead, sigma) = (pose.ahead(), side.turn_sign());
        let centre = pose.position + to_port(ahead) * (sigma * radius);
        Self {
            position: pose.position,
            heading: wrap(pose.heading),
            ahead,
            centre,
            radius,
            sigma,
            time,
            speed,
            seconds_per_radian: radius / speed,
        }
    }

    /// Copy with another speed.
    pub(crate) fn at_speed(&self, speed: f64) -> Self {
        Self {
            speed,
            seconds_per_radian: self.radius / speed,
            ..*self
        }
    }

    pub(crate) fn speed(&self) -> f64 {
        self.speed
    }

    /// Heading before the turn, radians in `(-pi, pi]`.
    pub(crate) fn heading(&self) -> f64 {
        self.heading
    }

    /// Direction after a turn of `turn` radians.
    pub(crate) fn after(&self, turn: f64) -> Vector {
        let (sin, cos) = turn.sin_cos();
        self.ahead * cos + to_port(self.ahead) * (self.sigma * sin)
    }

    /// Position and time at the end of a turn of `turn` radians into `direction`.
    pub(crate) fn turned(&self, direction: Vector, turn: f64) -> (Vector, f64) {
        let position = self.centre - to_port(direction) * (self.sigma * self.radius);
        (position, self.time + self.seconds_per_radian * turn)
    }

    /// Distance of own ship from a plane, metres, positive outside, and the increase of that
    /// distance after `turn` radians to port. A turn to starboard decreases it by this much.
    /// `across` is the component of the plane's normal to port of the heading after the turn.
    pub(crate) fn slacks(&self, plane: &HalfSpace, across: f64, turn: f64) -> [f64; 2] {
        let before = plane.normal.dot(&to_port(self.ahead));
        let moved = self.radius * (before - across)
            - plane.velocity_support * self.seconds_per_radian * turn;
        [plane.slack(self.position, self.time), moved]
    }

    /// Interception of a moving vertex by a turn between `turns`, where own ship's relative motion
    /// passes the vertex on different sides. `moments` of the vertex about the relative velocity at
    /// the two turns, m²/s, have opposite signs. Root finding by safeguarded Newton.
    pub(crate) fn intercept_tangentially(
        &self,
        vertex: &MovingVertex,
        turns: [f64; 2],
        moments: [f64; 2],
        limits: Limits,
    ) -> Option<Interception> {
        // moment of the relative position about the relative velocity, and its rate with the turn
        let moment = |turn: f64| {
            let direction = self.after(turn);
            let (position, time) = self.turned(direction, turn);
            let to = vertex.origin + vertex.velocity * time - position;
            let velocity = direction * self.speed - vertex.velocity;
            let turning = to_port(direction) * (self.sigma * self.speed);
            let rate = cross(to, turning);
            (cross(to, velocity), rate, to, velocity, time)
        };
        let ([mut low, mut high], [at_low, at_high]) = (turns, moments);
        if (at_low < 0.0) == (at_high < 0.0) {
            return None;
        }
        let mut turn = low + (high - low) * at_low / (at_low - at_high);
        for _ in 0..MAX_ITERATIONS {
            let (value, rate, ..) = moment(turn);
            if (value < 0.0) == (at_low < 0.0) {
                low = turn
            } else {
                high = turn
            }
            let newton = turn - value / rate;
            let within = (newton - low) * (newton - high) <= 0.0;
            let next = if within { newton } else { 0.5 * (low + high) };
            let step = (next - turn).abs();
            turn = next;
            // each Newton step squares the error
            if step <= LAST_STEP_RAD {
                break;
            }
        }
        let least = if self.sigma > 0.0 { -1e-11 } else { 1e-11 };
        if turn < least || turn > limits.turn {
            return None;
        }
        let turn = turn.max(0.0);
        let (_, _, to, velocity, time) = moment(turn);
        let after = to.dot(&velocity) / velocity.norm_squared();
        let met = time + after;
        (after >= 0.0 && met <= limits.time).then_some(Interception {
            turn,
            line: after * self.speed,
            time: met,
        })
    }

    /// Path to a fixed point: turn and line. `None` inside the turning circle.
    pub(crate) fn path_to(&self, point: Vector) -> Option<(f64, f64)> {
        let (turn, line, _) = self.tangent(point)?;
        // a full circle is a rounded zero: the point is dead ahead
        Some((
            if TAU - turn < DEAD_AHEAD_RAD {
                0.0
            } else {
                turn
            },
            line,
        ))
    }

    /// Turn, line and the line's direction. A full circle is not rounded to zero, which would hide
    /// the jump at a wrap. One arctangent suffices: the tangent is the line to the centre, turned
    /// by the angle whose sine is `radius / distance`.
    fn tangent(&self, point: Vector) -> Option<(f64, f64, Vector)> {
        let to = point - self.centre;
        let square = to.norm_squared();
        let along = square - self.radius * self.radius;
        // negated on purpose: a NaN is inside
        if !(along >= 0.0) {
            return None;
        }
        let line = along.sqrt();
        let course = (to * line + to_port(to) * (self.sigma * self.radius)) / square;
        let turn = (self.sigma * cross(self.ahead, course)).atan2(self.ahead.dot(&course));
        Some((if turn < 0.0 { turn + TAU } else { turn }, line, course))
    }

    /// Earliest interception of `origin + velocity t` within the limits; `t` is absolute time.
    /// Between its breakpoints `F(t) = u (t - t0) - length(t)` is concave, so each piece has at
    /// most two roots.
    pub(crate) fn intercept(
        &self,
        origin: Vector,
        velocity: Vector,
        limits: Limits,
    ) -> Option<Interception> {
        let from = self.time;
        let until = limits.time;
        if !(until > from) {
            return None;
        }
        let (ahead, centre) = (self.ahead, self.centre);
        let mut breakpoints = [from, until, until, until, until];
        let mut count = 1;
        let mut add_breakpoint = |t: f64| {
            if t > from && t < until {
                breakpoints[count] = t;
                count += 1;
            }
        };
        // point on the line ahead: the turn wraps between zero and a full circle
        let drift = cross(ahead, velocity);
        if drift != 0.0 {
            add_breakpoint(-cross(ahead, origin - self.position) / drift);
        }
        // point on the turning circle
        let (a, b, c) = (
            velocity.norm_squared(),
            velocity.dot(&(origin - centre)),
            (origin - centre).norm_squared() - self.radius * self.radius,
        );
        let discriminant = b * b - a * c;
        if a > 0.0 && discriminant > 0.0 {
            let root = discriminant.sqrt();
            add_breakpoint((-b - root) / a);
            add_breakpoint((-b + root) / a);
        }
        breakpoints[..count].sort_by(f64::total_cmp);
        breakpoints[count] = until;
        for pair in breakpoints[..=count].windows(2) {
            let width = pair[1] - pair[0];
            // one-sided values at a wrap
            let inset = (1e-9 * (1.0 + pair[1].abs())).min(width / 4.0);
            let (low, high) = (pair[0] + inset, pair[1] - inset);
            for root in self
                .roots(origin, velocity, low, high)
                .into_iter()
                .flatten()
            {
                let Some((turn, line)) = self.path_to(origin + velocity * root) else {
                    continue;
                };
                let length = self.radius * turn + line;
                let met = (length - self.speed * (root - from)).abs() <= MEETING_M;
                if met && turn <= limits.turn {
                    return Some(Interception {
                        turn,
                        line,
                        time: root,
                    });
                }
            }
        }
        None
    }

    /// `F` and its derivative.
    fn residual(&self, origin: Vector, velocity: Vector, time: f64) -> Option<(f64, f64)> {
        let (turn, line, course) = self.tangent(origin + velocity * time)?;
        // parallel motion dead ahead: a full circle is a rounded zero
        let wraps = TAU - turn < DEAD_AHEAD_RAD
            && cross(self.ahead, velocity).abs() <= 1e-12 * velocity.norm();
        let turn = if wraps { 0.0 } else { turn };
        let value = self.speed * (time - self.time) - (self.radius * turn + line);
        Some((value, self.speed - course.dot(&velocity)))
    }

    /// Roots of the concave `F` on one piece: at most two, earliest first.
    fn roots(&self, origin: Vector, velocity: Vector, low: f64, high: f64) -> [Option<f64>; 2] {
        let residual = |t: f64| self.residual(origin, velocity, t);
        let (Some((fa, da)), Some((fb, db))) = (residual(low), residual(high)) else {
            return [None, None];
        };
        if (fa < 0.0) != (fb < 0.0) {
            return [self.root(residual, low, fa, high), None];
        }
        if fa < 0.0 && da > 0.0 && db < 0.0 {
            let (mut a, mut b) = (low, high);
            for _ in 0..MAX_ITERATIONS {
                let middle = 0.5 * (a + b);
                let Some((f, d)) = residual(middle) else {
                    return [None, None];
                };
                if f >= 0.0 {
                    return [
                        self.root(residual, low, fa, middle),
                        self.root(residual, middle, f, high),
                    ];
                }
                if d > 0.0 {
                    a = middle
                } else {
                    b = middle
                }
                if b - a < 1e-9 {
                    break;
                }
            }
        }
        [None, None]
    }

    /// The only sign change between `a` and `b`, by safeguarded Newton.
    fn root(
        &self,
        residual: impl Fn(f64) -> Option<(f64, f64)>,
        a: f64,
        fa: f64,
        b: f64,
    ) -> Option<f64> {
        let (mut low, mut high) = (a, b);
        let rising = fa < 0.0;
        // concave: from the negative end Newton converges monotonically
        let mut at = if rising { a } else { b };
        for _ in 0..MAX_ITERATIONS {
            let (f, d) = residual(at)?;
            if (f < 0.0) == rising {
                low = at
            } else {
                high = at
            }
            let newton = at - f / d;
            let next = if newton > low && newton < high {
                newton
            } else {
                0.5 * (low + high)
            };
            if (next - at).abs() <= 1e-11 * (1.0 + at.abs()) {
                return Some(next);
            }
            at = next;
        }
        Some(at)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry_fixtures::random_vector;
    use rand::{Rng, SeedableRng};

    #[test]
    fn interceptions_are_the_earliest_of_a_dense_scan() {
        let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(21);
        let mut met = 0;
        for _ in 0..3000 {
            let pose = Pose::new(Vector::new(0.0, 0.0), rng.random_range(-3.1..3.1));
            let speed = [2.5, 5.0, 6.0][rng.random_range(0..3)];
            let side = if rng.random_bool(0.5) {
                Side::Port
            } else {
                Side::Starboard
            };
            let interceptor =
                Interceptor::new(&pose, rng.random_range(0.0..50.0), speed, 100.0, side);
            let origin = random_vector(&mut rng, 900.0);
            let velocity = random_vector(&mut rng, 7.0);
            let limits = Limits {
                turn: 2.0,
                time: interceptor.time + 300.0,
            };
            let found = interceptor.intercept(origin, velocity, limits);
            // dense scan for the first sign change with a small turn
            let n = 6000;
            let mut dense = None;
            let mut before: Option<(f64, f64)> = None;
            for i in 0..=n {
                let t = interceptor.time + 300.0 * f64::from(i) / f64::from(n);
                let now = interceptor
                    .path_to(origin + velocity * t)
                    .map(|(turn, line)| {
                        (
                            interceptor.speed * (t - interceptor.time) - 100.0 * turn - line,
                            turn,
                        )
                    });
                if let (Some((f0, turn0)), Some((f1, turn1))) = (before, now)
                    && (f0 < 0.0) != (f1 < 0.0)
                    && turn0.max(turn1) < 1.99
                    && (turn0 - turn1).abs() < 1.0
                {
                    dense = Some(t);
                    break;
                }
                before = now;
            }
            if let Some(meeting) = found {
                met += 1;
                let length = 100.0 * meeting.turn + meeting.line;
                assert!(
                    (length - interceptor.speed * (meeting.time - interceptor.time)).abs() < 1e-6
                );
            }
            if let Some(t) = dense {
                let first = found.expect("the scan met it").time;
                assert!(first <= t + 1e-6, "{first} {t}");
            }
        }
        assert!(met > 200, "{met}");
    }
}
