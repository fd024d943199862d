//! Passing sides: the homotopy class of a plan.

use super::keep_out::KeepOut;
use searoom_geometry::frame::{Side, cross};
use searoom_model::trajectory::Steered;

/// Least number of samples over the whole motion; every piece gets at least one.
const SAMPLES: usize = 400;

/// Level `(x - p_t)' Q_t^-1 (x - p_t)` of five times the set's size; a set that stays farther away
/// is not passed.
const FAR_LEVEL: f64 = 25.0;

/// Side of every set at its closest approach, seen along the motion relative to its centre; `None`
/// where it stays far away. Plans with equal sides pass every set in the same manner. For a set to
/// starboard, its motion decides whether own ship passes ahead or astern.
pub fn passing_sides(motion: &Steered, keep_outs: &[KeepOut]) -> Vec<Option<Side>> {
    keep_outs.iter().map(|keep| side(motion, keep)).collect()
}

fn side(motion: &Steered, keep: &KeepOut) -> Option<Side> {
    let mut nearest = (f64::INFINITY, 0.0);
    let samples = SAMPLES.div_ceil(motion.nodes().len() - 1);
    for piece in motion.pieces() {
        for sample in 0..=samples {
            let part = sample as f64 / samples as f64;
            let at = keep.at(piece.start_time + part * piece.duration);
            let level = at.level(piece.position(part));
            if level < nearest.0 {
                let relative = piece.velocity(part) - keep.set().velocity().center();
                nearest = (level, cross(relative, at.center - piece.position(part)));
            }
        }
    }
    (nearest.0 < FAR_LEVEL).then_some(if nearest.1 > 0.0 {
        Side::Port
    } else {
        Side::Starboard
    })
}
