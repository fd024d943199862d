//! Squared error along a straight motion near several legs: a lower envelope of functions of time.
//!
//! The squared space-time distance from a moving point to one leg is convex in time. It consists of
//! at most three parabolas: nearest to the leg's first end, between its ends, nearest to its last
//! end. The sweep starts with the leg that is nearest first. The next time at which another leg
//! becomes nearer is the root of a difference of parabolas.

use searoom_geometry::frame::cross;
use searoom_model::trajectory::{DesiredLeg, DesiredTrajectory, Segment};

/// Parabola `a + b t + c t²`, t from the start of the motion.
#[derive(Debug, Clone, Copy)]
struct Parabola {
    a: f64,
    b: f64,
    c: f64,
}

impl Parabola {
    /// `weight (value + slope t)²`.
    fn square(value: f64, slope: f64, weight: f64) -> Self {
        Self {
            a: weight * value * value,
            b: 2.0 * weight * value * slope,
            c: weight * slope * slope,
        }
    }

    fn plus(self, other: Self) -> Self {
        Self {
            a: self.a + other.a,
            b: self.b + other.b,
            c: self.c + other.c,
        }
    }

    fn at(&self, t: f64) -> f64 {
        self.a + t * (self.b + t * self.c)
    }

    fn slope(&self, t: f64) -> f64 {
        self.b + 2.0 * t * self.c
    }

    /// Integral from `from` to `to`; Simpson's rule is exact here.
    fn integral(&self, from: f64, to: f64) -> f64 {
        let middle = self.at(0.5 * (from + to));
        (self.at(from) + 4.0 * middle + self.at(to)) * (to - from) / 6.0
    }

    /// First time in `[from, to]` at which `other` crosses this parabola from above.
    fn crossing(&self, other: &Self, from: f64, to: f64) -> Option<f64> {
        let c = other.c - self.c;
        let b = other.slope(from) - self.slope(from);
        let a = (other.at(from) - self.at(from)).max(0.0);
        // downward zero crossing: the smaller root when convex, the larger one when concave
        let discriminant = b * b - 4.0 * a * c;
        if discriminant <= 0.0 && c > 0.0 {
            return None;
        }
        let steep = discriminant.max(0.0).sqrt();
        let after = if b < 0.0 {
            2.0 * a / (steep - b)
        } else if c < 0.0 {
            (b + steep) / (-2.0 * c)
        } else {
            return None;
        };
        (after <= to - from).then_some(from + after)
    }
}

/// Squared distance from one leg.
#[derive(Debug, Clone, Copy)]
struct FromLeg {
    /// Parabolas, each with the time until which it holds.
    parts: [(f64, Parabola); 3],
}

impl FromLeg {
    fn new(leg: &DesiredLeg, segment: &Segment, time_weight: f64) -> Self {
        let velocity = segment.start.ahead() * segment.speed;
        let offset = segment.start.position - leg.start;
        let (along, across) = (leg.direction.dot(&offset), cross(leg.direction, offset));
        let (ahead, aside) = (leg.direction.dot(&velocity), cross(leg.direction, velocity));
        let elapsed = segment.start_time - leg.start_time;
        let kappa = time_weight / (time_weight + leg.speed * leg.speed);
        let (lag, falling) = (leg.speed * elapsed - along, leg.speed - ahead);
        let sideways = Parabola::square(across, aside, 1.0);
        let within = sideways.plus(Parabola::square(lag, falling, kappa));
        let from_end = |end: f64| {
            sideways
                .plus(Parabola::square(along - end, ahead, 1.0))
                .plus(Parabola::square(
                    elapsed - end / leg.speed,
                    1.0,
                    time_weight,
                ))
        };
        let (nearest, rate) = (along + kappa * lag, ahead + kappa * falling);
        let (first, last) = if rate < 0.0 {
            (leg.length, 0.0)
        } else {
            (0.0, leg.length)
        };
        // a zero rate: never, or at once
        let passes = |end: f64| {
            let time = (end - nearest) / rate;
            if time.is_nan() { 0.0 } else { time }
        };
        let (enters, leaves) = (passes(first), passes(last));
        Self {
            parts: [
                (enters, from_end(first)),
                (leaves.max(enters), within),
                (f64::INFINITY, from_end(last)),
            ],
        }
    }

    /// Parabola that holds just after a time.
    fn part(&self, time: f64) -> &(f64, Parabola) {
        let index = self.parts.iter().position(|(until, _)| *until > time);
        &self.parts[index.unwrap_or(2)]
    }

    /// First time from `from` on at which `other` becomes nearer.
    fn crossing(&self, other: &Self, from: f64, to: f64) -> Option<f64> {
        let mut time = from;
        while time < to {
            let (mine, theirs) = (self.part(time), other.part(time));
            let until = mine.0.min(theirs.0).min(to);
            if let Some(passed) = mine.1.crossing(&theirs.1, time, until) {
                return Some(passed);
            }
            time = until;
        }
        None
    }

    fn integral(&self, from: f64, to: f64) -> f64 {
        let (mut time, mut sum) = (from, 0.0);
        while time < to {
            let (until, part) = self.part(time);
            let until = until.min(to);
            sum += part.integral(time, until);
            time = until;
        }
        sum
    }
}

/// Relative tolerance within which two legs are equally near.
const EQUAL: f64 = 1e-12;

/// Integral of the squared error over a line, m² s, exact to rounding. `None` where the nearest leg
/// changes more often than is possible; only rounding among coincident legs causes that. O(legs)
/// for each leg that is nearest in turn.
pub(crate) fn integral(
    desired: &DesiredTrajectory,
    segment: &Segment,
    time_weight: f64,
) -> Option<f64> {
    let duration = segment.duration;
    let mut legs = near(desired, segment, time_weight);
    // each pair of legs changes order at most once within each pair of their parabolas
    let mut changes = 12 * legs.len() + 12;
    let (mut time, mut sum) = (0.0, 0.0);
    let mut nearest = nearest_at(&legs, time)?;
    while time < duration {
        let current = legs.swap_remove(nearest);
        let mut next = (duration, None);
        for (index, other) in legs.iter().enumerate() {
            if let Some(passed) = current.crossing(other, time, next.0)
                && (next.1.is_none() || passed < next.0)
            {
                next = (passed, Some(index));
            }
        }
        sum += current.integral(time, next.0);
        let Some(index) = next.1 else { break };
        legs.push(current);
        (time, nearest) = (next.0, index);
        changes = changes.checked_sub(1)?;
    }
    // on the desired trajectory rounding may leave less than nothing, and a search has no edge of a
    // negative cost; a NaN stays one
    Some(if sum < 0.0 { 0.0 } else { sum })
}

/// Legs that may be nearest at some time of a line. A space-time distance changes by at most the
/// length of the path in space-time.
fn near(desired: &DesiredTrajectory, segment: &Segment, time_weight: f64) -> Vec<FromLeg> {
    let middle = 0.5 * segment.duration;
    let reach = middle * (segment.speed * segment.speed + time_weight).sqrt();
    let mut legs: Vec<(f64, FromLeg)> = Vec::with_capacity(desired.legs().len());
    let mut closest = f64::INFINITY;
    for leg in desired.legs() {
        let from = FromLeg::new(leg, segment, time_weight);
        let distance = from.part(middle).1.at(middle).max(0.0).sqrt();
        // negated on purpose: a NaN is retained and found later
        if !(distance > closest + 2.0 * reach) {
            closest = closest.min(distance);
            legs.push((distance, from));
        }
    }
    legs.retain(|(distance, _)| !(*distance > closest + 2.0 * reach));
    legs.into_iter().map(|(_, from)| from).collect()
}

/// Nearest leg just after a time; among equally near legs, the one that comes nearer.
fn nearest_at(legs: &[FromLeg], time: f64) -> Option<usize> {
    let values: Vec<f64> = legs.iter().map(|l| l.part(time).1.at(time)).collect();
    let least = values.iter().copied().fold(f64::INFINITY, f64::min);
    let equal = least + EQUAL * (1.0 + least);
    let slope = |i: &usize| legs[*i].part(time).1.slope(time);
    (0..legs.len())
        .filter(|i| values[*i] <= equal)
        .min_by(|i, k| slope(i).total_cmp(&slope(k)))
}
