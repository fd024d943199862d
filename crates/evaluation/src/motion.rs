//! Checks that a chain of segments starts, moves and arrives within own ship's limits.

use super::{Freedom, Request, Violation, along};
use searoom_geometry::frame::wrap;
use searoom_geometry::tolerance;
use searoom_model::trajectory::Segment;
use searoom_model::vessel::OwnShip;

/// Returns the violated requirements on the motion alone.
pub(super) fn check(request: &Request) -> Vec<Violation> {
    let (segments, own, desired) = (request.segments, request.own, request.desired);
    let mut found = Report::default();
    let (Some(first), Some(last)) = (segments.first(), segments.last()) else {
        found.add("segments: none; at least one is needed".to_owned());
        return found.violations;
    };
    let unfit = segments.iter().enumerate().filter(|(_, s)| !s.is_valid());
    for (index, s) in unfit {
        found.time = Some(s.start_time).filter(|t| t.is_finite()).unwrap_or(0.0);
        found.add(format!(
            "values: segment {index} is not finite, or has a negative duration or speed"
        ));
    }
    // Non-finite values cannot be judged further.
    if !found.violations.is_empty() {
        return found.violations;
    }
    let late = first.start_time.abs();
    found.limit("start time", "s", late, tolerance::TIME_S);
    found.time = first.start_time;
    let gap = (first.start.position - own.pose.position).norm();
    found.limit("start position", "m from own ship", gap, tolerance::JOINT_M);
    let joint_rad = tolerance::joint_rad(own.turning_radius);
    if !matches!(request.freedom, Freedom::Any) {
        let turn = wrap(first.start.heading - own.pose.heading).abs();
        found.limit("start heading", "rad from own ship's", turn, joint_rad);
    }
    let (mut steps, mut pauses) = (0.0, 0.0);
    for (index, pair) in segments.windows(2).enumerate() {
        let (before, after) = (&pair[0], &pair[1]);
        found.time = after.start_time;
        let mut joint = |what: &str, unit: &str, value: f64, allowed: f64| {
            let what = format!("{what} at the joint of segments {index} and {}", index + 1);
            found.limit(&what, unit, value, allowed);
        };
        let end = before.end();
        let step = (end.position - after.start.position).norm();
        // a segment of no time only adds joints: nothing but rounding is allowed beside it
        let lasts = before.duration > 0.0 && after.duration > 0.0;
        let (beside, allowed) = match lasts {
            true => ("position", tolerance::JOINT_M),
            false => ("position beside a segment of no time", tolerance::EDGE_M),
        };
        joint(beside, "m", step, allowed);
        steps += step;
        // On paths, own ship turns on the spot at the corners of the path.
        if let Freedom::Limits | Freedom::LimitsWithoutArrival = request.freedom {
            let turn = wrap(end.heading - after.start.heading).abs();
            joint("heading", "rad", turn, joint_rad);
        }
        let pause = (before.end_time() - after.start_time).abs();
        joint("time", "s", pause, tolerance::TIME_S);
        pauses += pause;
    }
    // many joints together must not displace own ship either
    found.limit("position at all joints", "m", steps, tolerance::JOINT_M);
    let allowed = tolerance::TIME_S * (1.0 + last.end_time());
    found.limit("time at all joints", "s", pauses, allowed);
    match request.freedom {
        Freedom::Limits | Freedom::LimitsWithoutArrival => limits(segments, own, &mut found),
        Freedom::Paths(paths) | Freedom::PathsToHorizon(paths) => {
            let arrives = matches!(request.freedom, Freedom::Paths(_));
            let along = along::check(segments, own, paths, arrives);
            found.violations.extend(along);
        }
        Freedom::Any => return found.violations,
    }
    let (end, horizon) = (last.end_time(), request.horizon);
    found.time = end;
    if let Freedom::PathsToHorizon(_) = request.freedom {
        let allowed = tolerance::TIME_S * (1.0 + horizon);
        found.limit("end", "s from the horizon", (end - horizon).abs(), allowed);
        return found.violations;
    }
    found.limit("arrival time", "s", end, horizon + tolerance::TIME_S);
    if let Freedom::LimitsWithoutArrival = request.freedom {
        return found.violations;
    }
    let short = (last.end().position - desired.end()).norm();
    let unit = "m from the last waypoint";
    found.limit("arrival", unit, short, tolerance::ARRIVAL_M);
    if let Some(stay) = request.stay {
        let allowed = tolerance::TIME_S * (1.0 + stay);
        found.limit("end", "s before that of the stay", stay - end, allowed);
        if last.speed == 0.0 {
            found.limit("end", "s after that of the stay", end - stay, allowed);
        }
    }
    let sailed: f64 = segments.iter().map(Segment::length).sum();
    // Negated on purpose: a NaN length is no motion.
    if !(sailed > tolerance::ARRIVAL_M) && desired.comes_by(own.pose.position) {
        found.add(format!(
            "arrival: {sailed} m sailed, with the path still ahead"
        ));
    }
    found.violations
}

/// Checks turning radius and speeds.
fn limits(segments: &[Segment], own: &OwnShip, found: &mut Report) {
    for (index, s) in segments.iter().enumerate() {
        found.time = s.start_time;
        // In this form, a turn on the spot is a violation too.
        let what = format!("turn rate times turning radius in segment {index}");
        let needed = s.turn_rate.abs() * own.turning_radius;
        let allowed = s.speed * (1.0 + tolerance::LIMIT);
        found.limit(&what, "m/s, by the speed", needed, allowed);
        let is_own = |speed: &f64| (speed - s.speed).abs() <= tolerance::LIMIT * speed.max(1.0);
        if !own.speeds.iter().any(is_own) {
            let (speed, speeds) = (s.speed, &own.speeds);
            found.add(format!(
                "speed in segment {index}: {speed} m/s, allowed {speeds:?}"
            ));
        }
    }
}

/// The violations so far, and the time of those that are added next.
#[derive(Default)]
pub(super) struct Report {
    pub violations: Vec<Violation>,
    pub time: f64,
}

impl Report {
    fn add(&mut self, what: String) {
        self.violations.push(Violation::new(what, self.time));
    }

    /// Adds a violation if a quantity exceeds its limit; a NaN exceeds every limit.
    pub fn limit(&mut self, what: &str, unit: &str, value: f64, allowed: f64) {
        if !(value <= allowed) {
            self.add(format!("{what}: {value:.6e} {unit}, allowed {allowed:.6e}"));
        }
    }
}
