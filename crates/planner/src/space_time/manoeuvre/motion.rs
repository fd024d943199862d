//! Parts of a motion.

use searoom_geometry::frame::Pose;
use searoom_geometry::tolerance;
use searoom_model::trajectory::Segment;

/// Part of a motion between two times.
pub(crate) fn part(motion: &[Segment], from: f64, to: f64) -> Vec<Segment> {
    motion
        .iter()
        .filter(|s| s.end_time() > from && s.start_time < to)
        .map(|s| s.between(from, to))
        .collect()
}

/// Motion up to a time.
pub(crate) fn until(motion: &[Segment], time: f64) -> Vec<Segment> {
    part(motion, f64::NEG_INFINITY, time)
}

/// Pose at a time, extrapolated before the start and beyond the end; `None` for an empty motion.
pub(crate) fn pose_at(motion: &[Segment], time: f64) -> Option<Pose> {
    let found = motion.iter().find(|s| s.end_time() >= time);
    found.or(motion.last()).map(|s| s.pose_at(time))
}

/// Distance sailed between two times, metres.
pub(crate) fn sailed_between(motion: &[Segment], from: f64, to: f64) -> f64 {
    motion.iter().map(|s| s.between(from, to).length()).sum()
}

/// Motion shifted in time, to later by a number of seconds.
pub(crate) fn shifted(motion: &[Segment], seconds: f64) -> Vec<Segment> {
    let shifted = |s: &Segment| Segment {
        start_time: s.start_time + seconds,
        ..*s
    };
    motion.iter().map(shifted).collect()
}

/// Motion without segments of zero length and with equal neighbours merged.
pub(crate) fn merged(motion: &[Segment]) -> Vec<Segment> {
    let mut merged: Vec<Segment> = Vec::with_capacity(motion.len());
    let of_use = |s: &&Segment| s.speed <= 0.0 || s.length() > tolerance::LENGTH_M;
    for s in motion.iter().filter(of_use) {
        match merged.last_mut() {
            Some(last) if last.speed == s.speed && last.turn_rate == s.turn_rate => {
                last.duration += s.duration;
            }
            _ => merged.push(*s),
        }
    }
    merged
}
