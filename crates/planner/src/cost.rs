//! Space-time error: the cost that the search minimises, docs/reference/theory.md section 7.

use std::f64::consts::PI;

use super::line_error;
use searoom_geometry::frame::cross;
use searoom_geometry::numerics::{GAUSS_2, GAUSS_4};
use searoom_geometry::tolerance;
use searoom_model::trajectory::{DesiredLeg, DesiredTrajectory, Mover, Nearest, Segment};

/// Largest radius (metres) and smallest turn (radians) of the closed form. It loses digits on
/// flatter or shorter arcs.
const FLAT_RADIUS_M: f64 = 3e3;
const SHORT_RAD: f64 = 1e-3;

/// Subdivision of an arc that has no closed form.
#[derive(Debug, Clone, Copy)]
struct Subdivision {
    /// Longest initial piece, radians.
    arc: f64,
    /// Least number of pieces.
    pieces: f64,
}

/// Largest number of halvings of a piece in which the nearest leg or its clamp changes. They locate
/// such a change to a thousandth of the piece. A change that only rounding makes costs two
/// evaluations per halving.
const MAX_HALVINGS: u32 = 10;

/// Number of legs above which legs that cannot be nearest are left out first.
const MANY_LEGS: usize = 6;

/// Subdivision used during the search.
const SEARCH_SUBDIVISION: Subdivision = Subdivision {
    arc: PI / 4.0,
    pieces: 1.0,
};

/// Subdivision used for reported costs.
const REPORT_SUBDIVISION: Subdivision = Subdivision {
    arc: PI / 64.0,
    pieces: 64.0,
};

/// Cost `(1/T_d) integral of e² dt` of one segment, m²: its part of the space-time error `J`.
///
/// A single leg and lines have a closed form. Other arcs use the 4-point Gauss-Legendre rule on
/// pieces up to pi/4. A piece in which the nearest leg or the clamp at its ends changes is halved,
/// down to a thousandth.
pub fn space_time_error(desired: &DesiredTrajectory, segment: &Segment, time_weight: f64) -> f64 {
    integral(desired, segment, time_weight, SEARCH_SUBDIVISION) / desired.duration()
}

/// Part of `J` after a motion that ends early, m². Own ship lies where it is until the desired
/// trajectory ends.
pub fn error_after_end(desired: &DesiredTrajectory, last: &Segment, time_weight: f64) -> f64 {
    let (end, left) = (last.end_time(), desired.duration() - last.end_time());
    // on time, to rounding
    if left <= tolerance::TIME_S {
        return 0.0;
    }
    space_time_error(
        desired,
        &Segment::straight(last.end(), end, left, 0.0),
        time_weight,
    )
}

/// Space-time error `J` of a whole motion, m², with the wait of a ship that arrives early.
/// Otherwise as [`sailed_space_time_error`].
pub fn whole_space_time_error(
    desired: &DesiredTrajectory,
    motion: &[Segment],
    time_weight: f64,
) -> f64 {
    let after = |last| error_after_end(desired, last, time_weight);
    sailed_space_time_error(desired, motion, time_weight) + motion.last().map_or(0.0, after)
}

/// Space-time error of a motion until it ends, m². Arcs are divided finely enough to see a leg that
/// is nearest only briefly. Relative accuracy 1e-6.
pub fn sailed_space_time_error(
    desired: &DesiredTrajectory,
    motion: &[Segment],
    time_weight: f64,
) -> f64 {
    let error = |segment| integral(desired, segment, time_weight, REPORT_SUBDIVISION);
    motion.iter().map(error).sum::<f64>() / desired.duration()
}

fn integral(
    desired: &DesiredTrajectory,
    segment: &Segment,
    time_weight: f64,
    subdivision: Subdivision,
) -> f64 {
    if let [leg] = desired.legs()
        && let Some(integral) = SingleLeg::new(leg, segment, time_weight).integral()
    {
        return integral;
    }
    if !segment.is_arc()
        && let Some(integral) = line_error::integral(desired, segment, time_weight)
    {
        return integral;
    }
    let pieces = (segment.turn_rate.abs() * segment.duration / subdivision.arc)
        .ceil()
        .max(subdivision.pieces);
    let duration = segment.duration / pieces;
    let mut integrand = Integrand {
        desired,
        near: None,
        mover: Mover::new(segment),
        time_weight,
        is_arc: segment.is_arc(),
    };
    let legs = desired.legs().len();
    let near = (legs > MANY_LEGS).then(|| {
        let all: Vec<usize> = (0..legs).collect();
        integrand.near(&all, segment.start_time, segment.duration)
    });
    (0..pieces as usize)
        .map(|k| {
            let from = segment.start_time + duration * k as f64;
            if let Some(near) = &near {
                integrand.near = Some(integrand.near(near, from, duration));
            }
            integrand.integral(from, duration, MAX_HALVINGS)
        })
        .sum()
}

/// Segment relative to the only leg. Where the nearest point lies between the leg's ends, the error
/// is `across² + kappa lag²`. Where it is an end, the error is the space-time distance from that
/// end.
struct SingleLeg<'a> {
    leg: &'a DesiredLeg,
    segment: &'a Segment,
    time_weight: f64,
    /// State at the start: metres along and across the leg, seconds since the leg began.
    along: f64,
    across: f64,
    elapsed: f64,
    /// Cosine and sine of own ship's course relative to the leg.
    cos: f64,
    sin: f64,
    /// Motion of the nearest point along the leg per metre of own ship.
    share: f64,
}

impl<'a> SingleLeg<'a> {
    fn new(leg: &'a DesiredLeg, segment: &'a Segment, time_weight: f64) -> Self {
        let offset = segment.start.position - leg.start;
        let ahead = segment.start.ahead();
        Self {
            leg,
            segment,
            time_weight,
            along: leg.direction.dot(&offset),
            across: cross(leg.direction, offset),
            elapsed: segment.start_time - leg.start_time,
            cos: leg.direction.dot(&ahead),
            sin: cross(leg.direction, ahead),
            share: leg.speed * leg.speed / (time_weight + leg.speed * leg.speed),
        }
    }

    fn kappa(&self) -> f64 {
        1.0 - self.share
    }

    fn lag(&self) -> f64 {
        self.leg.speed * self.elapsed - self.along
    }

    /// Position of the nearest point along the leg at the start, metres, without the clamp.
    fn nearest(&self) -> f64 {
        self.along + self.kappa() * self.lag()
    }

    /// Closed form. `None` for an arc on which an end may be nearest, and for a nearly straight
    /// one.
    fn integral(&self) -> Option<f64> {
        if self.segment.is_arc() {
            let turn = (self.segment.turn_rate * self.segment.duration).abs();
            let bends = self.segment.radius().abs() <= FLAT_RADIUS_M && turn >= SHORT_RAD;
            if bends { self.on_arc() } else { None }
        } else {
            Some(self.on_line())
        }
    }

    fn on_line(&self) -> f64 {
        let (leg, duration) = (self.leg, self.segment.duration);
        let (ahead, aside) = (self.segment.speed * self.cos, self.segment.speed * self.sin);
        let nearest = self.nearest();
        let rate = ahead + self.kappa() * (leg.speed - ahead);
        // a zero rate gives an infinite time or a NaN: the maximum takes the number
        let passes = |end: f64| ((end - nearest) / rate).max(0.0).min(duration);
        let (start, end) = if rate < 0.0 {
            (leg.length, 0.0)
        } else {
            (0.0, leg.length)
        };
        let (first, second) = (passes(start), passes(end));
        let sum = |from: f64, to: f64, value: f64, slope: f64| {
            let (a, b) = (value + slope * from, value + slope * to);
            (a * a + a * b + b * b) / 3.0 * (to - from)
        };
        let between = self.kappa() * sum(first, second, self.lag(), leg.speed - ahead);
        let beyond = |from: f64, to: f64, end: f64| {
            if to > from {
                sum(from, to, self.along - end, ahead)
                    + self.time_weight * sum(from, to, self.elapsed - end / leg.speed, 1.0)
            } else {
                0.0
            }
        };
        sum(0.0, duration, self.across, aside)
            + between
            + beyond(0.0, first, start)
            + beyond(second, duration, end)
    }

    fn on_arc(&self) -> Option<f64> {
        let (leg, segment) = (self.leg, self.segment);
        let (duration, rate, radius) = (segment.duration, segment.turn_rate, segment.radius());
        let turn = rate * duration;
        let (sin, cos) = turn.sin_cos();
        let versine = 1.0 - cos;
        let ahead = radius * (self.cos * sin - self.sin * versine);
        let from = self.nearest();
        let to = from + ahead + self.kappa() * (leg.speed * duration - ahead);
        // at this speed the nearest point never moves back
        let onward = self.share * segment.speed <= self.kappa() * leg.speed;
        let margin = if onward {
            0.0
        } else {
            self.share * radius.abs() * turn * turn / 8.0
        };
        // own ship may start at the leg's first end: rounding must not put it beyond
        let margin = margin - 1e-9;
        let within = |at: f64| at >= margin && at <= leg.length - margin;
        if !(within(from) && within(to)) {
            return None;
        }
        // integral over the angle of (a + b angle + c sine + d versine)²
        let sum = |a: f64, b: f64, c: f64, d: f64| {
            let missing = turn - sin;
            let square = turn * turn;
            a * a * turn
                + a * b * square
                + 2.0 * a * (c * versine + d * missing)
                + b * b * square * turn / 3.0
                + 2.0 * b * (c * (sin - turn * cos) + d * (0.5 * square - turn * sin + versine))
                + 0.5 * c * c * (turn - sin * cos)
                + c * d * versine * versine
                + d * d * (1.5 * missing - 0.5 * sin * versine)
        };
        let (c, d) = (radius * self.cos, radius * self.sin);
        let across = sum(self.across, 0.0, d, c);
        let along = sum(self.lag(), leg.speed / rate, -c, d);
        Some(((across + self.kappa() * along) / rate).max(0.0))
    }
}

struct Integrand<'a> {
    desired: &'a DesiredTrajectory,
    /// Legs that may be nearest, where there are many.
    near: Option<Vec<usize>>,
    mover: Mover,
    time_weight: f64,
    is_arc: bool,
}

impl Integrand<'_> {
    fn at(&self, time: f64) -> Nearest {
        let (position, q) = (self.mover.position_at(time), self.time_weight);
        match &self.near {
            Some(near) => self.desired.nearest_of(near, position, time, q),
            None => self.desired.nearest(position, time, q),
        }
    }

    /// Legs of the given ones that may be nearest during a time interval. In space-time, own ship
    /// stays within half the length of its path from the midpoint.
    fn near(&self, legs: &[usize], from: f64, duration: f64) -> Vec<usize> {
        let (middle, q) = (from + 0.5 * duration, self.time_weight);
        let at = self.mover.position_at(middle);
        let away: Vec<f64> = legs
            .iter()
            .map(|leg| self.desired.nearest_of(&[*leg], at, middle, q).error.sqrt())
            .collect();
        let speed = self.mover.velocity_at(middle).norm();
        let least = away.iter().copied().fold(f64::INFINITY, f64::min);
        // much larger than rounding errors
        let most = (least + duration * speed.hypot(q.sqrt())) * (1.0 + 1e-6) + 1e-6;
        // negated on purpose: a NaN is retained
        let near = legs.iter().zip(away).filter(|(_, away)| !(*away > most));
        near.map(|(leg, _)| *leg).collect()
    }

    /// Where the nearest point is: between the ends of this leg, or at its start, which is the end
    /// of the leg before.
    fn regime(&self, time: f64) -> (usize, bool) {
        let nearest = self.at(time);
        let leg = &self.desired.legs()[nearest.leg];
        let end = leg.start_distance + leg.length;
        match (
            nearest.distance > leg.start_distance,
            nearest.distance < end,
        ) {
            (true, true) => (nearest.leg, true),
            (true, false) => (nearest.leg + 1, false),
            (false, _) => (nearest.leg, false),
        }
    }

    fn integral(&self, from: f64, duration: f64, halvings: u32) -> f64 {
        let first = self.regime(from);
        // within one leg and one clamp the error is smooth
        let inner: &[f64] = if self.desired.legs().len() == 1 {
            &[1.0]
        } else {
            &[1.0, 0.5, 0.25, 0.75]
        };
        if halvings == 0
            || inner
                .iter()
                .all(|f| self.regime(from + duration * f) == first)
        {
            let nodes: &[(f64, f64)] = if self.is_arc { &GAUSS_4 } else { &GAUSS_2 };
            return duration
                * nodes
                    .iter()
                    .map(|(x, w)| w * self.at(from + duration * x).error)
                    .sum::<f64>();
        }
        let half = duration / 2.0;
        self.integral(from, half, halvings - 1) + self.integral(from + half, half, halvings - 1)
    }
}

#[cfg(test)]
mod tests;
