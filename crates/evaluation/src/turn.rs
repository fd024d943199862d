//! Turns on the spot: own hull sweeps every heading between two courses at one instant.

use crate::distance::clearance::{Body, least_distance};
use crate::least::Least;
use crate::sets::moving_slabs::MovingSlabs;
use searoom_geometry::frame::wrap;
use searoom_geometry::tolerance;
use searoom_model::trajectory::Segment;

/// Instantaneous change of heading between two segments.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Turn {
    /// The turn as a motion of one second per radian, through every heading on the side of the
    /// smaller turn.
    pub sweep: Segment,
    /// Time of the turn, seconds.
    pub time: f64,
}

/// Returns every turn on the spot of a chain of segments. For a half turn the side does not matter:
/// the hull covers equal areas about its centre.
pub(crate) fn turns(segments: &[Segment]) -> Vec<Turn> {
    let joints = segments.windows(2);
    joints
        .filter_map(|pair| {
            let (before, after) = (pair[0].end(), pair[1].start);
            let turn = wrap(after.heading - before.heading);
            if turn.abs() <= tolerance::JOINT_RAD {
                return None;
            }
            let mut start = after;
            start.heading = before.heading;
            Some(Turn {
                sweep: Segment::new(start, 0.0, turn.abs(), 0.0, turn.signum()),
                time: pair[1].start_time,
            })
        })
        .collect()
}

/// Least distance between own hull and a set during the turns. The set is fixed at the time of each
/// turn; the times of the result are those of the turns. NaN, a collision, for ellipses.
pub(crate) fn least_while_turning(turns: &[Turn], own: Body, slabs: &MovingSlabs) -> Least {
    let mut least = Least::new();
    for turn in turns {
        let Some(section) = slabs.section_at(turn.time) else {
            least.see(f64::NAN, turn.time);
            continue;
        };
        let here = least_distance(std::slice::from_ref(&turn.sweep), own, &section);
        least.see(here.value, turn.time);
        least.certified &= here.certified;
        least.probes += here.probes;
    }
    least
}

#[cfg(test)]
mod tests {
    use super::*;
    use searoom_geometry::ConvexPolygon;
    use searoom_geometry::frame::{Pose, Vector, direction};
    use searoom_model::target::Uncertainty;
    use searoom_model::vessel::Hull;
    use std::f64::consts::PI;

    fn straight(heading: f64, from: f64) -> Segment {
        Segment::straight(Pose::new(Vector::zeros(), heading), from, 10.0, 0.0)
    }

    /// The bow, 10 m ahead of the centre, passes a buoy at a distance of 3 m. Neither course comes
    /// near the buoy at any time.
    #[test]
    fn a_turn_sweeps_over_the_headings_between() {
        let body = Body::hull(&Hull::new(20.0, 0.2));
        let velocity = direction(0.7) * 0.5;
        let buoy = |bearing: f64| {
            let at_turn = direction(bearing) * 13.0;
            let initial = ConvexPolygon::point(at_turn - velocity * 10.0);
            MovingSlabs::new(&Uncertainty::constant(
                initial,
                ConvexPolygon::point(velocity),
            ))
        };
        let least = |to: f64, bearing: f64| {
            let turns = turns(&[straight(0.0, 0.0), straight(to, 10.0)]);
            let least = least_while_turning(&turns, body, &buoy(bearing));
            assert!(least.certified && least.time == 10.0);
            least.value
        };
        let bow = 10.0_f64.hypot(0.1);
        assert!(
            (least(1.4, 0.7) - (13.0 - bow)).abs() < 2e-3,
            "{}",
            least(1.4, 0.7)
        );
        assert!(least(1.4, -0.7) > 7.0 && least(1.4, 2.1) > 7.0);
        // A half turn may be to either side.
        assert!(least(PI, 0.7) < 3.01 && least(PI, -0.7) < 3.01);
        assert!(turns(&[straight(0.3, 0.0), straight(0.3, 10.0)]).is_empty());
    }
}
