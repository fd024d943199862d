//! Tests of the route.

use super::*;
use crate::frame::Vector;

/// A ship that may stop, on a line whose end is due before its start, or at zero speed.
#[test]
fn stretches_due_before_they_can_be_reached_are_not_waited_for() {
    for (slowness, fastest) in [(-0.1, true), (0.0, true), (f64::INFINITY, false)] {
        let piece = RoutePiece {
            start: Pose::new(Vector::zeros(), 0.0),
            distance: 0.0,
            length: 1000.0,
            curvature: 0.0,
            due: 0.0,
            slowness,
            leg: None,
            speed: None,
        };
        let route = Route {
            pieces: vec![piece],
            least_change: 0.0,
            speed_time: 0.0,
            speeds: vec![0.0, 2.0, 4.0],
        };
        let (speed, length) = route.speed_and_length(&piece, 0.0, piece.length, 0.0);
        assert_eq!(speed, if fastest { 4.0 } else { 2.0 }, "{slowness}");
        assert!(length >= LEAST_ALTERNATION_M, "{slowness}: {length}");
    }
}
