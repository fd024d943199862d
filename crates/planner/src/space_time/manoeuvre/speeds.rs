//! The speeds that manoeuvres use.

use crate::Problem;
use searoom_model::trajectory::DesiredLeg;

/// The leg that is due at a time, seconds.
pub(crate) fn due_leg<'a>(problem: &Problem<'a>, time: f64) -> &'a DesiredLeg {
    let legs = problem.desired.legs();
    let due = legs.partition_point(|leg| leg.start_time <= time);
    &legs[due.saturating_sub(1)]
}

/// Speeds of the manoeuvres: least and greatest speed, and the ordered one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct ManoeuvreSpeeds {
    pub slow: f64,
    pub normal: f64,
    pub fast: f64,
    /// The ordered speed, which own ship may not be able to keep.
    pub wanted: f64,
}

impl ManoeuvreSpeeds {
    /// Least and greatest moving speed, and the one nearest to the speed of the leg that is due at a
    /// time, seconds.
    pub(crate) fn at(problem: &Problem, time: f64) -> Self {
        let mut moving = problem.own.moving_speeds();
        let ordered = due_leg(problem, time).speed;
        let off = |u: &f64| (u - ordered).abs();
        let nearest = moving.clone().min_by(|a, b| off(a).total_cmp(&off(b)));
        let fast = problem.own.max_speed();
        Self {
            slow: moving.next().unwrap_or(fast),
            normal: nearest.unwrap_or(fast),
            fast,
            wanted: ordered,
        }
    }
}
