//! Motion over ground of a hull that is turned from its course.

use super::Segment;
use super::segment::sinc;
use searoom_geometry::frame::{Pose, Vector, heading_of, wrap};

/// m/s. A slower ship lies still.
const STILL: f64 = 1e-6;

/// A line or an arc over ground, and the crab angle of own ship on it: in a current, or where it
/// drifts in a turn, its hull is turned from its course.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GroundSegment {
    /// Place and course over time.
    pub track: Segment,
    /// Course less heading, radians, counter-clockwise positive.
    pub crab: f64,
}

impl GroundSegment {
    /// From one pose of the hull to another, at constant speed and turn rate. The hull turns the
    /// shorter way.
    pub fn through([from, to]: [Pose; 2], start_time: f64, duration: f64) -> Self {
        let chord = to.position - from.position;
        let turn = wrap(to.heading - from.heading);
        let half = 0.5 * turn;
        let (mut speed, mut course) = (0.0, from.heading);
        // negated on purpose: a NaN stays
        if !(chord.norm() <= STILL * duration) {
            speed = chord.norm() / (sinc(half) * duration);
            course = heading_of(chord) - half;
        }
        let start = Pose::new(from.position, course);
        Self {
            track: Segment::new(start, start_time, duration, speed, turn / duration),
            crab: wrap(course - from.heading),
        }
    }

    /// Pose of the hull at a time in seconds.
    pub fn pose_at(&self, time: f64) -> Pose {
        let mut pose = self.track.pose_at(time);
        pose.heading -= self.crab;
        pose
    }

    /// Velocity over ground at a time in seconds, m/s.
    pub fn velocity_at(&self, time: f64) -> Vector {
        self.track.velocity_at(time)
    }

    /// The part between two times, with time measured from `zero`.
    pub fn part(&self, from: f64, to: f64, zero: f64) -> Self {
        Self {
            track: self.track.part(from, to, zero),
            ..*self
        }
    }

    /// True for a motion that goes on from the end of this one.
    pub fn is_continued_by(&self, next: &Self) -> bool {
        self.crab == next.crab && self.track.is_continued_by(&next.track)
    }
}

impl From<Segment> for GroundSegment {
    /// The hull lies along its course.
    fn from(track: Segment) -> Self {
        Self { track, crab: 0.0 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_ends_are_those_of_the_hull() {
        for (way, heading, turn) in [
            (Vector::new(3.0, 4.0), 0.4, 0.8),
            (Vector::new(-5.0, 0.1), 3.0, 1.5),
            (Vector::new(0.0, 2.0), -3.1, -2.0),
            (Vector::new(0.0, 2.0), 0.4, 1e-7),
            (Vector::new(1e-7, 1e-7), 0.4, 0.1),
            (Vector::zeros(), 0.4, 0.3),
        ] {
            let from = Pose::new(Vector::new(10.0, -20.0), heading);
            let to = Pose::new(from.position + way, wrap(heading + turn));
            let sailed = GroundSegment::through([from, to], 7.0, 2.0);
            for (time, pose) in [(7.0, from), (9.0, to)] {
                let found = sailed.pose_at(time);
                let off = (found.position - pose.position).norm();
                assert!(off <= 2.0 * STILL, "{sailed:?}");
                assert!(
                    wrap(found.heading - pose.heading).abs() < 1e-12,
                    "{sailed:?}"
                );
            }
        }
    }
}
