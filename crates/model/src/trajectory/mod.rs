//! Trajectories: lines and arcs in time, the desired trajectory, and the network of paths.

mod desired;
mod ground;
mod network;
mod segment;
mod steered;

pub use desired::{DesiredLeg, DesiredTrajectory, Nearest};
pub use ground::GroundSegment;
pub use network::{NetworkError, NetworkLeg, PathNetwork};
pub use segment::Mover;
pub use segment::Segment;
pub use segment::{before_stay, rested};
pub use steered::{Bounds, hermite};
pub use steered::{Cubic, ForceNode, Steered};

use searoom_geometry::frame::{Pose, wrap};
use searoom_geometry::tolerance;

/// Why segments or waypoints are not a trajectory.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum TrajectoryError {
    /// No segment.
    #[error("a trajectory needs at least one segment")]
    Empty,
    /// A segment with a number that is not finite, a negative duration or a negative speed.
    #[error("segment {index} has a value that is not finite, or a negative duration or speed")]
    Invalid {
        /// Index of the segment, from 0.
        index: usize,
    },
    /// Two consecutive segments do not meet.
    #[error("segment {index} starts {gap:.3e} away from the end of the one before")]
    Gap {
        /// Index of the later segment, from 0.
        index: usize,
        /// The largest of the gaps in metres, seconds and radians.
        gap: f64,
    },
    /// Fewer than two waypoints.
    #[error("a desired trajectory needs at least two waypoints")]
    TooFewWaypoints,
    /// A leg without length or speed.
    #[error("leg {index} must have a positive length and a positive speed")]
    EmptyLeg {
        /// Index of the leg, from 0.
        index: usize,
    },
}

/// A continuous chain of [`Segment`]s: position is continuous, time increases, and heading is
/// continuous except at corners.
///
/// A motion under forces has no segments: see [`Trajectory::steered`].
#[derive(Debug, Clone, PartialEq)]
pub struct Trajectory {
    segments: Vec<Segment>,
    steered: Option<Steered>,
}

impl From<Segment> for Trajectory {
    /// A single segment; a duration or speed that is NaN or negative becomes 0.
    fn from(segment: Segment) -> Self {
        let segment = Segment {
            duration: segment.duration.max(0.0),
            speed: segment.speed.max(0.0),
            ..segment
        };
        Self {
            segments: vec![segment],
            steered: None,
        }
    }
}

impl From<Steered> for Trajectory {
    fn from(motion: Steered) -> Self {
        Self {
            segments: Vec::new(),
            steered: Some(motion),
        }
    }
}

impl Trajectory {
    /// A trajectory from segments that meet within [`tolerance::JOINT_M`], headings included.
    pub fn new(segments: Vec<Segment>) -> Result<Self, TrajectoryError> {
        Self::chained(segments, |turn| turn)
    }

    /// A trajectory along a path with corners, at which the heading may jump.
    pub fn with_corners(segments: Vec<Segment>) -> Result<Self, TrajectoryError> {
        Self::chained(segments, |_| 0.0)
    }

    fn chained(segments: Vec<Segment>, counted: fn(f64) -> f64) -> Result<Self, TrajectoryError> {
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
                let turn = wrap(end.heading - s.start.heading).abs();
                let gap = (end.position - s.start.position)
                    .norm()
                    .max((before.end_time() - s.start_time).abs())
                    .max(counted(turn));
                // negated so that a NaN is a gap
                if !(gap <= tolerance::JOINT_M) {
                    return Err(TrajectoryError::Gap { index, gap });
                }
            }
        }
        Ok(Self {
            segments,
            steered: None,
        })
    }

    /// The segments in order of time; empty for a motion under forces.
    pub fn segments(&self) -> &[Segment] {
        &self.segments
    }

    /// The nodes with their forces, for a motion under forces.
    pub fn steered(&self) -> Option<&Steered> {
        self.steered.as_ref()
    }

    /// Start time, seconds.
    pub fn start_time(&self) -> f64 {
        match &self.steered {
            Some(motion) => motion.nodes()[0].time,
            None => self.segments[0].start_time,
        }
    }

    /// End time, seconds.
    pub fn end_time(&self) -> f64 {
        match &self.steered {
            Some(motion) => motion.nodes()[motion.nodes().len() - 1].time,
            None => self.segments[self.segments.len() - 1].end_time(),
        }
    }

    /// The pose at the end.
    pub fn end(&self) -> Pose {
        match &self.steered {
            Some(motion) => motion.nodes()[motion.nodes().len() - 1].pose,
            None => self.segments[self.segments.len() - 1].end(),
        }
    }

    /// Length, metres.
    pub fn length(&self) -> f64 {
        match &self.steered {
            Some(motion) => motion.length(),
            None => self.segments.iter().map(Segment::length).sum(),
        }
    }

    fn segment_at(&self, time: f64) -> &Segment {
        let after = self.segments.partition_point(|s| s.end_time() <= time);
        &self.segments[after.min(self.segments.len() - 1)]
    }

    /// Pose at `time`, clamped to the trajectory's time span.
    pub fn pose_at(&self, time: f64) -> Pose {
        let clamped = time.clamp(self.start_time(), self.end_time());
        match &self.steered {
            Some(motion) => motion.piece_at(clamped).pose_at(clamped),
            None => self.segment_at(time).pose_at(clamped),
        }
    }

    /// Speed over ground at `time`, m/s: that of the first instant before the start, of the last
    /// one after the end.
    pub fn speed_at(&self, time: f64) -> f64 {
        match &self.steered {
            Some(motion) => {
                let clamped = time.clamp(self.start_time(), self.end_time());
                let piece = motion.piece_at(clamped);
                piece.velocity(piece.part(clamped)).norm()
            }
            None => self.segment_at(time).speed,
        }
    }

    /// Start times of the segments, or times of the nodes, seconds.
    pub fn joints(&self) -> Vec<f64> {
        match &self.steered {
            Some(motion) => motion.nodes().iter().map(|node| node.time).collect(),
            None => self.segments.iter().map(|s| s.start_time).collect(),
        }
    }

    /// Multiples of `step` from the start, the segments' starts or nodes, and the end, increasing.
    ///
    /// A longer step replaces `step` where it would give more than `most` multiples. A start or
    /// node replaces multiples next to it.
    pub fn sample_times(&self, step: f64, most: u32) -> Vec<f64> {
        let (start, end) = (self.start_time(), self.end_time());
        let step = step.max((end - start) / f64::from(most.max(1)));
        let count = ((end - start) / step).floor().max(0.0) as usize;
        let mut times = self.joints();
        times.push(end);
        times.dedup_by(|a, b| *a - *b < tolerance::TIME_S);
        let between = (0..=count).map(|i| start + step * i as f64).filter(|time| {
            let next = times.partition_point(|t| t < time);
            let near = &times[next.saturating_sub(1)..times.len().min(next + 1)];
            near.iter().all(|t| (t - time).abs() >= tolerance::TIME_S)
        });
        times.extend(between.collect::<Vec<_>>());
        times.sort_by(f64::total_cmp);
        times
    }
}
