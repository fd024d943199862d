//! Departure: where a manoeuvre leaves the nominal motion.

use crate::trajectory::Segment;

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
