//! The largest alteration of course of any motion.

use super::summary::{LEAST_TURN_DEG, Turn};
use crate::frame::{Side, deg_from_radians, wrap};
use crate::trajectory::Trajectory;

/// The largest turn to one side without a straight stretch or a turn back in it, the one at the start from the course before,
/// radians, included; `None` where all are too small to be seen.
pub(super) fn largest_alteration(trajectory: &Trajectory, before: f64) -> Option<Turn> {
    let mut largest = 0.0_f64;
    let mut turned = 0.0_f64;
    for change in changes(trajectory, before) {
        // a straight stretch, a change of 0, ends a turn
        turned = if turned * change > 0.0 {
            turned + change
        } else {
            change
        };
        if turned.abs() > largest.abs() {
            largest = turned;
        }
    }
    let degrees = deg_from_radians(largest.abs());
    let side = Side::of_turn(largest)?;
    (degrees >= LEAST_TURN_DEG).then_some(Turn { side, degrees })
}

/// Changes of the heading one after another, radians.
fn changes(trajectory: &Trajectory, before: f64) -> Vec<f64> {
    if let Some(motion) = trajectory.steered() {
        let nodes = motion.nodes().windows(2);
        return nodes
            .map(|pair| pair[1].pose.heading - pair[0].pose.heading)
            .collect();
    }
    let mut heading = before;
    let mut changes = Vec::new();
    for segment in trajectory.segments() {
        let corner = wrap(segment.start.heading - heading);
        // rounding at a joint is no corner
        if corner.abs() > crate::tolerance::JOINT_RAD {
            changes.push(corner);
        }
        if segment.duration > 0.0 && segment.speed > 0.0 {
            changes.push(segment.turn_rate * segment.duration);
        }
        heading = segment.start.heading + segment.turn_rate * segment.duration;
    }
    changes
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frame::{Pose, Vector};
    use crate::trajectory::Segment;

    #[test]
    fn the_largest_turn_is_found_at_the_start_in_arcs_and_at_corners() {
        let chain = |turns: &[f64]| {
            let mut pose = Pose::new(Vector::zeros(), 0.2);
            let mut segments: Vec<Segment> = Vec::new();
            for (i, turn) in turns.iter().enumerate() {
                let s = Segment {
                    start: pose,
                    start_time: 10.0 * i as f64,
                    duration: 10.0,
                    speed: 5.0,
                    turn_rate: turn / 10.0,
                };
                pose = s.end();
                segments.push(s);
            }
            Trajectory::new(segments).expect("a chain")
        };
        let degrees = |t: &Trajectory, before: f64| {
            largest_alteration(t, before)
                .map(|turn| (turn.side, (turn.degrees * 10.0).round() / 10.0))
        };
        let t = chain(&[0.1, 0.0, -0.2, -0.3, 0.0, 0.4]);
        assert_eq!(degrees(&t, 0.2), Some((Side::Starboard, 28.6)));
        // from a course of 0.9 before: 0.7 to starboard at once
        assert_eq!(degrees(&t, 0.9), Some((Side::Starboard, 40.1)));
        assert_eq!(degrees(&chain(&[0.0, 0.001]), 0.2), None);
        let mut corner = chain(&[0.0]).segments().to_vec();
        let end = corner[0].end();
        corner.push(Segment {
            start: Pose::new(end.position, end.heading + 1.0),
            start_time: 10.0,
            ..corner[0]
        });
        let corner = Trajectory::with_corners(corner).expect("a chain");
        assert_eq!(degrees(&corner, 0.2), Some((Side::Port, 57.3)));
    }
}
