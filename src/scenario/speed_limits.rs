//! The highest speeds that the legs of a route allow, and plans that are faster.

use super::check::SAME_SPEED;
use crate::frame::Vector;
use crate::text::knots;
use crate::trajectory::Trajectory;

/// Seconds between two samples of a plan.
const SAMPLE_S: f64 = 5.0;
const MOST_SAMPLES: u32 = 4000;

/// A leg of a route with the highest speed that it allows.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SpeedLimit {
    /// Where the leg begins, metres.
    pub from: Vector,
    /// Where the leg ends, metres.
    pub to: Vector,
    /// m/s; infinite without a limit.
    pub most: f64,
}

impl SpeedLimit {
    fn distance(&self, place: Vector) -> f64 {
        let way = self.to - self.from;
        let along = (place - self.from).dot(&way) / way.norm_squared();
        (self.from + way * along.clamp(0.0, 1.0) - place).norm()
    }
}

/// A caution, its subject and its statement, where a motion is faster than the nearest leg allows.
/// Within `corner`, metres, of two legs the higher limit counts: the motion goes over to the next.
pub(super) fn exceeded(
    limits: &[SpeedLimit],
    motion: &Trajectory,
    corner: f64,
) -> Option<(&'static str, String)> {
    let limit_at = |place: Vector| {
        let all = limits.iter().map(|leg| (leg.distance(place), leg.most));
        let nearest = (all.clone().map(|(off, _)| off)).fold(f64::INFINITY, f64::min);
        let near = all.filter(|(off, _)| *off <= nearest + corner);
        near.map(|(_, most)| most).fold(0.0, f64::max)
    };
    let over = |time: f64| {
        let (speed, limit) = (
            motion.speed_at(time),
            limit_at(motion.pose_at(time).position),
        );
        (speed > (1.0 + SAME_SPEED) * limit).then_some((speed, limit))
    };
    if limits.is_empty() {
        return None;
    }
    let times = motion.sample_times(SAMPLE_S, MOST_SAMPLES).into_iter();
    let (speed, limit) = times
        .filter_map(over)
        .max_by(|a, b| (a.0 / a.1).total_cmp(&(b.0 / b.1)))?;
    let statement = format!(
        "not kept: the plan makes {} where a leg of the route allows {}",
        knots(speed),
        knots(limit)
    );
    Some(("speedMax", statement))
}
