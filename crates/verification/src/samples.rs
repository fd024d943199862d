//! Checks that the samples of a document lie on its motion.

use super::claim::{Claim, ClaimedMotion};
use super::motion::around;
use searoom_document::SampleDocument;
use searoom_evaluation::Violation;
use searoom_geometry::frame::{Vector, heading_from_course_deg, heading_of, wrap};
use searoom_geometry::tolerance;

/// Largest time step between two samples, seconds, up to rounding; in a long plan it is the
/// duration divided by [`PARTS`].
const STEP: f64 = 1.0;
const PARTS: f64 = 20_000.0;

/// Returns the first sample that is not on the motion or leaves a gap.
pub(super) fn check(claim: &Claim, motion: &ClaimedMotion) -> Option<Violation> {
    let trajectory = claim.file.trajectory.as_ref();
    let samples = trajectory.map_or(&[][..], |t| &t.samples);
    let wrong = |index: usize, what: String, time: f64| {
        let what = format!("trajectory.samples[{index}]: {what}");
        Some(Violation::new(what, time))
    };
    let step = STEP.max(motion.end_time() / PARTS);
    let mut before = -tolerance::TIME_S;
    for (index, sample) in samples.iter().enumerate() {
        let gap = sample.t_s - before;
        let most = if index == 0 {
            2.0 * tolerance::TIME_S
        } else {
            step * (1.0 + tolerance::FIGURE)
        };
        if !(gap > 0.0 && gap <= most) {
            let allowed = if index == 0 {
                "0".to_owned()
            } else {
                format!("at most {step} s later")
            };
            let what = format!("at {} s, expected {allowed}", sample.t_s);
            return wrong(index, what, before.max(0.0));
        }
        before = sample.t_s;
        if let Some(what) = off(sample, motion) {
            return wrong(index, what, sample.t_s);
        }
    }
    let end = motion.end_time();
    if !((before - end).abs() <= tolerance::TIME_S * (1.0 + end)) {
        let what = format!("none at the end of the motion, {end} s");
        return wrong(samples.len(), what, before.max(0.0));
    }
    None
}

/// Describes how a sample differs from the motion at its time, if it does.
fn off(sample: &SampleDocument, motion: &ClaimedMotion) -> Option<String> {
    let place = Vector::new(sample.east_m, sample.north_m);
    let course = heading_from_course_deg(sample.course_deg);
    let poses = motion.poses_at(sample.t_s).into_iter();
    let away = poses.map(|pose| (pose.position - place).norm());
    let away = away.fold(f64::INFINITY, f64::min);
    if !(away <= tolerance::FIGURE) {
        return Some(format!("{away:.3e} m off the motion"));
    }
    let agrees = match motion {
        ClaimedMotion::Segments(segments) => around(segments, sample.t_s).any(|s| {
            wrap(s.pose_at(sample.t_s).heading - course).abs() <= tolerance::FIGURE
                && (s.speed - sample.speed_mps).abs() <= tolerance::FIGURE
        }),
        ClaimedMotion::Steered { motion, .. } => {
            let piece = motion.piece_at(sample.t_s);
            let velocity = piece.velocity(piece.part(sample.t_s));
            let slow = velocity.norm() <= tolerance::FIGURE;
            (velocity.norm() - sample.speed_mps).abs() <= tolerance::FIGURE
                && (slow || wrap(heading_of(velocity) - course).abs() <= tolerance::FIGURE)
        }
    };
    (!agrees).then(|| "course or speed is not that of the motion".to_owned())
}
