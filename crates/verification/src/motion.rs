//! Motion of a document: segments, or nodes with forces.

use super::claim::{ClaimError, ClaimedMotion, fault, not_negative};
use searoom_document::{ControlDocument, PlanDocument, SampleDocument, SegmentDocument};
use searoom_evaluation::{StageWeights, Violation};
use searoom_geometry::frame::{Pose, Vector, heading_from_course_deg, radians_from_deg, wrap};
use searoom_model::trajectory::{ForceNode, Segment, Steered};
use searoom_model::vessel::{ForceVector, StateVector, VesselKind};

impl ClaimedMotion {
    /// Number of segments, or of intervals between nodes.
    pub fn pieces(&self) -> usize {
        match self {
            Self::Segments(segments) => segments.len(),
            Self::Steered { motion, .. } => motion.nodes().len() - 1,
        }
    }

    /// Returns false for invalid or missing segments, which allow no further checks.
    pub fn is_sound(&self) -> bool {
        match self {
            Self::Segments(segments) => {
                !segments.is_empty() && segments.iter().all(Segment::is_valid)
            }
            Self::Steered { .. } => true,
        }
    }

    /// End of the motion, seconds; NaN without segments.
    pub fn end_time(&self) -> f64 {
        match self {
            Self::Segments(segments) => segments.last().map_or(f64::NAN, Segment::end_time),
            Self::Steered { motion, .. } => motion.nodes()[motion.nodes().len() - 1].time,
        }
    }

    /// Poses at a time: two at the joint of two segments.
    pub fn poses_at(&self, time: f64) -> Vec<Pose> {
        match self {
            Self::Segments(segments) => around(segments, time).map(|s| s.pose_at(time)).collect(),
            Self::Steered { motion, .. } => vec![motion.piece_at(time).pose_at(time)],
        }
    }
}

/// Returns the segments that contain a time.
pub(super) fn around(segments: &[Segment], time: f64) -> impl Iterator<Item = &Segment> {
    // The end of one segment and the start of the next differ by rounding.
    let slack = searoom_geometry::tolerance::TIME_S;
    segments
        .iter()
        .filter(move |s| s.start_time - slack <= time && time <= s.end_time() + slack)
}

/// Reads the motion. `None` for a document without a plan; nodes that form no valid motion are
/// added to `faults`.
pub(super) fn read(
    file: &PlanDocument,
    faults: &mut Vec<Violation>,
) -> Result<Option<ClaimedMotion>, ClaimError> {
    let Some(trajectory) = &file.trajectory else {
        return Ok(None);
    };
    match (&trajectory.segments, &file.optimal_control) {
        (Some(segments), None) => Ok(Some(ClaimedMotion::Segments(
            segments.iter().map(SegmentDocument::segment).collect(),
        ))),
        (None, Some(control)) => {
            let mut known = VesselKind::WORDS.into_iter();
            let Some((_, vessel)) = known.find(|(word, _)| *word == control.vessel) else {
                let words = VesselKind::WORDS.map(|(word, _)| word).join(", ");
                let found = format!("'{}'", control.vessel);
                return Err(fault("optimal_control.vessel", found, &words));
            };
            let limits = &control.force_limits;
            let force_limits = ForceVector::new(limits.surge_n, limits.sway_n, limits.yaw_nm);
            match Steered::new(nodes(&trajectory.samples)) {
                Ok(motion) => Ok(Some(ClaimedMotion::Steered {
                    motion,
                    vessel,
                    force_limits,
                    start_velocity: control
                        .start
                        .map_or([file.own_ship.speed_mps, 0.0, 0.0], |start| {
                            start.velocity()
                        }),
                    weights: weights(control)?,
                })),
                Err(error) => {
                    let what = format!("nodes among trajectory.samples: {error}");
                    faults.push(Violation::new(what, 0.0));
                    // A chain without segments is judged as no motion.
                    Ok(Some(ClaimedMotion::Segments(Vec::new())))
                }
            }
        }
        (Some(_), Some(_)) => {
            let found = "beside segments";
            Err(fault("optimal_control", found, "one of the two"))
        }
        (None, None) => {
            let found = "null without optimal_control";
            let allowed = "segments, or a motion under forces";
            Err(fault("trajectory.segments", found, allowed))
        }
    }
}

fn weights(control: &ControlDocument) -> Result<StageWeights, ClaimError> {
    let checked = |key: &str, values: &[f64]| {
        values.iter().enumerate().try_for_each(|(index, value)| {
            not_negative(&format!("optimal_control.{key}[{index}]"), *value).map(|_| ())
        })
    };
    checked("state_weights", &control.state_weights)?;
    checked("control_weights", &control.control_weights)?;
    Ok(StageWeights {
        state: StateVector::from(control.state_weights),
        force: ForceVector::from(control.control_weights),
    })
}

/// Converts the samples that are nodes. A course has no full circles, so the heading is continued
/// by the turn nearest to the integral of the yaw rates.
fn nodes(samples: &[SampleDocument]) -> Vec<ForceNode> {
    let mut nodes: Vec<ForceNode> = Vec::new();
    for sample in samples {
        let Some(mut node) = node(sample) else {
            continue;
        };
        if let Some(before) = nodes.last() {
            let duration = node.time - before.time;
            let expected = before.pose.heading + 0.5 * (before.yaw_rate + node.yaw_rate) * duration;
            node.pose.heading = expected + wrap(node.pose.heading - expected);
        }
        nodes.push(node);
    }
    nodes
}

/// Converts the signs: starboard and clockwise are positive in the file, port and counter-clockwise
/// here.
fn node(sample: &SampleDocument) -> Option<ForceNode> {
    let node = sample.node?;
    let place = Vector::new(sample.east_m, sample.north_m);
    Some(ForceNode {
        time: sample.t_s,
        pose: Pose::new(place, heading_from_course_deg(node.heading_deg)),
        velocity: Vector::new(node.surge_mps, -node.sway_mps),
        yaw_rate: radians_from_deg(-node.yaw_rate_deg_per_s),
        force: Vector::new(node.surge_n, -node.sway_n),
        moment: -node.yaw_nm,
    })
}
