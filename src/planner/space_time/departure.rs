//! Where the undisturbed motion is left.

use crate::trajectory::Segment;

/// The time at which a motion is to be left for a constant speed, to be at a distance along it at a time.
pub(crate) fn leave_for(
    undisturbed: &[Segment],
    distance: f64,
    time: f64,
    speed: f64,
) -> Option<f64> {
    let mut at = 0.0;
    for s in undisturbed {
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

/// A motion up to a time.
pub(crate) fn until(undisturbed: &[Segment], time: f64) -> Vec<Segment> {
    undisturbed
        .iter()
        .filter(|s| s.start_time < time)
        .map(|s| s.between(s.start_time, time))
        .collect()
}
