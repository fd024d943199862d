//! Return segments: the route followed after a manoeuvre, with the rates of its cost in the joining
//! position and time.

use crate::cost::error_after_end;
use crate::space_time::context::Context;
use crate::space_time::refinement::approach::Approach;
use crate::space_time::refinement::rollout::Rollout;
use searoom_geometry::tolerance;

/// Cost of the route from a position and time, with its rates per second and per metre and its
/// second rate per second. Also the schedule's seconds per metre there.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ReturnSegments {
    pub cost: f64,
    pub by_time: f64,
    pub by_distance: f64,
    pub curvature_along: f64,
    pub slowness: f64,
}

impl Context<'_> {
    /// Return segments, in closed form where there is one.
    pub(crate) fn return_segments(&self, distance: f64, time: f64) -> ReturnSegments {
        self.straight_return_segments(distance, time)
            .unwrap_or_else(|| self.general_return_segments(distance, time))
    }

    /// Wait of a ship that arrives at the last waypoint early. `None` for one that does not.
    pub(crate) fn wait_at_end(&self, rollout: &Rollout) -> Option<ReturnSegments> {
        let (desired, q) = (self.problem.desired, self.problem.time_weight);
        let last = &rollout.legs.last()?.segment;
        let left = desired.duration() - last.end_time();
        let error = desired.nearest(desired.end(), last.end_time(), q).error;
        let rate = error / desired.duration();
        (left > tolerance::TIME_S).then(|| ReturnSegments {
            cost: error_after_end(desired, last, q),
            by_time: -rate,
            by_distance: 0.0,
            curvature_along: 2.0 * rate / left,
            slowness: 0.0,
        })
    }

    /// Cost of following the route from a position at a time, m².
    fn return_cost(&self, distance: f64, time: f64) -> f64 {
        self.problem
            .error_to_end(&self.route.follow(distance, time))
    }

    /// Closed form on the last leg: own ship recovers the lag at the greatest or least speed, then
    /// keeps the schedule. The lag decreases at a constant rate `r`, so the cost is
    /// `kappa lag³ / (3 r T_d)`. `None` in any other case.
    fn straight_return_segments(&self, distance: f64, time: f64) -> Option<ReturnSegments> {
        let desired = self.problem.desired;
        let last = desired.legs().len() - 1;
        let leg = &desired.legs()[last];
        let stretch = self
            .route
            .stretch(last, desired)
            .filter(|s| s.distance <= distance && self.route.recovers())?;
        let own = self.problem.own;
        own.speeds
            .iter()
            .find(|u| (*u - leg.speed).abs() <= 1e-9 * leg.speed)?;
        let along = stretch.from + distance - stretch.distance;
        let lag = leg.speed * (time - leg.start_time) - along;
        let (pace, rate) = if lag >= 0.0 {
            (own.max_speed(), own.max_speed() - leg.speed)
        } else {
            (own.min_speed(), leg.speed - own.min_speed())
        };
        let recovery = lag.abs() / rate;
        let due = self.route.due_at(distance);
        let on_timetable = (due - leg.start_time - along / leg.speed).abs() < 1e-6;
        // negated on purpose: a NaN does not fit
        if !(rate > 1e-9 && along + recovery * pace <= stretch.to && on_timetable) {
            return None;
        }
        let q = self.problem.time_weight;
        let kappa = q / (q + leg.speed * leg.speed) / (rate * desired.duration());
        let by_lag = kappa * lag * lag.abs();
        Some(ReturnSegments {
            cost: kappa * lag.abs().powi(3) / 3.0,
            by_time: by_lag * leg.speed,
            by_distance: -by_lag,
            curvature_along: 2.0 * kappa * lag.abs() * leg.speed * leg.speed,
            slowness: 1.0 / leg.speed,
        })
    }

    /// General return segments, by differences in the position and time of joining.
    fn general_return_segments(&self, distance: f64, time: f64) -> ReturnSegments {
        let (ds, dt) = (0.05, 0.01);
        let cost = self.return_cost(distance, time);
        let (earlier, later) = (
            self.return_cost(distance, time - dt),
            self.return_cost(distance, time + dt),
        );
        let (back, on) = (
            self.return_cost(distance - ds, time),
            self.return_cost(distance + ds, time),
        );
        ReturnSegments {
            cost,
            by_time: (later - earlier) / (2.0 * dt),
            by_distance: (on - back) / (2.0 * ds),
            curvature_along: ((later + earlier - 2.0 * cost) / (dt * dt)).max(0.0),
            slowness: (self.route.due_at(distance + ds) - self.route.due_at(distance)) / ds,
        }
    }

    /// Rates of the slack at an approach on the return segments with the position and time of
    /// joining, by differences.
    pub(crate) fn return_segment_rates(
        &self,
        rollout: &Rollout,
        index: usize,
        approach: &Approach,
    ) -> (f64, f64) {
        let of = approach.rates;
        let (s, t) = rollout.joined;
        let (ds, dt) = (0.05, 0.01);
        let at = |distance: f64, time: f64| -> Option<f64> {
            let motion = self.route.follow(distance, time);
            let segment = motion.get(index)?;
            let elapsed = segment.duration * approach.fraction;
            let position = segment.pose_after(elapsed).position;
            Some(of[0] * position.x + of[1] * position.y + of[2] * (segment.start_time + elapsed))
        };
        let here = at(s, t).unwrap_or_default();
        let by_distance = (at(s + ds, t).unwrap_or(here) - here) / ds;
        let by_time = (at(s, t + dt).unwrap_or(here) - here) / dt;
        (by_distance, by_time)
    }
}
