//! Course alterations of a motion.

use super::Trajectory;
use crate::frame::{Side, deg_from_radians, wrap};

/// Angle in degrees below which an alteration is not visible and does not count as a turn.
const LEAST_TURN_DEG: f64 = 0.5;

/// Degrees: an alteration from which on own ship departs from its course.
const DEPARTURE_DEG: f64 = 5.0;

/// Alteration of course to one side.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Alteration {
    pub side: Side,
    /// Angle in degrees, positive.
    pub degrees: f64,
    /// Start time in seconds.
    pub start: f64,
}

/// First alteration of course by 5° or more, else the first visible one. Corners of a path do not
/// count.
pub(crate) fn first_alteration(trajectory: &Trajectory) -> Option<Alteration> {
    let all = turns(trajectory, None);
    let departs = all.iter().find(|turn| turn.degrees >= DEPARTURE_DEG);
    departs.or(all.first()).copied()
}

/// Largest alteration of course to one side. Corners of the path count, and so does the initial
/// turn from the course `before`, in radians.
pub(crate) fn largest_alteration(trajectory: &Trajectory, before: f64) -> Option<Alteration> {
    let all = turns(trajectory, Some(before)).into_iter();
    all.reduce(|most, turn| {
        if turn.degrees > most.degrees {
            turn
        } else {
            most
        }
    })
}

/// Lists all visible turns in order of time. Consecutive arcs to one side form one turn; a straight
/// segment ends it. Under forces, turns are swings of the heading. Corners between segments count
/// if a course `before` the start is given.
fn turns(trajectory: &Trajectory, before: Option<f64>) -> Vec<Alteration> {
    if let Some(motion) = trajectory.steered() {
        let swings = motion.swings().into_iter();
        return swings
            .filter_map(|s| visible(s.turned, s.start_time))
            .collect();
    }
    let mut changes: Vec<(f64, f64)> = Vec::new();
    let mut heading = before;
    for segment in trajectory.segments() {
        let corner = heading.map_or(0.0, |heading| wrap(segment.start.heading - heading));
        // rounding at a joint is not a corner
        if corner.abs() > crate::tolerance::JOINT_RAD {
            changes.push((segment.start_time, corner));
        }
        let turned = segment.turn_rate * segment.duration;
        if segment.duration > 0.0 && segment.speed > 0.0 {
            changes.push((segment.start_time, turned));
        }
        heading = heading.map(|_| segment.start.heading + turned);
    }
    let mut turns = Vec::new();
    let mut current = (0.0, 0.0);
    for (start, change) in changes {
        if current.1 * change > 0.0 {
            current.1 += change;
        } else {
            turns.extend(visible(current.1, current.0));
            current = (start, change);
        }
    }
    turns.extend(visible(current.1, current.0));
    turns
}

/// Converts a heading change in radians to a turn; `None` if it is not visible.
fn visible(turned: f64, start: f64) -> Option<Alteration> {
    let degrees = deg_from_radians(turned.abs());
    let side = Side::of_turn(turned)?;
    (degrees >= LEAST_TURN_DEG).then_some(Alteration {
        side,
        degrees,
        start,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frame::{Pose, Vector};
    use crate::trajectory::fixtures::chain;
    use crate::trajectory::{ForceNode, Segment, Steered};

    /// Builds ten-second segments with the given turns in degrees to starboard.
    fn arcs(turns: &[f64]) -> Trajectory {
        let parts = turns.iter();
        let parts: Vec<_> = parts
            .map(|degrees| (10.0, 5.0, -degrees.to_radians() / 10.0))
            .collect();
        let start = Pose::new(Vector::zeros(), 0.2);
        Trajectory::new(chain(start, &parts)).expect("continuous")
    }

    #[test]
    fn the_first_turn_is_the_first_that_can_be_seen() {
        use Side::{Port, Starboard};
        for (turns, expected) in [
            (vec![0.0], None),
            (vec![0.2, 0.0, -0.3], None),
            (vec![0.0, 30.0, -60.0], Some((Starboard, 30.0))),
            (vec![-30.0, -15.0, 0.0, -5.0], Some((Port, 45.0))),
            (vec![0.1, -20.0], Some((Port, 20.0))),
            (vec![-1.3, 0.0, 51.0], Some((Starboard, 51.0))),
            (vec![-1.3, 0.0, 4.0], Some((Port, 1.3))),
            (vec![0.0, 40.0], Some((Starboard, 40.0))),
        ] {
            let found = first_alteration(&arcs(&turns));
            let found = found.map(|turn| (turn.side, (turn.degrees * 1e6).round() / 1e6));
            assert_eq!(found, expected, "{turns:?}");
        }
    }

    #[test]
    fn under_forces_what_swings_by_less_than_five_degrees_is_steering() {
        use Side::{Port, Starboard};
        // courses in degrees, clockwise
        let steered = |courses: &[f64]| {
            let nodes = courses.iter().enumerate().map(|(k, course)| ForceNode {
                time: k as f64,
                pose: Pose::new(Vector::zeros(), -course.to_radians()),
                velocity: Vector::new(1.0, 0.0),
                yaw_rate: 0.0,
                force: Vector::zeros(),
                moment: 0.0,
            });
            Trajectory::from(Steered::new(nodes.collect()).expect("in order"))
        };
        let found = |turn: Option<Alteration>| turn.map(|t| (t.side, t.degrees.round()));
        for (courses, first, largest) in [
            (vec![10.0, 12.0, 9.0, 13.0, 8.5], None, None),
            // two degrees to port first, and again at the end
            (
                vec![0.0, -2.0, 10.0, 30.0, 28.0],
                Some((Starboard, 32.0)),
                Some((Starboard, 32.0)),
            ),
            // a swing back by four degrees does not end a turn
            (
                vec![0.0, -10.0, -6.0, -40.0, 20.0, 0.0],
                Some((Port, 40.0)),
                Some((Starboard, 60.0)),
            ),
            (
                vec![0.0, 5.5],
                Some((Starboard, 6.0)),
                Some((Starboard, 6.0)),
            ),
        ] {
            let motion = steered(&courses);
            assert_eq!(found(first_alteration(&motion)), first, "{courses:?}");
            assert_eq!(
                found(largest_alteration(&motion, 0.0)),
                largest,
                "{courses:?}"
            );
        }
    }

    #[test]
    fn the_largest_turn_is_found_at_the_start_in_arcs_and_at_corners() {
        let degrees = |t: &Trajectory, before: f64| {
            largest_alteration(t, before)
                .map(|turn| (turn.side, (turn.degrees * 10.0).round() / 10.0))
        };
        let t = arcs(&[-5.0, 0.0, 10.0, 20.0, 0.0, -25.0]);
        assert_eq!(degrees(&t, 0.2), Some((Side::Starboard, 30.0)));
        // initial course 0.9: a turn of 0.7 to starboard at once
        assert_eq!(degrees(&t, 0.9), Some((Side::Starboard, 40.1)));
        assert_eq!(degrees(&arcs(&[0.0, 0.1]), 0.2), None);
        let mut corner = arcs(&[0.0]).segments().to_vec();
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
