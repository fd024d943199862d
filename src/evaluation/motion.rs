//! Checks that a chain of segments starts, moves and arrives within own ship's limits.

use super::{Freedom, Request, Violation, along};
use crate::frame::wrap;
use crate::tolerance;
use crate::trajectory::Segment;
use crate::vessel::OwnShip;

/// Returns the violated requirements on the motion alone.
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
    // Non-finite values cannot be judged further.
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
            tolerance::joint_rad(own.turning_radius),
        );
    }
    for (index, pair) in segments.windows(2).enumerate() {
        let (before, after) = (&pair[0], &pair[1]);
        let place =
            |what: &str| format!("{what} at the joint of segments {index} and {}", index + 1);
        let end = before.end();
        let step = (end.position - after.start.position).norm();
        found.limit(
            &place("position"),
            "m",
            after.start_time,
            step,
            tolerance::JOINT_M,
        );
        // On paths, own ship turns on the spot at the corners of the path.
        if let Freedom::Limits = request.freedom {
            let turn = wrap(end.heading - after.start.heading).abs();
            found.limit(
                &place("heading"),
                "rad",
                after.start_time,
                turn,
                tolerance::joint_rad(own.turning_radius),
            );
        }
        let pause = (before.end_time() - after.start_time).abs();
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
        Freedom::Paths(paths) => found.0.extend(along::check(segments, own, paths, true)),
        Freedom::PathsToHorizon(paths) => {
            found.0.extend(along::check(segments, own, paths, false));
        }
        Freedom::Any => return found.0,
    }
    let end_time = last.end_time();
    if let Freedom::PathsToHorizon(_) = request.freedom {
        let off = (end_time - horizon).abs();
        let allowed = tolerance::TIME_S * (1.0 + horizon);
        found.limit("end", "s from the horizon", end_time, off, allowed);
        return found.0;
    }
    let short = (last.end().position - desired.end()).norm();
    found.limit(
        "arrival",
        "m from the last waypoint",
        end_time,
        short,
        tolerance::ARRIVAL_M,
    );
    let sailed: f64 = segments.iter().map(Segment::length).sum();
    // Negated on purpose: a NaN length is no motion.
    if !(sailed > tolerance::ARRIVAL_M) && desired.comes_by(own.pose.position) {
        let what = format!("arrival: {sailed} m sailed, with the path still ahead");
        found.add(end_time, what);
    }
    found.limit(
        "arrival time",
        "s",
        end_time,
        end_time,
        horizon + tolerance::TIME_S,
    );
    found.0
}

/// Checks turning radius and speeds.
fn limits(segments: &[Segment], own: &OwnShip, found: &mut Report) {
    for (index, s) in segments.iter().enumerate() {
        // In this form, a turn on the spot is a violation too.
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

    /// Adds a violation if a quantity exceeds its limit; a NaN exceeds every limit.
    fn limit(&mut self, what: &str, unit: &str, time: f64, value: f64, allowed: f64) {
        if !(value <= allowed) {
            self.add(
                time,
                format!("{what}: {value:.6e} {unit}, allowed {allowed:.6e}"),
            );
        }
    }
}
