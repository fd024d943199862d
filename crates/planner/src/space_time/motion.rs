//! Parts of a motion.

use searoom_geometry::frame::Pose;
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

/// Pose at a time, extrapolated beyond the end; `None` for an empty motion.
pub(crate) fn pose_at(motion: &[Segment], time: f64) -> Option<Pose> {
    let found = motion.iter().find(|s| s.end_time() >= time);
    found.or(motion.last()).map(|s| s.pose_at(time))
}

/// Distance sailed between two times, metres.
pub(crate) fn sailed_between(motion: &[Segment], from: f64, to: f64) -> f64 {
    motion.iter().map(|s| s.between(from, to).length()).sum()
}
