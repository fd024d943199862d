//! A line or an arc at constant speed.

use super::DesiredTrajectory;
use searoom_geometry::frame::{Pose, Vector, direction, wrap};
use searoom_geometry::tolerance;

/// Motion at constant speed and turn rate: a straight line (turn rate 0), a circular arc, or a wait
/// (speed 0). Exact at every time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Segment {
    /// Pose at `start_time`.
    pub start: Pose,
    /// Seconds from the scenario's start.
    pub start_time: f64,
    /// Seconds, not negative.
    pub duration: f64,
    /// m/s, not negative.
    pub speed: f64,
    /// Radians per second, counter-clockwise (to port) positive.
    pub turn_rate: f64,
}

impl Segment {
    /// A line, an arc or a wait, by its fields in their order.
    #[inline]
    pub fn new(start: Pose, start_time: f64, duration: f64, speed: f64, turn_rate: f64) -> Self {
        Self {
            start,
            start_time,
            duration,
            speed,
            turn_rate,
        }
    }

    /// A straight line at constant speed, or a wait at speed 0.
    #[inline]
    pub fn straight(start: Pose, start_time: f64, duration: f64, speed: f64) -> Self {
        Self::new(start, start_time, duration, speed, 0.0)
    }

    /// True when every number is finite and neither duration nor speed is negative.
    #[inline]
    pub fn is_valid(&self) -> bool {
        let Pose { position, heading } = self.start;
        [
            position.x,
            position.y,
            heading,
            self.start_time,
            self.turn_rate,
        ]
        .iter()
        .all(|v| v.is_finite())
            && self.duration >= 0.0
            && self.duration.is_finite()
            && self.speed >= 0.0
            && self.speed.is_finite()
    }

    /// End time, seconds.
    #[inline]
    pub fn end_time(&self) -> f64 {
        self.start_time + self.duration
    }

    /// Pose at the end.
    #[inline]
    pub fn end(&self) -> Pose {
        self.pose_after(self.duration)
    }

    /// Pose at an absolute time in seconds, extrapolated beyond the segment's ends.
    #[inline]
    pub fn pose_at(&self, time: f64) -> Pose {
        self.pose_after(time - self.start_time)
    }

    /// Pose `elapsed` seconds after the start.
    ///
    /// The chord form `2 R sin(turn/2)` is also exact for small turns, where the difference of two
    /// sines cancels.
    pub fn pose_after(&self, elapsed: f64) -> Pose {
        let turn = self.turn_rate * elapsed;
        let half = 0.5 * turn;
        let chord = self.speed * elapsed * sinc(half);
        Pose {
            position: self.start.position + direction(self.start.heading + half) * chord,
            heading: self.start.heading + turn,
        }
    }

    /// Pose at half the duration.
    pub fn middle(&self) -> Pose {
        self.pose_after(0.5 * self.duration)
    }

    /// Length, metres.
    #[inline]
    pub fn length(&self) -> f64 {
        self.speed * self.duration
    }

    /// Velocity at an absolute time, m/s.
    #[inline]
    pub fn velocity_at(&self, time: f64) -> Vector {
        direction(self.start.heading + self.turn_rate * (time - self.start_time)) * self.speed
    }

    /// True when the turn rate is not zero.
    #[inline]
    pub fn is_arc(&self) -> bool {
        self.turn_rate != 0.0 && self.speed > 0.0
    }

    /// Signed radius of the arc in metres, positive to port; infinite on a line.
    pub fn radius(&self) -> f64 {
        self.speed / self.turn_rate
    }

    /// True for a segment that goes on from the end of this one in the same motion.
    pub fn is_continued_by(&self, next: &Self) -> bool {
        let end = self.end();
        (end.position - next.start.position).norm() <= tolerance::JOINT_M
            && (self.end_time() - next.start_time).abs() <= tolerance::TIME_S
            && wrap(end.heading - next.start.heading).abs() <= tolerance::JOINT_RAD
            && (self.speed, self.turn_rate) == (next.speed, next.turn_rate)
    }

    /// The part between two absolute times, clamped to the segment.
    ///
    /// A part that reaches the end keeps the segment's end exactly, independent of the rounding of
    /// its end time.
    #[inline]
    pub fn between(&self, from: f64, to: f64) -> Self {
        let elapsed = |time: f64| {
            if time >= self.end_time() {
                self.duration
            } else {
                (time - self.start_time).clamp(0.0, self.duration)
            }
        };
        let begun = elapsed(from);
        Self {
            start: self.pose_after(begun),
            start_time: from.clamp(self.start_time, self.end_time()),
            duration: elapsed(to).max(begun) - begun,
            ..*self
        }
    }

    /// [`Self::between`] two times, with time measured from `zero`.
    pub fn part(&self, from: f64, to: f64, zero: f64) -> Self {
        let part = self.between(from, to);
        Self {
            start_time: part.start_time - zero,
            ..part
        }
    }
}

/// `sin(x) / x`: the chord of an arc of `2 x` radians over its length.
pub(super) fn sinc(x: f64) -> f64 {
    match x.abs() < 1e-4 {
        true => 1.0 - x * x / 6.0,
        false => x.sin() / x,
    }
}

/// A segment prepared for many positions: one sine and cosine each on an arc, none on a line.
#[derive(Debug, Clone, Copy)]
pub struct Mover {
    start_time: f64,
    origin: Vector,
    velocity: Vector,
    /// From the centre of the circle to the start; unused on a line.
    arm: Vector,
    turn_rate: f64,
}

impl Mover {
    /// Prepares a segment.
    #[inline]
    pub fn new(segment: &Segment) -> Self {
        let velocity = segment.start.ahead() * segment.speed;
        let bent = segment.is_arc();
        // to starboard of the velocity by the radius when turning to port
        let arm = if bent {
            searoom_geometry::frame::to_starboard(velocity) / segment.turn_rate
        } else {
            Vector::zeros()
        };
        Self {
            start_time: segment.start_time,
            origin: segment.start.position,
            velocity,
            arm,
            turn_rate: if bent { segment.turn_rate } else { 0.0 },
        }
    }

    /// Position at an absolute time in seconds; equals [`Segment::pose_at`] to rounding on arcs of
    /// more than a millionth of a turn.
    pub fn position_at(&self, time: f64) -> Vector {
        let elapsed = time - self.start_time;
        if self.turn_rate == 0.0 {
            return self.origin + self.velocity * elapsed;
        }
        let (sin, cos) = (self.turn_rate * elapsed).sin_cos();
        // rotated arm minus arm: 1 - cos without cancellation
        let versine = sin * sin / (1.0 + cos).max(f64::MIN_POSITIVE);
        let versine = if cos > 0.0 { versine } else { 1.0 - cos };
        self.origin + searoom_geometry::frame::to_port(self.arm) * sin - self.arm * versine
    }

    /// Velocity at an absolute time in seconds, m/s.
    #[inline]
    pub fn velocity_at(&self, time: f64) -> Vector {
        if self.turn_rate == 0.0 {
            return self.velocity;
        }
        let (sin, cos) = (self.turn_rate * (time - self.start_time)).sin_cos();
        self.velocity * cos + searoom_geometry::frame::to_port(self.velocity) * sin
    }
}

/// The part of a motion before its first rest at the end of the desired trajectory, and all of a
/// motion without one. On a round trip the rest before own ship sets out is none.
pub fn before_stay<'a>(desired: &DesiredTrajectory, motion: &'a [Segment]) -> &'a [Segment] {
    let place = desired.end();
    let sets_out = match motion.first() {
        Some(first) if desired.comes_by(first.start.position) => {
            let moving = motion.iter().position(|segment| segment.speed > 0.0);
            moving.unwrap_or(motion.len())
        }
        _ => 0,
    };
    let rests = |segment: &Segment| {
        let off = (segment.start.position - place).norm();
        segment.speed == 0.0 && segment.duration > 0.0 && off <= tolerance::ARRIVAL_M
    };
    let first = motion[sets_out..].iter().position(rests);
    &motion[..first.map_or(motion.len(), |first| sets_out + first)]
}

/// A motion and the rest after it until a time, seconds, which takes the place of a motion of no
/// time.
pub fn rested(mut motion: Vec<Segment>, until: f64) -> Vec<Segment> {
    if let Some(last) = motion.last() {
        let (pose, end) = (last.end(), last.end_time());
        if motion.iter().all(|segment| segment.duration <= 0.0) {
            motion.clear();
        }
        if until - end > tolerance::TIME_S {
            motion.push(Segment::straight(pose, end, until - end, 0.0));
        }
    }
    motion
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_arc_stays_on_its_circle_and_a_flat_one_is_a_line() {
        let start = Pose::new(Vector::new(3.0, -2.0), 0.4);
        let arc = Segment::new(start, 5.0, 40.0, 5.0, -0.05);
        let centre = start.position + searoom_geometry::frame::to_starboard(start.ahead()) * 100.0;
        for i in 0..=40 {
            let p = arc.pose_at(5.0 + f64::from(i)).position;
            assert!(((p - centre).norm() - 100.0).abs() < 1e-9);
        }
        let flat = Segment {
            turn_rate: 1e-13,
            ..arc
        };
        let line = Segment {
            turn_rate: 0.0,
            ..arc
        };
        assert!((flat.end().position - line.end().position).norm() < 1e-8);
    }

    #[test]
    fn a_mover_is_where_its_segment_is() {
        let start = Pose::new(Vector::new(-40.0, 7.0), 2.2);
        for turn_rate in [0.0, 0.05, -0.02, 1e-5] {
            let segment = Segment::new(start, 3.0, 90.0, 5.0, turn_rate);
            let mover = Mover::new(&segment);
            for i in 0..90 {
                let t = 3.0 + f64::from(i);
                assert!((mover.position_at(t) - segment.pose_at(t).position).norm() < 1e-9);
            }
        }
    }

    #[test]
    fn cutting_keeps_the_motion() {
        let start = Pose::new(Vector::new(0.0, 0.0), 1.0);
        let arc = Segment::new(start, 2.0, 30.0, 4.0, 0.03);
        let part = arc.between(10.0, 20.0);
        for t in [10.0, 13.3, 20.0] {
            assert!((part.pose_at(t).position - arc.pose_at(t).position).norm() < 1e-9);
        }
    }
}
