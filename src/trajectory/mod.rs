//! What every planner returns: exact constant-speed lines and arcs in time; and what it is compared
//! with: the desired trajectory.

mod desired;
mod segment;
mod steered;

pub use desired::{DesiredLeg, DesiredTrajectory, Nearest};
pub use segment::{Mover, Segment};
pub use steered::{Bounds, Cubic, Node, Steered, hermite};

use crate::frame::{Pose, wrap};
use crate::tolerance;

/// Why segments or waypoints do not make a trajectory.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum TrajectoryError {
    /// No segment at all.
    #[error("a trajectory needs at least one segment")]
    Empty,
    /// A segment with a number that is not finite, a negative duration or a negative speed.
    #[error("segment {index} has a value that is not finite, or a negative duration or speed")]
    Invalid {
        /// Which segment, from 0.
        index: usize,
    },
    /// Two segments do not meet.
    #[error("segment {index} starts {gap:.3e} away from the end of the one before")]
    Gap {
        /// The later segment, from 0.
        index: usize,
        /// The largest of the gaps in metres, seconds and radians.
        gap: f64,
    },
    /// Fewer than two waypoints.
    #[error("a desired trajectory needs at least two waypoints")]
    TooFewWaypoints,
    /// A leg of no length, or at no speed.
    #[error("leg {index} must have a positive length and a positive speed")]
    EmptyLeg {
        /// Which leg, from 0.
        index: usize,
    },
}

/// A continuous chain of [`Segment`]s: position and heading continuous, time increasing.
#[derive(Debug, Clone, PartialEq)]
pub struct Trajectory {
    segments: Vec<Segment>,
}

impl Trajectory {
    /// A trajectory from segments that meet within [`tolerance::JOINT_M`].
    pub fn new(segments: Vec<Segment>) -> Result<Self, TrajectoryError> {
        if segments.is_empty() {
            return Err(TrajectoryError::Empty);
        }
        for (index, s) in segments.iter().enumerate() {
            if !s.is_valid() {
                return Err(TrajectoryError::Invalid { index });
            }
            if index > 0 {
                let before = &segments[index - 1];
                let end = before.end();
                let gap = (end.position - s.start.position)
                    .norm()
                    .max((before.end_time() - s.start_time).abs())
                    .max(wrap(end.heading - s.start.heading).abs());
                // negated on purpose: a NaN is a gap
                if !(gap <= tolerance::JOINT_M) {
                    return Err(TrajectoryError::Gap { index, gap });
                }
            }
        }
        Ok(Self { segments })
    }

    /// The segments, in order of time.
    pub fn segments(&self) -> &[Segment] {
        &self.segments
    }

    /// Seconds at which the first segment starts.
    pub fn start_time(&self) -> f64 {
        self.segments[0].start_time
    }

    /// Seconds at which the last segment ends: the arrival of a plan.
    pub fn end_time(&self) -> f64 {
        self.segments[self.segments.len() - 1].end_time()
    }

    /// The pose at the end.
    pub fn end(&self) -> Pose {
        self.segments[self.segments.len() - 1].end()
    }

    /// Horizontal length in metres.
    pub fn length(&self) -> f64 {
        self.segments.iter().map(Segment::length).sum()
    }

    /// The segment in force at `time`; before the start the first, after the end the last.
    pub fn segment_at(&self, time: f64) -> &Segment {
        let after = self.segments.partition_point(|s| s.end_time() <= time);
        &self.segments[after.min(self.segments.len() - 1)]
    }

    /// The pose at `time`, clamped to the trajectory's own time span.
    pub fn pose_at(&self, time: f64) -> Pose {
        self.segment_at(time)
            .pose_at(time.clamp(self.start_time(), self.end_time()))
    }

    /// Every multiple of `step` seconds from the start, each segment's start and the end; increasing,
    /// without repetition.
    pub fn sample_times(&self, step: f64) -> Vec<f64> {
        let (start, end) = (self.start_time(), self.end_time());
        let count = ((end - start) / step).floor().clamp(0.0, 1e6) as usize;
        let mut times: Vec<f64> = (0..=count).map(|i| start + step * i as f64).collect();
        times.extend(self.segments.iter().map(|s| s.start_time));
        times.push(end);
        times.sort_by(f64::total_cmp);
        times.dedup_by(|a, b| *a - *b < tolerance::TIME_S);
        times
    }
}
