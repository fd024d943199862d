//! Does a chain of segments start, move and arrive as own ship can and must?

use super::quadrature::smooth;
use super::{Freedom, Request, Violation, along};
use crate::frame::{Vector, direction, wrap};
use crate::tolerance;
use crate::trajectory::Segment;
use crate::vessel::OwnShip;

/// Radians. Arcs are integrated in pieces of this turn.
const ARC_PIECE: f64 = std::f64::consts::FRAC_PI_4;

/// The requirements on motion alone. The ends of the segments are integrated anew from their speed and
/// turn rate, not taken from the trajectory's own closed form.
pub(super) fn check(request: &Request) -> Vec<Violation> {
    let Request {
        segments,
        own,
        desired,
        horizon,
        ..
    } = *request;
    let mut found = Report(Vec::new());
    let (Some(first), Some(last)) = (segments.first(), segments.last()) else {
        found.add(0.0, "segments: none; at least one is needed".to_owned());
        return found.0;
    };
    for (index, s) in segments.iter().enumerate() {
        if !s.is_valid() {
            let time = if s.start_time.is_finite() {
                s.start_time
            } else {
                0.0
            };
            found.add(
                time,
                format!(
                    "values: segment {index} is not finite, or has a negative duration or speed"
                ),
            );
        }
    }
    // what is not a number is not judged any further
    if !found.0.is_empty() {
        return found.0;
    }
    found.limit(
        "start time",
        "s",
        0.0,
        first.start_time.abs(),
        tolerance::TIME_S,
    );
    let gap = (first.start.position - own.pose.position).norm();
    found.limit(
        "start position",
        "m from own ship",
        first.start_time,
        gap,
        tolerance::JOINT_M,
    );
    if !matches!(request.freedom, Freedom::Any) {
        let turn = wrap(first.start.heading - own.pose.heading).abs();
        found.limit(
            "start heading",
            "rad from own ship's",
            first.start_time,
            turn,
            tolerance::JOINT_RAD,
        );
    }
    for (index, pair) in segments.windows(2).enumerate() {
        let (before, after) = (&pair[0], &pair[1]);
        let place =
            |what: &str| format!("{what} at the joint of segments {index} and {}", index + 1);
        let end = end_position(before);
        let heading = before.start.heading + before.turn_rate * before.duration;
        let step = (end - after.start.position).norm();
        found.limit(
            &place("position"),
            "m",
            after.start_time,
            step,
            tolerance::JOINT_M,
        );
        // along paths she turns where the path does
        if let Freedom::Limits = request.freedom {
            let turn = wrap(heading - after.start.heading).abs();
            found.limit(
                &place("heading"),
                "rad",
                after.start_time,
                turn,
                tolerance::JOINT_RAD,
            );
        }
        let pause = (before.start_time + before.duration - after.start_time).abs();
        found.limit(
            &place("time"),
            "s",
            after.start_time,
            pause,
            tolerance::TIME_S,
        );
    }
    match request.freedom {
        Freedom::Limits => limits(segments, own, &mut found),
        Freedom::Paths(paths) | Freedom::PathsToHorizon(paths) => {
            found.0.extend(along::check(segments, own, paths))
        }
        Freedom::Any => return found.0,
    }
    let end_time = last.start_time + last.duration;
    if let Freedom::PathsToHorizon(_) = request.freedom {
        let off = (end_time - horizon).abs();
        let allowed = tolerance::TIME_S * (1.0 + horizon);
        found.limit("end", "s from the horizon", end_time, off, allowed);
        return found.0;
    }
    let short = (end_position(last) - desired.end()).norm();
    found.limit(
        "arrival",
        "m from the last waypoint",
        end_time,
        short,
        tolerance::ARRIVAL_M,
    );
    found.limit(
        "arrival time",
        "s",
        end_time,
        end_time,
        horizon + tolerance::TIME_S,
    );
    found.0
}

/// Turning radius and speeds.
fn limits(segments: &[Segment], own: &OwnShip, found: &mut Report) {
    for (index, s) in segments.iter().enumerate() {
        // in this form a turn on the spot is a violation too
        let speed_needed = s.turn_rate.abs() * own.turning_radius;
        found.limit(
            &format!("turn rate times turning radius in segment {index}"),
            "m/s, by the speed",
            s.start_time,
            speed_needed,
            s.speed * (1.0 + tolerance::LIMIT),
        );
        let known = own
            .speeds
            .iter()
            .any(|speed| (speed - s.speed).abs() <= tolerance::LIMIT * speed.max(1.0));
        if !known {
            found.add(
                s.start_time,
                format!(
                    "speed in segment {index}: {} m/s, allowed {:?}",
                    s.speed, own.speeds
                ),
            );
        }
    }
}

struct Report(Vec<Violation>);

impl Report {
    fn add(&mut self, time: f64, what: String) {
        self.0.push(Violation { what, time });
    }

    /// Notes a quantity over its limit; a NaN is over every limit.
    fn limit(&mut self, what: &str, unit: &str, time: f64, value: f64, allowed: f64) {
        if !(value <= allowed) {
            self.add(
                time,
                format!("{what}: {value:.6e} {unit}, allowed {allowed:.6e}"),
            );
        }
    }
}

/// Where a segment ends, by quadrature of its velocity.
fn end_position(s: &Segment) -> Vector {
    let pieces = ((s.turn_rate * s.duration).abs() / ARC_PIECE)
        .ceil()
        .clamp(1.0, 1e4);
    let mut end = s.start.position;
    for k in 0..pieces as usize {
        let from = s.duration * k as f64 / pieces;
        let until = s.duration * (k + 1) as f64 / pieces;
        let ahead = |t: f64| direction(s.start.heading + s.turn_rate * t) * s.speed;
        end.x += smooth(from, until, &|t| ahead(t).x);
        end.y += smooth(from, until, &|t| ahead(t).y);
    }
    end
}
