//! Distances at which a motion passes the waypoints between the first and the last.

use crate::piece::Piece;
use searoom_geometry::frame::Vector;
use searoom_model::trajectory::DesiredTrajectory;

/// Accuracy of the distances, metres.
pub const ACCURACY_M: f64 = 0.01;

/// Largest number of parts of a piece. A long circle about a waypoint would need more, and is
/// divided less finely.
const MOST_PARTS: usize = 10_000;

/// Least distance of a motion from each waypoint between the first and the last, metres. It is at
/// most [`ACCURACY_M`] too large, or the length of the longest of [`MOST_PARTS`] parts. NaN for a
/// motion that is not finite. O(pieces) per waypoint, more for a circle about one.
pub(crate) fn waypoint_distances<P: Piece>(pieces: &[P], desired: &DesiredTrajectory) -> Vec<f64> {
    let inner = desired.legs().iter().skip(1).map(|leg| leg.start);
    inner.map(|place| least_distance(pieces, place)).collect()
}

/// Bisects each piece until no part is nearer by more than the accuracy, by the greatest speed.
fn least_distance<P: Piece>(pieces: &[P], place: Vector) -> f64 {
    let mut least = f64::INFINITY;
    for piece in pieces {
        let distance_at = |time: f64| (piece.pose_at(time).position - place).norm();
        let (start, end) = (piece.start_time(), piece.end_time());
        let ends = [distance_at(start), distance_at(end)];
        if ends.iter().any(|distance| !distance.is_finite()) {
            return f64::NAN;
        }
        least = least.min(ends[0]).min(ends[1]);
        let mut open = vec![(start, end)];
        let mut parts = 0;
        while let Some((from, until)) = open.pop() {
            let middle = 0.5 * (from + until);
            let distance = distance_at(middle);
            if !distance.is_finite() {
                return f64::NAN;
            }
            least = least.min(distance);
            let nearest = distance - 0.5 * piece.bounds().speed * (until - from);
            parts += 1;
            if nearest < least - ACCURACY_M && parts < MOST_PARTS {
                open.extend([(from, middle), (middle, until)]);
            }
        }
    }
    least
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ship_fixtures::{chain, desired};
    use searoom_geometry::frame::Pose;

    /// A line past a waypoint, a circle about one, and one that is not passed.
    #[test]
    fn distances_match_closed_form() {
        let inner = [(300.0, 40.0), (600.0, 100.0), (500.0, -900.0)];
        let round = [&[(0.0, 0.0)], &inner[..], &[(0.0, 0.0)]].concat();
        let desired = desired(&round, &[5.0; 4]);
        let lap = 2.0 * std::f64::consts::PI * 100.0 / 5.0;
        let motion = chain(
            Pose::new(Vector::zeros(), 0.0),
            &[(120.0, 5.0, 0.0), (lap, 5.0, 0.05), (20.0, 0.0, 0.0)],
        );
        let exact = [40.0, 100.0, 900.0];
        let found = waypoint_distances(&motion, &desired);
        for (found, exact) in found.iter().zip(exact) {
            let more = found - exact + 1e-9;
            assert!((0.0..=ACCURACY_M).contains(&more), "{found} {exact}");
        }
        assert_eq!(found.len(), 3);
    }

    /// Lines of 10 to 1,000 km straight through the waypoint.
    #[test]
    fn long_lines_have_exact_distances() {
        for length in [1e4, 1e5, 1e6] {
            let way = [(0.0, 0.0), (length / 3.0, 0.0), (length, 0.0)];
            let desired = desired(&way, &[10.0; 2]);
            for beside in [0.0, 0.005, 3.0] {
                let start = Pose::new(Vector::new(0.0, beside), 0.0);
                let motion = chain(start, &[(length / 10.0, 10.0, 0.0)]);
                let found = waypoint_distances(&motion, &desired)[0];
                assert!(found >= beside && found <= beside + ACCURACY_M, "{found}");
            }
        }
    }

    /// An unsound document: 1e300 m/s, and a turn of a year on the spot of a waypoint.
    #[test]
    fn the_number_of_parts_is_bounded() {
        let desired = desired(&[(0.0, 0.0), (0.0, 100.0), (900.0, 0.0)], &[5.0; 2]);
        for unsound in [(1e-3, 1e300, 0.0), (3e7, 50.0, 0.5), (1e9, 1e18, 1e16)] {
            let motion = chain(Pose::new(Vector::zeros(), 0.0), &[unsound]);
            let found = waypoint_distances(&motion, &desired)[0];
            assert!(found.is_nan() || found <= 100.0, "{found}");
        }
    }
}
