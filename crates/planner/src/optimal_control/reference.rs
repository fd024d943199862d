//! Reference of the stage cost: the desired trajectory as a state over time.

use searoom_geometry::frame::heading_of;
use searoom_geometry::tolerance;
use searoom_model::trajectory::DesiredTrajectory;
use searoom_model::vessel::StateVector;

/// Leg that counts at a waypoint.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LegSide {
    /// Leg that ends there.
    Before,
    /// Leg that begins there.
    After,
}

/// State of the desired trajectory at `time`: position, heading and speed of its leg, zero sway and
/// yaw rate. After its end, at rest there.
pub fn reference(desired: &DesiredTrajectory, time: f64, side: LegSide) -> StateVector {
    let legs = desired.legs();
    let rounding = tolerance::LEG_END * (1.0 + desired.duration());
    let index = match side {
        LegSide::Before => legs.partition_point(|leg| leg.end_time() + rounding < time),
        LegSide::After => legs.partition_point(|leg| leg.end_time() - rounding <= time),
    };
    let over = index == legs.len();
    let leg = &legs[index.min(legs.len() - 1)];
    let position = desired.position_at(time);
    StateVector::new(
        position.x,
        position.y,
        heading_of(leg.direction),
        if over { 0.0 } else { leg.speed },
        0.0,
        0.0,
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use searoom_geometry::frame::Vector;

    #[test]
    fn corners_and_the_end_belong_to_the_requested_side() {
        let points = [(0.0, 0.0), (10.0, 0.0), (10.0, 6.0)].map(|(x, y)| Vector::new(x, y));
        let desired = DesiredTrajectory::new(&points, &[1.0, 2.0]).expect("valid");
        let at = |time, side| reference(&desired, time, side);
        assert_eq!(
            at(4.0, LegSide::Before),
            StateVector::new(4.0, 0.0, 0.0, 1.0, 0.0, 0.0)
        );
        assert_eq!(at(10.0, LegSide::Before)[3], 1.0);
        assert_eq!(at(10.0, LegSide::After)[3], 2.0);
        assert!((at(10.0, LegSide::After)[2] - std::f64::consts::FRAC_PI_2).abs() < 1e-15);
        assert_eq!(at(13.0, LegSide::Before)[3], 2.0);
        assert_eq!(at(13.0, LegSide::After)[3], 0.0);
        // a horizon is at the end but for rounding
        let end = desired.duration();
        assert_eq!(at(end.next_up(), LegSide::Before)[3], 2.0);
        assert_eq!(at(end.next_down(), LegSide::After)[3], 0.0);
        let late = at(99.0, LegSide::Before);
        assert_eq!((late[0], late[1], late[3]), (10.0, 6.0, 0.0));
    }
}
