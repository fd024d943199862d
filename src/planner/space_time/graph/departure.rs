//! Departure: where a manoeuvre leaves the nominal motion.

use crate::colregs::APPARENT_TIME;
use crate::planner::Problem;
use crate::planner::space_time::route::Route;
use crate::planner::space_time::rules::compliance::apparent_slow_speed;
use crate::planner::space_time::selection::initial_guess::ManoeuvreSpeeds;
use crate::trajectory::Segment;

/// Seconds for which a reduced speed is held before a turn.
const SLOW_INTERVALS_S: [f64; 3] = [APPARENT_TIME, 2.0 * APPARENT_TIME, 4.0 * APPARENT_TIME];

/// Time at which to leave a motion for a constant speed, in order to be at a given distance along
/// it at a given time.
pub(crate) fn leave_for(
    nominal_motion: &[Segment],
    distance: f64,
    time: f64,
    speed: f64,
) -> Option<f64> {
    let mut at = 0.0;
    for s in nominal_motion {
        // at + s.speed (t - s.start_time) + speed (time - t) = distance
        let gap = distance - at + s.speed * s.start_time - speed * time;
        let t = gap / (s.speed - speed);
        if t.is_finite() && t >= s.start_time && t <= s.end_time() && t < time {
            return Some(t);
        }
        at += s.length();
    }
    None
}

/// Motion up to a time.
pub(crate) fn until(nominal_motion: &[Segment], time: f64) -> Vec<Segment> {
    nominal_motion
        .iter()
        .filter(|s| s.start_time < time)
        .map(|s| s.between(s.start_time, time))
        .collect()
}

/// Motions along the route up to a departure, each with the least turn (radians) that complies with
/// the rules there. These are the given motion, and variants that slow down at its end; after these
/// no turn need be readily apparent.
pub(crate) fn departure_motions(
    problem: &Problem,
    route: &Route,
    before: &[Segment],
) -> Vec<(Vec<Segment>, f64)> {
    let duty = problem.duty();
    let mut found = vec![(before.to_vec(), duty.least_turn())];
    let speed = ManoeuvreSpeeds::of(problem).slow;
    if duty.is_none() || !duty.may_slow || speed > apparent_slow_speed(problem) {
        return found;
    }
    let along: f64 = before.iter().map(Segment::length).sum();
    let time = before.last().map_or(0.0, Segment::end_time);
    for interval in SLOW_INTERVALS_S {
        let mut motion = before.to_vec();
        route.run(along, time, speed * interval, speed, &mut motion);
        found.push((motion, 0.0));
    }
    found
}
