//! On which side each set is passed: what tells one homotopy class of plans from another.

use super::keep_out::KeepOut;
use crate::frame::{Side, cross};
use crate::trajectory::Steered;

/// Looks over the whole motion, at least; one per piece at least.
const LOOKS: usize = 400;

/// `(x - p_t)' Q_t^-1 (x - p_t)`: a set that never comes nearer than five times its size is not passed at all.
const FAR: f64 = 25.0;

/// Of every set the side, seen along the motion relative to its centre, on which it lies when it is nearest; `None` where
/// it stays far away. Two plans with the same sides pass everything alike: a set that lies to starboard has own ship
/// pass ahead of it or astern according to its motion.
pub fn passing_sides(motion: &Steered, keep_outs: &[KeepOut]) -> Vec<Option<Side>> {
    keep_outs.iter().map(|keep| side(motion, keep)).collect()
}

fn side(motion: &Steered, keep: &KeepOut) -> Option<Side> {
    let mut nearest = (f64::INFINITY, 0.0);
    let looks = LOOKS.div_ceil(motion.nodes().len() - 1);
    for piece in motion.pieces() {
        for look in 0..=looks {
            let part = look as f64 / looks as f64;
            let at = keep.at(piece.start_time + part * piece.duration);
            let level = at.level(piece.position(part));
            if level < nearest.0 {
                let relative = piece.velocity(part) - keep.set().velocity().center();
                nearest = (level, cross(relative, at.center - piece.position(part)));
            }
        }
    }
    (nearest.0 < FAR).then_some(if nearest.1 > 0.0 {
        Side::Port
    } else {
        Side::Starboard
    })
}
