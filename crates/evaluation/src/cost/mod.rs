//! Two cost figures for the deviation from the desired trajectory, docs/reference/theory.md section
//! 7, with a separate quadrature.

pub(crate) mod counted;
pub(crate) mod quadrature;
pub(crate) mod stage_cost;

use crate::cost::quadrature::{adaptive, smooth};
use searoom_model::trajectory::{DesiredTrajectory, Segment};

/// Largest turn per quadrature rule, radians.
const ARC_PIECE: f64 = std::f64::consts::FRAC_PI_4;

/// Space-time error `J = (1 / T_d) ∫ e² dt` in m², docs/reference/theory.md section 7, `q` in
/// m²/s².
///
/// Relative accuracy 1e-9. Intervals are halved towards kinks of `e²`, where the nearest leg
/// changes.
pub(crate) fn space_time_error(segments: &[Segment], desired: &DesiredTrajectory, q: f64) -> f64 {
    let error = |s: &Segment, time: f64| desired.nearest(s.pose_at(time).position, time, q).error;
    let joints = |s: &Segment| -> Vec<f64> {
        let pieces = pieces(s);
        (0..=pieces)
            .map(|k| s.start_time + s.duration * k as f64 / pieces as f64)
            .collect()
    };
    // A small part of the whole needs accuracy relative to the whole only.
    let about: f64 = segments
        .iter()
        .flat_map(|s| {
            let joints = joints(s);
            let rule = |w: &[f64]| smooth(w[0], w[1], &|time| error(s, time));
            joints.windows(2).map(rule).collect::<Vec<_>>()
        })
        .sum();
    let integral: f64 = segments
        .iter()
        .map(|s| adaptive(&joints(s), about, &|time| error(s, time)))
        .sum();
    integral / desired.duration()
}

/// Eq. (30) read literally, m²: `∫ |x(s) - x_d(s)|² + q (t(s) - t_d(s))² ds` over `[0, 1]`.
///
/// Each curve is parametrised by the fraction `s` of its own length. The integral is split at the
/// joints of both curves, and arcs to pi/4, with one Gauss-Legendre rule per piece: accurate to
/// rounding. A wait has no length and is a jump of `t(s)`. NaN for a trajectory of zero length.
pub(crate) fn arc_length_error(segments: &[Segment], desired: &DesiredTrajectory, q: f64) -> f64 {
    let length: f64 = segments.iter().map(Segment::length).sum();
    // Negated on purpose: a NaN has no length either.
    if !(length > 0.0) {
        return f64::NAN;
    }
    let mut cuts = vec![0.0, 1.0];
    let mut starts = Vec::with_capacity(segments.len());
    let mut run = 0.0;
    for s in segments {
        starts.push(run / length);
        let pieces = pieces(s);
        cuts.extend((0..pieces).map(|k| (run + s.length() * k as f64 / pieces as f64) / length));
        run += s.length();
    }
    let joints = desired.legs().iter();
    cuts.extend(joints.map(|leg| leg.start_distance / desired.length()));
    cuts.sort_by(f64::total_cmp);
    cuts.windows(2)
        .filter(|w| w[0] < w[1])
        .map(|w| {
            let middle = 0.5 * (w[0] + w[1]);
            // Only the last of the segments that start at one fraction moves; the others are waits.
            let index = starts.partition_point(|s| *s <= middle).max(1) - 1;
            let (own, own_start) = (&segments[index], starts[index]);
            let legs = desired.legs();
            let begun = legs.partition_point(|leg| leg.start_distance <= middle * desired.length());
            let leg = &legs[begun.max(1) - 1];
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

/// Number of quadrature rules for a segment: one per [`ARC_PIECE`] of turn.
fn pieces(segment: &Segment) -> usize {
    let turn = (segment.turn_rate * segment.duration).abs();
    (turn / ARC_PIECE).ceil().clamp(1.0, 1e4) as usize
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ship_fixtures::{chain, desired};
    use searoom_geometry::frame::{Pose, Vector, direction};

    #[test]
    fn the_integral_matches_a_dense_sum_on_polylines_and_arcs() {
        let wish = desired(
            &[(0.0, 0.0), (300.0, 0.0), (300.0, 200.0), (100.0, 250.0)],
            &[5.0, 4.0, 3.0],
        );
        let own = chain(
            Pose::new(Vector::new(-20.0, 30.0), 0.3),
            &[
                (30.0, 5.0, -0.02),
                (10.0, 0.0, 0.0),
                (50.0, 6.0, 0.045),
                (60.0, 2.5, 0.0),
            ],
        );
        for q in [0.0, 1.0, 25.0] {
            let found = space_time_error(&own, &wish, q);
            let mut sum = 0.0;
            for s in &own {
                let n = 400_000;
                let e = |i: i32| {
                    let t = s.start_time + s.duration * f64::from(i) / f64::from(n);
                    wish.nearest(s.pose_at(t).position, t, q).error
                };
                let inner: f64 = (1..n).map(e).sum();
                sum += (inner + 0.5 * (e(0) + e(n))) * s.duration / f64::from(n);
            }
            let dense = sum / wish.duration();
            assert!((found - dense).abs() < 1e-8 * dense, "{found} {dense}");
        }
    }

    #[test]
    fn the_arc_length_reading_matches_a_dense_sum() {
        let wish = desired(&[(0.0, 0.0), (300.0, 0.0), (300.0, 200.0)], &[5.0, 4.0]);
        let own = chain(
            Pose::new(Vector::new(-20.0, 30.0), 0.3),
            &[
                (0.0, 5.0, 0.0),
                (30.0, 5.0, -0.02),
                (10.0, 0.0, 0.0),
                (50.0, 6.0, 0.045),
            ],
        );
        let found = arc_length_error(&own, &wish, 25.0);
        let total: f64 = own.iter().map(Segment::length).sum();
        let n = 400_000;
        let sum: f64 = (0..n)
            .map(|i| {
                let s = (f64::from(i) + 0.5) / f64::from(n);
                let (mut run, mut k) = (0.0, 0);
                while run + own[k].length() < s * total {
                    run += own[k].length();
                    k += 1;
                }
                let elapsed = (s * total - run) / own[k].speed;
                let x = own[k].pose_after(elapsed).position;
                let t = own[k].start_time + elapsed;
                let d = s * wish.length();
                let (xd, td) = if d < 300.0 {
                    (direction(0.0) * d, d / 5.0)
                } else {
                    (Vector::new(300.0, d - 300.0), 60.0 + (d - 300.0) / 4.0)
                };
                (x - xd).norm_squared() + 25.0 * (t - td) * (t - td)
            })
            .sum();
        let dense = sum / f64::from(n);
        // The wait is a jump. The dense sum locates it to `1 / n` only.
        assert!((found - dense).abs() < 1e-6 * dense, "{found} {dense}");
        assert!(arc_length_error(&own[..1], &wish, 25.0).is_nan());
    }
}
