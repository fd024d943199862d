//! The highest speeds that the legs of a route allow, and plans that are faster.

use super::check::SAME_SPEED;
use searoom_geometry::frame::Vector;
use searoom_input::text::knots;
use searoom_model::trajectory::Trajectory;

/// Seconds between two samples of a plan.
const SAMPLE_S: f64 = 5.0;
const MOST_SAMPLES: u32 = 4000;

/// A leg of a route with its speed limit, in the scenario's plane (east, north).
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
    /// Metres from the leg's start to its point nearest to a place, and from there to the place.
    fn nearest(&self, place: Vector) -> (f64, f64) {
        let way = self.to - self.from;
        let length = way.norm();
        let along = match length > 0.0 {
            true => ((place - self.from).dot(&way) / length).clamp(0.0, length),
            false => 0.0,
        };
        let point = self.from + way * (along / length.max(f64::MIN_POSITIVE));
        (along, (point - place).norm())
    }

    fn length(&self) -> f64 {
        (self.to - self.from).norm()
    }
}

/// Metres before and after a corner in which the motion turns to the next leg with a `radius`, at
/// most half of either leg.
fn turn_of(leg: &SpeedLimit, next: &SpeedLimit, radius: f64) -> f64 {
    let half = 0.5 * (leg.to - leg.from).angle(&(next.to - next.from));
    let tangent = radius * half.tan().min(2.0);
    tangent.min(0.5 * leg.length()).min(0.5 * next.length())
}

/// The limit at a place, m/s, where own ship has sailed so many metres. Legs are candidates that are
/// at most `radius` farther than the nearest one; the distance sailed tells which of them it is, as
/// a route may come by a place again. While the motion turns to the next leg, the higher limit counts.
fn limit_at(limits: &[SpeedLimit], place: Vector, sailed: f64, radius: f64) -> f64 {
    let nearest = limits.iter().map(|leg| leg.nearest(place).1);
    let nearest = nearest.fold(f64::INFINITY, f64::min);
    let mut begins = 0.0;
    let mut found = (f64::INFINITY, 0.0);
    for (index, leg) in limits.iter().enumerate() {
        let (along, off) = leg.nearest(place);
        let ahead = (begins + along - sailed).abs();
        if off <= nearest + radius && ahead < found.0 {
            let before = index.checked_sub(1).map(|before| &limits[before]);
            let before = before.filter(|before| along <= turn_of(before, leg, radius));
            let left = leg.length() - along;
            let after = limits.get(index + 1);
            let after = after.filter(|after| left <= turn_of(leg, after, radius));
            let beside = before.into_iter().chain(after);
            found = (ahead, beside.fold(leg.most, |most, leg| most.max(leg.most)));
        }
        begins += leg.length();
    }
    found.1
}

/// A caution, its subject and its statement, where a motion that turns with a `radius`, metres, is
/// faster than the legs of its route allow. Samples of five seconds.
pub(super) fn exceeded(
    limits: &[SpeedLimit],
    motion: &Trajectory,
    radius: f64,
) -> Option<(&'static str, String)> {
    if limits.is_empty() {
        return None;
    }
    let (mut sailed, mut last) = (0.0, motion.pose_at(0.0).position);
    let mut worst: Option<(f64, f64)> = None;
    for time in motion.sample_times(SAMPLE_S, MOST_SAMPLES) {
        let place = motion.pose_at(time).position;
        sailed += (place - last).norm();
        last = place;
        let (speed, limit) = (
            motion.speed_at(time),
            limit_at(limits, place, sailed, radius),
        );
        // negated on purpose: what is no number is too fast
        let is_over = !(speed <= (1.0 + SAME_SPEED) * limit);
        let is_worse = |(faster, less): (f64, f64)| speed * less > faster * limit;
        if is_over && worst.is_none_or(is_worse) {
            worst = Some((speed, limit));
        }
    }
    let (speed, limit) = worst?;
    let statement = format!(
        "not kept: the plan makes {} where a leg of the route allows {}",
        knots(speed),
        knots(limit)
    );
    Some(("speedMax", statement))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Legs through places on east and north axes, with their limits.
    fn legs(through: &[[f64; 2]], most: &[f64]) -> Vec<SpeedLimit> {
        let at = |[east, north]: [f64; 2]| Vector::new(east, north);
        let ends = through.windows(2);
        let leg = |(ends, most): (&[[f64; 2]], &f64)| SpeedLimit {
            from: at(ends[0]),
            to: at(ends[1]),
            most: *most,
        };
        ends.zip(most).map(leg).collect()
    }

    #[test]
    fn a_short_leg_between_free_ones_keeps_its_limit() {
        let free = f64::INFINITY;
        let route = legs(
            &[[0.0, 0.0], [3000.0, 0.0], [4000.0, 0.0], [7000.0, 0.0]],
            &[free, 4.0, free],
        );
        let limit = |east: f64| limit_at(&route, Vector::new(east, 60.0), east, 500.0);
        assert_eq!((limit(2900.0), limit(4100.0)), (free, free));
        assert_eq!(
            (limit(3100.0), limit(3500.0), limit(3900.0)),
            (4.0, 4.0, 4.0)
        );
    }

    #[test]
    fn at_a_corner_the_higher_limit_counts_while_own_ship_turns() {
        let route = legs(&[[0.0, 0.0], [3000.0, 0.0], [3000.0, 3000.0]], &[4.0, 7.0]);
        let limit = |east: f64| limit_at(&route, Vector::new(east, 0.0), east, 500.0);
        assert_eq!((limit(2400.0), limit(2600.0)), (4.0, 7.0));
    }

    #[test]
    fn out_and_back_on_one_line_each_way_has_its_own_limit() {
        let route = legs(&[[0.0, 0.0], [5000.0, 0.0], [0.0, 0.0]], &[4.0, 7.0]);
        let limit =
            |east: f64, sailed: f64| limit_at(&route, Vector::new(east, 0.0), sailed, 300.0);
        assert_eq!((limit(1000.0, 1050.0), limit(1000.0, 9100.0)), (4.0, 7.0));
    }

    #[test]
    fn what_is_no_number_has_no_speed_allowed() {
        let route = legs(&[[0.0, 0.0], [f64::NAN, 0.0]], &[4.0]);
        assert_eq!(limit_at(&route, Vector::zeros(), 0.0, 300.0), 0.0);
    }
}
