//! The two figures for how far a plan strays, formulas section 7, by quadrature of their own.

use super::quadrature::{adaptive, smooth};
use crate::trajectory::{DesiredTrajectory, Segment};

/// Radians. Arcs are cut to this before a rule is put on them.
const ARC_PIECE: f64 = std::f64::consts::FRAC_PI_4;

/// The space-time error `J = (1 / T_d) ∫ e² dt` in m², formulas section 7, `q` in m²/s². Accurate to
/// 1e-9 of itself; corners of `e²`, where the nearest leg changes, are closed in on by halving.
pub(super) fn space_time_error(segments: &[Segment], desired: &DesiredTrajectory, q: f64) -> f64 {
    let integral: f64 = segments
        .iter()
        .map(|s| {
            let pieces = pieces(s);
            let joints: Vec<f64> = (0..=pieces)
                .map(|k| s.start_time + s.duration * k as f64 / pieces as f64)
                .collect();
            adaptive(&joints, &|time| {
                desired.nearest(s.pose_at(time).position, time, q).error
            })
        })
        .sum();
    integral / desired.duration()
}

/// Eq. (30) read literally, m²: both curves by their own fraction `s` of their own length,
/// `∫ |x(s) - x_d(s)|² + q (t(s) - t_d(s))² ds` over `[0, 1]`. Cut where either curve has a joint, arcs
/// to pi/4, then one Gauss-Legendre rule per piece: accurate to rounding. A wait has no length and is a
/// jump of `t(s)`. NaN for a trajectory of no length.
pub(super) fn arc_length_error(segments: &[Segment], desired: &DesiredTrajectory, q: f64) -> f64 {
    let length: f64 = segments.iter().map(Segment::length).sum();
    let mut cuts = vec![0.0, 1.0];
    let mut starts = Vec::with_capacity(segments.len());
    let mut run = 0.0;
    for s in segments {
        starts.push(run / length);
        let pieces = pieces(s);
        cuts.extend((0..pieces).map(|k| (run + s.length() * k as f64 / pieces as f64) / length));
        run += s.length();
    }
    cuts.extend(
        desired
            .legs()
            .iter()
            .map(|leg| leg.start_distance / desired.length()),
    );
    if cuts.iter().any(|cut| cut.is_nan()) {
        return f64::NAN;
    }
    cuts.sort_by(f64::total_cmp);
    cuts.windows(2)
        .filter(|w| w[0] < w[1])
        .map(|w| {
            let middle = 0.5 * (w[0] + w[1]);
            // of segments that start at one fraction the last one moves, the others wait
            let own = &segments[starts.partition_point(|s| *s <= middle) - 1];
            let own_start = starts[starts.partition_point(|s| *s <= middle) - 1];
            let legs = desired.legs();
            let leg = &legs[legs
                .partition_point(|leg| leg.start_distance <= middle * desired.length())
                .max(1)
                - 1];
            smooth(w[0], w[1], &|s| {
                let elapsed = (s - own_start) * length / own.speed;
                let along = s * desired.length() - leg.start_distance;
                let apart = own.pose_after(elapsed).position - leg.start - leg.direction * along;
                let late = own.start_time + elapsed - leg.start_time - along / leg.speed;
                apart.norm_squared() + q * late * late
            })
        })
        .sum()
}

/// How many rules a segment needs: one per [`ARC_PIECE`] of turn.
fn pieces(segment: &Segment) -> usize {
    let turn = (segment.turn_rate * segment.duration).abs();
    (turn / ARC_PIECE).ceil().clamp(1.0, 1e4) as usize
}
