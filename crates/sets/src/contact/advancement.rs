//! First contact with any convex space-time obstacle, from its signed distance alone.
//!
//! The signed distance is jointly convex in space and time, because supports are concave in time.
//! So its tangent is a lower bound along a chord, and an arc is within the sagitta of its chord.

use super::CHORD_RAD;
use crate::SpaceTimeObstacle;
use searoom_geometry::tolerance;
use searoom_model::trajectory::{Mover, Segment};

/// Bound on the tangents along one chord; each doubles the digits near a crossing.
const MAX_TANGENTS: usize = 200;

/// The first time at which the segment is at least `depth` inside, by conservative advancement
/// (Mirtich 1996).
///
/// Early only where less than [`tolerance::GRAZE_M`] away from that depth. Late by at most a
/// nanosecond, where a set without an interior starts to grow. A segment or depth that is not
/// finite is in contact at once. About ten distance evaluations on a line, some tens on an arc that
/// comes near.
pub(crate) fn advanced_contact<O: SpaceTimeObstacle>(
    obstacle: &O,
    segment: &Segment,
    depth: f64,
) -> Option<f64> {
    if !(segment.is_valid() && depth.is_finite()) {
        return Some(segment.start_time);
    }
    let mover = Mover::new(segment);
    let (mut time, end) = (segment.start_time.max(0.0), segment.end_time());
    if time > end {
        return None;
    }
    let longest = if segment.is_arc() {
        CHORD_RAD / segment.turn_rate.abs()
    } else {
        f64::INFINITY
    };
    // m/s²: the sagitta of a chord of duration d is this times d²
    let bend = segment.speed * segment.turn_rate.abs() / 8.0;
    loop {
        let from = mover.position_at(time);
        let gap = obstacle.signed_distance(from, time).distance + depth;
        // negated so that a NaN is contact
        if !(gap > tolerance::GRAZE_M) {
            return Some(time);
        }
        // a chord whose sagitta is a fraction of the gap
        let duration = if bend > 0.0 {
            (0.25 * gap / bend).sqrt().min(longest)
        } else {
            f64::INFINITY
        };
        let until = (time + duration).min(end);
        if !(until > time) {
            // the end, or an arc too tight for the resolution of time, which counts as contact
            return (time < end).then_some(time);
        }
        let sagitta = bend * (until - time).powi(2);
        let velocity = (mover.position_at(until) - from) / (until - time);
        let mut at = time;
        let mut cleared = false;
        for _ in 0..MAX_TANGENTS {
            let here = obstacle.signed_distance(from + velocity * (at - time), at);
            let left = here.distance + depth - sagitta;
            if !(left > 0.5 * tolerance::GRAZE_M) {
                break;
            }
            let rate = velocity.dot(&here.normal) - obstacle.support(here.normal, at).rate;
            // by convexity there is no contact before the root of the tangent
            let step = if rate < 0.0 {
                left / -rate
            } else {
                f64::INFINITY
            };
            if at + step >= until {
                cleared = true;
                break;
            }
            if !(at + step > at) {
                // the boundary grows infinitely fast at t = 0, or the step is below rounding
                at = at.next_up().max(at + tolerance::TIME_S);
                break;
            }
            at += step;
        }
        let next = if cleared { until } else { at };
        if next >= end && cleared {
            // the end itself is part of the segment
            let last = obstacle.signed_distance(mover.position_at(end), end);
            return (!(last.distance + depth > tolerance::GRAZE_M)).then_some(end);
        }
        if !(next > time) {
            return Some(time);
        }
        time = next.min(end);
    }
}
