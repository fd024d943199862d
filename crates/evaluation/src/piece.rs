//! Interface of the checker to a piece of motion: exact values, and bounds between two samples.

use searoom_geometry::frame::{Pose, Vector};
use searoom_model::trajectory::{Bounds, Cubic, GroundSegment, Segment};

/// Piece of own ship's motion, smooth within its time.
pub trait Piece: Copy + Sync {
    /// Start time, seconds.
    fn start_time(&self) -> f64;
    /// End time, seconds.
    fn end_time(&self) -> f64;
    /// Pose at a time in seconds.
    fn pose_at(&self, time: f64) -> Pose;
    /// Velocity over ground, m/s.
    fn velocity_at(&self, time: f64) -> Vector;
    /// Turn rate, rad/s, counter-clockwise.
    fn turn_rate_at(&self, time: f64) -> f64;
    /// Upper bounds of the derivatives within the piece.
    fn bounds(&self) -> Bounds;
    /// Part between two times, with time measured from `zero`.
    fn part(&self, from: f64, to: f64, zero: f64) -> Self;
}

/// Segment at rest at the end of a chain of pieces, for `duration` seconds; empty without pieces.
pub(crate) fn at_rest<P: Piece>(pieces: &[P], duration: f64) -> Vec<Segment> {
    let lying = |last: &P| {
        Segment::straight(
            last.pose_at(last.end_time()),
            last.end_time(),
            duration,
            0.0,
        )
    };
    pieces.last().map(lying).into_iter().collect()
}

/// Latest end of some pieces, seconds; 0 without any, infinite for a NaN.
pub(crate) fn end_of<P: Piece>(pieces: &[P]) -> f64 {
    let ends = pieces.iter().map(Piece::end_time);
    ends.fold(0.0, |latest, end| match end.is_nan() {
        true => f64::INFINITY,
        false => end.max(latest),
    })
}

/// Returns the parts of a chain of pieces after `from`, with time measured from `zero`. If `from`
/// is NaN, returns all pieces.
pub(crate) fn since<P: Piece>(pieces: &[P], from: f64, zero: f64) -> Vec<P> {
    // Negated on purpose: a NaN removes no piece.
    let later = pieces.iter().filter(|piece| !(piece.end_time() <= from));
    later
        .map(|piece| piece.part(piece.start_time().max(from), piece.end_time(), zero))
        .collect()
}

impl Piece for Segment {
    fn start_time(&self) -> f64 {
        self.start_time
    }

    fn end_time(&self) -> f64 {
        Segment::end_time(self)
    }

    fn pose_at(&self, time: f64) -> Pose {
        Segment::pose_at(self, time)
    }

    fn velocity_at(&self, time: f64) -> Vector {
        Segment::velocity_at(self, time)
    }

    fn turn_rate_at(&self, _: f64) -> f64 {
        self.turn_rate
    }

    fn bounds(&self) -> Bounds {
        Bounds {
            speed: self.speed,
            acceleration: self.speed * self.turn_rate.abs(),
            yaw_rate: self.turn_rate.abs(),
            yaw_acceleration: 0.0,
        }
    }

    fn part(&self, from: f64, to: f64, zero: f64) -> Self {
        Segment::part(self, from, to, zero)
    }
}

impl Piece for GroundSegment {
    fn start_time(&self) -> f64 {
        self.track.start_time
    }

    fn end_time(&self) -> f64 {
        self.track.end_time()
    }

    fn pose_at(&self, time: f64) -> Pose {
        GroundSegment::pose_at(self, time)
    }

    fn velocity_at(&self, time: f64) -> Vector {
        GroundSegment::velocity_at(self, time)
    }

    fn turn_rate_at(&self, _: f64) -> f64 {
        self.track.turn_rate
    }

    fn bounds(&self) -> Bounds {
        Piece::bounds(&self.track)
    }

    fn part(&self, from: f64, to: f64, zero: f64) -> Self {
        GroundSegment::part(self, from, to, zero)
    }
}

impl Piece for Cubic {
    fn start_time(&self) -> f64 {
        self.start_time
    }

    fn end_time(&self) -> f64 {
        Cubic::end_time(self)
    }

    fn pose_at(&self, time: f64) -> Pose {
        Cubic::pose_at(self, time)
    }

    fn velocity_at(&self, time: f64) -> Vector {
        self.velocity(Cubic::part(self, time))
    }

    fn turn_rate_at(&self, time: f64) -> f64 {
        self.yaw_rate_at(time)
    }

    fn bounds(&self) -> Bounds {
        Cubic::bounds(self)
    }

    fn part(&self, from: f64, to: f64, zero: f64) -> Self {
        let from = from.clamp(self.start_time, Cubic::end_time(self));
        let to = to.clamp(from, Cubic::end_time(self));
        let cut = self.between(from, to);
        Self {
            start_time: cut.start_time - zero,
            ..cut
        }
    }
}
