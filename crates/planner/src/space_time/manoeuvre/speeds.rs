//! The speeds that manoeuvres use.

use crate::Problem;

/// Speeds of the manoeuvres: least and greatest speed, and the desired one.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ManoeuvreSpeeds {
    pub slow: f64,
    pub normal: f64,
    pub fast: f64,
}

impl ManoeuvreSpeeds {
    /// Least and greatest moving speed, and the one nearest to the desired speed.
    pub(crate) fn of(problem: &Problem) -> Self {
        let mut moving = problem.own.moving_speeds();
        let desired = problem.desired.length() / problem.desired.duration();
        let off = |u: &f64| (u - desired).abs();
        let nearest = moving.clone().min_by(|a, b| off(a).total_cmp(&off(b)));
        let fast = problem.own.max_speed();
        Self {
            slow: moving.next().unwrap_or(fast),
            normal: nearest.unwrap_or(fast),
            fast,
        }
    }
}
